"""Result of a search for N: the last N, the deciding row, and the reason for the end of the search."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from comparisons.formats import at_station, percent
from cprbm_scene import Scene

SolverName = Literal["cprbm", "fea", "solid"]


@dataclass(frozen=True, slots=True)
class WorstRow:
    """A row, by probe, stage and station, with its uncertainty as a fraction.

    The fraction is infinite where the value exists at one N and not at another.
    """

    probe: str
    stage: str
    station: float
    fraction: float


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Result of a search for N.

    Attributes:
        asked: the tolerance, a fraction.
        solver: the solver.
        n: the last N.
        worst: the row with the largest fraction; None without a row that states any.
        trouble: why nothing is stated; else empty.
        probes: names of the probes with limits as values.
        solved: every solved N, ascending.
        ended: why no larger N followed; empty where the tolerance is met.
    """

    asked: float
    solver: SolverName
    n: int
    worst: WorstRow | None
    trouble: str
    probes: tuple[str, ...]
    solved: tuple[int, ...] = ()
    ended: str = ""

    @property
    def extrapolated(self) -> tuple[int, ...]:
        """The two finest N, where values are limits of both; otherwise empty."""
        return (self.n // 2, self.n) if self.probes else ()

    @property
    def fraction(self) -> float:
        """The largest fraction: infinite in trouble, 0 without a row."""
        return math.inf if self.trouble else 0.0 if self.worst is None else self.worst.fraction

    @property
    def met(self) -> bool:
        """Whether every row is within the tolerance."""
        return self.fraction <= self.asked

    def sentence(self, scene: Scene) -> str:
        """Result with the deciding row, with stations in the units of the scene's file."""
        what = f"{self.n} {'links' if self.solver == 'cprbm' else 'elements'} per beam"
        if self.probes:
            what = f"{len(self.probes)} probes extrapolated from N = {', '.join(map(str, self.extrapolated))}"
        found, row = self.trouble or "no row has a value", self.worst
        if row is not None:
            finite = math.isfinite(row.fraction)
            stated = f"states {percent(row.fraction)}" if finite else "has a value at one N and none at another"
            found = f"{row.probe} at {at_station(scene, row.stage, row.station)} {stated}"
        ended = f"; {self.ended}" if self.ended else ""
        met = "within" if self.met else "NOT within"
        return f"{self.solver.upper()}: {met} {percent(self.asked)}: {what}; at worst {found}{ended}."
