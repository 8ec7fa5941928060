"""Offset points of a chain beside the exact offset curve: rows, and AGREE, DIFFER or UNDECIDED.

======  ==========================================================================================
o_i     calculated ordinate of the offset point i; e_i the exact curve's at the same place
d_i     |o_i − e_i| over |e_i| or over t, as the question says
u_i     1.25 times the construction's own estimate of its distance from the curve, taken along the
        axis of the ordinate: the chain's largest, over the same
r_i     round-off of coordinates and offset, over the same
======  ==========================================================================================

A row (a spacing, N and t) differs where at some point d_i > u_i + r_i, is undecided where no point does but a sum is
more than the verdict limit (or a point lies beyond the exact curve's ends), and agrees otherwise.
"""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from comparisons.case import Comparison, Verdict
from comparisons.formats import percent
from comparisons.geometry import ordinates
from comparisons.pairing import OffsetConstruction, Offsets, cprbm_offset_points
from comparisons.verdict import SAFETY, Word, first_met, worst_of
from cprbm_scene import Array, OffsetClaim, OffsetQuestion, frozendict

_ROUND_OFF = 64.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class OffsetRow:
    """All offset points of one chain at one distance.

    Attributes:
        spacing: its name in the question.
        n: springs, and points.
        offset: t, m.
        differences, stated, round_off: d_i, u_i and r_i, (n,).
        over_offset: the largest |o_i − e_i| over t, whatever the question says.
        limit: the verdict limit of the question.
    """

    spacing: str
    n: int
    offset: float
    differences: Array
    stated: Array
    round_off: Array
    over_offset: float
    limit: float

    @property
    def total(self) -> Array:
        """u_i + r_i, (n,)."""
        return self.stated + self.round_off

    @property
    def difference(self) -> float:
        """The largest d_i; NaN where a point has no exact ordinate."""
        return float(np.max(self.differences))

    @property
    def pressure(self) -> float:
        """The largest d_i/(u_i + r_i)."""
        return float(np.max(self.differences / self.total))

    @property
    def word(self) -> Word:
        """The verdict on the row."""
        rules = (
            (not np.all(np.isfinite(self.differences)), Word.UNDECIDED),
            (self.pressure > 1.0, Word.DIFFER),
            (bool(np.max(self.total) > self.limit), Word.UNDECIDED),
        )
        return first_met(rules, Word.AGREE)


@dataclass(frozen=True, slots=True)
class OffsetComparison:
    """An offset question, its rows and the verdict.

    Attributes:
        seconds: of the two routes.
        shown: the calculated points of the first spacing at the numbers and offsets to be shown, (k, n, 2), m, each.
    """

    question: OffsetQuestion
    rows: tuple[OffsetRow, ...]
    verdict: Verdict
    seconds: Mapping[str, float]
    shown: tuple[Array, ...]

    @property
    def pressures(self) -> list[float]:
        """Differences of the rows over their stated uncertainties."""
        return [row.pressure for row in self.rows]


Compared = Comparison | OffsetComparison
"""Comparison of a scene or of an offset question."""


def compared_offset(question: OffsetQuestion, construct: OffsetConstruction = cprbm_offset_points) -> OffsetComparison:
    """Both routes for every spacing, N and t of a question."""
    distances, graph = question.sign * np.array(question.offsets), 0 if question.axis == "y" else 1
    chains = [(name, n) for name in question.spacings for n in question.numbers]
    begun = time.perf_counter()
    found = [construct(question.curve, question.spacings[name], n, distances) for name, n in chains]
    between = time.perf_counter()
    places = np.concatenate([each.points[..., graph] for each in found], axis=1)  # (k, all points)
    exact = np.stack(
        [ordinates(question.curve, *at, along_x=graph == 0) for at in zip(places, distances.tolist(), strict=True)]
    )
    seconds = {"cprbm": between - begun, "exact": time.perf_counter() - between}
    parts = np.split(exact, np.cumsum([n for _, n in chains])[:-1], axis=1)
    rows = tuple(
        row
        for (name, _), each, part in zip(chains, found, parts, strict=True)
        for row in _rows(question, name, each, part)
    )
    return OffsetComparison(question, rows, _judged(question, rows), frozendict(seconds), _shown(question, construct))


def claim_of_offset(question: OffsetQuestion, n: int) -> OffsetClaim | None:
    """The strictest claim about a chain of ``n`` springs."""
    claims = [claim for claim in question.claims if n >= claim.numbers_from]
    return min(claims, key=lambda claim: claim.bound, default=None)


def _rows(question: OffsetQuestion, name: str, found: Offsets, exact: Array) -> Iterator[OffsetRow]:
    """The rows of a chain, with exact ordinates (k, n) at the k offsets of the question."""
    tilt = np.abs(np.cos(found.tangents) if question.axis == "y" else np.sin(found.tangents))
    for t, points, off_curve, o in zip(question.offsets, found.points, found.off_curve, exact, strict=True):
        apart = np.abs(points[:, 1 if question.axis == "y" else 0] - o)
        over = np.full(len(o), t) if question.relative_to == "offset" else np.abs(o)
        yield OffsetRow(
            name,
            len(o),
            t,
            differences=apart / over,
            stated=SAFETY * np.max(off_curve / tilt) / over,
            round_off=_ROUND_OFF * (np.max(np.abs(points)) + t) / tilt / over,
            over_offset=float(np.max(apart)) / t,
            limit=question.verdict_limit,
        )


def _shown(question: OffsetQuestion, construct: OffsetConstruction) -> tuple[Array, ...]:
    if question.shown is None:
        return ()
    spacing, distances = next(iter(question.spacings.values())), question.sign * np.array(question.shown.offsets)
    return tuple(construct(question.curve, spacing, n, distances).points for n in question.shown.numbers)


def _judged(question: OffsetQuestion, rows: Sequence[OffsetRow]) -> Verdict:
    """The worst word of all rows, with the row that decides."""
    word = worst_of(row.word for row in rows) or Word.UNDECIDED
    mine = [row for row in rows if row.word is word]
    row = max(mine, key=lambda row: row.pressure if np.isfinite(row.pressure) else np.inf)
    largest, i = max(float(np.max(row.stated)) for row in mine), int(np.argmax(row.differences / row.total))
    limit = percent(question.verdict_limit)
    rules = (
        (not np.isfinite(row.pressure), "some offset point lies beyond the ends of the exact curve"),
        (word is Word.UNDECIDED, f"the stated uncertainty reaches {percent(largest)}, more than {limit}"),
    )
    cause = first_met(rules, f"{percent(row.differences[i])} against a stated {percent(row.total[i])}")
    beginning = {
        Word.AGREE: f"All {len(rows)} rows agree; the closest call is",
        Word.DIFFER: f"{len(mine)} of {len(rows)} rows differ, most of all",
        Word.UNDECIDED: f"{len(mine)} of {len(rows)} rows are undecided, first of all",
    }
    sentence = f"{beginning[word]} {row.spacing} at N = {row.n}, t = {row.offset:g}: {cause}."
    return Verdict(word, (sentence,), completed=all(np.isfinite(each.difference) for each in rows))
