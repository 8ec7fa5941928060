"""Newton's method for the equations, at given λ or with an additional condition and unknown λ.

=======  ===================================================================
symbol   meaning
=======  ===================================================================
r, J     rows of the equations at z, and their derivative
C        additional condition, with λ as additional unknown
=======  ===================================================================
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cprbm_scene.answer import Array
from elastica_reference.equations import Equations
from elastica_reference.evaluation import Columns, Evaluation
from elastica_reference.spectral import UnsolvableError
from elastica_reference.state import Known, State

_STEP = 1e-40  # complex step: far below round-off, as no subtraction takes place
_LARGEST = 1e3  # largest dimensionless residual within reach of Newton's method
_SETTLED = 1e-11  # residual at which a step without reduction ends the iteration
_ROUND_OFF = 1e-14  # residual at round-off

Condition = Callable[[Columns, Evaluation], Columns]
"""Function of z (n, K) and all quantities: (K,), zero where the condition holds."""


class LostError(ArithmeticError):
    """No equilibrium was found near the guess."""


def solve(
    equations: Equations, z: Array, lam: float, iterations: int, known: Known, condition: Condition | None = None
) -> State:
    """Equilibrium near z (n,) at λ, or at the condition.

    Args:
        equations: of a structure under loads.
        z: initial unknowns.
        lam: λ, or its initial guess with a condition.
        iterations: largest number.
        known: a state with tangent angles for the first solution of pieces.
        condition: additional condition, with λ as additional unknown.

    Raises:
        LostError: there is none, or too far away.
    """
    guess: Known = known
    last, free = np.inf, int(condition is not None)
    n = len(z)
    for _ in range(iterations):
        evaluation, r, J = linearised(equations, z, lam, guess, condition)
        size = float(np.max(np.abs(r)))
        if not size <= _LARGEST:
            raise LostError
        here = State(equations, z, lam, evaluation, size)
        if size < _ROUND_OFF or (size < _SETTLED and size >= 0.5 * last):
            return here
        last = size
        try:
            step = np.linalg.solve(J, -r)
        except np.linalg.LinAlgError as error:
            raise LostError from error
        z = z + step[:n]
        if free:
            lam += float(step[n])
        guess = here
    raise LostError


def linearised(
    equations: Equations, z: Array, lam: float, guess: Known, condition: Condition | None = None
) -> tuple[Evaluation, Array, Array]:
    """All quantities at z (n,) and λ, the rows r (n,), and their derivative J (n, n).

    Pieces are solved from the tangent angles of ``guess``. With a condition r and J have an additional row, and J a
    column for λ.

    Raises:
        LostError: a piece cannot be integrated, or a row is not finite.
    """
    n, free = len(z), int(condition is not None)
    columns = np.concatenate([z, [lam]])[:, None] + 1j * _STEP * np.eye(n + 1)[:, : n + free]
    try:
        evaluation = equations(columns[:n], columns[n], _angles_of(guess))
    except (UnsolvableError, FloatingPointError) as error:
        raise LostError from error
    rows = np.stack([*evaluation.rows, *([condition(columns[:n], evaluation)] if condition is not None else [])])
    if not np.all(np.isfinite(rows)):
        raise LostError
    return evaluation.real(), np.ascontiguousarray(rows[:, 0].real), rows.imag / _STEP


def _angles_of(known: Known) -> Callable[[str, Array], Array]:
    """Tangent angles of the last iterate as function of beam and arc length; starts of pieces may have moved since."""
    return lambda beam, s: known.along(beam, s)[2]


def residual_with_more_points(state: State, further: int) -> float:
    """Largest row for the same z with ``further`` more Gauss points per piece.

    Raises:
        LostError: a piece cannot be integrated.
    """
    finer = replace(state.equations, nodes=state.equations.nodes + further)
    try:
        evaluation = finer(state.z[:, None], np.array([state.lam]), _angles_of(state))
    except UnsolvableError as error:
        raise LostError from error
    return float(np.max(np.abs(np.concatenate(evaluation.rows))))
