"""What acts at a station besides the loads, and what the beams are inside, for those who sum it up anew.

Contacts act on a beam's smooth line, in the places by which their rows go; joints at its ends.  The multipliers say
how hard, and nothing here is used to find a state.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cprbm import smooth
from cprbm.circle import Circle
from cprbm.closure import closure_forces
from cprbm.contact import Group
from cprbm.edge import Edge
from cprbm.forces import contact_forces
from cprbm.holding import held
from cprbm.kinematics import place
from cprbm.mechanism import Mechanism
from cprbm.model import Chain
from cprbm.point import Point
from cprbm.standing import Attachment
from cprbm_scene import FreeEnd, Scene
from cprbm_scene.answer import Array, Inside, Ints, Statics, frozen_array

NO_PULLS = frozen_array(np.zeros(0))


@dataclass(frozen=True, slots=True)
class _Acting:
    """Forces (k, 2) of one kind on one beam or body, at places (k, 2) and arc lengths (k,), without units."""

    by: str
    on: str
    s: Array
    places: Array
    forces: Array
    moments: Array


def statics(scene: Scene, mechanism: Mechanism, point: Point) -> Statics | None:
    """What acts; None in the formulation ``paper``, whose boundaries press on joints and not on places of a line."""
    if mechanism.boundaries:
        return None
    model = mechanism.problem.model
    parts = [*_at_ends(scene, mechanism, point), *_on_bodies(scene, mechanism, point), *_touching(mechanism, point)]
    empty = np.zeros((0, 2))
    bodies = {
        name: frozen_array((u * model.unit_length, v * model.unit_length, phi))
        for name, (u, v, phi) in zip(model.free_bodies, point.state.bodies, strict=True)
        if name in scene.bodies  # a start that nothing holds is a body of the chain's own
    }
    return Statics(
        by=tuple(part.by for part in parts for _ in part.s),
        on=tuple(part.on for part in parts for _ in part.s),
        s=frozen_array(np.concatenate([np.zeros(0), *(part.s for part in parts)]) * model.unit_length),
        places=frozen_array(np.concatenate([empty, *(part.places for part in parts)]) * model.unit_length),
        forces=frozen_array(np.concatenate([empty, *(part.forces for part in parts)]) * model.unit_force),
        moments=frozen_array(np.concatenate([np.zeros(0), *(part.moments for part in parts)]) * model.unit_moment),
        bodies=bodies,
        inside={
            chain.name: Inside(
                "links",
                frozen_array(chain.borders * model.unit_length),
                frozen_array(point.state.theta[chain.links]),
                NO_PULLS,
            )
            for chain in model.chains
        },
    )


def _one(by: str, on: str, s: float, at: Array, force: Array, moment: float) -> _Acting:
    return _Acting(by, on, np.array([s]), at.reshape(1, 2), np.asarray(force).reshape(1, 2), np.array([moment]))


def _at_ends(scene: Scene, mechanism: Mechanism, point: Point) -> Iterator[_Acting]:
    """Of the joints on the beams' ends and on the bodies that these are joined to."""
    problem, at = mechanism.problem, point.at
    model, closure = problem.model, problem.closure
    contact = contact_forces(problem, point)
    fx, fy = closure_forces(model, closure, point.mu)
    forces = np.array((fx - contact.fx - point.work.fx, fy - contact.fy - point.work.fy))
    starts = np.add.reduceat(forces, model.layout.roots, axis=1).T
    # ∂L/∂θ of the whole, whose entry at a link that does not turn is the moment that holds it
    turned = point.unbalanced
    welds = {weld: -float(point.mu[2 * len(closure.ends) + row]) for row, weld in enumerate(closure.welds)}
    names = dict(enumerate(model.free_bodies))
    for chain, start in zip(model.chains, starts, strict=False):
        beam, last = scene.beams[chain.name], chain.joints.stop - 1
        if not isinstance(beam.start, FreeEnd):
            first, link = np.array((at.x[chain.first_joint], at.y[chain.first_joint])), chain.first_link
            on_ground = chain.start.welded and chain.start.body < 0
            moment = float(turned[link]) if on_ground else welds.get((link, chain.start.body), 0.0)
            yield from _joined(chain, names, beam.start.point, chain.start, 0.0, first, start, moment)
        if chain.end is not None and not isinstance(beam.end, FreeEnd):
            here, link = np.array((at.x[last], at.y[last])), chain.first_link + chain.n
            moment = welds.get((link, chain.end.body), 0.0) if chain.end.welded else 0.0
            force = -np.array((fx[last], fy[last]))
            yield from _joined(chain, names, beam.end.point, chain.end, float(chain.s[-1]), here, force, moment)


def _joined(
    chain: Chain, names: dict[int, str], name: str, to: Attachment, s: float, at: Array, force: Array, moment: float
) -> Iterator[_Acting]:
    yield _one(name, chain.name, s, at, force, moment)
    if to.body >= 0:
        yield _one(name, names[to.body], np.nan, at, -force, -moment)


def _on_bodies(scene: Scene, mechanism: Mechanism, point: Point) -> Iterator[_Acting]:
    """Of slides, pivots, drives and pins between bodies."""
    problem = mechanism.problem
    model, closure = problem.model, problem.closure
    holds = held(model, closure.holds, point.state, point.mu[closure.first_hold :])
    for hold, each in zip(closure.holds, holds, strict=True):
        body = model.free_bodies[hold.at.body]
        yield _one(each.drive or body, body, np.nan, each.place, each.force, each.moment)
    pins = point.mu[closure.first_hinge : closure.first_hold].reshape(-1, 2)
    for name, hinge, mu in zip(scene.pins, closure.hinges, pins, strict=True):
        for to, sign in zip(hinge.points, (-1.0, 1.0), strict=True):
            if to.body >= 0:
                at = np.array(place(model, to, point.state.bodies))
                yield _one(name, model.free_bodies[to.body], np.nan, at, sign * mu, 0.0)


def _touching(mechanism: Mechanism, point: Point) -> Iterator[_Acting]:
    """Of contacts that press and stops that hold."""
    model = mechanism.problem.model
    for group, lam in point.rows.shares(point.lam):
        pressing = np.flatnonzero(lam)
        if not pressing.size:
            continue
        if group.holds_angles:
            yield from _turning(mechanism, point, group, lam)
            continue
        pair = mechanism.pairs[group.contact]
        fx, fy = group.on_first(pair.a)
        forces = -(lam[:, None] * np.stack((fx, fy), axis=1))[pressing]
        arcs = group.arc[pressing]
        for chain, (sign, s, _) in zip(pair.chains, pair.pressed(point.state, point.at, arcs), strict=True):
            s = np.asarray(s)
            at = _places(mechanism, point, chain, s)
            moments = -lam[pressing] * _couples(group, chain, point, pressing, at)
            yield _Acting(group.contact, chain.name, s, at, sign * forces, moments)
            if isinstance(pair, Circle | Edge) and (body := _body(mechanism, group)) >= 0:
                yield _Acting(group.contact, model.free_bodies[body], np.full(len(s), np.nan), at, -forces, -moments)


def _couples(group: Group, chain: Chain, point: Point, rows: Ints, places: Array) -> Array:
    """Moments about ``places`` (k, 2) of what ``rows`` (k,) with multipliers of −1 do to a beam.

    A row of the mean gap around a joint acts in several places.  Of a beam that touches itself it is not told apart.
    """
    if group.itself:
        return np.zeros(len(rows))
    joints, p = group.joints[rows], group.joints.shape[1]
    slopes = group.slopes[rows]
    mine = (joints >= chain.joints.start) & (joints < chain.joints.stop)
    turning = (group.angles[rows] >= chain.links.start) & (group.angles[rows] < chain.links.stop)
    x, y = point.at.x[joints] - places[:, :1], point.at.y[joints] - places[:, 1:]
    moments = mine * (x * slopes[:, p : 2 * p] - y * slopes[:, :p])
    return np.asarray(moments.sum(axis=1) + (turning * slopes[:, 2 * p :]).sum(axis=1))


def _body(mechanism: Mechanism, group: Group) -> int:
    """The body that moves of what is rigid and pressed by a group; −1 for the ground."""
    model = mechanism.problem.model
    mark = model.marks.get(group.contact)
    return -1 if mark is None else mark.body


def _turning(mechanism: Mechanism, point: Point, group: Group, lam: Array) -> Iterator[_Acting]:
    """Of a limit of an angle: moments on the beam's end, and on the body of the pin."""
    model = mechanism.problem.model
    for row in np.flatnonzero(lam):
        for number, slope in zip(group.angles[row], group.slopes[row], strict=True):
            moment = -float(lam[row] * slope)
            if number >= model.n_links:
                body = (int(number) - model.n_links) // 3
                at = np.array(place(model, Attachment(body, (0.0, 0.0), welded=False), point.state.bodies))
                yield _one(group.contact, model.free_bodies[body], np.nan, at, np.zeros(2), moment)
                continue
            chain = next(each for each in model.chains if each.links.start <= number < each.links.stop)
            s = 0.0 if number == chain.first_link else float(chain.s[-1])
            yield _one(
                group.contact, chain.name, s, _places(mechanism, point, chain, np.array([s])), np.zeros(2), moment
            )


def _places(mechanism: Mechanism, point: Point, chain: Chain, s: Array) -> Array:
    """Places (k, 2) of the beam's smooth line."""
    on = smooth.smooth_line(chain, mechanism.problem.model.unit_length, point.state, point.at).at(s)
    return np.stack((on.x, on.y), axis=1)
