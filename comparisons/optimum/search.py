"""Search for the parameters of a goal within limits: COBYQA of SciPy from several starts.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
u       parameters over their ranges, from 0 to 1
f(u)    the goal over its scale: the number to minimise, its negative, or its squared distance from a value
g(u)    excesses of the limits over their scales, negative within a limit
======  ==========================================================================================

COBYQA (Ragonneau and Zhang, 2022) needs no derivatives and never leaves the ranges.  Every start is a trust-region
method of its own; the starts share workers and solved points.  A point without an answer has the worst f and g of its
start: the trust region shrinks, and the start goes on elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from threading import Lock

import numpy as np

from comparisons.choices import Choices
from comparisons.optimum.problem import Problem
from comparisons.pairing import Solvers
from comparisons.sweeps.outcome import Asked, Outcome
from comparisons.sweeps.points import Point
from comparisons.sweeps.running import Sweep, run, tasks_of
from comparisons.sweeps.workers import Workers
from comparisons.writing import append_line
from cprbm_scene import SceneError
from cprbm_scene.answer import Array

FEASIBLE = 1e-6
"""Excess over the scale of a limit that still counts as met: the optimum often lies on a limit."""

_FIRST, _LAST = 0.1, 1e-4
"""First and last radius of the trust region, shares of the ranges."""


@dataclass(frozen=True, slots=True)
class End:
    """End of a start.

    Attributes:
        begun, point: first and last values of the parameters.
        outcome: at the last values.
        number: of the goal.
        feasible: whether all limits are met.
        solves: number of solved points.
        settled: whether the trust region shrank to its last radius, rather than the number of solves ran out.
    """

    begun: Point
    point: Point
    outcome: Outcome
    number: float
    feasible: bool
    solves: int
    settled: bool


@dataclass(frozen=True, slots=True)
class PointSolver:
    """Solver of single points for several threads, with a journal of outcomes.

    Attributes:
        problem: scene and ranges.
        workers: solve the points.
        choices: how finely, and by which variants.
        solvers: the functions that answer.
        limit: time limit per solve, s.
        journal: file of the outcomes.
        known: outcomes by key.
        moved: called with the number of known outcomes.
    """

    problem: Problem
    workers: Workers
    choices: Choices
    solvers: Solvers
    limit: float
    journal: Path
    known: dict[str, Outcome]
    moved: Callable[[int], None]
    lock: Lock = field(default_factory=Lock)

    def outcome(self, point: Point, asked: Asked = "cprbm", *, finer: bool = False) -> Outcome:
        """The outcome at a point; an invalid scene is an outcome too.

        Args:
            point: values of the parameters, SI.
            asked: solver, or the comparison of both solvers.
            finer: whether to double the numbers of links and elements.

        Raises:
            OSError: the journal cannot be written.
        """
        scene, choices = self.problem.scene, self.choices.finer() if finer else self.choices
        try:
            tasks = tasks_of(scene, [point], asked, frozenset(), choices)
        except SceneError as error:
            return Outcome(asked, "REFUSED", "; ".join(map(str, error.mistakes)))
        sweep = Sweep(scene, self.problem.axes, tasks, self.known)
        found = run(sweep, self.workers, choices, self.solvers, self.limit, None).outcomes[tasks[0].key]
        with self.lock:
            if self.known.get(tasks[0].key) != found:
                self.known[tasks[0].key] = found
                append_line(self.journal, found.line(tasks[0].key))
                self.moved(len(self.known))
        return found


def search(problem: Problem, solver: PointSolver, starts: int, most: int) -> list[End]:
    """Ends of all starts, the best first: feasible before infeasible ends, then by the goal.

    Args:
        problem: scene, ranges, goal and limits.
        solver: of points.
        starts: number of starts.
        most: largest number of solves per start.

    Raises:
        OSError: the journal cannot be written.
    """
    first = problem.number(solver.outcome(problem.point(problem.starts(1)[0])))
    scale = abs(problem.cost(first)) if isfinite(first) else 1.0

    def end(u: Array) -> End:
        return _end(problem, solver, u, scale or 1.0, most)

    with ThreadPoolExecutor(starts) as pool:
        found = list(pool.map(end, problem.starts(starts)))
    return sorted(found, key=lambda each: (not each.feasible, problem.cost(each.number) if each.feasible else 0.0))


def _end(problem: Problem, solver: PointSolver, begun: Array, scale: float, most: int) -> End:
    """End of the start at the shares ``begun`` (d,)."""
    from scipy.optimize import Bounds, NonlinearConstraint, minimize

    seen: dict[bytes, Array] = {}

    def values(u: Array) -> Array:
        """f and g at u."""
        if u.tobytes() not in seen:
            outcome = solver.outcome(problem.point(u))
            cost = problem.cost(problem.number(outcome)) / scale
            own = np.array([cost, *(bound.excess(outcome) for bound in problem.bounds)])
            if not np.isfinite(own).all():
                own = np.max([np.ones_like(own), *seen.values()], axis=0)
            seen[u.tobytes()] = own
        return seen[u.tobytes()]

    limits = [NonlinearConstraint(lambda u: values(u)[1:], -np.inf, 0.0)] if problem.bounds else []
    found = minimize(
        lambda u: values(u)[0],
        begun,
        method="COBYQA",
        bounds=Bounds(np.zeros_like(begun), np.ones_like(begun)),
        constraints=limits,
        options={"initial_tr_radius": _FIRST, "final_tr_radius": _LAST, "maxfev": most},
    )
    outcome = solver.outcome(problem.point(found.x))
    feasible = outcome.completed and all(bound.excess(outcome) <= FEASIBLE for bound in problem.bounds)
    number = problem.number(outcome)
    point = problem.point(found.x)
    return End(problem.point(begun), point, outcome, number, feasible, len(seen), bool(found.status == 0))
