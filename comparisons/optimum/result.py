"""The result of a search: the best point, its check at twice the size and by both solvers, and its name."""

from __future__ import annotations

from collections.abc import Iterator
from math import nan

from comparisons.formats import number
from comparisons.optimum.search import Optimum, Problem
from comparisons.plain import Plain, plain
from comparisons.present.columns import Section, Table
from comparisons.sweeps.demands import Measure
from comparisons.sweeps.outcome import Outcome
from comparisons.sweeps.points import Point, place_text

_SAME = 1e-3
"""Distance over the range of two ends of starts that count as a point."""


def result_of(found: Optimum) -> Section:
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
    same = sum(each.feasible and _near(problem, each.point, best.point) for each in found.ends)
    ends = [axis.name for axis in problem.axes if min(abs(best.point[axis.name] - end) for end in (axis.low, axis.high))
            <= _SAME * abs(axis.high - axis.low)]  # fmt: skip
    yield f"{same} of {len(found.ends)} starts end there." + (
        f" {', '.join(ends)} lies at an end of its range." if ends else ""
    )


def _near(problem: Problem, one: Point, other: Point) -> bool:
    return all(abs(one[a.name] - other[a.name]) <= _SAME * abs(a.high - a.low) for a in problem.axes)


def _starts_table(found: Optimum) -> Table:
    problem = found.problem
    rows = tuple(
        (
            place_text(problem.axes, each.begun),
            place_text(problem.axes, each.point),
            number(each.number, 6),
            "met" if each.feasible else "not met",
            str(each.solves),
            each.outcome.ending,
        )
        for each in found.ends
    )
    headers = ("start", "end", f"{problem.measure}, {problem.measure.unit}", "limits", "solves", "ending")
    return Table("Starts", headers, rows)


def _check_table(found: Optimum) -> Table:
    """Goal and limits at N and 2N links, and by the finite elements."""
    rows = tuple(
        (name, measure.unit, *(number(value, 6) for value in _checked(found, measure)))
        for name, measure in _numbers(found.problem).items()
    )
    return Table("Best point, checked", ("number", "unit", "CPRBM", "at 2N", "FEA"), rows)


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
    data: Plain = plain({
        "scene": problem.scene.name,
        "optimum": not found.doubt,
        "doubt": found.doubt,
        "verdict": found.compared.verdict,
        "parameters": found.best.point,
        "goal": goal,
        "starts": starts,
        "checked": {name: _checked(found, each) for name, each in _numbers(problem).items()},
    })  # fmt: skip
    return data
