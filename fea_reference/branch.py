"""Following a branch of equilibria by its arc length, through where its load turns back.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
z, λ    state, and value of the stepped load or drive: both unknown
R, K    unbalanced forces and their tangent; f = −∂R/∂λ
t, τ    direction of the branch, dz/ds and dλ/ds
w       weights of an arc length: the mean square of all motions, and of λ over a span
======  =====================================================================================

From a point (z₀, λ₀) the next one at distance s along (t, τ) has

    R(z, λ) = 0,     t·w (z − z₀) + w_λ τ (λ − λ₀) = s,

which is regular where K is not because λ turns back (Riks, Int. J. Solids Struct. 15 (1979) 529; Keller, in
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
from fea_reference.sinking import known_depths, sunk
from fea_reference.system import System, assemble, factors, load_direction
from fea_reference.touch import Contact, Penalty

_ITERATIONS = 20
_NEAR = 1e-9  # of a way along which a place is sought: how near it is known
_ROUNDED = 4.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class Branch:
    """What stays the same along a piece of a branch: all but the state and the value that is stepped.

    ``values`` are those of all that is stepped, of which number ``load`` is; ``span`` is what its changes are measured
    by.
    """

    model: Model
    settings: Settings
    penalties: Mapping[Contact, Penalty]
    acting: Acting
    values: Array
    load: int
    span: float

    def at(self, value: float) -> Array:
        """The values of all that is stepped, (number,)."""
        values = self.values.copy()
        values[self.load] = value
        return values

    @property
    def weights(self) -> Array:
        """w of the unknowns, (size,)."""
        moving = self.model.moving
        weights = np.zeros(self.model.size)
        weights[moving] = 1.0 / moving.size
        return weights

    @property
    def weight(self) -> float:
        """w of the value."""
        return 1.0 / self.span**2


@dataclass(frozen=True, slots=True)
class Place:
    """An equilibrium on a branch: the ``value``, its softest ``mode``, and the direction ``way`` (t), ``rate`` (τ)."""

    value: float
    system: System
    mode: Mode
    way: Array
    rate: float

    @property
    def curvature(self) -> float:
        """The smallest."""
        return self.mode.curvature


def place(branch: Branch, value: float, system: System, before: tuple[Array, float]) -> Place | None:
    """The place of an equilibrium, its direction that which goes with the one ``before``; None where it has none."""
    f = load_direction(branch.model, branch.load, system.z, system.acting)
    solved = _solve(branch, system, f, before, np.zeros(branch.model.size), 1.0)
    if solved is None:
        return None
    way, rate = solved
    size = np.sqrt(float(way @ (branch.weights * way)) + branch.weight * rate**2)
    if not size > 0.0:
        return None
    return Place(value, system, softest(branch.model, system), way / size, rate / size)


def onwards(branch: Branch, start: Place, length: float) -> Place | None:
    """The place at a ``length`` of arc beyond ``start``; None where Newton's method finds none."""
    model, settings = branch.model, branch.settings
    z, value = advance(model, start.system.z, length * start.way), start.value + length * start.rate
    foreseen = {one.pair: one.foreseen(length * start.way) for one in start.system.touches}
    pushes = {one.pair: one.pushes for one in start.system.touches if one.closed}
    known = known_depths(start.system, {one.pair: one.penetration for one in start.system.touches}, pushes)
    z = sunk(model, branch.penalties, settings.quadrature, start.system, z, foreseen, known)
    correction = np.inf
    for _ in range(_ITERATIONS):
        system = assemble(
            model, branch.penalties, settings.quadrature, branch.at(value), z, branch.acting, {}, foreseen
        )
        unbalanced = float(np.abs(system.residual).max())
        if correction <= settings.correction and unbalanced <= max(settings.residual * system.scale, system.floor):
            return place(branch, value, system, (start.way, start.rate))
        f = load_direction(model, branch.load, z, branch.acting)
        gone = (z.values - start.system.z.values) + (z.rest - start.system.z.rest)
        missing = length - float(start.way @ (branch.weights * gone))
        missing -= branch.weight * start.rate * (value - start.value)
        solved = _solve(branch, system, f, (start.way, start.rate), -system.residual, missing)
        if solved is None:
            return None
        step, change = solved
        correction = max(float(np.abs(step[model.moving]).max()), abs(change) / branch.span)
        if correction > 1.0:
            return None
        foreseen = {one.pair: one.foreseen(step) for one in system.touches}
        z = sunk(model, branch.penalties, settings.quadrature, system, advance(model, z, step), foreseen, known)
        value += change
    return None


def sought(branch: Branch, start: Place, length: float, size: Callable[[Place], float]) -> Place | None:
    """The place just behind where a ``size`` goes from positive to negative, within a ``length`` of arc from ``start``.

    None where Newton's method finds no place on the way there.
    """
    behind: list[tuple[float, Place]] = []

    def sized(way: float) -> float:
        there = onwards(branch, start, way) if way > 0.0 else start
        if there is None:
            raise ArithmeticError
        found = size(there)
        if found < 0.0:
            behind.append((way, there))
        return found if way > 0.0 else max(found, np.finfo(float).tiny)

    near = _NEAR * length
    try:
        root = brentq(sized, 0.0, length, xtol=near, rtol=_ROUNDED)
        if min(way for way, _ in behind) > root + 2.0 * near:
            sized(root + 2.0 * near)
    except ArithmeticError:
        return None
    return min(behind, key=lambda one: one[0])[1]


def _solve(
    branch: Branch, system: System, f: Array, along: tuple[Array, float], right: Array, last: float
) -> tuple[Array, float] | None:
    """K t − f τ = ``right`` and w t₀·t + w τ₀ τ = ``last``, of the direction ``along`` (t₀, τ₀)."""
    way, rate = along
    matrix = bordered(system.tangent, -f, branch.weights * way, branch.weight * rate)
    try:
        solution = factors(matrix).solve(np.append(right, last))
    except RuntimeError:  # exactly singular
        return None
    return (solution[:-1], float(solution[-1])) if np.isfinite(solution).all() else None


def bordered(K: csc_matrix, column: Array, row: Array, corner: float) -> csc_matrix:
    """K (size, size) with one more ``column`` and ``row`` (size,) each, and what is in the ``corner``."""
    size = column.size
    below, beside = np.flatnonzero(row), np.flatnonzero(column)
    ends = K.indptr[below + 1]
    entries = np.concatenate([np.insert(K.data, ends, row[below]), column[beside], [corner]])
    rows = np.concatenate([np.insert(K.indices, ends, size), beside, [size]])
    counts = np.append(np.diff(K.indptr), beside.size + 1)
    counts[below] += 1
    return csc_matrix((entries, rows, np.append(0, np.cumsum(counts))), (size + 1, size + 1))
