"""Probed quantities at a station, in SI units, as :mod:`cprbm_scene.answer` defines them."""

import numpy as np

from cprbm_scene.answer import Array, Shape, frozen_array
from cprbm_scene.statement import DisplacementDrive, Probe, Scene, TurningBody
from fea_reference.ends import ends
from fea_reference.energy import potential_energy
from fea_reference.march import March
from fea_reference.recovery import bending_moment, normal_force
from fea_reference.stops import acting_stops
from fea_reference.supports import ground_reaction, joint_reaction, row_reaction
from fea_reference.touch import Pair, Touch

_NOTHING = 1e-9  # of the largest force


def probed(scene: Scene, march: March, probe: Probe) -> Array:
    """Value of a probe; the potential energy excludes the energy of contact penalties."""
    model, z = march.model, march.system.z
    units = model.units
    match probe.quantity:
        case "displacement":
            body = next(body for body in model.bodies if probe.of in body.points)
            return frozen_array((model.place(body, probe.of, z) - body.points[probe.of]) * units.length)
        case "rotation":
            body = next(body for body in model.bodies if body.name == probe.of)
            return frozen_array(model.body_state(body, z)[2])
        case "reaction":
            forces = [force for force, _ in _reactions(scene, march, probe.of)]
            return frozen_array(sum(forces, np.zeros(2)) * units.force)
        case "reaction_moment":
            return frozen_array(sum(moment for _, moment in _reactions(scene, march, probe.of)) * units.moment)
        case "bending_stress":
            u, beam = np.linspace(0.0, 1.0, probe.points), scene.beams[probe.of]
            moment = bending_moment(model, march.system, model.beam(probe.of), u)
            # M t/(2I), with I of the local rectangle
            return frozen_array(moment * units.moment * 6.0 / (beam.width_at(u) * beam.thickness_at(u) ** 2))
        case "combined_stress":
            u, beam = np.linspace(0.0, 1.0, probe.points), scene.beams[probe.of]
            width, thickness, part = beam.width_at(u), beam.thickness_at(u), model.beam(probe.of)
            moment = bending_moment(model, march.system, part, u) * units.moment
            normal = normal_force(model, march.system, part, u) * units.force
            return frozen_array(np.abs(moment) * 6.0 / (width * thickness**2) + np.abs(normal) / (width * thickness))
        case "potential_energy":
            return frozen_array(potential_energy(model, march.system, march.values) * units.moment)
        case "closing_load":
            closed = _touch(march, probe.of) is not None or _ends_held_by_moment(march, probe.of)
            return frozen_array(march.closing[probe.of] if closed else [])
        case "angle":
            return frozen_array(next(stop for stop in model.stops if stop.name == probe.of).angle(z))
        case "moment":
            return frozen_array(abs(_moment(march, probe.of)) * units.moment)
        case "force":
            touch = _touch(march, probe.of)
            return frozen_array(0.0 if touch is None else np.hypot(*touch.force.sum(axis=1)) * units.force)
        case "centre":
            touch = _touch(march, probe.of)
            return frozen_array([] if touch is None else _centre(march, touch) * units.length)
        case "ends":
            touch, pinned_ends = _touch(march, probe.of), _ends_held_by_moment(march, probe.of)
            places = [*pinned_ends, *([] if touch is None else _ends(march, touch))]
            return frozen_array(np.array([min(places), max(places)]) * units.length if places else [])


def shapes(march: March) -> dict[str, Shape]:
    """Nodes of the deformed beams, SI."""
    model, drawn = march.model, {}
    for beam in model.beams:
        line = model.line(beam, march.system.z)
        x, y = line.points * model.units.length + model.units.origin[:, None]
        s = np.linspace(0.0, beam.length * model.units.length, line.n + 1)
        drawn[beam.name] = Shape(frozen_array(s), frozen_array(x), frozen_array(y))
    return drawn


def touching(march: March) -> dict[str, Array]:
    """Midpoints between the surfaces at the Gauss points of closed contacts, (k, 2) in metres."""
    model, places = march.model, {}
    for contact in march.system.touches:
        if contact.closed:
            if isinstance(contact.pair, Pair):
                # from a neutral line to its own surface; lines have none
                own, other = (model.beams[i].thickness for i in (contact.pair.first, contact.pair.second))
                to_surfaces = np.asarray(contact.pair.distance / (own + other) * (other - own))
                if contact.pair.tapers is not None:
                    to_surfaces = contact.pair.tapers.second.at(contact.zeta_m) - contact.pair.tapers.first.at(
                        contact.zeta
                    )
            else:
                # points of a rigid body are on its surface already
                to_surfaces = -contact.pair.edge.at(contact.zeta)
            middle = 0.5 * (contact.x + contact.x_m + to_surfaces * contact.normal)
            places[contact.pair.name] = frozen_array((middle * model.units.length + model.units.origin[:, None]).T)
    return places


def _moment(march: March, name: str) -> float:
    """Moment of a stop, or of a contact on a beam about the first of its pins on the contact edge."""
    model, z = march.model, march.system.z
    stops = [stop for stop in model.stops if stop.known_as == name]
    moment = sum(stop.moment(z) for stop in stops)
    for contact in march.system.touches:
        if contact.pair.name == name and stops:
            pin = model.line(model.beam(stops[0].end[0]), z).points[:, 0 if stops[0].end[1] == "start" else -1]
            arm = contact.x - pin[:, None]
            moment += float((arm[0] * contact.force[1] - arm[1] * contact.force[0]).sum())
    return moment


def _ends_held_by_moment(march: March, name: str) -> list[float]:
    """Arc lengths of the pinned ends that the named contact holds by a moment."""
    model, ends_held = march.model, []
    for stop, _ in acting_stops(model.stops, march.acting):
        if stop.owner == name:
            ends_held.append(0.0 if stop.end[1] == "start" else model.beam(stop.end[0]).length)
    return ends_held


def _reactions(scene: Scene, march: March, name: str) -> list[tuple[Array, float]]:
    """Reaction forces and moments at a fixed point, or of guides and drives of a point or body.

    A fixed point includes its pivots and stops.
    """
    model, z = march.model, march.system.z
    turning = {key for key, body in scene.bodies.items() if isinstance(body, TurningBody) and body.about == name}
    joints = [joint for joint in model.joints if model.bodies[joint.body].dofs is None]
    hinges = [reaction for hinge in model.hinges if (reaction := ground_reaction(model, hinge, z)) is not None]
    return [
        *(joint_reaction(joint, z) for joint in joints if joint.point == name),
        *((force, 0.0) for point, force in hinges if point == name),
        *(row_reaction(part, z) for part in model.guides if part.name in turning or part.name == name),
        *((np.zeros(2), stop.moment(z)) for stop in model.stops if stop.phi is None and stop.point == name),
        *(row_reaction(part, z) for part in model.drives if _driven_name(scene, part.name) == name),
    ]


def _driven_name(scene: Scene, drive: str) -> str:
    """Name of the point or body that a drive moves."""
    part = scene.drives[drive]
    return part.point if isinstance(part, DisplacementDrive) else part.body


def _touch(march: March, name: str) -> Touch | None:
    """The closed contact of this name; None if open, or if its force is round-off."""
    for contact in march.system.touches:
        if (
            contact.pair.name == name
            and contact.closed
            and np.hypot(*contact.force).sum() > _NOTHING * march.system.scale
        ):
            return contact
    return None


def _centre(march: March, touch: Touch) -> float:
    """Arc length of the pressure's centre on the beam that the scene names first."""
    weight = np.hypot(*touch.force)
    zeta = touch.zeta_m if isinstance(touch.pair, Pair) and touch.pair.turned else touch.zeta
    return float(weight @ _arc_lengths(march, touch, zeta) / weight.sum())


def _ends(march: March, touch: Touch) -> Array:
    """Arc lengths (2,) of the ends of the contact zone, on the beam that the scene names first."""
    zeta = ends(march.model, march.system, touch)
    pair, model, z = touch.pair, march.model, march.system.z
    if isinstance(pair, Pair) and pair.turned:
        first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
        nearest = np.argmin(np.abs(touch.zeta[:, None] - zeta), axis=0)
        zeta = pair.places_facing(first, second, zeta, touch.zeta_m[nearest]).zeta_m
    return np.sort(_arc_lengths(march, touch, zeta))


def _arc_lengths(march: March, touch: Touch, zeta: Array) -> Array:
    """Arc lengths (k,) of places ``zeta`` (k,) on the beam that the scene names first."""
    pair = touch.pair
    number = pair.second if isinstance(pair, Pair) and pair.turned else pair.first
    line = march.model.line(march.model.beams[number], march.system.z)
    e, xi = line.locate(zeta)
    start = np.concatenate([[0.0], np.cumsum(line.lengths)])
    return np.asarray(start[e] + xi * line.lengths[e])
