"""Bending moment and normal force along a beam, by statics.

The moment at s balances the forces on the piece of an element between its first node and s: the element's end force
and end moment, and the contact forces at Gauss points in between. End forces follow from equilibrium, not from
differentiated displacements. The moment is therefore as accurate as the nodes' positions (fourth order), continuous
at nodes, and has the kinks of contacts in place.

A contact acts within an element, so that its share of nodal forces is first removed from the end forces. Its share in
neighbouring elements, by their shear, is balanced within these. Loads on beams are treated in the same way.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.beam_loads import force_before, moment_before
from fea_reference.model import BeamPart, Model
from fea_reference.system import System
from fea_reference.touch import Pair, Touch

_NOTHING = (np.empty(0), np.empty((2, 0)), np.empty((2, 0)))


def normal_force(model: Model, system: System, beam: BeamPart, fractions: Array) -> Array:
    """N (k,) at ``fractions`` (k,) of the arc length, dimensionless, positive in tension."""
    zeta = fractions * (beam.elements.stop - beam.elements.start)
    tangent = model.line(beam, system.z).at(zeta)[1]
    return np.asarray((section_force(model, system, beam, fractions) * tangent).sum(axis=0) / np.hypot(*tangent))


def section_force(model: Model, system: System, beam: BeamPart, fractions: Array) -> Array:
    """Force (2, k) of the part beyond ``fractions`` (k,) of the arc length on the part before, dimensionless."""
    line, zeta = model.line(beam, system.z), fractions * (beam.elements.stop - beam.elements.start)
    ends, place, _, force = _end_forces(model, system, beam)
    e, _ = line.locate(zeta)
    owner, _ = line.locate(place)
    before = (owner[None, :] == e[:, None]) & (place[None, :] < zeta[:, None])
    beyond = -ends[:2, e] - force @ before.T
    for load in system.loads:
        if load.part.beam == model.beams.index(beam):
            beyond -= force_before(load, line, zeta)
    return np.asarray(beyond)


def bending_moment(model: Model, system: System, beam: BeamPart, fractions: Array) -> Array:
    """EI (κ − κ⁰) at ``fractions`` (k,) of the arc length, in units of EI/length."""
    line = model.line(beam, system.z)
    ends, place, point, force = _end_forces(model, system, beam)
    owner, _ = line.locate(place)
    zeta = fractions * line.n
    e, _ = line.locate(zeta)
    x = line.at(zeta)[0]
    arm = line.points[:, e] - x
    moment = -(ends[2, e] + arm[0] * ends[1, e] - arm[1] * ends[0, e])
    before = (owner[None, :] == e[:, None]) & (place[None, :] < zeta[:, None])
    lever = point[:, None, :] - x[:, :, None]
    moment -= ((lever[0] * force[1] - lever[1] * force[0]) * before).sum(axis=1)
    for load in system.loads:
        if load.part.beam == model.beams.index(beam):
            moment -= moment_before(load, line, zeta)
    return np.asarray(moment)


def _end_forces(model: Model, system: System, beam: BeamPart) -> tuple[Array, Array, Array, Array]:
    """Forces and moments at first nodes without contacts and loads, and contacts' places, points and forces.

    Force and moment (3, n) act on the first node of every element; places are (k,), points and forces (2, k).
    """
    ends = system.elements.gradient[:3, beam.elements].copy()  # force and moment on every element's first node
    number = model.beams.index(beam)
    parts = [_NOTHING, *(part for touch in system.touches for part in _on_beam(touch, number))]
    place, point, force = (np.concatenate(arrays, axis=-1) for arrays in zip(*parts, strict=True))
    for touch in system.touches:
        for of_line, elements, forces in touch.chain.on_first_nodes(touch.local_gradient):
            if number == (touch.pair.second if of_line == 1 and isinstance(touch.pair, Pair) else touch.pair.first):
                np.add.at(ends.T, elements, forces.T)
    for load in system.loads:
        if load.part.beam == number:
            for _, elements, forces in load.chain.on_first_nodes(load.local_gradient):
                np.add.at(ends.T, elements, -forces.T)
    return ends, place, point, force


def _on_beam(touch: Touch, number: int) -> list[tuple[Array, Array, Array]]:
    """Places, points and forces of a contact on a beam, as its first and as its second beam."""
    parts = []
    if touch.pair.first == number:
        parts.append((touch.zeta, touch.x, touch.force))
    if isinstance(touch.pair, Pair) and touch.pair.second == number:
        parts.append((touch.zeta_m, touch.x_m, -touch.force))
    return parts
