"""Newton's method on the equations, with λ given or with one condition more and λ unknown.

=======  ===================================================================
symbol   meaning
=======  ===================================================================
r, J     the equations' rows at z, and their derivative
C        one condition more, for which λ is an unknown too
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

_STEP = 1e-40  # of the complex step: far below round-off, no subtraction takes place
_LARGEST = 1e3  # of a residual, without dimension, that may still be mended
_SETTLED = 1e-11  # of a residual that a further step does not make less
_ROUND_OFF = 1e-14  # of one that no step makes less

Condition = Callable[[Columns, Evaluation], Columns]
"""Of z (n, K) and everything there: (K,), zero where it holds."""


class LostError(ArithmeticError):
    """No equilibrium was found near the guess."""


def solve(
    equations: Equations, z: Array, lam: float, iterations: int, known: Known, condition: Condition | None = None
) -> State:
    """The equilibrium near z (n,) at λ, or where the condition holds.

    Args:
        equations: of a structure under loads.
        z: unknowns to begin with.
        lam: λ, or with a condition where the search for it begins.
        iterations: at most so many.
        known: a state from whose tangent angles pieces are solved first.
        condition: one more, for which λ is free.

    Raises:
        LostError: there is none, or too far away.
    """
    guess: Known = known
    last, free = np.inf, int(condition is not None)
    n = len(z)
    for _ in range(iterations):
        found, r, J = linearised(equations, z, lam, guess, condition)
        size = float(np.max(np.abs(r)))
        if not size <= _LARGEST:
            raise LostError
        here = State(equations, z, lam, found, size)
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
    """Everything at z (n,) and λ, pieces solved from a ``guess``; the rows r (n,) and their derivative J (n, n).

    With a condition r and J have a row more, and J a column for λ.

    Raises:
        LostError: a piece cannot be integrated, or something is not finite.
    """
    n, free = len(z), int(condition is not None)
    columns = np.concatenate([z, [lam]])[:, None] + 1j * _STEP * np.eye(n + 1)[:, : n + free]
    try:
        found = equations(columns[:n], columns[n], _angles_of(guess))
    except (UnsolvableError, FloatingPointError) as error:
        raise LostError from error
    rows = np.stack([*found.rows, *([condition(columns[:n], found)] if condition is not None else [])])
    if not np.all(np.isfinite(rows)):
        raise LostError
    return found.real(), np.ascontiguousarray(rows[:, 0].real), rows.imag / _STEP


def _angles_of(known: Known) -> Callable[[str, Array], Array]:
    """Tangent angles of the last iterate; places of contact, where pieces begin, may have moved since."""
    return lambda beam, s: known.along(beam, s)[2]


def checked(state: State, further: int) -> float:
    """Largest row of the same z where pieces have ``further`` more Gauss points.

    Raises:
        LostError: a piece cannot be integrated so.
    """
    finer = replace(state.equations, nodes=state.equations.nodes + further)
    try:
        found = finer(state.z[:, None], np.array([state.lam]), _angles_of(state))
    except UnsolvableError as error:
        raise LostError from error
    return float(np.max(np.abs(np.concatenate(found.rows))))
