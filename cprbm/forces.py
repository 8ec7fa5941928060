"""Forces at supports and contacts, from the multipliers.

==========  ======================================================================
f_j         ∂(μ·Z + λ·c)/∂p_j; the force that acts on joint j is −f_j
R, M        force and moment of the ground on what is joined at a point
==========  ======================================================================
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Literal

import numpy as np

from cprbm.closure import closure_forces
from cprbm.first_equilibrium import largest_moment
from cprbm.holding import Held, held
from cprbm.kinematics import place
from cprbm.model import Chain
from cprbm.point import Point, Problem
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Support:
    """What the ground does at one beam's end ``at``: ``place`` (2,), ``force`` (2,), ``moment`` about the place."""

    beam: str
    at: Literal["start", "end"]
    place: Array
    force: Array
    moment: float


@dataclass(frozen=True, slots=True)
class ContactForces:
    """Forces of the contacts on the joints fx, fy (n_joints,) and moments on links and bodies (n_links + 3B,)."""

    fx: Array
    fy: Array
    moments: Array


def contact_forces(problem: Problem, point: Point, only: str | None = None) -> ContactForces:
    """Forces that all contacts (or ``only`` one) exert on the chains."""
    model, rows, exerted = problem.model, point.rows, -point.lam
    if only is not None:
        exerted[[name != only for name in rows.contact]] = 0.0
    fx, fy, moments = rows.forces(exerted, model.n_joints, model.n_unknowns)
    return ContactForces(fx, fy, moments)


def contact_moment(problem: Problem, point: Point, contact: str, chain: Chain, arc: float) -> float:
    """Moment on a chain of all that one contact exerts on it, about its start (``arc`` = 0) or its end."""
    exerted, j = contact_forces(problem, point, contact), chain.joints
    about = chain.first_joint if arc == 0.0 else j.stop - 1
    x, y = point.at.x[j] - point.at.x[about], point.at.y[j] - point.at.y[about]
    return float(x @ exerted.fy[j] - y @ exerted.fx[j] + np.sum(exerted.moments[chain.links]))


def contact_pressure(point: Point, contact: str, chain: Chain) -> tuple[Array, Array]:
    """Of the rows of a contact that press: arc length on its first beam, ``chain``, and the force there, (k,) each."""
    arcs, forces = [np.zeros(0)], [np.zeros(0)]
    for group, lam in point.rows.shares(point.lam):
        if group.contact != contact or group.holds_angles:
            continue
        fx, fy = group.on_first(chain)
        pressing = lam > 0.0
        arcs.append(group.arc[pressing])
        forces.append((lam * np.hypot(fx, fy))[pressing])
    return np.concatenate(arcs), np.concatenate(forces)


def resultant(point: Point, contact: str, chain: Chain) -> float:
    """Magnitude of what a contact exerts on its first beam, ``chain``, units of force."""
    fx = fy = 0.0
    for group, lam in point.rows.shares(point.lam):
        if group.contact == contact and not group.holds_angles:
            over_x, over_y = group.on_first(chain)
            fx, fy = fx + float(lam @ over_x), fy + float(lam @ over_y)
    return float(np.hypot(fx, fy))


def supports(problem: Problem, point: Point) -> tuple[Support, ...]:
    """What the ground does to every beam that is joined to it."""
    return _supports(problem, point, contact_forces(problem, point))


def _supports(problem: Problem, point: Point, contact: ContactForces) -> tuple[Support, ...]:
    model, closure = problem.model, problem.closure
    fx, fy = closure_forces(model, closure, point.mu)
    forces = np.array((fx - contact.fx - point.work.fx, fy - contact.fy - point.work.fy))
    on_beams = np.add.reduceat(forces, model.layout.roots, axis=1).T
    # ∂L/∂θ of the whole, whose entry at a link that does not turn is the moment that holds it
    held = point.unbalanced
    found = []
    for chain, force in zip(model.chains, on_beams, strict=False):
        if chain.start.body < 0:
            place = np.array((point.at.x[chain.first_joint], point.at.y[chain.first_joint]))
            moment = float(held[chain.first_link]) if chain.start.welded else 0.0
            found.append(Support(chain.name, "start", place, force, moment))
        if chain.end is not None and chain.end.body < 0:
            last = chain.first_joint + chain.n + 1
            moment = 0.0
            if chain.end.welded:
                row = 2 * len(closure.ends) + closure.welds.index((chain.first_link + chain.n, -1))
                moment = -float(point.mu[row])
            force = -np.array((fx[last], fy[last]))
            found.append(Support(chain.name, "end", np.array((point.at.x[last], point.at.y[last])), force, moment))
    return tuple(found)


def holding(problem: Problem, point: Point) -> tuple[Held, ...]:
    """What slides, drives and pins of the ground do to the bodies, in the order of the closure's."""
    closure, model = problem.closure, problem.model
    found = list(held(model, closure.holds, point.state, point.mu[closure.first_hold :]))
    for hinge, mu in zip(
        closure.hinges, point.mu[closure.first_hinge : closure.first_hold].reshape(-1, 2), strict=True
    ):
        found += hinge.held(model, point.state, mu)
    return tuple(found)


def _across_gaps(problem: Problem, point: Point) -> list[float]:
    """Moments by which ends that are on their way to points of bodies are held apart from these."""
    model, closure = problem.model, problem.closure
    found = []
    for r, (c, joint) in enumerate(zip(closure.ends, closure.end_joints, strict=True)):
        end = model.chains[c].end
        assert end is not None
        if end.body < 0:
            continue  # what the ground does is at the end itself
        px, py = place(model, end, point.state.bodies)
        fx, fy = point.mu[2 * r : 2 * r + 2]
        found.append(float((point.at.y[joint] - py) * fx - (point.at.x[joint] - px) * fy))
    return found


def balances(problem: Problem, point: Point) -> tuple[float, float]:
    """ΣF and ΣM about the origin of supports, slides, drives, loads and contacts, without units.

    Each over its largest part; where forces are small beside moments over ℓ, ΣF is measured by these, and the
    other way round; where there is no load, by S, as the residual is.  A beam's own ΣF vanishes by construction, for
    the force at its start is what balances it: ΣF says whether the free bodies are in equilibrium, ΣM whether the
    beams are too.
    """
    model, at = problem.model, point.at
    contact = contact_forces(problem, point)
    # of every part its force, and its moment about the origin
    parts = [_about(each.place, each.force, each.moment) for each in _supports(problem, point, contact)]
    parts += [_about(each.place, each.force, each.moment) for each in holding(problem, point)]
    work, stops = (over[model.n_links :].reshape(-1, 3) for over in (point.work.gradient, contact.moments))
    for b in range(model.n_bodies):
        place = model.references[b] + point.state.bodies[b, :2]
        parts.append(_about(place, work[b, :2], float(work[b, 2] + stops[b, 2])))
    # of loads on beams that is the moment about the beam's start; where the ground holds that, the force is no body's
    parts.append((0.0, 0.0, float(point.work.gradient[: model.n_links].sum())))
    # ends that are apart from their points pass forces on across the gap
    parts += [(0.0, 0.0, moment) for moment in _across_gaps(problem, point)]
    for chain in model.chains if point.work.on_beams else ():
        if chain.start.body < 0:
            j, start = chain.joints, chain.first_joint
            force = np.array((point.work.fx[j].sum(), point.work.fy[j].sum()))
            parts.append(_about(np.array((at.x[start], at.y[start])), force, 0.0))
    # what contacts do to beams, and to the marks on bodies behind them
    forces = np.array((contact.fx, contact.fy, at.x * contact.fy - at.y * contact.fx))
    exerted = np.add.reduceat(forces, model.layout.roots, axis=1)
    first_links = [chain.first_link for chain in model.chains]
    exerted[2, : len(first_links)] += np.add.reduceat(contact.moments[: model.n_links], first_links)
    parts += [(fx, fy, moment) for fx, fy, moment in exerted.T.tolist()]
    fx, fy, moments = zip(*parts, strict=True)
    largest_force = max(map(abs, fx + fy))
    # round-off of the springs' moments may be a force, over a link's length
    scale = max(*map(abs, moments), largest_force) if largest_moment(point) > 0.0 else 1.0
    return hypot(sum(fx), sum(fy)) / scale, abs(sum(moments)) / scale


def _about(place: Array, force: Array, moment: float) -> tuple[float, float, float]:
    """A ``force`` (2,) at a ``place`` (2,) and its moment about the origin, a ``moment`` added."""
    x, y = place.tolist()
    fx, fy = force.tolist()
    return fx, fy, moment + x * fy - y * fx
