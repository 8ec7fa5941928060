"""Optimum: the search for parameters of a goal within limits by COBYQA of SciPy, a check of the best, and the result.

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

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite, nan
from pathlib import Path

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, minimize
from scipy.stats import qmc

from comparisons.formats import number, with_symbols
from comparisons.present.columns import Column, Plain, Section, Table, plain, table_of
from comparisons.sweeps.demands import Bound, Goal, Measure, bounds_of, measure_of, read_demands
from comparisons.sweeps.outcome import Asked, Outcome
from comparisons.sweeps.points import SEED, Axis, Point, in_file_units, place_text, ranges_of
from comparisons.sweeps.running import Runner, known_outcomes, tasks_of
from comparisons.verdict import first_met
from cprbm_scene import Array, Mistake, Scene, SceneError

FEASIBLE = 1e-6
"""Excess over the scale of a limit that still counts as met: the optimum often lies on a limit."""

_SAME = 1e-3
"""Distance over the range of two ends of starts that count as a point."""

_FIRST, _LAST = 0.1, 1e-4
"""First and last radius of the trust region, shares of the ranges."""


@dataclass(frozen=True, slots=True)
class Problem:
    """A scene with ranges of parameters, a goal and limits.

    Attributes:
        scene: the question.
        axes: ranges of the parameters.
        goal: aim and value.
        measure: the number of the goal.
        bounds: the limits.
    """

    scene: Scene
    axes: tuple[Axis, ...]
    goal: Goal
    measure: Measure
    bounds: tuple[Bound, ...]

    def number(self, outcome: Outcome) -> float:
        """The number of the goal, of several stations the worst; NaN without a complete answer."""
        values = self.measure.values(outcome) if outcome.completed else []
        return max(values, key=self.cost, default=nan)

    def cost(self, number: float) -> float:
        """The function to minimise, of the number of the goal."""
        if self.goal.value is not None:
            return (number - self.goal.value) ** 2
        return -number if self.goal.aim == "maximise" else number

    def point(self, u: Array) -> Point:
        """Values of the parameters, SI, at shares ``u`` (d,) of the ranges."""
        return {axis.name: float(axis.low + x * (axis.high - axis.low)) for axis, x in zip(self.axes, u, strict=True)}

    def outcome(self, runner: Runner, point: Point, asked: Asked = "cprbm") -> Outcome:
        """The outcome at a point; an invalid scene is an outcome too.

        Args:
            runner: solver of the point.
            point: values of the parameters, SI.
            asked: solver, or the comparison of both solvers.

        Raises:
            OSError: the journal cannot be written.
        """
        try:
            (task,) = tasks_of(self.scene, [point], asked, frozenset(), runner.choices)
        except SceneError as error:
            return Outcome(asked, "REFUSED", "; ".join(map(str, error.mistakes)))
        return runner.outcomes([task])[task.key]

    def starts(self, count: int) -> list[Array]:
        """Shares (d,) of ``count`` starts: the values of the file, and Sobol points."""
        own = [(self.scene.parameters[axis.name].value - axis.low) / (axis.high - axis.low) for axis in self.axes]
        others = qmc.Sobol(len(own), seed=SEED).random_base2((count - 1).bit_length())
        return [np.clip(own, 0.0, 1.0), *others[: count - 1]]


def problem_of(scene: Scene, axes: Sequence[Axis], file: Path) -> Problem:
    """The problem with the goal and the limits in a file.

    Args:
        scene: the question.
        axes: ranges of parameters; without axes the ranges of the scene.
        file: with a goal and limits.

    Raises:
        SceneError: the file is wrong, has no goal, or the scene has no such number or no range.
    """
    demands = read_demands(file)
    if demands.goal is None:
        raise SceneError([Mistake("goal", "nothing", "[goal] with a probe and an aim", str(file))])
    varied = in_file_units(scene, axes or ranges_of(scene))
    if not varied:
        raise SceneError([Mistake("--vary", "no range", "NAME=FIRST..LAST, or a parameter with a range")])
    return Problem(
        scene,
        axes=varied,
        goal=demands.goal,
        measure=measure_of(scene, demands.goal, "goal", str(file)),
        bounds=bounds_of(scene, demands, str(file)),
    )


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
class Optimum:
    """Ends of all starts, the best first, and the check of the best.

    Attributes:
        problem: scene, ranges, goal and limits.
        ends: of the starts.
        finer: outcome of the best end at twice the links.
        compared: outcome of the comparison of both solvers at the best end.
    """

    problem: Problem
    ends: tuple[End, ...]
    finer: Outcome
    compared: Outcome

    @property
    def best(self) -> End:
        """The best end."""
        return self.ends[0]

    @property
    def doubt(self) -> str:
        """Why the best end is no optimum; empty for an optimum."""
        verdict = self.compared.verdict or self.compared.ending
        rules = (
            (not self.best.feasible, "no start met all limits"),
            (not self.best.settled, "the number of solves ran out"),
            (not self.finer.completed, f"twice the links end with {self.finer.ending}"),
            (verdict != "AGREE", f"both solvers: {verdict} {self.compared.reason}".rstrip()),
        )
        return first_met(rules, "")


def optimum(problem: Problem, runner: Runner, starts: int, most: int) -> Optimum:
    """Ends of all starts, the best first (feasible before infeasible ends, then by the goal), and its check.

    Args:
        problem: scene, ranges, goal and limits.
        runner: solver of points, with a folder for the journal.
        starts: number of starts.
        most: largest number of solves per start.

    Raises:
        OSError: the journal cannot be written.
    """
    assert runner.out is not None
    runner.known.update(known_outcomes([runner.out]))
    first = problem.number(problem.outcome(runner, problem.point(problem.starts(1)[0])))
    scale = (abs(problem.cost(first)) if isfinite(first) else 1.0) or 1.0
    with ThreadPoolExecutor(starts) as pool:
        found = list(pool.map(partial(_end, problem, runner, scale, most), problem.starts(starts)))
    found.sort(key=lambda each: (not each.feasible, problem.cost(each.number) if each.feasible else 0.0))
    best = found[0].point
    doubled = replace(runner, choices=runner.choices.finer())
    return Optimum(
        problem,
        ends=tuple(found),
        finer=problem.outcome(doubled, best),
        compared=problem.outcome(runner, best, "compare"),
    )


def _end(problem: Problem, runner: Runner, scale: float, most: int, begun: Array) -> End:
    """End of the start at the shares ``begun`` (d,)."""
    seen: dict[bytes, Array] = {}

    def values(u: Array) -> Array:
        """f and g at u."""
        if u.tobytes() not in seen:
            outcome = problem.outcome(runner, problem.point(u))
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
    point = problem.point(found.x)
    outcome = problem.outcome(runner, point)
    return End(
        begun=problem.point(begun),
        point=point,
        outcome=outcome,
        number=problem.number(outcome),
        feasible=outcome.completed and all(bound.excess(outcome) <= FEASIBLE for bound in problem.bounds),
        solves=len(seen),
        settled=bool(found.status == 0),
    )


def optimum_section(found: Optimum) -> Section:
    """The result as sentences, tables and JSON."""
    return Section(
        f"{'Optimum' if not found.doubt else 'Best point'} of {found.problem.scene.name}",
        tuple(_sentences(found)),
        tables=(_starts_table(found), _check_table(found)),
        name="optimum",
        data=_data(found),
        complete=not found.doubt,
    )


def _sentences(found: Optimum) -> Iterator[str]:
    problem, best = found.problem, found.best
    name = "an optimum" if not found.doubt else "the best point, no optimum"
    aim = problem.goal.aim if problem.goal.value is None else f"reach {problem.measure.text(problem.goal.value)}"
    value = f"{aim} {problem.measure}: {problem.measure.text(best.number)}"
    yield f"{problem.scene.name}: {name} at {place_text(problem.axes, best.point)}. {value[0].upper()}{value[1:]}."
    if found.doubt:
        yield f"The point is no optimum: {found.doubt}. {found.compared.sentence}".rstrip()
    same = sum(
        each.feasible
        and all(abs(each.point[a.name] - best.point[a.name]) <= _SAME * abs(a.high - a.low) for a in problem.axes)
        for each in found.ends
    )
    ends = [axis.name for axis in problem.axes if min(abs(best.point[axis.name] - end) for end in (axis.low, axis.high))
            <= _SAME * abs(axis.high - axis.low)]  # fmt: skip
    yield f"{same} of {len(found.ends)} starts end there." + (
        f" {', '.join(ends)} lies at an end of its range." if ends else ""
    )


def _starts_table(found: Optimum) -> Table:
    problem, place = found.problem, partial(place_text, found.problem.axes)
    return table_of(
        "Starts",
        columns=[
            Column[End]("start", "begun", place),
            Column("end", "point", place),
            Column(f"{problem.measure}, {with_symbols(problem.measure.unit)}", "number", partial(number, digits=6)),
            Column("limits", lambda each: "met" if each.feasible else "not met"),
            Column("solves", "solves"),
            Column("ending", "outcome.ending"),
        ],
        items=found.ends,
    )


def _check_table(found: Optimum) -> Table:
    """Goal and limits at N and 2N links, and by the finite elements."""
    return Table(
        "Best point, checked",
        headers=("number", "unit", "CPRBM", "at 2N", "FEA"),
        rows=tuple(
            (name, with_symbols(measure.unit), *(number(value, 6) for value in _checked(found, measure)))
            for name, measure in _numbers(found.problem).items()
        ),
    )


def _numbers(problem: Problem) -> dict[str, Measure]:
    """Numbers of the goal and of the limits by their texts."""
    return {str(problem.measure): problem.measure} | {str(bound): bound.measure for bound in problem.bounds}


def _checked(found: Optimum, measure: Measure) -> tuple[float, float, float]:
    """Largest value of a number at N, at 2N and by the finite elements; NaN without a value."""
    fea = [{**each, "value": each["fea"]} for each in found.compared.numbers if each.get("fea") is not None]
    outcomes = found.best.outcome, found.finer, Outcome("fea", "COMPLETED", "", numbers=tuple(fea))
    first, second, third = (max(measure.values(each), key=abs, default=nan) for each in outcomes)
    return first, second, third


def _data(found: Optimum) -> Plain:
    """Documented JSON; parameters in SI, numbers in the units of the scene's file."""
    problem = found.problem
    goal = {"number": str(problem.measure), "unit": problem.measure.unit, "value": found.best.number}
    starts = [
        {"start": each.begun, "end": each.point, "value": each.number, "met": each.feasible, "solves": each.solves}
        for each in found.ends
    ]
    return dict(plain({
        "scene": problem.scene.name,
        "optimum": not found.doubt,
        "doubt": found.doubt,
        "verdict": found.compared.verdict,
        "parameters": found.best.point,
        "goal": goal,
        "starts": starts,
        "checked": {name: _checked(found, each) for name, each in _numbers(problem).items()},
    }))  # fmt: skip
