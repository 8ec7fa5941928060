"""An offset question at a family of sizes: how its error falls with the number of springs.

The exact curve is known, so nothing is extrapolated: the limit of every error is zero, and the order of two sizes is
the logarithm of their errors' ratio over that of the sizes.
"""

from __future__ import annotations

from itertools import pairwise
from math import log
from statistics import median

from comparisons.converging.report import ConvergenceResult
from comparisons.documents import Plain, plain
from comparisons.figures import LOOKS, Picture, canvas, picture
from comparisons.formats import number, percent
from comparisons.offset_verdict import OffsetRow, compared_offset
from comparisons.pairing import OffsetConstruction
from comparisons.sheet import Sheet
from cprbm_scene import OffsetQuestion
from cprbm_scene.offset import FEWEST, MOST

Curves = dict[tuple[str, float], list[OffsetRow]]
"""By spacing and offset the rows of all sizes, ascending."""


def result_of(question: OffsetQuestion, sizes: tuple[int, ...], construct: OffsetConstruction) -> ConvergenceResult:
    """Error against N for every spacing and offset, at the allowed sizes."""
    numbers = tuple(n for n in sizes if FEWEST <= n <= MOST)
    left_out = ", ".join(str(n) for n in sizes if n not in numbers)
    sentences = (f"An offset question takes {FEWEST} to {MOST} springs; left out: {left_out}.",) if left_out else ()
    if len(numbers) < 2:
        return ConvergenceResult(
            question, (), sentences, (), {"case": question.name, "families": [], "runs": []}, completed=True
        )
    compared = compared_offset(question.model_copy(update={"numbers": numbers}), construct)
    curves: Curves = {}
    for row in compared.rows:
        curves.setdefault((row.spacing, row.offset), []).append(row)
    return ConvergenceResult(
        question,
        (_sheet(question, numbers, curves),),
        sentences,
        (_drawn(question, numbers, curves),),
        {"case": question.name, "families": [_entry(*key, rows) for key, rows in curves.items()], "runs": []},
        completed=compared.verdict.completed,
    )


def orders(rows: list[OffsetRow]) -> list[float | None]:
    """The order of every two sizes that follow each other; None where an error vanishes or is not known."""
    return [
        log(one.difference / two.difference) / log(two.n / one.n)
        if one.difference > 0.0 and two.difference > 0.0
        else None
        for one, two in pairwise(rows)
    ]


def _entry(spacing: str, offset: float, rows: list[OffsetRow]) -> Plain:
    found = orders(rows)
    errors = [plain(row.difference) for row in rows]
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


def _sheet(question: OffsetQuestion, numbers: tuple[int, ...], curves: Curves) -> Sheet:
    body = []
    for spacing in question.spacings:
        mine = [rows for (name, _), rows in curves.items() if name == spacing]
        found = [order for rows in mine for order in orders(rows) if order is not None]
        spread = f"{number(median(found))} ({number(min(found), 2)} to {number(max(found), 2)})" if found else "–"
        body.append((spacing, *(percent(worst) for worst in _worst(mine)), spread))
    return Sheet(
        f"{question.title or question.name}: largest error of all offsets",
        ("spacing", *(f"N = {n}" for n in numbers), "order"),
        tuple(body),
        f"Error along {question.axis}, relative to the {question.relative_to} of the exact offset curve; orders of "
        "every two sizes and offset: median, and from the least to the largest.",
    )


def _worst(curves: list[list[OffsetRow]]) -> list[float]:
    return [max(row.difference for row in rows) for rows in zip(*curves, strict=True)]


def _drawn(question: OffsetQuestion, numbers: tuple[int, ...], curves: Curves) -> Picture:
    with canvas(6.4, 4.2) as figure:
        axes = figure.add_subplot()
        for place, spacing in enumerate(question.spacings):
            line, marker = LOOKS[place % len(LOOKS)]
            worst = _worst([rows for (name, _), rows in curves.items() if name == spacing])
            axes.plot(numbers, worst, line, marker=marker, color=f"C{place % 10}", markersize=4.5, label=spacing)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(numbers, [str(n) for n in numbers])
        axes.minorticks_off()
        axes.grid(visible=True, which="major", color="#e4e4e4", linewidth=0.6)
        axes.set_xlabel("springs N")
        axes.set_ylabel(f"largest error / {question.relative_to}")
        axes.legend(loc="best")
        return picture(figure, "convergence", "Largest error of all offsets against the number of springs.")
