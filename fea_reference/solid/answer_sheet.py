"""Point forces, contact states and body motions of a solid for the answer sheet, SI; a solid has no beam states.

Contacts act at the Gauss points of their zones, or in a corner.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from cprbm_scene.answer import Array, ContactState, PointForce, PointForces, contact_states, frozen_array
from cprbm_scene.statement import Scene, TurningBody
from fea_reference.solid.bodies import is_face_alone, rotation_unknown
from fea_reference.solid.contacts import Touch
from fea_reference.solid.march import March
from fea_reference.solid.pairs import CornerOnEdge
from fea_reference.solid.skin import Skin
from fea_reference.solid.supports import place, tie_reaction


def point_forces(scene: Scene, march: March) -> PointForces:
    """All forces except the loads."""
    rows = [*_at_faces(scene, march), *_on_bodies(scene, march), *_at_stops(march)]
    rows += [row for touch in march.system.touches for row in _at_contact(scene, march, touch)]
    units = march.model.units
    return PointForces.collected(rows, units.length, units.force, tuple(units.origin))


def contacts(
    scene: Scene, march: March, forces: PointForces, touching: Mapping[str, Array]
) -> Mapping[str, ContactState]:
    """States of all contacts."""
    return contact_states(scene.contacts, forces, touching, (march.model.units.length, march.model.units.force))


def body_motions(scene: Scene, march: March) -> dict[str, Array]:
    """Displacement of the first point, m, and rotation of every moving body of the scene, (3,)."""
    z, motions = march.system.z, {}
    for body in march.model.bodies:
        if body.dofs is not None and body.name in scene.bodies:
            moved = body.motion(body.arm(next(iter(body.points))), z) * march.model.units.length
            motions[body.name] = frozen_array((*moved, body.state(z)[2]))
    return motions


def _at_faces(scene: Scene, march: March) -> Iterator[PointForce]:
    """Forces of joints on the beams' end faces and on the joined bodies."""
    model, system = march.model, march.system
    for tie in model.ties:
        at, body, (force, moment) = place(model, system, tie), model.bodies[tie.body], tie_reaction(model, system, tie)
        s = 0.0 if tie.end == "start" else model.lengths[tie.beam]
        yield PointForce(tie.point, model.mesh.names[tie.beam], s, at, force, moment)
        if body.dofs is not None and not is_face_alone(tie, scene):  # the row of an own body states the reaction
            yield PointForce(tie.point, body.name, np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, march: March) -> Iterator[PointForce]:
    """Forces of slides, pivots, drives and pins on bodies."""
    model, z = march.model, march.system.z
    for row in model.rows:
        owner = scene.bodies.get(row.name)
        source = owner.about if isinstance(owner, TurningBody) and row.drive is None else row.name
        pull = -float(z[row.multiplier])
        for share in row.shares:
            body = model.bodies[share.body]
            if body.dofs is not None and body.name in scene.bodies:
                at = body.carried(share.arm, z)
                force, moment = (np.zeros(2), pull) if share.direction is None else (pull * share.direction, 0.0)
                yield PointForce(source, body.name, np.nan, at, force, moment)


def _at_stops(march: March) -> Iterator[PointForce]:
    """Moments of angle stops on beams' ends and on the pins' bodies."""
    model, z = march.model, march.system.z
    for stop in model.stops:
        moment = stop.moment(z)
        if moment:
            tie = next(tie for tie in model.ties if rotation_unknown(tie, model.bodies) == stop.psi)
            at, s = place(model, march.system, tie), 0.0 if tie.end == "start" else model.lengths[tie.beam]
            yield PointForce(stop.name, model.mesh.names[tie.beam], s, at, np.zeros(2), moment)
            if stop.phi is not None:
                yield PointForce(stop.name, model.bodies[stop.body].name, np.nan, at, np.zeros(2), -moment)


def _at_contact(scene: Scene, march: March, touch: Touch) -> Iterator[PointForce]:
    """Forces of a contact on both edges, or on the edge and the rigid body."""
    pair, body = touch.pair, march.model.bodies[touch.pair.body]
    pressing = np.hypot(*touch.push.T) > 0.0
    points, push = touch.points[pressing], touch.push[pressing]
    yield from _on_edge(scene, march, pair.name, (pair.skin, touch.zeta[pressing]), points, push)
    other = pair.other.skin if isinstance(pair.other, CornerOnEdge) else pair.other
    if isinstance(other, Skin):
        yield from _on_edge(scene, march, pair.name, (other, touch.facing[pressing]), points, -push)
    elif body.dofs is not None:
        for at, force in zip(points, push, strict=True):
            yield PointForce(pair.name, body.name, np.nan, at, -force, 0.0)


def _on_edge(
    scene: Scene, march: March, source: str, edge: tuple[Skin, Array], points: Array, push: Array
) -> Iterator[PointForce]:
    """Forces ``push`` (k, 2) on an edge at its places, half a thickness further along the force."""
    model, (skin, zeta) = march.model, edge
    beam, u = model.mesh.names[skin.beam], skin.at(skin.u, zeta)
    half = 0.5 * scene.beams[beam].thickness_at(u)[:, None] / model.units.length
    at = points + half * push / np.hypot(*push.T)[:, None]
    for row in zip(u * model.lengths[skin.beam], at, push, strict=True):
        yield PointForce(source, beam, *row, 0.0)
