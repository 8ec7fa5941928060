"""The same problem once more as expressions of CasADi, for IPOPT, with exact first and second derivatives.

Symbols and equations are those of the module of the problem; CasADi is the optional extra ``peers``.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.studies.readings_problem import Array, Problem

if TYPE_CHECKING:
    from casadi import MX, Function


def there() -> bool:
    """Whether CasADi is installed."""
    return importlib.util.find_spec("casadi") is not None


def expressions(problem: Problem) -> tuple[MX, MX, MX, MX]:
    """z, the pins (x_B, y_B, x_C, y_C), PE in J, and closure and contact in m, one below the other.

    Raises:
        ModuleNotFoundError: CasADi is not installed.
        ValueError: the reading has no fitted curve.
    """
    import casadi as ca

    degree = problem.reading.degree
    if degree is None:
        raise ValueError("the expressions are those of the fitted curve")
    n, t = problem.links, problem.mechanism.thickness
    z, pins = ca.MX.sym("z", 2 * n), ca.MX.sym("pins", 4)
    theta = [ca.vertcat(np.pi / 2.0, z[b * n : (b + 1) * n]) for b in (0, 1)]
    delta = [turn[1:] - turn[:-1] for turn in theta]
    energy = 0.5 * problem.stiffness * (ca.sumsqr(delta[0]) + ca.sumsqr(delta[1]))
    sides = (-problem.mechanism.base, problem.mechanism.base)
    x = [side + ca.cumsum(problem.lengths * ca.cos(turn)) for side, turn in zip(sides, theta, strict=True)]
    y = [ca.cumsum(problem.lengths * ca.sin(turn)) for turn in theta]
    closure = ca.vertcat(x[0][-1], y[0][-1], x[1][-1], y[1][-1]) - pins
    related = [int(joint) for joint in problem.related]
    before = [joint - 1 for joint in related]  # joint j lies behind link j − 1
    mean = 0.5 * (theta[1][related] + theta[1][before])
    half = 0.5 * float(related[-1]) * problem.mechanism.beam / n

    def powers(heights: MX) -> MX:
        scaled = (heights - half) / half
        return ca.horzcat(*[scaled**exponent for exponent in range(degree + 1)])

    V = powers(y[1][before] + t * ca.cos(mean))
    p = ca.solve(V.T @ V, V.T @ (x[1][before] - t * ca.sin(mean)))
    contact = x[0][before] - powers(y[0][before]) @ p
    return z, pins, energy, ca.vertcat(closure, contact)


@lru_cache(maxsize=8)
def solver(
    problem: Problem, per_energy: float, per_length: float, options: Mapping[str, Any]
) -> tuple[Function, Array]:
    """IPOPT on a problem in given units, and a row of zeros as long as its constraints.

    Raises:
        ModuleNotFoundError: CasADi is not installed.
        ValueError: the reading has no fitted curve.
    """
    import casadi as ca

    z, pins, energy, constraints = expressions(problem)
    settings: dict[str, Any] = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "error_on_fail": False}
    settings.update({f"ipopt.{name}": value for name, value in options.items()})
    task = {"x": z, "p": pins, "f": per_energy * energy, "g": per_length * constraints}
    return ca.nlpsol("ipopt", "ipopt", task, settings), np.zeros(constraints.shape[0])
