"""An offset question at a family of sizes: the error against the number of springs.

The exact curve is known: the limit of every error is zero, and the order of two sizes is the logarithm of their errors'
ratio over the logarithm of the ratio of sizes.
"""

from __future__ import annotations

from itertools import pairwise
from math import log

from comparisons.formats import percent
from comparisons.offset_verdict import OffsetRow, compared_offset
from comparisons.pairing import OffsetConstruction
from comparisons.plain import Plain, plain
from comparisons.present.canvas import LINES, canvas, finished, logarithmic
from comparisons.present.columns import Column, Figure, Section, Table, table_of
from comparisons.studies.convergence_tables import spread
from cprbm_scene import OffsetQuestion
from cprbm_scene.offset import FEWEST, MOST

Curves = dict[tuple[str, float], list[OffsetRow]]
"""Rows of all sizes, ascending, by spacing and offset."""


def convergence_section(question: OffsetQuestion, sizes: tuple[int, ...], construct: OffsetConstruction) -> Section:
    """Error against N for every spacing and offset, at the allowed sizes."""
    numbers = tuple(n for n in sizes if FEWEST <= n <= MOST)
    excluded = ", ".join(str(n) for n in sizes if n not in numbers)
    sentences = (f"An offset question takes {FEWEST} to {MOST} springs; left out: {excluded}.",) if excluded else ()
    curves: Curves = {}
    completed = True
    if len(numbers) > 1:
        compared = compared_offset(question.model_copy(update={"numbers": numbers}), construct)
        completed = compared.verdict.completed
        for row in compared.rows:
            curves.setdefault((row.spacing, row.offset), []).append(row)
    return Section(
        "Error against N",
        sentences,
        (_figure(question, numbers, curves),) if curves else (),
        (_table(question, numbers, curves),) if curves else (),
        "convergence",
        {"case": question.name, "families": [_entry(*key, rows) for key, rows in curves.items()], "runs": []},
        completed,
    )


def orders(rows: list[OffsetRow]) -> list[float | None]:
    """The order of every two consecutive sizes; None where an error vanishes or is not known."""
    return [
        log(one.difference / two.difference) / log(two.n / one.n)
        if one.difference > 0.0 and two.difference > 0.0
        else None
        for one, two in pairwise(rows)
    ]


def _entry(spacing: str, offset: float, rows: list[OffsetRow]) -> Plain:
    found, errors = orders(rows), [plain(row.difference) for row in rows]
    return {
        "solver": "cprbm",
        "settings": {"spacing": spacing},
        "probe": f"{spacing}.offset_points",
        "component": "largest",
        "stage": "offset",
        "station": offset,
        "unit": "1",
        "n": [row.n for row in rows],
        "values": errors,
        "errors": errors,
        "order": found[-1],
        "order_assumed": None,
        "order_of_probe": found[-1],
        "orders_of_probe": found,
        "limit": 0.0,
        "limit_uncertainty": 0.0,
        "used": [row.n for row in rows],
        "why": None,
        "exact": 0.0,
        "scale": 1.0,
    }


def _largest(curves: Curves, spacing: str, n: int) -> float:
    """The largest error of all offsets."""
    return max(row.difference for (name, _), rows in curves.items() for row in rows if (name, row.n) == (spacing, n))


def _table(question: OffsetQuestion, numbers: tuple[int, ...], curves: Curves) -> Table:
    def at(n: int) -> Column[str]:
        return Column(f"N = {n}", lambda spacing: percent(_largest(curves, spacing, n)))

    def order(spacing: str) -> str:
        return spread(each for (name, _), rows in curves.items() if name == spacing for each in orders(rows))

    return table_of(
        f"{question.title or question.name}: largest error of all offsets",
        [Column[str]("spacing", str), *map(at, numbers), Column("order", order)],
        question.spacings,
        f"Error along {question.axis}, relative to the {question.relative_to} of the exact offset curve; orders of "
        "every two sizes and offset: median, least and largest.",
    )


def _figure(question: OffsetQuestion, numbers: tuple[int, ...], curves: Curves) -> Figure:
    with canvas(6.4, 4.2) as drawing:
        axes = drawing.add_subplot()
        for place, spacing in enumerate(question.spacings):
            line, marker = LINES[place % len(LINES)]
            worst = [_largest(curves, spacing, n) for n in numbers]
            axes.plot(numbers, worst, line, marker=marker, color=f"C{place % 10}", markersize=4.5, label=spacing)
        logarithmic(axes, numbers)
        axes.set_xlabel("springs N")
        axes.set_ylabel(f"largest error / {question.relative_to}")
        axes.legend(loc="best")
        return finished(drawing, "convergence", "Largest error of all offsets against the number of springs.")
