"""Calibration: true errors beside the exact answer against stated uncertainties.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
e       true error |v − x| of the CPRBM or of the finite elements, both in ``bending``
u       stated uncertainty of the solver, with round-off and q
q       uncertainty of the exact value (:mod:`comparisons.verdict.rows`)
F       2, the factor beyond which a row differs
======  ==========================================================================================

e ≤ u shall hold in at least 95 % of the rows, and the median of u/e shall be at most 10.  A solver states one u per
probe, stage and branch.  This u covers the largest e of its rows, and u/e counts once, with the largest e.  A row with
e ≤ q tells nothing about u.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from comparisons.verdict.rows import Row
from comparisons.verdict.runs import Solver

SHARE_WITHIN = 0.95
LARGEST_MEDIAN = 10.0
EXACT_FACTOR = 2.0
"""A true error beyond this multiple of the stated uncertainty is no chance of where a mesh stands."""


@dataclass(frozen=True, slots=True)
class ErrorRatio:
    """True error e and stated uncertainty u of one row, in the probe's unit, both positive."""

    solver: Solver
    row: Row
    true: float
    stated: float

    @property
    def ratio(self) -> float:
        """e/u: above 1 the statement is not true."""
        return self.true / self.stated

    @property
    def pressure(self) -> float:
        """e/(F u): above 1 the row differs."""
        return self.ratio / EXACT_FACTOR

    @property
    def word(self) -> str:
        """Position of the true error: ``within``, ``beyond`` or ``far beyond`` the stated uncertainty."""
        if self.ratio <= 1.0:
            return "within"
        return "beyond" if self.pressure <= 1.0 else "far beyond"


@dataclass(frozen=True, slots=True)
class Tally:
    """Error ratios of one solver together.

    Attributes:
        rows: number of rows with an error above q; within: rows with e ≤ u.
        over: median of u/e over the statements; None without rows.
        worst: rows with the largest e/u, largest first.
    """

    solver: Solver
    rows: int
    within: int
    over: float | None
    worst: tuple[ErrorRatio, ...]

    @property
    def share(self) -> float | None:
        """within/rows; None without rows."""
        return self.within / self.rows if self.rows else None

    @property
    def holds(self) -> bool:
        """Whether both conditions hold; true without rows."""
        return self.share is None or self.over is None or (self.share >= SHARE_WITHIN and self.over <= LARGEST_MEDIAN)


def true_errors(row: Row) -> Iterator[ErrorRatio]:
    """Error ratios of a row by solver; none without an exact value."""
    if row.true_errors is None or row.bounds is None:
        return
    bounds, true = row.bounds, row.true_errors
    floor = bounds.round_off + true.allowance
    yield ErrorRatio("cprbm", row, true.cprbm, bounds.cprbm + floor)
    yield ErrorRatio("fea", row, true.fea, bounds.fea + floor)


def error_ratios(rows: Iterable[Row]) -> tuple[ErrorRatio, ...]:
    """Error ratios with a true error above q; of a closing load, repeated at later stations, one ratio per stage."""
    found: list[ErrorRatio] = []
    closings: set[tuple[str, str]] = set()
    for row in rows:
        key = row.probe.name, row.stage
        if row.true_errors is None or key in closings:
            continue
        if row.probe.quantity == "closing_load":
            closings.add(key)
        found.extend(each for each in true_errors(row) if each.true > row.true_errors.allowance)
    return tuple(found)


def tally(ratios: Sequence[ErrorRatio], solver: Solver, *, worst: int = 3) -> Tally:
    """The error ratios of one solver together."""
    mine = sorted((each for each in ratios if each.solver == solver), key=lambda each: -each.ratio)
    statements: dict[tuple[str, str, int | None], float] = {}
    for each in mine:  # the largest e/u of a statement comes first
        statements.setdefault((each.row.probe.name, each.row.stage, each.row.branch), 1.0 / each.ratio)
    return Tally(
        solver=solver,
        rows=len(mine),
        within=sum(each.ratio <= 1.0 for each in mine),
        over=median(statements.values()) if statements else None,
        worst=tuple(mine[:worst]),
    )
