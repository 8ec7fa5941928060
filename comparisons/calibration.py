"""Is what the solvers state of their errors true?  Rows with an exact value, and what they say together.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
e       true error, |v − x|, of the CPRBM or of the finite elements in ``bending``
u       what that solver states of it, with its round-off and with q
q       what the exact value may itself be off by (:mod:`comparisons.measures`)
F       2: beyond F u a row differs (:mod:`comparisons.verdict`)
======  ==================================================================================

The house's rule: e ≤ u in at least 95 % of the rows, so that a statement can be relied on, and the median of u/e is at
most 10, so that it is no excuse.  A row with e ≤ q has no error worth the name and says nothing of either.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

from comparisons.measures import Row

Judged = Literal["cprbm", "fea"]
JUDGED: tuple[Judged, ...] = ("cprbm", "fea")

SHARE_WITHIN = 0.95
MOST_OVER = 10.0
FAR = 2.0
"""A true error of more than so many times the stated one is no chance of where a mesh stands."""


@dataclass(frozen=True, slots=True)
class Held:
    """A row's true error held against the stated one: e and u in the probe's unit, both positive."""

    solver: Judged
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
        return self.ratio / FAR

    @property
    def word(self) -> str:
        """Where the true error lies."""
        if self.ratio <= 1.0:
            return "within"
        return "beyond" if self.pressure <= 1.0 else "far beyond"


@dataclass(frozen=True, slots=True)
class Tally:
    """What some rows say of one solver's statements.

    Attributes:
        rows: how many there are with an error worth the name.
        within: in how many of them e ≤ u.
        over: median of u/e; None without rows.
        worst: the rows with the largest e/u, largest first.
    """

    solver: Judged
    rows: int
    within: int
    over: float | None
    worst: tuple[Held, ...]

    @property
    def share(self) -> float | None:
        """within/rows; None without rows."""
        return self.within / self.rows if self.rows else None

    @property
    def holds(self) -> bool:
        """Whether the house's rule is kept; without rows there is nothing to break it."""
        return self.share is None or self.over is None or (self.share >= SHARE_WITHIN and self.over <= MOST_OVER)


def every(row: Row) -> Iterator[Held]:
    """A row's true errors with what is stated of each; none where there is no exact value."""
    if row.true_errors is None or row.bounds is None:
        return
    bounds, true = row.bounds, row.true_errors
    beside = bounds.round_off + true.allowance
    yield Held("cprbm", row, float(true.cprbm), float(bounds.cprbm + beside))
    yield Held("fea", row, float(true.bending), float(bounds.bending + beside))


def held(rows: Iterable[Row]) -> tuple[Held, ...]:
    """The true errors worth the name; a closing load, which all stations after it repeat, once in a stage."""
    found: list[Held] = []
    told: set[tuple[str, str]] = set()
    for row in rows:
        once = (row.probe.name, row.stage)
        if row.true_errors is None or once in told:
            continue
        if row.probe.quantity == "closing_load":
            told.add(once)
        found.extend(each for each in every(row) if each.true > row.true_errors.allowance)
    return tuple(found)


def tally(found: Sequence[Held], solver: Judged, *, worst: int = 3) -> Tally:
    """What the errors of one solver say together."""
    mine = sorted((each for each in found if each.solver == solver), key=lambda each: -each.ratio)
    return Tally(
        solver=solver,
        rows=len(mine),
        within=sum(each.ratio <= 1.0 for each in mine),
        over=median(each.stated / each.true for each in mine) if mine else None,
        worst=tuple(mine[:worst]),
    )
