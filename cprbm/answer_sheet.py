"""Statics of a state for the answer sheet: internal forces of beams, point forces, contact states, body motions.

Contacts act on a beam's smooth line at the places of the contact rows, joints act at the beams' ends.  All forces come
from multipliers, all bending moments from springs; the equilibrium search uses nothing from here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import repeat

import numpy as np

from cprbm import smooth
from cprbm.circle import Circle
from cprbm.closure import closure_forces
from cprbm.edge import Edge
from cprbm.first_contact import Group
from cprbm.forces import contact_forces
from cprbm.holding import held
from cprbm.kinematics import place
from cprbm.mechanism import Mechanism
from cprbm.model import Chain
from cprbm.normal_force import force_beyond
from cprbm.point import Point
from cprbm.standing import Attachment
from cprbm.stress import bending_moment
from cprbm_scene import FreeEnd, Scene
from cprbm_scene.answer import Array, BeamState, ContactState, Ints, PointForce, PointForces, frozen_array
from cprbm_scene.contact_states import contact_states

BESIDE = 1e-12
"""Distance behind a place, over the beam's length, at which internal forces are read: the limit from the end's side."""


def beam_states(mechanism: Mechanism, point: Point) -> dict[str, BeamState]:
    """Internal forces at the start, the springs and the end of every beam; SI."""
    model, states = mechanism.problem.model, {}
    for chain in model.chains:
        s = chain.s + chain.s[-1] * BESIDE * (chain.s < chain.s[-1])
        line = smooth.smooth_line(chain, model.unit_length, point.state, point.at).at(chain.s)
        force = force_beyond(mechanism, point, chain, s) @ (1.0, 1j) * np.exp(-1j * line.psi) * model.unit_force
        columns = (
            chain.s * model.unit_length,
            line.x * model.unit_length,
            line.y * model.unit_length,
            line.psi,
            line.psi,
            force.real,
            force.imag,
            bending_moment(mechanism, point, chain, s) * model.unit_moment,
            chain.borders * model.unit_length,
        )
        states[chain.name] = BeamState(*map(frozen_array, columns))
    return states


def point_forces(scene: Scene, mechanism: Mechanism, point: Point) -> PointForces:
    """All forces but the loads."""
    return PointForces.collected(
        [*_at_ends(scene, mechanism, point), *_on_bodies(scene, mechanism, point), *_at_contacts(mechanism, point)],
        mechanism.problem.model.unit_length,
        mechanism.problem.model.unit_force,
    )


def contacts(
    scene: Scene, mechanism: Mechanism, forces: PointForces, touching: Mapping[str, Array]
) -> Mapping[str, ContactState]:
    """States of all contacts."""
    return contact_states(
        scene.contacts, forces, touching, (mechanism.problem.model.unit_length, mechanism.problem.model.unit_force)
    )


def body_motions(scene: Scene, mechanism: Mechanism, point: Point) -> dict[str, Array]:
    """Displacement of the first point, m, and rotation of every moving body of the scene, (3,)."""
    model = mechanism.problem.model
    return {
        name: frozen_array((u * model.unit_length, v * model.unit_length, phi))
        for name, (u, v, phi) in zip(model.free_bodies, point.state.bodies, strict=True)
        if name in scene.bodies  # a free start is a body of the chain alone
    }


def _at_ends(scene: Scene, mechanism: Mechanism, point: Point) -> Iterator[PointForce]:
    """Forces of joints on the beams' ends and on the joined bodies."""
    model, closure = mechanism.problem.model, mechanism.problem.closure
    contact = contact_forces(mechanism.problem, point)
    fx, fy = closure_forces(model, closure, point.mu)
    forces = np.array((fx - contact.fx - point.work.fx, fy - contact.fy - point.work.fy))
    starts = np.add.reduceat(forces, model.layout.roots, axis=1).T
    welds = {weld: -float(point.mu[2 * len(closure.ends) + row]) for row, weld in enumerate(closure.welds)}
    for chain, start in zip(model.chains, starts, strict=False):
        beam, last = scene.beams[chain.name], chain.joints.stop - 1
        if not isinstance(beam.start, FreeEnd):
            moment = welds.get((chain.first_link, chain.start.body), 0.0)
            if chain.start.welded and chain.start.body < 0:
                # a fixed link is no unknown: the residual of the whole at its angle is the ground's moment
                moment = float(point.unbalanced[chain.first_link])
            yield from _at_end(mechanism, point, chain, (beam.start.point, chain.start, 0.0), start, moment)
        if chain.end is not None and not isinstance(beam.end, FreeEnd):
            moment = welds.get((chain.first_link + chain.n, chain.end.body), 0.0) if chain.end.welded else 0.0
            end = -np.array((fx[last], fy[last]))
            yield from _at_end(mechanism, point, chain, (beam.end.point, chain.end, float(chain.s[-1])), end, moment)


def _at_end(
    mechanism: Mechanism, point: Point, chain: Chain, end: tuple[str, Attachment, float], force: Array, moment: float
) -> Iterator[PointForce]:
    """Force at one ``end``: the point's name, the attachment, and the arc length."""
    source, joined, s = end
    joint = chain.joints.stop - 1 if s else chain.first_joint
    at = np.array((point.at.x[joint], point.at.y[joint]))
    yield PointForce(source, chain.name, s, at, force, moment)
    if joined.body >= 0:
        yield PointForce(source, mechanism.problem.model.free_bodies[joined.body], np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, mechanism: Mechanism, point: Point) -> Iterator[PointForce]:
    """Forces of slides, pivots, drives and pins on bodies."""
    model, closure = mechanism.problem.model, mechanism.problem.closure
    holds = held(model, closure.holds, point.state, point.mu[closure.first_hold :])
    for hold, support in zip(closure.holds, holds, strict=True):
        body = model.free_bodies[hold.at.body]
        yield PointForce(support.drive or body, body, np.nan, support.place, np.asarray(support.force), support.moment)
    pins = point.mu[closure.first_hinge : closure.first_hold].reshape(-1, 2)
    for name, hinge, mu in zip(scene.pins, closure.hinges, pins, strict=True):
        for joined, sign in zip(hinge.points, (-1.0, 1.0), strict=True):
            if joined.body >= 0:
                at = np.array(place(model, joined, point.state.bodies))
                yield PointForce(name, model.free_bodies[joined.body], np.nan, at, sign * mu, 0.0)


def _at_contacts(mechanism: Mechanism, point: Point) -> Iterator[PointForce]:
    """Forces of contacts, and moments of stops."""
    model = mechanism.problem.model
    for group, lam in point.rows.shares(point.lam):
        pressing = np.flatnonzero(lam)
        if group.holds_angles:
            for row in pressing.tolist():
                yield from _at_stop(mechanism, point, group, row, float(lam[row]))
        elif pressing.size:
            pair, source = mechanism.pairs[group.contact], group.contact
            forces = -(lam[:, None] * np.stack(group.on_first(pair.a), axis=1))[pressing]
            mark = model.marks.get(source) if isinstance(pair, Circle | Edge) else None
            pressed = pair.pressed(point.state, point.at, group.arc[pressing])
            for chain, (sign, arc, _) in zip(pair.chains, pressed, strict=True):
                s = np.asarray(arc)
                at = _on_line(mechanism, point, chain, s)
                moments = -lam[pressing] * _moments(group, chain, point, pressing, at)
                yield from map(PointForce, repeat(source), repeat(chain.name), s, at, sign * forces, moments)
                if mark is not None and mark.body >= 0:
                    body = model.free_bodies[mark.body]
                    yield from map(PointForce, repeat(source), repeat(body), s + np.nan, at, -forces, -moments)


def _moments(group: Group, chain: Chain, point: Point, rows: Ints, at: Array) -> Array:
    """Moments of ``rows`` (k,) with multipliers of -1 on a beam about the places ``at`` (k, 2).

    A row of the mean gap around a joint acts in several places.  The rows of self-contact mix both places of one beam,
    and no moment of either place is known.
    """
    if group.itself:
        return np.zeros(len(rows))
    joints, angles, slopes, p = group.joints[rows], group.angles[rows], group.slopes[rows], group.joints.shape[1]
    on_chain = (joints >= chain.joints.start) & (joints < chain.joints.stop)
    links = (angles >= chain.links.start) & (angles < chain.links.stop)
    x, y = point.at.x[joints] - at[:, :1], point.at.y[joints] - at[:, 1:]
    moments = on_chain * (x * slopes[:, p : 2 * p] - y * slopes[:, :p])
    return np.asarray(moments.sum(axis=1) + (links * slopes[:, 2 * p :]).sum(axis=1))


def _at_stop(mechanism: Mechanism, point: Point, group: Group, row: int, lam: float) -> Iterator[PointForce]:
    """Moments of an angle stop on the beam's end and on the pin's body."""
    model = mechanism.problem.model
    for number, slope in zip(group.angles[row], group.slopes[row], strict=True):
        moment, body = -lam * float(slope), (int(number) - model.n_links) // 3
        if number >= model.n_links:
            at = np.array(place(model, Attachment(body, (0.0, 0.0), welded=False), point.state.bodies))
            yield PointForce(group.contact, model.free_bodies[body], np.nan, at, np.zeros(2), moment)
            continue
        chain = next(chain for chain in model.chains if chain.links.start <= number < chain.links.stop)
        s = 0.0 if number == chain.first_link else float(chain.s[-1])
        at = _on_line(mechanism, point, chain, np.array([s]))[0]
        yield PointForce(group.contact, chain.name, s, at, np.zeros(2), moment)


def _on_line(mechanism: Mechanism, point: Point, chain: Chain, s: Array) -> Array:
    """Positions (k, 2) on the beam's smooth line."""
    line = smooth.smooth_line(chain, mechanism.problem.model.unit_length, point.state, point.at).at(s)
    return np.stack((line.x, line.y), axis=1)
