"""An offset question at a family of sizes: the error against the number of springs.

The exact curve is known: the limit of every error is zero, and the order of two sizes is the logarithm of their errors'
ratio over the logarithm of the ratio of sizes.
"""

from __future__ import annotations

from itertools import pairwise
from math import log, nan

import numpy as np

from comparisons.formats import percent
from comparisons.offset_verdict import OffsetRow, compared_offset
from comparisons.pairing import OffsetConstruction
from comparisons.present.canvas import LINES, canvas, finished, logarithmic
from comparisons.present.columns import Column, Figure, Section, Table, table_of
from comparisons.studies.convergence_tables import entries, spread
from comparisons.studies.families import Family
from comparisons.verdict.uncertainty import Limit
from cprbm_scene import OffsetQuestion
from cprbm_scene.offset import FEWEST, MOST


def convergence_section(question: OffsetQuestion, sizes: tuple[int, ...], construct: OffsetConstruction) -> Section:
    """Error against N for every spacing and offset, at the allowed sizes."""
    numbers = tuple(n for n in sizes if FEWEST <= n <= MOST)
    excluded = ", ".join(str(n) for n in sizes if n not in numbers)
    families, completed = list[Family](), True
    if len(numbers) > 1:
        compared = compared_offset(question.model_copy(update={"numbers": numbers}), construct)
        completed = compared.verdict.completed
        curves: dict[tuple[str, float], list[OffsetRow]] = {}
        for row in compared.rows:
            curves.setdefault((row.spacing, row.offset), []).append(row)
        families = [_family(*key, rows) for key, rows in curves.items()]
    return Section(
        "Error against N",
        (f"An offset question takes {FEWEST} to {MOST} springs; left out: {excluded}.",) if excluded else (),
        (_figure(question, numbers, families),) if families else (),
        (_table(question, numbers, families),) if families else (),
        "convergence",
        {
            "case": question.name,
            "families": [entry for family in families for entry in entries(numbers, family)],
            "runs": [],
        },
        completed,
    )


def _family(spacing: str, offset: float, rows: list[OffsetRow]) -> Family:
    """Errors of a spacing at an offset; an error that vanishes or is not finite has no order."""
    orders = [
        log(one.difference / two.difference) / log(two.n / one.n)
        if one.difference > 0.0 and two.difference > 0.0
        else None
        for one, two in pairwise(rows)
    ]
    zero = np.zeros(1)
    return Family(
        solver="cprbm",
        settings={"spacing": spacing},
        probe=f"{spacing}.offset_points",
        stage="offset",
        station=offset,
        unit="1",
        scale=1.0,
        components=("largest",),
        values={row.n: np.array([row.difference]) for row in rows},
        floor=0.0,
        used=tuple(row.n for row in rows),
        orders=tuple(orders),
        found=Limit(zero, zero, nan, orders[-1], ""),
        why="",
        exact=zero,
    )


def _largest(families: list[Family], spacing: str, n: int) -> float:
    """The largest error of all offsets."""
    return max(float(each.values[n][0]) for each in families if each.settings["spacing"] == spacing)


def _table(question: OffsetQuestion, numbers: tuple[int, ...], families: list[Family]) -> Table:
    def error(n: int) -> Column[str]:
        return Column(f"N = {n}", lambda spacing: percent(_largest(families, spacing, n)))

    def order(spacing: str) -> str:
        return spread(each for family in families if family.settings["spacing"] == spacing for each in family.orders)

    return table_of(
        f"{question.title or question.name}: largest error of all offsets",
        [Column[str]("spacing", str), *map(error, numbers), Column("order", order)],
        question.spacings,
        f"Error along {question.axis}, relative to the {question.relative_to} of the exact offset curve; orders of "
        "every two sizes and offset: median, least and largest.",
    )


def _figure(question: OffsetQuestion, numbers: tuple[int, ...], families: list[Family]) -> Figure:
    with canvas(6.4, 4.2) as drawing:
        axes = drawing.add_subplot()
        for place, spacing in enumerate(question.spacings):
            line, marker = LINES[place % len(LINES)]
            worst = [_largest(families, spacing, n) for n in numbers]
            axes.plot(numbers, worst, line, marker=marker, color=f"C{place % 10}", markersize=4.5, label=spacing)
        logarithmic(axes, numbers)
        axes.set(xlabel="springs N", ylabel=f"largest error / {question.relative_to}")
        axes.legend(loc="best")
        return finished(drawing, "convergence", "Largest error of all offsets against the number of springs.")
