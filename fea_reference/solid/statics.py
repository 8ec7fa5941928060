"""What acts at a station besides the loads, and where the areas' nodes are, for those who sum it up anew; SI.

Contacts act at the Gauss points of their zones.  Nothing here is used to find a state.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Area, Array, Statics, frozen_array
from cprbm_scene.statement import Scene, TurningBody
from fea_reference.solid.bodies import is_own, stands_on
from fea_reference.solid.contacts import Touch
from fea_reference.solid.march import March
from fea_reference.solid.pairs import Tip
from fea_reference.solid.skin import Skin
from fea_reference.solid.supports import place, support


@dataclass(frozen=True, slots=True)
class _Acting:
    """Forces (k, 2) of one kind on one beam or body, at places (k, 2) and arc lengths (k,), without units."""

    by: str
    on: str
    s: Array
    places: Array
    forces: Array
    moments: Array


def statics(scene: Scene, march: March) -> Statics:
    """What acts in the state that the march has reached."""
    model, units, z = march.model, march.model.units, march.system.z
    parts = [*_joints(scene, march), *_on_bodies(scene, march), *_stops(march)]
    for one in march.system.touches:
        parts += _touching(scene, march, one)
    empty = np.zeros((0, 2))
    bodies = {}
    for body in model.bodies:
        if body.dofs is not None and body.name in scene.bodies:
            moved = body.motion(body.arm(next(iter(body.points))), z) * units.length
            bodies[body.name] = frozen_array((*moved, body.state(z)[2]))
    return Statics(
        by=tuple(part.by for part in parts for _ in part.s),
        on=tuple(part.on for part in parts for _ in part.s),
        s=frozen_array(np.concatenate([np.zeros(0), *(part.s for part in parts)]) * units.length),
        places=frozen_array(np.concatenate([empty, *(part.places for part in parts)]) * units.length + units.origin),
        forces=frozen_array(np.concatenate([empty, *(part.forces for part in parts)]) * units.force),
        moments=frozen_array(np.concatenate([np.zeros(0), *(part.moments for part in parts)]) * units.moment),
        bodies=bodies,
        inside={name: _area(march, i) for i, name in enumerate(model.mesh.names)},
    )


def _area(march: March, beam: int) -> Area:
    model, mesh = march.model, march.model.mesh
    layers = np.unique(np.round(mesh.eta[mesh.beams == beam], 9))
    lines = [mesh.line(beam, float(eta)) for eta in layers]
    places = mesh.places + march.system.q.reshape(-1, 2)
    x, y = np.stack([places[nodes] for nodes in lines], axis=1).transpose(2, 0, 1) * model.units.length
    along = mesh.u[lines[0]] * model.lengths[beam] * model.units.length
    at = model.units.origin
    across = np.array([mesh.eta[nodes[0]] for nodes in lines])  # to the last digit
    return Area(frozen_array(along), frozen_array(across), frozen_array(x + at[0]), frozen_array(y + at[1]))


def _one(by: str, on: str, s: float, at: Array, force: Array, moment: float) -> _Acting:
    return _Acting(by, on, np.array([s]), at.reshape(1, 2), np.asarray(force).reshape(1, 2), np.array([moment]))


def _joints(scene: Scene, march: March) -> Iterator[_Acting]:
    """Of joints on the beams' end faces and on the bodies that these are tied to."""
    model, system = march.model, march.system
    for tie in model.ties:
        at, body, (force, moment) = place(model, system, tie), model.bodies[tie.body], support(model, system, tie)
        s = 0.0 if tie.end == "start" else model.lengths[tie.beam]
        yield _one(tie.point, model.mesh.names[tie.beam], s, at, force, moment)
        if body.dofs is not None and not is_own(tie, scene):  # what carries such a face is told of with its row
            yield _one(tie.point, body.name, np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, march: March) -> Iterator[_Acting]:
    """Of slides, pivots, drives and pins between bodies."""
    model, z = march.model, march.system.z
    for row in model.rows:
        owner = scene.bodies.get(row.name)
        name = owner.about if isinstance(owner, TurningBody) and row.drive is None else row.name
        pull = -float(z[row.multiplier])
        for share in row.shares:
            body = model.bodies[share.body]
            if body.dofs is None or body.name not in scene.bodies:
                continue
            at = body.carried(share.arm, z)
            force, moment = (np.zeros(2), pull) if share.direction is None else (pull * share.direction, 0.0)
            yield _one(name, body.name, np.nan, at, force, moment)


def _stops(march: March) -> Iterator[_Acting]:
    model, z = march.model, march.system.z
    for stop in model.stops:
        moment = stop.moment(z)
        if moment:
            tie = next(tie for tie in model.ties if stands_on(tie, model.bodies) == stop.psi)
            at, s = place(model, march.system, tie), 0.0 if tie.end == "start" else model.lengths[tie.beam]
            yield _one(stop.name, model.mesh.names[tie.beam], s, at, np.zeros(2), moment)
            if stop.phi is not None:
                yield _one(stop.name, model.bodies[stop.body].name, np.nan, at, np.zeros(2), -moment)


def _touching(scene: Scene, march: March, one: Touch) -> Iterator[_Acting]:
    """Of a contact at its Gauss points, or in a corner."""
    model, pair = march.model, one.pair
    size = np.hypot(*one.push.T)
    mine = size > 0.0
    points, push, way = one.points[mine], one.push[mine], one.push[mine] / size[mine, None]
    yield _pressed(scene, march, pair.name, pair.skin, one.zeta[mine], points, push, way)
    other = pair.other.skin if isinstance(pair.other, Tip) else pair.other
    if isinstance(other, Skin):
        yield _pressed(scene, march, pair.name, other, one.facing[mine], points, -push, -way)
    elif model.bodies[pair.body].dofs is not None:
        none = np.zeros(len(points))
        yield _Acting(pair.name, model.bodies[pair.body].name, none + np.nan, points, -push, none)


def _pressed(
    scene: Scene, march: March, name: str, skin: Skin, zeta: Array, points: Array, push: Array, way: Array
) -> _Acting:
    """Forces ``push`` (k, 2), along ``way``, on an edge at its ζ (k,), half a thickness further along them."""
    model = march.model
    beam, u = model.mesh.names[skin.beam], skin.at(skin.u, zeta)
    half = 0.5 * scene.beams[beam].thickness_at(u)[:, None] / model.units.length
    return _Acting(name, beam, u * model.lengths[skin.beam], points + half * way, push, np.zeros(len(points)))
