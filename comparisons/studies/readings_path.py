"""A branch of minima followed with care: exact derivatives, a working set, and the smallest curvature at every step.

==========  =====================================================================================================
symbol      meaning
==========  =====================================================================================================
z, α        unknowns and turn of the crank, as in the module of the problem
g, G        the constraints' values and their gradients: closure = 0 (4), contact ≤ 0 (m), limits ≤ 0 (four)
W           working set: the closure and the inequalities that act
λ           multipliers, ≥ 0 for inequalities; L = PE + λ·g, and the crank's moment is ∂L/∂α
H           ∂²L/∂z², by complex steps: exact but for round-off
κ           the smallest eigenvalue of ZᵀHZ, Z an orthonormal basis of the directions with G_W dz = 0, N·m
==========  =====================================================================================================

Where the branch ends is found by halving the step until it is below :data:`FINEST`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import linalg

from comparisons.studies.readings_problem import Array, Problem

FINEST = np.radians(0.005)
_STEP = 1e-30
_LARGEST_TURN = np.radians(6.0)
_NONE_LEFT = 0.05  # a curvature below this share of the largest on the branch is on its way to zero
_LETS_GO = 0.01  # and so is a multiplier below this share of its own largest
_NEWTON = 30

Kind = Literal["fold", "contact lets go", "limit lets go", "lost"]


@dataclass(frozen=True, slots=True)
class State:
    """An equilibrium; ``acting`` numbers the inequalities: contact 0..m − 1, then least and most of θ_1N, of θ_2N."""

    alpha: float
    z: Array
    energy: float
    moment: float
    multipliers: Array
    acting: tuple[int, ...]
    curvature: float


@dataclass(frozen=True, slots=True)
class End:
    """Where a branch ends, rad, and how: κ before it, and what is left of κ without the inequality that lets go."""

    alpha: float
    kind: Kind
    before: float
    left: float | None


@dataclass(frozen=True, slots=True)
class Path:
    """States at the stations that were reached, and the last one before the end where there is an end."""

    states: tuple[State, ...]
    last: State
    end: End | None


def constraints(problem: Problem, z: Array, alpha: complex) -> tuple[Array, Array]:
    """g, (…, 4 + m + 4), and G, (…, 4 + m + 4, 2N): closure, contact, limits."""
    closure, dclosure = problem.closure(z, alpha)
    contact, dcontact = problem.contact(z)
    n = problem.links
    limited = problem.limited(alpha)
    ends = z[..., [n - 1, 2 * n - 1]]
    limits = np.stack((limited[:, 0] - ends, ends - limited[:, 1]), axis=-1).reshape(*z.shape[:-1], 4)
    dlimits = np.zeros((*z.shape[:-1], 4, 2 * n))
    dlimits[..., [0, 1, 2, 3], [n - 1, n - 1, 2 * n - 1, 2 * n - 1]] = [-1.0, 1.0, -1.0, 1.0]
    return np.concatenate((closure, contact, limits), axis=-1), np.concatenate((dclosure, dcontact, dlimits), axis=-2)


def hessian(problem: Problem, z: Array, alpha: float, multipliers: Array) -> Array:
    """∂²L/∂z², (2N, 2N), of the multipliers of g; the limits are linear in z, and the energy's part is constant."""
    steps = z + 1j * _STEP * np.eye(len(z))
    slope = problem.energy(steps)[1]
    slope = slope + np.einsum("...cv,c->...v", problem.closure(steps, alpha)[1], multipliers[:4])
    contact = multipliers[4:-4]
    if np.any(contact != 0.0):
        moves = problem.moves_contact
        slope[moves] += np.einsum("...cv,c->...v", problem.contact(steps[moves])[1], contact)
    return np.asarray(slope.imag / _STEP)


def settled(problem: Problem, alpha: float, z: Array, multipliers: Array, acting: Sequence[int]) -> State | None:
    """The equilibrium near ``z``, the working set changed by one inequality at a time; None where there is none."""
    working = set(acting)
    tried: set[frozenset[int]] = set()
    while frozenset(working) not in tried:  # a set that comes back would come back for ever
        tried.add(frozenset(working))
        rows = _rows(working)
        solved = _newton(problem, alpha, z, multipliers, rows)
        if solved is None:
            return None
        z, multipliers = solved
        g, G = constraints(problem, z, alpha)
        broken = [(g[4 + i], i) for i in range(len(g) - 4) if i not in working and g[4 + i] > 1e-11]
        pulling = [(multipliers[4 + i], i) for i in working if multipliers[4 + i] < -1e-8]
        if broken:
            working.add(max(broken)[1])
        elif pulling:
            working.discard(min(pulling)[1])
        else:
            curvature = _curvature(hessian(problem, z, alpha, multipliers), G[rows])
            turned = constraints(problem, z, alpha + 1j * _STEP)[0]
            moment = float(multipliers[rows] @ turned[rows].imag / _STEP)
            energy = float(problem.energy(z)[0])
            return State(alpha, z, energy, moment, multipliers, tuple(sorted(working)), curvature)
    return None


def followed(problem: Problem, start: State, stations: Sequence[float]) -> Path:
    """The branch of ``start`` at stations, rad, in their order, as far as it goes."""
    states: list[State] = []
    state, largest, strongest = start, start.curvature, start.multipliers
    for station in stations:
        step = station - state.alpha
        while abs(station - state.alpha) > 1e-12:
            aim = state.alpha + np.sign(step) * min(abs(step), abs(station - state.alpha))
            after = settled(problem, aim, state.z, state.multipliers, state.acting)
            if after is not None and np.max(np.abs(after.z - state.z)) < _LARGEST_TURN and after.curvature > 0.0:
                state, step = after, 2.0 * step
                largest, strongest = max(largest, state.curvature), np.maximum(strongest, state.multipliers)
            elif abs(aim - state.alpha) < FINEST:
                return Path(tuple(states), state, _ended(problem, state, largest, strongest))
            else:
                step = 0.5 * (aim - state.alpha)
        states.append(state)
    return Path(tuple(states), state, None)


def _rows(working: set[int]) -> Array:
    return np.array([*range(4), *(4 + i for i in sorted(working))])


def _newton(problem: Problem, alpha: float, z: Array, multipliers: Array, rows: Array) -> tuple[Array, Array] | None:
    """z and λ with ∂L/∂z = 0 and g = 0 in ``rows``, λ = 0 in the others."""
    for _ in range(_NEWTON):
        g, G = constraints(problem, z, alpha)
        acting = np.zeros(len(g))
        acting[rows] = multipliers[rows]
        residual = np.concatenate((problem.energy(z)[1] + G[rows].T @ acting[rows], g[rows]))
        if np.max(np.abs(residual[: len(z)])) < 1e-8 and np.max(np.abs(residual[len(z) :])) < 1e-12:
            return z, acting
        H = hessian(problem, z, alpha, acting)
        matrix = np.block([[H, G[rows].T], [G[rows], np.zeros((len(rows), len(rows)))]])
        try:
            change = np.linalg.solve(matrix, -residual)
        except np.linalg.LinAlgError:
            return None
        part = min(1.0, 0.3 / float(np.max(np.abs(change[: len(z)]))))
        z = z + part * change[: len(z)]
        acting[rows] += part * change[len(z) :]
        multipliers = acting
    return None


def _curvature(H: Array, G: Array) -> float:
    Z = linalg.null_space(G)
    return float(linalg.eigvalsh(Z.T @ H @ Z, subset_by_index=[0, 0])[0])


def _ended(problem: Problem, state: State, largest: float, strongest: Array) -> End:
    """How the branch ends: κ has gone to zero, or the weakest of what acts lets go and leaves a negative κ.

    ``largest`` and ``strongest`` are the largest κ and λ of the branch.
    """
    if state.curvature < _NONE_LEFT * largest:
        return End(state.alpha, "fold", state.curvature, None)
    shares = {i: float(state.multipliers[4 + i] / strongest[4 + i]) for i in state.acting}
    weakest = min(shares, key=shares.__getitem__, default=None)
    if weakest is None or shares[weakest] > _LETS_GO:
        return End(state.alpha, "lost", state.curvature, None)
    rows = _rows(set(state.acting) - {weakest})
    G = constraints(problem, state.z, state.alpha)[1]
    left = _curvature(hessian(problem, state.z, state.alpha, state.multipliers), G[rows])
    lets_go: Kind = "limit lets go" if weakest >= len(problem.related) else "contact lets go"
    return End(state.alpha, lets_go if left < 0.0 else "lost", state.curvature, left)
