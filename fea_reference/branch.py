"""Path following of a branch of equilibria by arc length, through limit points.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
z, λ    state, and value of the stepped parameter: both unknown
R, K    unbalanced forces and their tangent; f = −∂R/∂λ
t, τ    direction of the branch, dz/ds and dλ/ds
w       weights of the arc length: mean square of all motions, and of λ over a span
======  =====================================================================================

From a point (z₀, λ₀) with direction (t, τ) the next point at distance s satisfies

    R(z, λ) = 0,     t·w (z − z₀) + w_λ τ (λ − λ₀) = s,

which is regular at limit points, where K is singular (Riks, Int. J. Solids Struct. 15 (1979) 529; Keller, in
Applications of Bifurcation Theory, 1977, p. 359).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import csc_matrix

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.advance import advance
from fea_reference.curvature import Mode, softest
from fea_reference.model import Model
from fea_reference.settings import Settings
from fea_reference.sinking import known_depths, with_predicted_depths
from fea_reference.system import System, assemble, factors, load_direction
from fea_reference.touch import Contact, Penalty

_ITERATIONS = 20
_NEAR = 1e-9  # relative accuracy of a root along the arc
_ROUNDED = 4.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class Branch:
    """Constant data of a branch: model, settings, penalties, constraints and the values of other parameters.

    ``load`` is the number of the stepped parameter among ``values``; ``span`` is the reference for its changes.
    """

    model: Model
    settings: Settings
    penalties: Mapping[Contact, Penalty]
    acting: Acting
    values: Array
    load: int
    span: float

    def at(self, value: float) -> Array:
        """Values (number,) of all stepped parameters."""
        values = self.values.copy()
        values[self.load] = value
        return values

    @property
    def weights(self) -> Array:
        """w (size,) of the unknowns."""
        moving = self.model.moving
        weights = np.zeros(self.model.size)
        weights[moving] = 1.0 / moving.size
        return weights

    @property
    def weight(self) -> float:
        """w of the stepped parameter."""
        return 1.0 / self.span**2


@dataclass(frozen=True, slots=True)
class BranchPoint:
    """A point of a branch: ``value``, system, softest ``mode``, and the direction ``way`` (t), ``rate`` (τ)."""

    value: float
    system: System
    mode: Mode
    way: Array
    rate: float

    @property
    def curvature(self) -> float:
        """The smallest curvature."""
        return self.mode.curvature


def branch_point(branch: Branch, value: float, system: System, before: tuple[Array, float]) -> BranchPoint | None:
    """Point of a branch at an equilibrium, with a direction in the sense of ``before``; None without a direction."""
    f = load_direction(branch.model, branch.load, system.z, system.acting)
    solved = _solve(branch, system, f, before, np.zeros(branch.model.size), 1.0)
    if solved is None:
        return None
    way, rate = solved
    size = np.sqrt(float(way @ (branch.weights * way)) + branch.weight * rate**2)
    if not size > 0.0:
        return None
    return BranchPoint(value, system, softest(branch.model, system), way / size, rate / size)


def point_at(branch: Branch, start: BranchPoint, length: float) -> BranchPoint | None:
    """The point at arc ``length`` beyond ``start``; None if Newton's method fails."""
    model, settings = branch.model, branch.settings
    z, value = advance(model, start.system.z, length * start.way), start.value + length * start.rate
    predicted = {contact.pair: contact.predicted_forces(length * start.way) for contact in start.system.touches}
    pushes = {contact.pair: contact.pushes for contact in start.system.touches if contact.closed}
    known = known_depths(start.system, {contact.pair: contact.penetration for contact in start.system.touches}, pushes)
    z = with_predicted_depths(model, branch.penalties, settings.quadrature, start.system, z, predicted, known)
    correction = np.inf
    for _ in range(_ITERATIONS):
        system = assemble(
            model, branch.penalties, settings.quadrature, branch.at(value), z, branch.acting, {}, predicted
        )
        unbalanced = float(np.abs(system.residual).max())
        if correction <= settings.correction and unbalanced <= max(settings.residual * system.scale, system.floor):
            return branch_point(branch, value, system, (start.way, start.rate))
        f = load_direction(model, branch.load, z, branch.acting)
        displacement = (z.values - start.system.z.values) + (z.rest - start.system.z.rest)
        missing = length - float(start.way @ (branch.weights * displacement))
        missing -= branch.weight * start.rate * (value - start.value)
        solved = _solve(branch, system, f, (start.way, start.rate), -system.residual, missing)
        if solved is None:
            return None
        step, change = solved
        correction = max(float(np.abs(step[model.moving]).max()), abs(change) / branch.span)
        if correction > 1.0:
            return None
        predicted = {contact.pair: contact.predicted_forces(step) for contact in system.touches}
        z = with_predicted_depths(
            model, branch.penalties, settings.quadrature, system, advance(model, z, step), predicted, known
        )
        value += change
    return None


def sign_change(
    branch: Branch, start: BranchPoint, length: float, size: Callable[[BranchPoint], float]
) -> BranchPoint | None:
    """The point just behind a sign change of ``size`` from positive to negative, within arc ``length`` of ``start``.

    None if Newton's method fails on the way.
    """
    behind: list[tuple[float, BranchPoint]] = []

    def sized(distance: float) -> float:
        there = point_at(branch, start, distance) if distance > 0.0 else start
        if there is None:
            raise ArithmeticError
        value = size(there)
        if value < 0.0:
            behind.append((distance, there))
        return value if distance > 0.0 else max(value, np.finfo(float).tiny)

    near = _NEAR * length
    try:
        root = brentq(sized, 0.0, length, xtol=near, rtol=_ROUNDED)
        if min(distance for distance, _ in behind) > root + 2.0 * near:
            sized(root + 2.0 * near)
    except ArithmeticError:
        return None
    return min(behind, key=lambda item: item[0])[1]


def _solve(
    branch: Branch, system: System, f: Array, along: tuple[Array, float], right: Array, last: float
) -> tuple[Array, float] | None:
    """Solution of K t − f τ = ``right`` and w t₀·t + w τ₀ τ = ``last``, with ``along`` (t₀, τ₀); None if singular."""
    way, rate = along
    matrix = bordered(system.tangent.matrix, -f, branch.weights * way, branch.weight * rate)
    try:
        solution = factors(matrix).solve(np.append(right, last))
    except RuntimeError:  # exactly singular
        return None
    return (solution[:-1], float(solution[-1])) if np.isfinite(solution).all() else None


def bordered(K: csc_matrix, column: Array, row: Array, corner: float) -> csc_matrix:
    """K (size, size) bordered by a ``column`` and a ``row`` (size,) and the ``corner``."""
    size = column.size
    below, beside = np.flatnonzero(row), np.flatnonzero(column)
    ends = K.indptr[below + 1]
    entries = np.concatenate([np.insert(K.data, ends, row[below]), column[beside], [corner]])
    rows = np.concatenate([np.insert(K.indices, ends, size), beside, [size]])
    counts = np.append(np.diff(K.indptr), beside.size + 1)
    counts[below] += 1
    return csc_matrix((entries, rows, np.append(0, np.cumsum(counts))), (size + 1, size + 1))
