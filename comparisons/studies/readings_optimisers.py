"""General optimisers on the problem of one angle, as somebody uses them who writes the paper's formulas down.

Each is handed energy, closure and contact in units of its user's choice: what a stopping rule, a first guess of the
curvature or a barrier of 0.1 means depends on them.  Limits of the last links are bounds of two unknowns.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np
from scipy import optimize

from comparisons.studies.readings_problem import Array, Problem
from cprbm_scene.frozendict import frozendict

Units = Literal["J, m", "mJ, mm"]
_FACTORS: Mapping[Units, tuple[float, float]] = frozendict({"J, m": (1.0, 1.0), "mJ, mm": (1e3, 1e3)})
_TOLERANCE = 1e-6
"""m or rad: by this much a constraint may be broken."""


@dataclass(frozen=True, slots=True)
class Answered:
    """What an optimiser came to; ``why`` says why it is no answer, and is empty where it is one.

    What is there when the time is up is taken where it keeps the constraints, as after a number of iterations.
    """

    z: Array
    why: str
    iterations: int
    timed_out: bool = False


class Optimiser(Protocol):
    """One solve: problem, α in rad, start, and the seconds it may take."""

    def __call__(self, problem: Problem, alpha: float, start: Array, seconds: float) -> Answered:
        """Solve."""


@dataclass(frozen=True, slots=True)
class Slsqp:
    """Sequential quadratic programming with an updated Hessian; ``differences`` takes gradients forward by 1.5e-8."""

    units: Units
    differences: bool = False
    stops_at: float = 1e-6

    def __call__(self, problem: Problem, alpha: float, start: Array, seconds: float) -> Answered:
        """Solve."""
        task = _Task(problem, alpha, self.units, differences=self.differences)
        lower, upper = bounds(problem, alpha)
        clock = _Clock(seconds)

        def minimised() -> optimize.OptimizeResult:
            return optimize.minimize(
                task.energy,
                np.clip(start, lower, upper),
                jac=task.energy_slope,
                method="SLSQP",
                bounds=list(zip(lower, upper, strict=True)),
                constraints=[
                    {"type": "eq", "fun": task.closure, "jac": task.closure_slope},
                    {"type": "ineq", "fun": lambda z: -task.contact(z), "jac": lambda z: -task.contact_slope(z)},
                ],
                callback=clock,
                options={"maxiter": 1500, "ftol": self.stops_at},
            )

        return _answered(problem, alpha, start, clock, minimised)


@dataclass(frozen=True, slots=True)
class TrustConstr:
    """SciPy's interior point in a trust region, of the family of fmincon's; the Hessian is updated by BFGS."""

    units: Units

    def __call__(self, problem: Problem, alpha: float, start: Array, seconds: float) -> Answered:
        """Solve."""
        task = _Task(problem, alpha, self.units, differences=False)
        lower, upper = bounds(problem, alpha)
        clock = _Clock(seconds)
        held = np.flatnonzero(np.isfinite(lower) | np.isfinite(upper))
        rows = np.eye(len(start))[held]
        constraints = [
            optimize.NonlinearConstraint(task.closure, 0.0, 0.0, jac=task.closure_slope, hess=optimize.BFGS()),
            optimize.NonlinearConstraint(task.contact, -np.inf, 0.0, jac=task.contact_slope, hess=optimize.BFGS()),
        ]
        if len(held):
            constraints.append(optimize.LinearConstraint(rows, lower[held], upper[held]))

        def minimised() -> optimize.OptimizeResult:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)  # an update that is skipped is of no interest here
                return optimize.minimize(
                    task.energy,
                    start,
                    jac=task.energy_slope,
                    hess=optimize.BFGS(),
                    method="trust-constr",
                    constraints=constraints,
                    callback=clock,
                    options={"maxiter": 1000},
                )

        return _answered(problem, alpha, start, clock, minimised)


@dataclass(frozen=True, slots=True)
class Ipopt:
    """IPOPT by CasADi, its own settings but for ``options``; only where the extra ``peers`` is installed."""

    units: Units
    options: Mapping[str, str | float] = field(default_factory=frozendict)

    def __call__(self, problem: Problem, alpha: float, start: Array, seconds: float) -> Answered:
        """Solve."""
        from comparisons.studies.readings_peers import solver

        energy, length = _FACTORS[self.units]
        solve, zeros = solver(problem, energy, length, frozendict({**self.options, "max_wall_time": seconds}))
        lower, upper = bounds(problem, alpha)
        least = np.where(np.arange(zeros.size) < 4, 0.0, -np.inf)
        found = solve(x0=start, p=problem.pins(alpha).ravel(), lbx=lower, ubx=upper, lbg=least, ubg=zeros)
        z, stats = np.array(found["x"]).ravel(), solve.stats()
        late = stats["return_status"] == "Maximum_WallTime_Exceeded"
        unfinished = "" if stats["success"] or late else stats["return_status"].replace("_", " ")
        return Answered(z, _broken(problem, alpha, z) or unfinished, int(stats["iter_count"]), timed_out=late)


def bounds(problem: Problem, alpha: float) -> tuple[Array, Array]:
    """Least and most of each unknown, (2N,) each."""
    lower = np.full(2 * problem.links, -np.inf)
    upper = -lower
    last = [problem.links - 1, 2 * problem.links - 1]
    lower[last], upper[last] = problem.limited(alpha).T
    return lower, upper


class _TimeIsUpError(Exception):
    def __init__(self, z: Array) -> None:
        super().__init__()
        self.z = z


class _Clock:
    """Ends a solve that takes too long."""

    def __init__(self, seconds: float) -> None:
        self.until = time.perf_counter() + seconds
        self.iterations = 0

    def __call__(self, z: Array, _: object = None) -> None:
        self.iterations += 1
        if time.perf_counter() > self.until:
            raise _TimeIsUpError(np.array(z))


class _Task:
    """The problem's functions of z alone, in the units and with the gradients that the optimiser is handed."""

    def __init__(self, problem: Problem, alpha: float, units: Units, *, differences: bool) -> None:
        self.problem, self.alpha, self.differences = problem, alpha, differences
        self.per_energy, self.per_length = _FACTORS[units]

    def energy(self, z: Array) -> Array:
        return np.asarray(self.per_energy * self.problem.energy(z)[0])

    def energy_slope(self, z: Array) -> Array:
        if self.differences:
            return _forward(self.energy, z)
        return self.per_energy * self.problem.energy(z)[1]

    def closure(self, z: Array) -> Array:
        return self.per_length * self.problem.closure(z, self.alpha)[0]

    def closure_slope(self, z: Array) -> Array:
        if self.differences:
            return _forward(self.closure, z)
        return self.per_length * self.problem.closure(z, self.alpha)[1]

    def contact(self, z: Array) -> Array:
        return self.per_length * self.problem.contact(z)[0]

    def contact_slope(self, z: Array) -> Array:
        if self.differences:
            return _forward(self.contact, z)
        return self.per_length * self.problem.contact(z)[1]


def _forward(values: Callable[[Array], Array], z: Array) -> Array:
    """Differences by √ε, as fmincon takes them."""
    steps = np.sqrt(np.finfo(float).eps) * np.maximum(1.0, np.abs(z))
    return np.asarray((values(z + np.diag(steps)) - values(z)).T / steps)


def _answered(
    problem: Problem, alpha: float, start: Array, clock: _Clock, minimised: Callable[[], optimize.OptimizeResult]
) -> Answered:
    """What one of SciPy's solves found, or where it stood when the time was up."""
    try:
        found = minimised()
    except _TimeIsUpError as up:
        return Answered(up.z, _broken(problem, alpha, up.z), clock.iterations, timed_out=True)
    except np.linalg.LinAlgError:
        return Answered(start, "lost: no curve can be fitted", clock.iterations)
    return Answered(found.x, _broken(problem, alpha, found.x), int(found.nit))


def _broken(problem: Problem, alpha: float, z: Array) -> str:
    """Which constraint an answer breaks, or nothing."""
    if not np.all(np.isfinite(z)):
        return "not a number"
    lower, upper = bounds(problem, alpha)
    for name, most in (
        ("closure", np.max(np.abs(problem.closure(z, alpha)[0]))),
        ("contact", np.max(problem.contact(z)[0])),
        ("limit", max(np.max(lower - z), np.max(z - upper))),
    ):
        if not most <= _TOLERANCE:
            return f"breaks the {name}"
    return ""
