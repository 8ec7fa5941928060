"""Run times at the discretisations of the paper's Table 1, in a single load step to the paper's last load.

Every number of the table is a cell: a case, a method and a discretisation.  A cell is a method of its own in a
benchmark session (:mod:`comparisons.bench.running`): the session goes through all cells, and then again, so that other
work on the machine falls on all cells alike.  Only the first cell of a method is warmed up.
"""

import math
from collections.abc import Mapping
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from comparisons import cases
from comparisons.bench.measures import at_last_loads
from comparisons.bench.running import Contender, Run, Session, Timing, outcome_of
from comparisons.choices import Choices, Count
from comparisons.formats import number
from comparisons.pairing import Solvers
from comparisons.present.canvas import BLUE, RED, RULE, canvas, finished, name_rows
from comparisons.present.columns import Column, Figure, Section, plain, records_of, table_of
from cprbm_scene import Scene, frozendict

THEIR_MACHINE = "Intel Core i5-8500, MATLAB R2018b for the CPRBM, ANSYS 19.1 for the finite elements"


class Cell(NamedTuple):
    """A number of the table: case, method, discretisation, and the paper's seconds; None without a number."""

    case: str
    method: Literal["cprbm", "fea"]
    size: Count
    theirs: float | None
    contact: bool = True
    formulation: Literal["auto", "paper"] = "auto"

    @property
    def label(self) -> str:
        """Method, and whether with contact."""
        if self.method == "cprbm":
            return f"CPRBM {self.formulation}"
        return "FEA, contact" if self.contact else "FEA without contact"

    @property
    def size_text(self) -> str:
        """The discretisation, as the paper writes it."""
        return f"({', '.join(map(str, self.size.values()))})" if isinstance(self.size, Mapping) else str(self.size)

    @property
    def name(self) -> str:
        """Case, method and discretisation."""
        return f"{self.case}, {self.label}, {self.size_text}"


def _cprbm(case: str, first: int, second: int, theirs: float | None) -> tuple[Cell, ...]:
    size = frozendict({"beam1": first, "beam2": second})
    return Cell(case, "cprbm", size, theirs), Cell(case, "cprbm", size, theirs, formulation="paper")


CELLS = (
    Cell("hinge", "fea", 80, 4.0),
    Cell("hinge", "fea", 160, 5.0),
    Cell("hinge", "fea", 80, 4.0, contact=False),
    *_cprbm("hinge", 40, 40, 5.0),
    *_cprbm("hinge", 60, 60, 11.75),
    Cell("gripper", "fea", 80, 23.0),
    Cell("gripper", "fea", 160, 40.0),
    Cell("gripper", "fea", 80, 4.0, contact=False),
    *_cprbm("gripper", 40, 30, 4.32),
    # section 3.3 has these two the other way round; the table has no time for them
    *_cprbm("gripper", 30, 40, None),
    *_cprbm("gripper", 60, 50, 19.56),
)


def question(cell: Cell) -> Scene:
    """A cell's scene: the last station of every stage, and no contact where the cell has none."""
    scene = at_last_loads(cases.opened(cell.case)).model_copy(update={"claims": ()})
    if cell.contact:
        return scene
    probes = tuple(probe for probe in scene.probes if probe.of not in scene.contacts)
    return scene.model_copy(update={"contacts": frozendict(), "probes": probes})


def session(
    solvers: Solvers, machine: Mapping[str, str | int], repeat: int, at_most: float, cells: tuple[Cell, ...] = CELLS
) -> Session:
    """A benchmark session with all cells, each ``repeat`` times; no cell is repeated after ``at_most`` seconds."""
    first = {cell.method: cell.name for cell in reversed(cells)}
    return Session(
        question(cells[0]),
        machine,
        {_contender(cell, solvers): (cell.size,) for cell in cells},
        kinematics="shear",
        repeat=repeat,
        at_most=at_most,
        largest={cell.name: math.inf for cell in cells if cell.name not in first.values()},
    )


def _contender(cell: Cell, solvers: Solvers) -> Contender:
    """A cell as a method on the scene of the cell."""
    solver, asked = (solvers.cprbm if cell.method == "cprbm" else solvers.fea), question(cell)
    choices = Choices(links=cell.size, elements=cell.size, formulation=cell.formulation)
    run = Run(lambda: partial(solver, asked, choices), outcome_of)
    return Contender(cell.name, cell.method, cell.formulation, cell.label, lambda scene, count, at_most: run)


Line = tuple[Cell, Timing]
"""A cell, and its runs so far."""

_COLUMNS: tuple[Column[Line], ...] = (
    Column("case", lambda line: line[0].case),
    Column("method", lambda line: line[0].label),
    Column("elements or links", lambda line: line[0].size_text),
    Column("ours", lambda line: _seconds(line[1]), number),
    Column("spread", lambda line: line[1].spread("both") if line[1].seconds else None, lambda value: number(value, 2)),
    Column("repeats", lambda line: len(line[1].seconds)),
    Column("theirs", lambda line: line[0].theirs, number),
    Column(
        "theirs / ours", lambda line: (own := _seconds(line[1])) and line[0].theirs and line[0].theirs / own, number
    ),
    Column("ended", lambda line: line[1].outcome.ended or ("refused" if line[1].refusal else "not begun")),
)

_KEYS: tuple[Column[Line], ...] = (
    Column("case", lambda line: line[0].case),
    Column("method", lambda line: line[0].method),
    Column("formulation", lambda line: None if line[0].method == "fea" else line[0].formulation),
    Column("contact", lambda line: line[0].contact),
    Column("size", lambda line: plain(line[0].size)),
    Column("seconds", lambda line: _seconds(line[1])),
    Column("spread", lambda line: line[1].spread("both") if line[1].seconds else None),
    Column("repeats", lambda line: len(line[1].seconds)),
    Column("ended", lambda line: line[1].outcome.ended if line[1].seconds else None),
    Column("why", lambda line: line[1].why or None),
    Column("paper_seconds", lambda line: line[0].theirs),
)


def _seconds(timing: Timing) -> float | None:
    """Median, s; None without a run."""
    return timing.median("both") if timing.seconds else None


def result_of(measured: Session, cells: tuple[Cell, ...] = CELLS) -> Section:
    """Result of the measurements so far, without :func:`pictures`."""
    times = dict(zip(cells, measured.timings, strict=True))
    taken = {cell: timing for cell, timing in times.items() if timing.seconds}
    machine = measured.machine
    table = table_of(
        "Seconds to the last load, in one load",
        _COLUMNS,
        times.items(),
        "Ours: median of whole answers, set-up included, and the distance of the quartiles; finite elements in shear. "
        f"Ours on {machine['cpu']}, BLAS on one thread, Python {machine['python']}, NumPy {machine['numpy']}, SciPy "
        f"{machine['scipy']}, scikit-fem {machine['scikit-fem']}; theirs on {THEIR_MACHINE}.",
    )
    return Section(
        "Run times, beside Table 1 of the paper",
        sentences=(
            "Times of different programs on different machines: the paper's CPRBM is interpreted code round a general "
            "optimiser, its finite elements are a commercial program with all that it does besides. What can be "
            "compared is how the times of one program go with the discretisation and with contact.",
            "The table gives the gripper's links as 40 and 30 where section 3.3 has 30 and 40; both are run.",
            *(
                f"{cell.name}: {'not whole' if cell in taken else 'refused'}. {timing.why}."
                for cell, timing in times.items()
                if timing.why
            ),
        ),
        tables=(table,),
        name="table1",
        data={
            "study": "table1",
            "machine": dict(machine),
            "paper_machine": THEIR_MACHINE,
            "rows": records_of(_KEYS, times.items()),
        },
        complete=all(timing.outcome.completed for timing in taken.values()),
    )


def pictures(measured: Session, cells: tuple[Cell, ...] = CELLS) -> tuple[Figure, ...]:
    """Our median times with their quartiles and the paper's, a line for each cell; no figure without a run."""
    taken = {place: timing.quartiles("both") for place, timing in enumerate(measured.timings) if timing.seconds}
    if not taken:
        return ()
    low, middle, high = np.array([*taken.values()]).T
    theirs = {place: cell.theirs for place, cell in enumerate(cells) if cell.theirs is not None}
    with canvas(7.2, 1.2 + 0.26 * len(cells)) as (drawing, (axes,)):
        spread = [middle - low, high - middle]
        axes.errorbar(middle, [*taken], xerr=spread, fmt="o", color=BLUE, markersize=5, capsize=3, label="ours")
        axes.plot([*theirs.values()], [*theirs], "x", color=RED, markersize=6, label="the paper's")
        axes.grid(visible=True, which="major", axis="x", color=RULE, linewidth=0.6)
        name_rows(axes, [cell.name for cell in cells])
        axes.set(xscale="log", xlabel="seconds")
        return (
            finished(
                drawing,
                "table1",
                caption="Seconds to the last load: ours as medians with the quartiles, and the paper's, on another "
                "machine.",
                legend=("upper right", 2),
            ),
        )
