"""Linkages of bodies alone that are drawn as far as they reach, and hold from there on.

==========  ==================================================================================
x           u, v, φ of the bodies that no beam is joined to
Z, A        equalities and their derivatives over x
σ, ν, w     smallest singular value of A and its vectors, A w = σ ν
κ           ∂²(ν·Z)/∂t² along x + t w
m           multiplier of ν·Z
==========  ==================================================================================

Between pins a body that no beam holds goes where the others lead it, by a motion w that takes no energy, and carries
nothing.  Where it lies in one line with what holds it, σ = 0 and w moves nothing else, a little further the others
would have to come apart, and it holds them: the branch with m = 0 goes over into one with t = −σ/κ, along which m grows
from nothing.  To first order in t and m their equation along w is

    m (σ + κ t) = 0,

of which Newton's method, begun at m = 0, keeps m = 0: it looks for the one branch where only the other goes on.  Begun
at t = −σ/κ and any m that holds x there (m κ > 0) it finds the other.  Where m κ < 0 the linkage is pushed, and folds:
an equilibrium and no minimum.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cprbm.closure import closure_second
from cprbm.kinematics import State
from cprbm.point import Point, Problem, point_at
from cprbm_scene.answer import Array, Ints

NEAR = 0.7  # rad, and units of length: the most that one step may bring a linkage into line by
SLIGHT = 1e-6  # of the largest turn: κ that is nothing
ENOUGH = 1.0  # S/ℓ²: m κ to begin with
IN_LINE = 1e-6  # of the largest singular value: σ that is nothing
NOTHING = 1e-9  # S: curvature that is none


def stretched(problem: Problem, values: Mapping[str, float], point: Point) -> Point | None:
    """From a ``point``, near which linkages are in line, the one at which they are and hold; None if none are near.

    ``values`` (SI) are those of loads and drives there.
    """
    model, first = problem.model, problem.model.n_links
    columns = _alone(problem)
    if not columns.size:
        return None
    A = point.A_E[:, columns]
    left, sizes, right = np.linalg.svd(A, full_matrices=False)
    nu, sigma, w = left[:, -1], float(sizes[-1]), np.zeros(model.n_unknowns)
    w[columns] = right[-1]
    turns = w[first + 2 :: 3]
    kappa = float(closure_second(model, problem.closure, point.state, nu) @ turns**2)
    if abs(kappa) * NEAR <= sigma + SLIGHT * float(np.max(np.abs(turns))):
        return None
    state: State = point.state.moved(-sigma / kappa * w, first)
    mu: Array = point.mu + ENOUGH / kappa * nu
    return point_at(problem, dict(values), state, mu, point.lam, point.rows)


def folds(problem: Problem, point: Point) -> bool:
    """Whether a linkage that is in line carries a push, under which it folds.

    That moves no link of a beam, and is in no curvature over their angles.  Of bodies that contacts press on nothing is
    said: how these are bent counts, too.
    """
    columns, first = _alone(problem), problem.model.n_links
    if not columns.size or point.slopes[point.lam > 0.0][:, columns].any():
        return False
    _, sizes, right = np.linalg.svd(point.A_E[:, columns])
    sizes = np.pad(sizes, (0, len(columns) - len(sizes)))
    free = right[sizes <= IN_LINE * sizes[0]]
    if not len(free):
        return False
    second = closure_second(problem.model, problem.closure, point.state, point.mu) - point.work.second
    turns = np.zeros((len(free), problem.model.n_unknowns - first))
    turns[:, columns - first] = free
    turns = turns[:, 2::3]
    return bool(np.linalg.eigvalsh((turns * second) @ turns.T)[0] < -NOTHING)


def _alone(problem: Problem) -> Ints:
    """u, v, φ of the bodies that no beam is joined to, by their numbers among the unknowns."""
    model = problem.model
    led = {body for chain in model.chains for body in (chain.start.body, chain.end.body if chain.end else -1)}
    alone = [body for body in range(model.n_bodies) if body not in led]
    return np.array([model.n_links + 3 * body + k for body in alone for k in range(3)], dtype=np.intp)
