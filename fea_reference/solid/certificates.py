"""Certificate of a station's answer."""

import numpy as np

from cprbm_scene.answer import Certificate
from fea_reference.solid.contacts import touch
from fea_reference.solid.curvature import smallest_curvature
from fea_reference.solid.march import March
from fea_reference.solid.pairs import CornerOnShape, Pair
from fea_reference.solid.rigid import in_body_frame
from fea_reference.solid.skin import Skin
from fea_reference.solid.stops import STIFFNESS
from fea_reference.solid.supports import balance
from fea_reference.solid.system import assemble

_VIOLATION = 1e-9
_BALANCE = 1e-8
_YIELDING = 1e-4  # rad
_OTHER_WAY = 5.0  # times the requested penetration: limit for the penetration seen from the other edge


def certify(march: March) -> Certificate:
    """Certificate of the current state, from a fresh assembly.

    Contact of two beams is integrated along the first edge. The certificate also evaluates the gap from the second
    edge, where the corner of an end on the first's side would show. For an end against a rigid body both corners are
    in contact; the certificate evaluates the face in between.
    """
    model, settings = march.model, march.settings
    march.system = assemble(model, march.penalties, settings.quadrature, march.values, march.system.z)
    system = march.system
    first_row = model.size - len(model.rows)
    residual = float(np.abs(system.residual[:first_row]).max()) / system.scale
    floor = system.floor / system.scale
    violation = float(np.abs(system.residual[first_row:]).max(initial=0.0))
    penetration = max((contact.penetration / contact.pair.measure for contact in system.touches), default=0.0)
    behind = max((_penetration_from_other_side(march, pair) for pair in march.penalties), default=0.0)
    force, moment = balance(model, system, march.values)
    curvature = smallest_curvature(model, system)
    thinnest = float(system.strained.determinants.min())
    allowed = max(_BALANCE, floor * float(np.sqrt(len(model.mesh.places))))
    failures = []
    if not residual <= max(settings.residual, floor):
        failures.append(f"the unbalanced force is {residual:.1e} of the largest force")
    if not violation <= max(_VIOLATION, system.floor):
        failures.append(f"a drive, a slide or a pin is violated by {violation:.1e} of the longest beam")
    yielding = max((abs(stop.moment(system.z)) / STIFFNESS for stop in model.stops), default=0.0)
    if not yielding <= _YIELDING:
        failures.append(f"a stop yields by {yielding:.1e} rad")
    if not thinnest > 0.0:
        failures.append(f"an element is inverted: det F is {thinnest:.1e}")
    if not penetration <= settings.penetration:
        failures.append(
            f"the penetration is {penetration:.1e} of the thickness; {settings.penetration:.1e} was requested"
        )
    if not behind <= _OTHER_WAY * settings.penetration:
        failures.append(f"a beam's end penetrates the opposite side by {behind:.1e} of the thickness")
    if not force <= allowed:
        failures.append(f"the forces of loads and supports have a sum of {force:.1e} of the largest")
    if not moment <= allowed:
        failures.append(f"the moments of loads and supports have a sum of {moment:.1e} of the largest")
    if not curvature > 0.0:
        failures.append(f"the smallest curvature of the potential energy is {curvature:.1e}: no minimum")
    return Certificate(
        residual=residual,
        residual_floor=floor,
        violation=violation,
        penetration=max(penetration, behind),
        complementarity=penetration,
        force_balance=force,
        moment_balance=moment,
        smallest_curvature=curvature,
        iterations=march.iterations,
        failures=tuple(failures),
    )


def _penetration_from_other_side(march: March, pair: Pair) -> float:
    """Penetration of two edges seen from the other edge, relative to the mean thickness."""
    if isinstance(pair.other, CornerOnShape):
        return _face_penetration(march, pair, pair.other)
    if not isinstance(pair.other, Skin):
        return 0.0
    turned = Pair(pair.name, pair.other, pair.skin, -1, pair.measure, -pair.way)
    system = march.system
    return touch(march.model, turned, 1.0, march.settings.quadrature, system.q, system.z).penetration / pair.measure


def _face_penetration(march: March, pair: Pair, butt: CornerOnShape) -> float:
    """Penetration of an end's face into a rigid body, relative to the thickness."""
    model, system = march.model, march.system
    nodes = model.mesh.face(pair.skin.beam, 1.0 if butt.last else 0.0)
    places = (model.mesh.places + system.q.reshape(-1, 2))[nodes]
    g, _, _ = butt.shape.measured(in_body_frame(model.bodies[pair.body], places, system.z))
    return max(0.0, -float(g.min())) / pair.measure
