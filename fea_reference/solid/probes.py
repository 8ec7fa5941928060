"""Probed quantities at a station, in SI units, as :mod:`cprbm_scene.answer` defines them."""

import numpy as np

from cprbm_scene.answer import Array, Shape, frozen_array
from cprbm_scene.statement import DisplacementDrive, Probe, Scene, TurningBody
from fea_reference.solid.beam_loads import AreaLoad
from fea_reference.solid.beam_moments import CouplePart
from fea_reference.solid.contacts import Touch, closed
from fea_reference.solid.march import March
from fea_reference.solid.model import SharePart
from fea_reference.solid.pairs import CornerOnEdge
from fea_reference.solid.skin import Skin
from fea_reference.solid.stress import bending_and_membrane
from fea_reference.solid.supports import Wrench, cross, moving_share, place, row_reaction, tie_reaction

_NOTHING = 1e-9  # times the largest force


def probed(scene: Scene, march: March, probe: Probe) -> Array:
    """Value of a probe; the potential energy excludes the energy of contact penalties."""
    model, system = march.model, march.system
    units, z = model.units, system.z
    match probe.quantity:
        case "displacement":
            body = next(body for body in model.bodies if probe.of in body.points)
            return frozen_array(body.motion(body.arm(probe.of), z) * units.length)
        case "rotation":
            body = next(body for body in model.bodies if body.name == probe.of)
            return frozen_array(body.state(z)[2])
        case "reaction":
            forces = [force for force, _ in _reactions(scene, march, probe.of)]
            return frozen_array(sum(forces, np.zeros(2)) * units.force)
        case "reaction_moment":
            return frozen_array(sum(moment for _, moment in _reactions(scene, march, probe.of)) * units.moment)
        case "bending_stress" | "combined_stress":
            E = scene.materials[scene.beams[probe.of].material].youngs_modulus
            u = np.linspace(0.0, 1.0, probe.points)
            bending, membrane = bending_and_membrane(model, system.q, model.mesh.names.index(probe.of), E, u)
            return frozen_array(bending if probe.quantity == "bending_stress" else np.abs(bending) + np.abs(membrane))
        case "potential_energy":
            return frozen_array(_potential_energy(march) * units.moment)
        case "closing_load":
            return frozen_array(march.closing[probe.of] if _touches(march, probe.of) else [])
        case "force":
            return frozen_array(_resultant(march, probe.of) * units.force)
        case "centre":
            return frozen_array(_centre(scene, march, probe.of))
        case "ends":
            return frozen_array(_ends(scene, march, probe.of))
        case "angle":
            return frozen_array(next(stop for stop in model.stops if stop.name == probe.of).angle(z))
        case "moment":
            if probe.of in scene.contacts:
                return frozen_array(abs(_moment_about_pin(scene, march, probe.of)) * units.moment)
            return frozen_array(next(stop for stop in model.stops if stop.name == probe.of).moment(z) * units.moment)


def shapes(march: March) -> dict[str, Shape]:
    """Neutral lines of the deformed beams, SI."""
    model, drawn = march.model, {}
    places = model.mesh.places + march.system.q.reshape(-1, 2)
    for i, name in enumerate(model.mesh.names):
        nodes = model.mesh.line(i, 0.0)
        x, y = places[nodes].T * model.units.length + model.units.origin[:, None]
        s = model.mesh.u[nodes] * model.lengths[i] * model.units.length
        drawn[name] = Shape(frozen_array(s), frozen_array(x), frozen_array(y))
    return drawn


def touching(march: March) -> dict[str, Array]:
    """Positions of the closed contacts' points on the first edge, (k, 2) in metres."""
    units = march.model.units
    return {
        name: frozen_array(np.concatenate([contact.points for contact in contacts]) * units.length + units.origin)
        for name in dict.fromkeys(pair.name for pair in march.penalties)
        if (contacts := _touches(march, name))
    }


def _touches(march: March, name: str) -> tuple[Touch, ...]:
    """Touching pairs of a contact; empty if open, or if the force is round-off."""
    contacts = closed(march.system.touches).get(name, ())
    force = sum(float(np.hypot(*contact.push.T).sum()) for contact in contacts)
    return contacts if force > _NOTHING * march.system.scale else ()


def _arc_lengths(march: March, contact: Touch, zeta: Array, facing: Array) -> Array:
    """Arc lengths (k,), m, on the neutral line of the edge that carries the integral.

    In self-contact the smaller arc length of both places counts, with the other place at ``facing`` (k,).
    """
    skin, other = contact.pair.skin, contact.pair.other
    u = skin.at(skin.u, zeta)
    if contact.pair.way:
        partner = other if isinstance(other, Skin) else other.skin if isinstance(other, CornerOnEdge) else skin
        u = np.minimum(u, partner.at(partner.u, facing))
    return u * march.model.lengths[skin.beam] * march.model.units.length


def _ends_of(march: March, contact: Touch) -> Array:
    """Arc lengths of the ends of a pair's zones; in self-contact of the outermost points."""
    if contact.pair.way:
        return _arc_lengths(march, contact, contact.zeta, contact.facing)
    return _arc_lengths(march, contact, contact.zones.zones.ravel(), np.empty(0))


def _resultant(march: March, name: str) -> float:
    """Magnitude of a contact's force on its first beam; in self-contact on the later of both places."""
    pushes = (-contact.push if contact.pair.way > 0 else contact.push for contact in _touches(march, name))
    return float(np.hypot(*sum((push.sum(axis=0) for push in pushes), np.zeros(2))))


def _moment_about_pin(scene: Scene, march: March, name: str) -> float:
    """Moment of a contact's forces on the beam about the first of its pins on the opposite body."""
    model, moment = march.model, 0.0
    for contact in _touches(march, name):
        body = model.bodies[contact.pair.body].name
        pins = (tie for tie in model.ties if tie.beam == contact.pair.skin.beam and _moves_with(scene, tie.point, body))
        tie = next(pins, None)
        if tie is not None:
            moment += float(cross(contact.points - place(model, march.system, tie), contact.push).sum())
    return moment


def _moves_with(scene: Scene, point: str, body: str) -> bool:
    """True if a point belongs to the body or is pinned to a point of it; all fixed bodies count as one."""
    points = {point}.union(*(pin.points for pin in scene.pins.values() if point in pin.points))
    fixed = {name for name, record in scene.bodies.items() if record.motion == "fixed"}
    return any(scene.body_of(point_name) in (fixed if body in fixed else {body}) for point_name in points)


def _centre(scene: Scene, march: March, name: str) -> Array:
    contacts = _touches(march, name)
    if not contacts:
        return np.empty(0)
    weights = np.concatenate([np.hypot(*contact.push.T) for contact in contacts])
    places = np.concatenate([_arc_lengths(march, contact, contact.zeta, contact.facing) for contact in contacts])
    return np.array([weights @ places / weights.sum()])


def _ends(scene: Scene, march: March, name: str) -> Array:
    contacts = _touches(march, name)
    if not contacts:
        return np.empty(0)
    places = np.concatenate([_ends_of(march, contact) for contact in contacts])
    return np.array([places.min(), places.max()])


def _potential_energy(march: March) -> float:
    model, system = march.model, march.system
    energy = system.strained.energy
    for part, value in zip(model.loads, march.values[: len(model.loads)], strict=True):
        if isinstance(part, SharePart):
            continue  # zero whenever a probe is evaluated
        if isinstance(part, CouplePart):
            moved = _section_rotation(march, part)
        elif isinstance(part, AreaLoad):
            moved = float((part.forces * system.q.reshape(-1, 2)[part.nodes]).sum())
        elif part.direction is None:
            moved = float(model.bodies[part.body].state(system.z)[2])
        else:
            moved = float(part.direction @ model.bodies[part.body].motion(part.arm, system.z))
        energy -= float(value) * moved
    return energy


def _section_rotation(march: March, part: CouplePart) -> float:
    """Rotation of a moment's section, full turns included."""
    model, z = march.model, march.system.z
    beam = int(model.mesh.beams[part.nodes[0]])
    tie = next(tie for tie in model.ties if tie.beam == beam)  # the tie at the start comes first
    start = float(model.bodies[tie.body].state(z)[2]) if tie.psi is None else float(z[tie.psi])
    drawn = model.mesh.places
    return part.turned(drawn, drawn + march.system.q.reshape(-1, 2), start)


def _reactions(scene: Scene, march: March, name: str) -> list[Wrench]:
    """Reaction forces and moments at a fixed point, with pivots, or of guides and drives of a point or body."""
    model, system = march.model, march.system
    turning = {key for key, body in scene.bodies.items() if isinstance(body, TurningBody) and body.about == name}
    reactions = [
        tie_reaction(model, system, tie)
        for tie in model.ties
        if tie.point == name and model.bodies[tie.body].dofs is None
    ]
    for row in model.rows:
        if row.point:
            if row.point == name and (i := moving_share(model, row)) is not None:
                direction = row.shares[i].direction
                assert direction is not None
                reactions.append((-float(system.z[row.multiplier]) * direction, 0.0))
        elif row.drive is not None:
            drive = scene.drives[row.drive]
            if name == (drive.point if isinstance(drive, DisplacementDrive) else drive.body):
                reactions.append(row_reaction(row, system))
        elif row.name in scene.pins:
            i = moving_share(model, row)
            if i is not None and scene.pins[row.name].points[1 - i] == name:
                direction = row.shares[i].direction
                assert direction is not None
                reactions.append((-float(system.z[row.multiplier]) * direction, 0.0))
        elif row.name in turning or row.name == name:
            reactions.append(row_reaction(row, system))
    return reactions
