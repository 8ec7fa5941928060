"""A branch of solutions of n equations in n + 1 unknowns, and the places on it where a function vanishes.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
X        the n + 1 unknowns, a load or drive among them
R        the n equations; t unit null vector of ∂R/∂X, the branch's tangent
=======  =================================================================================

Source: E. L. Allgower and K. Georg, Introduction to Numerical Continuation Methods, chapters 2 and 8.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from tests.references.rod import LOOSE, TIGHT

Array = NDArray[np.float64]
Equations = Callable[[Array, float], tuple[Array, Array]]
"""Of X and a tolerance: R (n,) and ∂R/∂X (n, n + 1)."""
Wanted = Callable[[Array, float], float]
"""Of X and a tolerance: a number that is to vanish."""


def tangent(jacobian: Array, along: Array) -> Array:
    """The unit null vector (n + 1,) that has a positive product with ``along``."""
    t = np.linalg.svd(jacobian)[2][-1]
    return np.asarray(t if t @ along > 0.0 else -t)


def on_branch(equations: Equations, guess: Array, across: Array, tolerance: float = TIGHT) -> Array:
    """The solution in the plane through ``guess`` normal to ``across``."""
    X = guess.copy()
    for _ in range(30):
        R, J = equations(X, tolerance)
        step = np.linalg.solve(np.vstack((J, across)), np.append(-R, across @ (guess - X)))
        X = X + step
        # the error that is left is as this step squared
        if np.linalg.norm(step) < 0.1 * np.sqrt(tolerance) * (1.0 + np.linalg.norm(X)):
            return X
    raise ValueError("Newton's method found no solution")


def followed(equations: Equations, start: Array, along: Array, step: float) -> Iterator[Array]:
    """Solutions one ``step`` apart from ``start`` on, which solves, first to the side of ``along``."""
    X, t = start, along
    while True:
        yield X
        t = tangent(equations(X, LOOSE)[1], t)
        X = on_branch(equations, X + step * t, t, LOOSE)


def vanishing(equations: Equations, wanted: Wanted, start: Array, along: Array, step: float, reach: int) -> Array:
    """The first solution on the branch from ``start`` at which ``wanted`` vanishes with a change of sign.

    Raises:
        ValueError: it keeps its sign for ``reach`` steps.
    """
    path = followed(equations, start, along, step)
    last = next(path)
    sign = wanted(last, LOOSE)
    for _ in range(reach):
        X = next(path)
        if wanted(X, LOOSE) * sign < 0.0:
            chord = (X - last) / np.linalg.norm(X - last)

            def at(share: float, last: Array = last, X: Array = X, chord: Array = chord) -> Array:
                return on_branch(equations, last + share * (X - last), chord)

            # both ends were found loosely: a little beyond them
            return at(float(brentq(lambda share: wanted(at(share), TIGHT), -0.01, 1.01, xtol=1e-12)))
        last = X
    raise ValueError(f"no change of sign in {reach} steps")
