"""Result of the paper's Table 1 beside ours: a table, sentences, a figure, and the documented JSON."""

from __future__ import annotations

import numpy as np

from comparisons.formats import number
from comparisons.plain import Plain, plain
from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Figure, Section, Table
from comparisons.studies.table1 import THEIR_MACHINE, Cell, Times, TimeTable


def result_of(table: TimeTable) -> Section:
    """Result of the measurements so far."""
    measured = any(times.seconds for times in table.times.values())
    figures = (run_times(table),) if measured else ()
    return Section(
        "Run times, beside Table 1 of the paper", _words(table), figures, (_table(table),), "table1", _data(table)
    )


def _table(table: TimeTable) -> Table:
    body = tuple(
        (
            cell.case,
            cell.label,
            cell.sized,
            number(times.median),
            number(times.spread, 2),
            str(len(times.seconds)),
            number(cell.theirs),
            _ratio(cell, times),
            _ended(times),
        )
        for cell, times in table.times.items()
    )
    machine = table.machine
    return Table(
        "Seconds to the last load, in one load",
        ("case", "method", "elements or links", "ours", "spread", "repeats", "theirs", "theirs / ours", "ended"),
        body,
        "Ours: median of whole answers, set-up included, and the distance of the quartiles; finite elements in shear. "
        f"Ours on {machine['cpu']}, BLAS on one thread, Python {machine['python']}, NumPy {machine['numpy']}, SciPy "
        f"{machine['scipy']}, scikit-fem {machine['scikit-fem']}; theirs on {THEIR_MACHINE}.",
    )


def _ratio(cell: Cell, times: Times) -> str:
    return number(cell.theirs / times.median) if cell.theirs is not None and times.median else "–"


def _ended(times: Times) -> str:
    if times.ending is None:
        return "refused" if times.why else "not begun"
    return times.ending.name


def _words(table: TimeTable) -> tuple[str, ...]:
    return (
        "Times of different programs on different machines: the paper's CPRBM is interpreted code round a general "
        "optimiser, its finite elements are a commercial program with all that it does besides. What can be compared "
        "is how the times of one program go with the discretisation and with contact.",
        "The table gives the gripper's links as 40 and 30 where section 3.3 has 30 and 40; both are run.",
        *(
            f"{cell.case}, {cell.label}, {cell.sized}: {'not whole' if times.seconds else 'refused'}. {times.why}."
            for cell, times in table.times.items()
            if times.why
        ),
    )


def _data(table: TimeTable) -> Plain:
    return {
        "study": "table1",
        "machine": dict(table.machine),
        "paper_machine": THEIR_MACHINE,
        "rows": [
            {
                "case": cell.case,
                "method": cell.method,
                "formulation": cell.formulation,
                "contact": cell.contact,
                "size": plain(cell.size),
                "seconds": times.median,
                "spread": times.spread,
                "repeats": len(times.seconds),
                "ended": None if times.ending is None else times.ending.name,
                "why": times.why or None,
                "paper_seconds": cell.theirs,
            }
            for cell, times in table.times.items()
        ],
    }


def run_times(table: TimeTable) -> Figure:
    """Our median times with their quartiles and the paper's, a line for each cell."""
    cells = list(table.times)
    with canvas(7.2, 1.2 + 0.26 * len(cells)) as figure:
        axes = figure.add_subplot()
        for place, cell in enumerate(cells):
            times = table.times[cell]
            if times.seconds:
                low, middle, high = np.percentile(times.seconds, (25.0, 50.0, 75.0))
                bars = [[middle - low], [high - middle]]
                axes.errorbar(middle, place, xerr=bars, fmt="o", color=BLUE, markersize=5, capsize=3)
            if cell.theirs is not None:
                axes.plot(cell.theirs, place, "x", color=RED, markersize=6)
        axes.plot([], [], "o", color=BLUE, label="ours")
        axes.plot([], [], "x", color=RED, label="the paper's")
        axes.set_yticks(range(len(cells)), [f"{cell.case}, {cell.label}, {cell.sized}" for cell in cells])
        axes.invert_yaxis()
        axes.set_xscale("log")
        axes.grid(visible=True, which="major", axis="x", color="#e4e4e4", linewidth=0.6)
        axes.set_xlabel("seconds")
        figure.legend(loc="outside upper right", ncols=2)
        return finished(
            figure,
            "table1",
            "Seconds to the last load: ours as medians with the quartiles, and the paper's, on another machine.",
        )
