"""What acts at a station besides the loads, and what the beams are inside, for those who sum it up anew; SI.

Contacts act at the Gauss points of their zones.  Nothing here is used to find a state.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Inside, Statics, frozen_array
from cprbm_scene.statement import Scene, TurningBody
from fea_reference.march import March
from fea_reference.model import BeamPart
from fea_reference.stops import acting_stops
from fea_reference.supports import held, support
from fea_reference.touch import Pair, Touch
from fea_reference.upright import upright


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
    parts = [*_joints(march), *_on_bodies(scene, march), *_stops(march)]
    for one in march.system.touches:
        parts += _touching(march, one)
    empty = np.zeros((0, 2))
    bodies = {}
    for body in model.bodies:
        if body.dofs is not None:
            first = next(iter(body.points))
            moved = (model.place(body, first, z) - body.points[first]) * units.length
            bodies[body.name] = frozen_array((*moved, model.body_state(body, z)[2]))
    inside = {}
    for beam in model.beams:
        n = beam.elements.stop - beam.elements.start
        inside[beam.name] = Inside(
            "elements",
            frozen_array(np.linspace(0.0, beam.length * units.length, n + 1)),
            frozen_array(z[model.node_dofs[2, beam.nodes]]),
            frozen_array(z[model.element_dofs[6, beam.elements]] * units.force),
            upright(scene, beam.name),
        )
    return Statics(
        by=tuple(part.by for part in parts for _ in part.s),
        on=tuple(part.on for part in parts for _ in part.s),
        s=frozen_array(np.concatenate([np.zeros(0), *(part.s for part in parts)]) * units.length),
        places=frozen_array(np.concatenate([empty, *(part.places for part in parts)]) * units.length + units.origin),
        forces=frozen_array(np.concatenate([empty, *(part.forces for part in parts)]) * units.force),
        moments=frozen_array(np.concatenate([np.zeros(0), *(part.moments for part in parts)]) * units.moment),
        bodies=bodies,
        inside=inside,
    )


def _one(by: str, on: str, s: float, at: Array, force: Array, moment: float) -> _Acting:
    return _Acting(by, on, np.array([s]), at.reshape(1, 2), np.asarray(force).reshape(1, 2), np.array([moment]))


def _joints(march: March) -> Iterator[_Acting]:
    """Of joints on the beams' ends and on the bodies that these are joined to."""
    model, z = march.model, march.system.z
    ends = {int(model.node_dofs[0, beam.nodes.start]): (beam, 0.0) for beam in model.beams}
    ends |= {int(model.node_dofs[0, beam.nodes.stop - 1]): (beam, beam.length) for beam in model.beams}
    for joint in model.joints:
        beam, s = ends[int(joint.dofs[0])]
        at, body, (force, moment) = z[joint.dofs[:2]], model.bodies[joint.body], support(joint, z)
        yield _one(joint.point, beam.name, s, at, force, moment)
        if body.dofs is not None:
            yield _one(joint.point, body.name, np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, march: March) -> Iterator[_Acting]:
    """Of slides, pivots, drives and pins between bodies."""
    model, z = march.model, march.system.z
    for part in (*model.guides, *model.drives):
        body, (force, moment) = model.bodies[part.body], held(part, z)
        owner = scene.bodies.get(part.name)
        name = owner.about if isinstance(owner, TurningBody) else part.name
        yield _one(name, body.name, np.nan, model.carried(body, part.arm, z), force, moment)
    for name, hinge in zip(scene.pins, model.hinges, strict=True):
        for i, arm, sign in zip(hinge.bodies, hinge.arms, (-1.0, 1.0), strict=True):
            if model.bodies[i].dofs is not None:
                at = model.carried(model.bodies[i], arm, z)
                yield _one(name, model.bodies[i].name, np.nan, at, sign * z[hinge.rows], 0.0)


def _stops(march: March) -> Iterator[_Acting]:
    model, z = march.model, march.system.z
    for stop, _ in acting_stops(model.stops, march.acting):
        beam, moment = model.beam(stop.end[0]), stop.moment(z)
        node, s = (beam.nodes.start, 0.0) if stop.end[1] == "start" else (beam.nodes.stop - 1, beam.length)
        at = z[model.node_dofs[:2, node]]
        yield _one(stop.known_as, beam.name, s, at, np.zeros(2), moment)
        if stop.phi is not None:
            yield _one(stop.known_as, model.bodies[stop.body].name, np.nan, at, np.zeros(2), -moment)


def _touching(march: March, one: Touch) -> Iterator[_Acting]:
    """Of a contact at its Gauss points."""
    model, none = march.model, np.zeros(one.zeta.size)
    first = model.beams[one.pair.first]
    yield _Acting(one.pair.name, first.name, _arc(first, one.zeta), one.x.T, one.force.T, none)
    if isinstance(one.pair, Pair):
        second = model.beams[one.pair.second]
        yield _Acting(one.pair.name, second.name, _arc(second, one.zeta_m), one.x_m.T, -one.force.T, none)
    elif model.bodies[one.pair.body].dofs is not None:
        yield _Acting(one.pair.name, model.bodies[one.pair.body].name, none + np.nan, one.x.T, -one.force.T, none)


def _arc(beam: BeamPart, zeta: Array) -> Array:
    """Arc lengths of places ``zeta`` (k,)."""
    return np.asarray(zeta * (beam.length / (beam.elements.stop - beam.elements.start)))
