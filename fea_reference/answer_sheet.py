"""Statics of a state for the answer sheet: internal forces, point forces, contact states, body motions; SI.

Contacts act at the Gauss points of their zones; internal forces follow from the elements. The equilibrium search does
not use this module.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from cprbm_scene.answer import Array, BeamState, ContactState, PointForce, PointForces, contact_states, frozen_array
from cprbm_scene.statement import Scene, TurningBody
from fea_reference.march import March
from fea_reference.model import BeamPart
from fea_reference.recovery import bending_moment, section_force
from fea_reference.stops import acting_stops
from fea_reference.supports import joint_reaction, row_reaction
from fea_reference.touch import Pair, Touch

BESIDE = 1e-12
"""Distance behind a node, over the beam's length, at which internal forces are read: the limit from the end's side."""


def beam_states(march: March) -> dict[str, BeamState]:
    """Internal forces at the nodes of every beam."""
    model, z, units = march.model, march.system.z, march.model.units
    states = {}
    for beam in model.beams:
        line, nodes = model.line(beam, z), np.arange(beam.elements.stop - beam.elements.start + 1.0)
        fractions = nodes / nodes[-1] + BESIDE * (nodes < nodes[-1])
        x, y = line.points * units.length + units.origin[:, None]
        force = np.array([1.0, 1j]) @ section_force(model, march.system, beam, fractions) * units.force
        ahead = np.array([1.0, 1j]) @ line.at(nodes)[1]
        section = np.asarray(z[model.node_dofs[2, beam.nodes]])
        s = beam.length * units.length * nodes / nodes[-1]
        force = force * np.conj(ahead) / np.abs(ahead)
        moment = bending_moment(model, march.system, beam, fractions) * units.moment
        angle = section + np.angle(ahead * np.exp(-1j * section))
        states[beam.name] = BeamState(*map(frozen_array, (s, x, y, angle, section, force.real, force.imag, moment, s)))
    return states


def point_forces(scene: Scene, march: March) -> PointForces:
    """All forces except the loads; without a significant force a contact's force is a penalty times round-off."""
    rows = [*_at_joints(march), *_on_bodies(scene, march), *_at_stops(march)]
    rows += [row for touch in march.system.touches if march.system.significant for row in _at_contact(march, touch)]
    units = march.model.units
    return PointForces.collected(rows, units.length, units.force, tuple(units.origin))


def contacts(
    scene: Scene, march: March, forces: PointForces, touching: Mapping[str, Array]
) -> Mapping[str, ContactState]:
    """States of all contacts."""
    return contact_states(scene.contacts, forces, touching, (march.model.units.length, march.model.units.force))


def body_motions(march: March) -> dict[str, Array]:
    """Displacement of the first point, m, and rotation of every moving body, (3,)."""
    model, z, motions = march.model, march.system.z, {}
    for body in model.bodies:
        if body.dofs is not None:
            first = next(iter(body.points))
            moved = (model.place(body, first, z) - body.points[first]) * model.units.length
            motions[body.name] = frozen_array((*moved, model.body_state(body, z)[2]))
    return motions


def _at_joints(march: March) -> Iterator[PointForce]:
    """Forces of joints on the beams' ends and on the joined bodies."""
    model, z = march.model, march.system.z
    ends = {int(model.node_dofs[0, beam.nodes.start]): (beam.name, 0.0) for beam in model.beams}
    ends |= {int(model.node_dofs[0, beam.nodes.stop - 1]): (beam.name, beam.length) for beam in model.beams}
    for joint in model.joints:
        beam, s = ends[int(joint.dofs[0])]
        at, body, (force, moment) = z[joint.dofs[:2]], model.bodies[joint.body], joint_reaction(joint, z)
        yield PointForce(joint.point, beam, s, at, force, moment)
        if body.dofs is not None:
            yield PointForce(joint.point, body.name, np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, march: March) -> Iterator[PointForce]:
    """Forces of slides, pivots, drives and pins on bodies."""
    model, z = march.model, march.system.z
    for part in (*model.guides, *model.drives):
        body, (force, moment) = model.bodies[part.body], row_reaction(part, z)
        owner = scene.bodies.get(part.name)
        source = owner.about if isinstance(owner, TurningBody) else part.name
        yield PointForce(source, body.name, np.nan, model.carried(body, part.arm, z), force, moment)
    for name, hinge in zip(scene.pins, model.hinges, strict=True):
        for number, arm, sign in zip(hinge.bodies, hinge.arms, (-1.0, 1.0), strict=True):
            body = model.bodies[number]
            if body.dofs is not None:
                yield PointForce(name, body.name, np.nan, model.carried(body, arm, z), sign * z[hinge.rows], 0.0)


def _at_stops(march: March) -> Iterator[PointForce]:
    """Moments of angle stops on beams' ends and on the pins' bodies."""
    model, z = march.model, march.system.z
    for stop, _ in acting_stops(model.stops, march.acting):
        beam, moment = model.beam(stop.end[0]), stop.moment(z)
        node, s = (beam.nodes.start, 0.0) if stop.end[1] == "start" else (beam.nodes.stop - 1, beam.length)
        at = z[model.node_dofs[:2, node]]
        yield PointForce(stop.known_as, beam.name, s, at, np.zeros(2), moment)
        if stop.phi is not None:
            yield PointForce(stop.known_as, model.bodies[stop.body].name, np.nan, at, np.zeros(2), -moment)


def _at_contact(march: March, touch: Touch) -> Iterator[PointForce]:
    """Forces of a contact at the Gauss points."""
    model, pair = march.model, touch.pair
    first, nowhere = model.beams[pair.first], np.full(touch.zeta.size, np.nan)
    sides = [(first.name, _arc_lengths(first, touch.zeta), touch.x, touch.force)]
    if isinstance(pair, Pair):
        second = model.beams[pair.second]
        sides.append((second.name, _arc_lengths(second, touch.zeta_m), touch.x_m, -touch.force))
    elif model.bodies[pair.body].dofs is not None:
        sides.append((model.bodies[pair.body].name, nowhere, touch.x, -touch.force))
    for target, s, at, force in sides:
        for row in zip(s, at.T, force.T, strict=True):
            yield PointForce(pair.name, target, *row, 0.0)


def _arc_lengths(beam: BeamPart, zeta: Array) -> Array:
    """Arc lengths of places ``zeta`` (k,), element number plus share of the element."""
    return np.asarray(zeta * (beam.length / (beam.elements.stop - beam.elements.start)))
