"""Result of a search for N: the deciding row, and the reason for the end of the search.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
N       links or elements per beam, of the solid elements along each beam
τ       tolerance, a fraction
f       stated uncertainty of a row (a probe at a station) over the denominator of the row
======  ==========================================================================================

A doubling of N divides f by 2⁴ at most, the highest order of all methods.  The search ends early where even this order
does not reach τ at the largest N.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

from comparisons.display_units import at_station
from comparisons.formats import percent
from comparisons.verdict.rows import Row
from cprbm_scene import Scene

SolverName = Literal["cprbm", "fea", "solid"]

FIRST: Mapping[SolverName, int] = {"cprbm": 10, "fea": 10, "solid": 20}
"""N of the first runs."""

LARGEST: Mapping[SolverName, int] = {"cprbm": 5120, "fea": 640, "solid": 160}
"""Largest N of each solver."""

LARGEST_PAPER = 640
"""Largest N of the formulation ``paper``, whose time grows with the cube of N."""

HIGHEST_ORDER = 4.0

ENOUGH = 40
"""N from which on a refusal of a solver is final, and a tolerance out of reach ends the search."""

PATIENCE = 160
"""N from which on the search ends where nothing can be stated: a run ended early, or a value comes and goes with N."""


@dataclass(frozen=True, slots=True)
class Stated:
    """A row, by probe, stage and station, and f; f is infinite where the value exists at one N and not at another."""

    probe: str
    stage: str
    station: float
    fraction: float


@dataclass(frozen=True, slots=True)
class Level:
    """Result of the runs at one N: the row with the largest f, and why nothing is stated (else empty)."""

    n: int
    worst: Stated | None
    trouble: str = ""

    @property
    def fraction(self) -> float:
        """The largest f; infinite in trouble, 0 where no row has a value."""
        if self.trouble:
            return math.inf
        return 0.0 if self.worst is None else self.worst.fraction

    def end(self, tolerance: float, most: int) -> str:
        """Why no larger N follows, of at most ``most``; empty where the search goes on."""
        if 2 * self.n > most:
            return f"N = {most} is the largest N"
        if not math.isfinite(self.fraction):
            return "no larger N would help" if self.n >= PATIENCE else ""
        reached = self.fraction * (self.n / most) ** HIGHEST_ORDER
        hopeless = self.n >= ENOUGH and reached > tolerance
        return f"N = {most}, the largest N, would not do either" if hopeless else ""


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Result of a search for N.

    Attributes:
        asked: τ.
        solver: the solver.
        level: result at the last N.
        extrapolated: the two finest N, where values are limits of both; else nothing.
        probes: names of the probes with limits as values.
        solved: every solved N, ascending.
        ended: why no larger N followed; empty where the tolerance is met.
    """

    asked: float
    solver: SolverName
    level: Level
    extrapolated: tuple[int, ...]
    probes: tuple[str, ...]
    solved: tuple[int, ...]
    ended: str = ""

    @property
    def met(self) -> bool:
        """Whether the f of every row is within τ."""
        return self.level.fraction <= self.asked

    @property
    def n(self) -> int:
        """The last N."""
        return self.level.n

    @property
    def worst(self) -> Stated | None:
        """The row with the largest f; None where nothing is stated."""
        return self.level.worst

    def sentence(self, scene: Scene) -> str:
        """Result with the deciding row, with stations in the units of the scene's file."""
        what = f"{self.n} {'links' if self.solver == 'cprbm' else 'elements'} per beam"
        if self.extrapolated:
            what = f"{len(self.probes)} probes extrapolated from N = {', '.join(map(str, self.extrapolated))}"
        found = self.level.trouble or "no row has a value"
        if self.worst is not None:
            row, found = self.worst, f"states {percent(self.worst.fraction)}"
            if not math.isfinite(row.fraction):
                found = "has a value at one N and none at another"
            found = f"{row.probe} at {at_station(scene, row.stage, row.station)} {found}"
        met = "within" if self.met else "NOT within"
        ended = f"; {self.ended}" if self.ended else ""
        return f"{self.solver.upper()}: {met} {percent(self.asked)}: {what}; at worst {found}{ended}."


def worst_row(rows: Iterable[tuple[Row, float | None]]) -> Stated | None:
    """The row with the largest f of all rows with an f; None without any."""
    known = (Stated(row.probe.name, *row.where, fraction) for row, fraction in rows if fraction is not None)
    return max(known, key=lambda stated: stated.fraction, default=None)
