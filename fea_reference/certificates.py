"""Certificate of a station's answer."""

import numpy as np

from cprbm_scene.answer import Array, Certificate
from fea_reference.contacts import CLOSED, least_gap
from fea_reference.face import tip_depth
from fea_reference.march import March
from fea_reference.model import Model, OnBeam
from fea_reference.stops import acting_stops
from fea_reference.supports import ground_reaction, joint_reaction, row_reaction
from fea_reference.system import NOTHING, System
from fea_reference.touch import LACKING, Face, Pair
from fea_reference.yielding import SIGNIFICANT, penetration_effects

_VIOLATION = 1e-9
_BALANCE = 1e-8
_RESOLVED = 0.05  # thicknesses: penetration of a rigid body, whose penalty is the stiffest that the elements resolve
_WIDEST_GAP = 0.05  # thicknesses: largest gap with contact pressure
_SLENDER = 0.01  # lengths of the longest beam: largest reference thickness for this gap
_SOFT = 0.05  # accepted relative deficit of a penalty against the resolution of the elements
_ROUND_OFF_UNITS = 1e3  # units of round-off of the stiffest element: measured up to twelve for 10 to 640 elements
_STOP_TENSION = 1e-8  # times the largest force or EI/length: largest tension of a stop


def certify(march: March) -> Certificate:
    """Certificate of the current state, from a fresh assembly.

    The complementarity of a penalty contact is not zero: gap times pressure, relative to mean thickness times largest
    pressure, equals the relative penetration.
    """
    model, settings = march.model, march.settings
    march.reassemble()  # the last Newton iteration used predicted contact forces
    march.remove_gap_round_off()
    system = march.system
    free = np.ones(model.size, dtype=bool)
    free[model.multipliers] = False
    free[model.element_dofs[6]] = False
    residual = float(np.abs(system.residual[free]).max()) / system.scale
    floor = system.floor / system.scale
    violation = float(np.abs(system.residual[~free]).max())
    violation = max(violation, *(-stop.margin(system.z)[0] for stop in model.stops), 0.0)
    penetration = max((contact.penetration / contact.pair.measure for contact in system.touches), default=0.0)
    force, moment, largest = _balance(model, march.values, system)
    # The sum of residuals of all nodes: round-off adds like a random walk. Generalised forces in bent beams exceed the
    # external forces by far.
    balance = max(_BALANCE, system.floor * float(np.sqrt(model.node_dofs.shape[1])) / largest)
    curvature = march.curvature

    failures = []
    if not residual <= max(settings.residual, floor):
        failures.append(f"the unbalanced force is {residual:.1e} of the largest force")
    if not violation <= max(_VIOLATION, system.floor):
        failures.append(f"a joint, a stop or an element's length is violated by {violation:.1e} of the longest beam")
    for stop, limit in acting_stops(model.stops, march.acting):
        press = stop.press(system.z, limit)
        if not press >= -_STOP_TENSION * max(1.0, system.scale):
            failures.append(f"{stop.known_as} acts in tension, with a moment of {press * model.units.moment:.1e} N·m")
    if not system.significant:
        round_off = system.floor * model.units.force
        if march.values[: len(model.loads)].any():
            failures.append(f"the loads cannot be distinguished from round-off, with forces of {round_off:.1e} N")
        elif _drive_below_round_off(march):
            failures.append(
                f"the reactions of drives cannot be distinguished from round-off, with forces of {round_off:.1e} N"
            )
    for pair in march.open:
        if (gap := least_gap(model, pair, system.z)) < -CLOSED * pair.scale:
            failures.append(f"the open contact {pair.name} overlaps by {-gap * model.units.length:.1e} m")
    shares = penetration_effects(model, system, march.penalties, march.open, settings.quadrature)
    for contact in system.touches:
        allowed = settings.penetration if isinstance(contact.pair, Pair) else max(settings.penetration, _RESOLVED)
        overlap = contact.penetration / (contact.pair.scale if isinstance(contact.pair, Pair) else contact.pair.measure)
        if not overlap <= allowed:
            failures.append(
                f"contact {contact.pair.name} has a relative penetration of {overlap:.1e}; {allowed:.1e} was requested"
            )
        elif contact.closed and march.penalties[contact.pair].stiffness < (1.0 - _SOFT) * contact.pair.stiffest:
            failures.append(
                f"the penalty of contact {contact.pair.name} could not be raised to the limit of the elements"
            )
        elif (share := shares.get(contact.pair, 0.0)) > SIGNIFICANT:
            failures.append(
                f"contact {contact.pair.name} has a penetration of {contact.penetration * model.units.length:.1e} m, "
                f"which changes forces or motions by {share:.0%}"
            )
        if isinstance(contact.pair, Face) and contact.closed:
            deep = tip_depth(model, contact.pair, system.z)
            if not deep <= max(settings.penetration, _RESOLVED) * contact.pair.measure:
                failures.append(
                    f"a tip of contact {contact.pair.name} cuts into the beam by {deep * model.units.length:.1e} m"
                )
        # a lead starts the pressure before the gap closes: the predicted pressure over the penalty, which is
        # proportional to EI; a taut beam needs a larger lead
        far = max(0.0, float((contact.gap[contact.gap < 0.0] + march.penalties[contact.pair].lead).max(initial=0.0)))
        if not far <= _WIDEST_GAP * min(contact.pair.measure, _SLENDER):
            failures.append(f"contact {contact.pair.name} presses across a gap of {far * model.units.length:.1e} m")
    if not force <= balance:
        failures.append(f"the forces of loads and supports have a sum of {force:.1e} of the largest")
    if not moment <= balance:
        failures.append(f"the moments of loads and supports have a sum of {moment:.1e} of the largest")
    for contact in system.touches:
        if isinstance(contact.pair, Pair) and contact.missing_share > LACKING:
            end, side = model.beams[contact.pair.second].name, model.beams[contact.pair.first].name
            failures.append(
                f"in contact {contact.pair.name} an end of {end} presses on the side of {side}, and a force of "
                f"{contact.missing * model.units.force:.1e} N along {end} is missing"
            )
    if not curvature > 0.0:
        failures.append(f"the smallest curvature of the potential energy is {curvature:.1e}: no minimum")
    return Certificate(
        residual=residual,
        residual_floor=floor,
        violation=violation,
        penetration=penetration,
        complementarity=penetration,
        force_balance=force,
        moment_balance=moment,
        smallest_curvature=curvature,
        iterations=march.iterations,
        failures=tuple(failures),
    )


def _drive_below_round_off(march: March) -> bool:
    """True if a drive meets resistance, but its reaction so far is below round-off.

    A rigid motion meets only the round-off of elements, of 12 EI/h³, at any distance.
    """
    model = march.model
    round_off = _ROUND_OFF_UNITS * float(np.finfo(float).eps) * model.stiffest / float(model.elements.length.min())
    first = len(model.loads)
    for number, value in enumerate(march.values[first : first + len(model.drives)], start=first):
        reaction = float(np.abs(march.rate(number)[model.multipliers]).max())
        if reaction > round_off and 0.0 < reaction * abs(value) <= NOTHING * march.system.floor:
            return True
    return False


def _balance(model: Model, values: Array, system: System) -> tuple[float, float, float]:
    """|ΣF| and |ΣM| of loads, supports, guides and drives, and the largest force or moment among them.

    Moments are about the origin. Both sums are relative to this largest value if it exceeds round-off.

    The two forces of a contact are opposite on one line and cancel in both sums. A contact force on a fixed body is a
    reaction of the support.
    """
    z = system.z
    forces: list[Array] = []
    moments: list[float] = []

    def act(force: Array, at: Array) -> None:
        forces.append(force)
        moments.append(float(at[0] * force[1] - at[1] * force[0]))

    for joint in model.joints:
        if model.bodies[joint.body].dofs is None:
            force, moment = joint_reaction(joint, z)
            moments.append(moment)
            act(force, z[joint.dofs[:2]])
    for hinge in model.hinges:
        if (reaction := ground_reaction(model, hinge, z)) is not None:
            act(reaction[1], model.carried(model.bodies[hinge.bodies[0]], hinge.arms[0], z))
    for hold in (*model.guides, *model.drives):
        force, moment = row_reaction(hold, z)
        moments.append(moment)
        act(force, model.carried(model.bodies[hold.body], hold.arm, z))
    for stop, _ in acting_stops(model.stops, system.acting):
        if stop.phi is None:
            moments.append(stop.moment(z))
    for part, value in zip(model.loads, values[: len(model.loads)], strict=True):
        if isinstance(part, OnBeam):
            continue
        if part.direction is None:
            moments.append(float(value))
        else:
            act(value * part.direction, model.carried(model.bodies[part.body], part.arm, z))
    for load in system.loads:
        forces.append(load.force.sum(axis=1))
        moments.append(load.moment)
    for contact in system.touches:
        if not isinstance(contact.pair, Pair) and model.bodies[contact.pair.body].dofs is None:
            forces.append(contact.force.sum(axis=1))
            moments.append(float((contact.x[0] * contact.force[1] - contact.x[1] * contact.force[0]).sum()))
    largest_force = max((float(np.hypot(*force)) for force in forces), default=0.0)
    # vanishing forces are judged relative to the moments and conversely: lengths are of order one
    scale = max(largest_force, max(map(abs, moments), default=0.0))
    scale = scale if scale > NOTHING * system.floor else 1.0
    return float(np.hypot(*sum(forces, np.zeros(2)))) / scale, abs(sum(moments)) / scale, scale
