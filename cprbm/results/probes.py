"""Values of the scene's probes, and states of contacts; meanings in :mod:`cprbm_scene.answer`.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
g, s     gap, arc length of a joint on the first beam
e        arc length of the zone's end
=======  ====================================================================================

Forces act at joints: the outermost force gives e to about one link.  Beyond that force the moment is smooth:
g″ is zero at e.  A parabola through three second differences of g at the next joints has the zero e: under a weight the
moment is a parabola.  The spline spreads a force over one joint on either side; such joints do not count.  A moving
place at the end of a zone is e.

Clamp and contact share the force of a zone beside a weld, and a moment at an own pin is part of the contact: such a
zone begins at the beam's end.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from cprbm.chain import END, ends_of, stop_angle
from cprbm.contact import Geometry
from cprbm.continuation.path import potential
from cprbm.results.statics import Statics, cross, pin_moments, stop_moment
from cprbm.results.view import Pressed, View
from cprbm_scene import Probe
from cprbm_scene.answer import Array, ContactState, PointForces, contact_states, frozen_array
from cprbm_scene.question_records import Quantity
from cprbm_scene.statement import DisplacementDrive, EdgeContact, PinnedEnd

ZONE = 3
"""Closed joints from which a contact has a length: two neighbours share the force of a point."""

SMEARED = 1
"""Joints beside a force with a wrong second difference."""

JOINTS = 5
"""Joints for three second differences."""

NEGLIGIBLE = 1e-4
"""Force of a joint, over the largest force, that errors of the discretisation leave on a flat edge."""

FARTHEST = 1.5
"""Distance, in links, of e from the outermost force; a larger one shows another law of g."""


VALUES: dict[Quantity, tuple[Literal["", "length", "force", "moment"], Callable[[Statics, Probe], ArrayLike]]] = {
    "displacement": ("length", lambda statics, probe: statics.view.displacement(probe.of)),
    "rotation": ("", lambda statics, probe: statics.view.mechanism.rotation(probe.of).value(statics.view.z)),
    "bending_stress": ("", lambda statics, probe: statics.bending_stress(probe.of, probe.points)),
    "combined_stress": ("", lambda statics, probe: statics.combined_stress(probe.of, probe.points)),
    "reaction": ("force", lambda statics, probe: _reaction(statics, probe.of)[0]),
    "reaction_moment": ("moment", lambda statics, probe: _reaction(statics, probe.of)[1]),
    "potential_energy": ("moment", lambda statics, _: potential(statics.view.solved.system, statics.view.solved.state)),
    "angle": ("", lambda statics, probe: stop_angle(statics.view.mechanism, probe.of).value(statics.view.z)),
    "moment": ("moment", lambda statics, probe: abs(_moment(statics.view, probe.of))),
    "force": ("force", lambda statics, probe: contact_force(statics.view, probe.of)),
    "centre": ("length", lambda statics, probe: contact_centre(statics.view, probe.of)),
    "ends": ("length", lambda statics, probe: contact_ends(statics.view, probe.of)),
    "closing_load": ("", lambda statics, probe: closing_load(statics.view, probe.of)),
}
"""Unit and value of every quantity."""


def probe_values(statics: Statics, stage: str) -> dict[str, Array]:
    """Values by the probes' names, SI; empty for a probe that is not asked in the stage."""
    found, units = {}, statics.view.mechanism.units
    for probe in statics.view.scene.probes:
        unit, value = VALUES[probe.quantity]
        asked = np.ravel(value(statics, probe) if probe.asked_in(stage) else [])
        found[probe.name] = frozen_array(asked * getattr(units, unit) if unit else asked)
    return found


def _reaction(statics: Statics, of: str) -> tuple[Array, float]:
    """Force and moment of the ground at a point or on a sliding body, or of the drives of a point or body.

    Joints of two moving parts exert opposite forces on the parts, and cancel.
    """
    view, scene = statics.view, statics.view.scene
    parts = {
        **{
            name: drive.point if isinstance(drive, DisplacementDrive) else drive.body
            for name, drive in scene.drives.items()
        },
        **{name: getattr(scene.beams[stop.beam], stop.end).point for name, stop in scene.stops.items()},
        **{name: of for name, pin in scene.pins.items() if of in pin.points},
    }
    sources = {of, *(name for name, part in parts.items() if part == of)}
    moving = {*scene.beams, *view.mechanism.bodies}
    found = [each for each in statics.forces if each.source in sources and each.target in moving]
    slides = of in scene.bodies and not sources - {of}
    return sum((each.force for each in found), np.zeros(2)), 0.0 if slides else sum(each.moment for each in found)


def contact_force(view: View, contact: str) -> float:
    """Magnitude of the resultant on the first beam."""
    return float(np.hypot(*view.pressed[contact].forces[:, 0].sum(axis=0)))


def contact_centre(view: View, contact: str) -> list[float]:
    """Arc length of the resultant on the first beam; empty for an open contact."""
    found = view.pressed[contact]
    weights = np.hypot(*found.forces[:, 0].T)
    return [float(np.average(found.arcs[:, 0], weights=weights))] if weights.sum() > 0.0 else []


def closing_load(view: View, contact: str) -> list[float]:
    """Value (SI) of the stepped load or drive at the first closing of a contact; else empty."""
    return [view.closing[contact]] if contact in view.closing and contact_force(view, contact) > 0.0 else []


def _moment(view: View, of: str) -> float:
    """Moment of a stop on its beam, or of a contact on the beam about the first pin on the edge; else zero."""
    record = view.scene.contacts.get(of)
    if record is None:
        return stop_moment(view, of)
    if isinstance(record, EdgeContact):
        for end, joint in zip(END, ends_of(view.scene, record.beam), strict=True):
            if isinstance(joint, PinnedEnd) and view.scene.body_of(joint.point) == record.body:
                about = view.end(record.beam, end)[1]
                held, found = sum(moment for _, _, moment in pin_moments(view, of)), view.pressed[of]
                return float(held + cross(found.places[:, 0] - about, found.forces[:, 0]).sum())
    return 0.0


def touching_places(view: View) -> dict[str, Array]:
    """Positions (k, 2), m, of the closed contacts."""
    units, places = view.mechanism.units, {name: [*pressed.surface] for name, pressed in view.pressed.items()}
    for name, of in places.items():
        of += [view.end(beam, end)[1] for beam, end, _ in pin_moments(view, name)]
    return {name: frozen_array(np.array(of) * units.length + units.origin) for name, of in places.items() if of}


def states_of_contacts(view: View, forces: PointForces, touching: Mapping[str, Array]) -> Mapping[str, ContactState]:
    """States of all contacts.

    The force of a contact beside a clamp is indeterminate, and beside a moment at an own pin.
    """
    units = view.mechanism.units
    states = contact_states(view.scene.contacts, forces, touching, (units.length, units.force))
    return {name: replace(state, indeterminate=_is_shared(view, name)) for name, state in states.items()}


def _is_shared(view: View, contact: str) -> bool:
    """True if a joint beside a weld or an own pin takes a part of the force."""
    shares = view.pressed[contact].shares
    return bool(shares.any()) or (len(shares) > 0 and any(True for _ in pin_moments(view, contact)))


def contact_ends(view: View, contact: str) -> list[float]:
    """Arc lengths on the first beam at which the first zone begins and the last zone ends; empty without contact."""
    geometry, found = view.solved.system.geometry, view.pressed[contact]
    pins = [view.end(beam, end)[0] for beam, end, _ in pin_moments(view, contact)]
    sizes = np.hypot(*found.forces[:, 0].T)
    if not len(sizes) and not pins:
        return []
    found = Pressed(*(column[sizes >= NEGLIGIBLE * sizes.max(initial=0.0)] for column in found))
    arcs = [*found.arcs[:, 0].tolist(), *pins]
    low, high = min(arcs), max(arcs)
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    of_joints = np.all(found.on_first | found.moves) and not geometry.pairs[pair].itself
    if (len(found.arcs) < ZONE and not pins) or not of_joints:
        return [low, high]
    length = float(geometry.curves[geometry.pairs[pair].first].arcs[-1])
    clamps = [0.0 if share > 0 else length for share in found.shares.tolist() if share]
    begin, end = min([low, *clamps]), max([high, *clamps])
    held = [*pins, *clamps, *found.arcs[found.moves, 0].tolist()]
    return [
        begin if begin in held else _zone_end(view, geometry, pair, low, sense=-1.0),
        end if end in held else _zone_end(view, geometry, pair, high, sense=1.0),
    ]


def _zone_end(view: View, geometry: Geometry, pair: int, outermost: float, *, sense: float) -> float:
    """e beyond the ``outermost`` force, in the ``sense`` of growing or falling arc lengths."""
    contacts = view.solved.state.contacts
    places = contacts.places
    mine = (places.pair == pair) & (places.curve == geometry.pairs[pair].first) & ~places.moves & ~contacts.closed
    arcs = geometry.arrays.arc[places.piece] + places.xi * geometry.arrays.span[places.piece]
    span = float(geometry.arrays.span[places.piece].max())
    beyond = np.flatnonzero(mine & (sense * (arcs - outermost) > 0.25 * span))
    joints = beyond[np.argsort(sense * arcs[beyond])][SMEARED - 1 : SMEARED - 1 + JOINTS]
    s, g = arcs[joints], view.solved.gaps[joints]
    if len(joints) < JOINTS or not np.all(np.isfinite(g)):
        return outermost
    # g″ of a cubic through three joints each, and the places, the means of the joints
    slopes = np.diff(g) / np.diff(s)
    parting, at = np.diff(slopes) / (0.5 * (s[2:] - s[:-2])), (s[2:] + s[1:-1] + s[:-2]) / 3.0
    if not np.all(np.diff(parting, prepend=0.0) > 0.0):
        return outermost
    # the zero of the parabola through g″ that is nearest to the outermost force
    zeros = Polynomial.fit(at, parting, 2).roots()
    end = min(zeros[zeros.imag == 0.0].real.tolist(), key=lambda zero: abs(zero - outermost), default=np.inf)
    return end if abs(end - outermost) <= FARTHEST * span else outermost
