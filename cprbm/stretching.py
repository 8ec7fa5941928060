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
at t = −σ/κ and any m that holds x there (m κ > 0) it finds the other.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cprbm.closure import closure_second
from cprbm.kinematics import State
from cprbm.point import Point, Problem, point_at
from scene.answer import Array

NEAR = 0.7  # rad, and units of length: the most that one step may bring a linkage into line by
SLIGHT = 1e-6  # of the largest turn: κ that is nothing
ENOUGH = 1.0  # S/ℓ²: m κ to begin with


def stretched(problem: Problem, values: Mapping[str, float], point: Point) -> Point | None:
    """From a ``point``, near which linkages are in line, the one at which they are and hold; None if none are near.

    ``values`` (SI) are those of loads and drives there.
    """
    model, first = problem.model, problem.model.n_links
    led = {body for chain in model.chains for body in (chain.start.body, chain.end.body if chain.end else -1)}
    alone = [body for body in range(len(model.free_bodies)) if body not in led]
    if not alone:
        return None
    columns = (first + 3 * np.array(alone)[:, None] + np.arange(3)).ravel()
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
