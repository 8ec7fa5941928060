"""N for a tolerance: the cheapest N whose own error estimate meets it, found from coarse to fine.

=======  ==================================================================================================
symbol   meaning
=======  ==================================================================================================
N        links or elements per beam
τ        the tolerance, a fraction
f        stated uncertainty of a row (a probe at a station) over what its differences are divided by
p        the order of convergence that both solvers have at least, 2
q        the order that f shows between two N, between p and 4 (the highest order of either solver)
g        by how much N must grow for f to be τ in every row: max (f/τ)^(1/q)
M        safety factor of a predicted N, so that the N that is predicted passes
=======  ==================================================================================================

Two ways to meet τ, by what must be solved:

* *plain*: the value at N, whose f comes from N and 2N (and from N + N/7, where the error may be uneven in N);
* *settled*: of N/2, N and 2N the value at 2N, or what N and 2N extrapolate to, whichever states less, probe by probe.

A solve's work grows with its N.  From f = C/N^p follows where the plain way would pass: at N' = M·g·N.  It must solve
N' and 2N'; to double N must solve 4N alone, and makes both ways possible with what is solved already.  So N goes to N'
where that is little work (3N' ≤ 5N), and else to 2N: never further than the double of what did not do.  Where
extrapolation is not to be had (an error that is uneven in N by its nature), N goes to N' in one step, as soon as two N
have shown the order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

from comparisons.display_units import at_station
from comparisons.formats import percent
from cprbm_scene import Scene, SceneError

FIRST = 10
"""N with which a search begins."""

ENOUGH = 80
"""N from which on a prediction is believed that says that the largest N will not do, and a failure as well."""

MARGIN = 1.03
HIGHEST_ORDER = 4.0

_LARGEST_STEP = 4.0
"""Of a predicted N over the one from which it was predicted."""

_FOR_CERTAIN = 2.0
"""How far beyond the largest N a predicted one must lie for the search to end."""


@dataclass(frozen=True, slots=True)
class Stated:
    """A row's stated uncertainty.

    Attributes:
        probe, stage, station: the row.
        fraction: f; infinite where none can be stated, because the value is there at one N and not at another.
        order: p.
    """

    probe: str
    stage: str
    station: float
    fraction: float
    order: float

    @property
    def row(self) -> tuple[str, str, float]:
        """What the row is known by."""
        return self.probe, self.stage, self.station


@dataclass(frozen=True, slots=True)
class Estimate:
    """What the solves at and about one N state.

    Attributes:
        rows: one for each that has a value.
        trouble: why nothing is stated; empty otherwise.
        extrapolated: names of the probes whose values are.
    """

    rows: tuple[Stated, ...]
    trouble: str = ""
    extrapolated: frozenset[str] = frozenset()

    @property
    def worst(self) -> Stated | None:
        """The row with the largest f; None without rows."""
        return max(self.rows, key=lambda row: row.fraction, default=None)

    @property
    def fraction(self) -> float:
        """The largest f; infinite in trouble, 0 where no row has a value."""
        if self.trouble:
            return math.inf
        return 0.0 if self.worst is None else self.worst.fraction

    def worst_of_probes(self) -> dict[str, float]:
        """The largest f of every probe."""
        worst: dict[str, float] = {}
        for row in self.rows:
            worst[row.probe] = max(row.fraction, worst.get(row.probe, 0.0))
        return worst

    def growth(self, tolerance: float, before: Estimate | None, ratio: float) -> float:
        """g, at least 1.

        Args:
            tolerance: τ.
            before: what was stated at an N smaller by ``ratio``, from which q is seen; without it q is p.
            ratio: greater than 1.
        """
        if self.trouble:
            return math.inf
        earlier = {} if before is None else {row.row: row.fraction for row in before.rows}
        return max((_growth(row, tolerance, earlier.get(row.row), ratio) for row in self.rows), default=1.0)


def _growth(row: Stated, tolerance: float, before: float | None, ratio: float) -> float:
    if row.fraction <= tolerance:
        return 1.0
    q = row.order
    if before is not None and math.isfinite(before) and math.isfinite(row.fraction):
        q = min(max(q, math.log(before / row.fraction) / math.log(ratio)), HIGHEST_ORDER) if before > 0.0 else q
    return float((row.fraction / tolerance) ** (1.0 / q))


class Levels(Protocol):
    """What a search may ask; whatever N an answer needs is solved once."""

    def plain(self, n: int) -> Estimate:
        """Of the values at ``n``, from n and 2n."""

    def checked(self, n: int) -> Estimate:
        """The same with all that the values at ``n`` are to be held against."""

    def settled(self, n: int) -> Estimate:
        """Of the values at 2n or of what n and 2n extrapolate to, from n/2, n and 2n."""


@dataclass(frozen=True, slots=True)
class Found:
    """Where a search ended: at the values of ``n``, or at what is ``settled`` of n/2, n and 2n."""

    n: int
    estimate: Estimate
    met: bool
    settled: bool = False


def search(levels: Levels, tolerance: float, largest: int, *, extrapolates: bool) -> Found:
    """The cheapest N that meets a tolerance, or the best of what was solved where none does.

    Args:
        levels: what is solved and stated.
        tolerance: τ, positive.
        largest: N beyond which nothing is solved; at least 4 ``FIRST``.
        extrapolates: whether the settled way is open.

    Raises:
        SceneError: the question is refused at every N.
    """
    tried: list[Found] = []
    n, before = FIRST, None
    while True:
        try:
            found = _plainly(levels, n, tolerance)
        except SceneError:  # a formulation may ask for more joints in a range than few links have there
            if n >= ENOUGH:
                raise
            n *= 2
            continue
        tried.append(found)
        estimate = last = found.estimate
        ratio = 2.0 if before is None else n / before.n
        growth = estimate.growth(tolerance, None if before is None else before.estimate, ratio)
        if not found.met and extrapolates:
            if n > FIRST:
                last = levels.settled(n)
                tried.append(Found(n, last, last.fraction <= tolerance, settled=True))
            if not tried[-1].met and 3 * _predicted(n, growth) <= 5 * n:
                tried.append(_plainly(levels, _predicted(n, growth), tolerance))
        if tried[-1].met:
            return tried[-1]
        step = 2.0 if extrapolates or before is None else _LARGEST_STEP
        further = 2 * n if extrapolates else min(_predicted(n, growth), round(step * n))
        further = min(further, largest // 2)
        if further <= n or (n >= ENOUGH and _hopeless(last, 2.0 * n, tolerance, largest)):
            return min(tried, key=lambda each: each.estimate.fraction)
        before, n = found, further


def _plainly(levels: Levels, n: int, tolerance: float) -> Found:
    estimate = levels.plain(n)
    if estimate.fraction <= tolerance:
        estimate = levels.checked(n)
    return Found(n, estimate, estimate.fraction <= tolerance)


def _predicted(n: int, growth: float) -> int:
    """N' = M·g·N; where g says nothing, because a value comes and goes, 2N.

    It is even as the first N is, so that the middle of a beam, where what is symmetric touches, stays a border: a
    prediction from one kind of mesh is worth little for another.
    """
    return 2 * math.ceil(max(n + 1, MARGIN * growth * n) / 2) if math.isfinite(growth) else 2 * n


def _hopeless(estimate: Estimate, finest: float, tolerance: float, largest: int) -> bool:
    """Whether no N up to the largest is likely to do, with ``finest`` the finest N that was solved."""
    if estimate.trouble:
        return True
    growth = estimate.growth(tolerance, None, 2.0)
    if not math.isfinite(growth):
        return finest >= 8 * ENOUGH
    return finest * growth > _FOR_CERTAIN * largest


@dataclass(frozen=True, slots=True)
class Tolerance:
    """What a search for N has come to.

    Attributes:
        asked: the tolerance, a fraction.
        met: whether every row's stated uncertainty is within it.
        solver: whose search it was.
        n: links or elements per beam of the answer; of an extrapolated one the finest. Of a solid along each beam.
        worst: the row with the largest stated uncertainty; None where nothing is stated.
        trouble: why nothing is; empty otherwise.
        extrapolated: N and 2N, or nothing.
        probes: names of those whose values are extrapolated.
        solved: every N that was solved, ascending.
        ended: why nothing finer was solved, where that is said.
    """

    asked: float
    met: bool
    solver: Literal["cprbm", "fea", "solid"]
    n: int
    worst: Stated | None
    trouble: str
    extrapolated: tuple[int, ...]
    probes: tuple[str, ...]
    solved: tuple[int, ...]
    ended: str = ""

    def sentence(self, scene: Scene) -> str:
        """What the search has found, with stations in the units of the scene's file."""
        what = f"{self.n} {'links' if self.solver == 'cprbm' else 'elements'} per beam"
        if self.extrapolated and self.solver == "solid":
            coarse, fine = self.extrapolated
            what = f"extrapolated from {coarse} and {fine} elements along each beam"
        elif self.extrapolated:
            coarse, fine = self.extrapolated
            what = f"{len(self.probes)} probes extrapolated from N = {coarse}, {fine}, the others at N = {fine}"
        found = self.trouble or "no row has a value"
        if self.worst is not None:
            row, found = self.worst, f"states {percent(self.worst.fraction)}"
            if not math.isfinite(row.fraction):
                found = "has a value at one N and none at another"
            found = f"{row.probe} at {at_station(scene, row.stage, row.station)} {found}"
        met = "within" if self.met else "NOT within"
        ended = f"; {self.ended}" if self.ended else ""
        return f"{self.solver.upper()}: {met} {percent(self.asked)}: {what}; at worst {found}{ended}."
