"""Run times at the discretisations of the paper's Table 1, one solve to the paper's last load in one load.

A cell of the table is a case, a method and a discretisation.  All cells are solved in turn, and then again, so that
what else the machine does falls on all of them alike; BLAS has one thread.  Each method has solved once before anything
counts, so that no time holds an import.  A cell that a solver refuses has no time and says why; one that takes longer
than allowed is not repeated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from comparisons import cases
from comparisons.bench.timing import Method, timed
from comparisons.choices import Choices, Count
from comparisons.crew import Solver
from comparisons.pairing import Solvers
from comparisons.studies.last_loads import at_last_loads
from cprbm_scene import Answer, Ending, Scene, SceneError
from cprbm_scene.frozendict import frozendict
from cprbm_scene.threads import one_thread

THEIR_MACHINE = "Intel Core i5-8500, MATLAB R2018b for the CPRBM, ANSYS 19.1 for the finite elements"


@dataclass(frozen=True, slots=True)
class Cell:
    """One number of the table: what is solved, how finely, and the paper's seconds where it has them."""

    case: str
    method: Method
    size: Count
    theirs: float | None
    contact: bool = True
    formulation: Literal["auto", "paper"] | None = None

    @property
    def label(self) -> str:
        """What is solved, and by what."""
        if self.method == "fea":
            return "FEA, contact" if self.contact else "FEA without contact"
        return f"CPRBM {self.formulation}"

    @property
    def sized(self) -> str:
        """The discretisation, as the paper writes it."""
        return f"({', '.join(map(str, self.size.values()))})" if isinstance(self.size, Mapping) else str(self.size)


def _cprbm(case: str, first: int, second: int, theirs: float | None) -> tuple[Cell, ...]:
    size = frozendict({"beam1": first, "beam2": second})
    return tuple(Cell(case, "cprbm", size, theirs, formulation=name) for name in _FORMULATIONS)


_FORMULATIONS: tuple[Literal["auto", "paper"], ...] = ("auto", "paper")

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


@dataclass(frozen=True, slots=True)
class Times:
    """A cell's solves so far.

    Attributes:
        seconds: of each.
        ending: of the last; None before there is one, and where the solver refuses.
        why: why there is no time, or no whole answer; empty if there is.
    """

    seconds: tuple[float, ...] = ()
    ending: Ending | None = None
    why: str = ""

    @property
    def median(self) -> float | None:
        """Median, s."""
        return float(np.median(self.seconds)) if self.seconds else None

    @property
    def spread(self) -> float | None:
        """Distance of the quartiles, s."""
        return float(np.subtract(*np.percentile(self.seconds, (75.0, 25.0)))) if self.seconds else None


@dataclass(frozen=True, slots=True)
class TimeTable:
    """All times so far, by cell, and the machine they were measured on."""

    machine: Mapping[str, str | int]
    times: Mapping[Cell, Times]

    @property
    def unfinished(self) -> bool:
        """Whether a solve gave no whole answer."""
        return any(times.ending not in (None, Ending.COMPLETED) for times in self.times.values())


def begun(solvers: Solvers, machine: Mapping[str, str | int], cells: tuple[Cell, ...] = CELLS) -> TimeTable:
    """A table without times; each of the solvers has been loaded and has solved once."""
    for method in dict.fromkeys(cell.method for cell in cells):
        _solve(next(cell for cell in cells if cell.method == method), solvers)
    return TimeTable(machine, frozendict({cell: Times() for cell in cells}))


def runs(repeat: int, cells: tuple[Cell, ...] = CELLS) -> tuple[Cell, ...]:
    """The cells in the order in which they are solved: all of them, ``repeat`` times."""
    return repeat * cells


def solved(table: TimeTable, cell: Cell, solvers: Solvers, at_most: float) -> TimeTable:
    """The table after one more solve of a cell; the same where the cell is refused or takes longer than ``at_most``."""
    before = table.times[cell]
    if (before.why and not before.seconds) or max(before.seconds, default=0.0) > at_most:
        return table
    outcome = _solve(cell, solvers)
    if isinstance(outcome, str):
        after = Times(why=outcome)
    else:
        seconds, answer = outcome
        after = Times((*before.seconds, seconds), answer.ending, "" if answer.completed else answer.sentence)
    return replace(table, times=frozendict({**table.times, cell: after}))


def question(cell: Cell) -> Scene:
    """A cell's scene: every stage's last station alone, and without contact where the cell has none."""
    scene = at_last_loads(cases.opened(cell.case)).model_copy(update={"claims": ()})
    if cell.contact:
        return scene
    probes = tuple(probe for probe in scene.probes if probe.of not in scene.contacts)
    return scene.model_copy(update={"contacts": frozendict(), "probes": probes})


def _solve(cell: Cell, solvers: Solvers) -> tuple[float, Answer] | str:
    """Seconds and answer of one solve, or why it is refused."""
    solver: Solver = solvers.cprbm if cell.method == "cprbm" else solvers.fea
    choices = Choices(elements=cell.size) if cell.method == "fea" else Choices(links=cell.size)
    if cell.formulation is not None:
        choices = replace(choices, formulation=cell.formulation)
    try:
        with one_thread():
            return timed(solver, question(cell), choices)
    except SceneError as error:
        return "; ".join(f"{each.key}: found {each.found}; allowed: {each.allowed}" for each in error.mistakes)
