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

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from comparisons.case import Verdict
from comparisons.formats import percent
from comparisons.offset_exact import ordinates
from comparisons.pairing import OffsetConstruction, Offsets, cprbm_offset_points
from comparisons.verdict.uncertainty import SAFETY
from comparisons.verdict.words import Word
from cprbm_scene import OffsetClaim, OffsetQuestion
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

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
    """

    spacing: str
    n: int
    offset: float
    differences: Array
    stated: Array
    round_off: Array
    over_offset: float

    @property
    def difference(self) -> float:
        """The largest d_i; NaN where a point has no exact ordinate."""
        return float(np.max(self.differences))

    @property
    def pressure(self) -> float:
        """The largest d_i/(u_i + r_i)."""
        return float(np.max(self.differences / (self.stated + self.round_off)))

    def word(self, limit: float) -> Word:
        """The verdict on the row."""
        if not np.all(np.isfinite(self.differences)):
            return Word.UNDECIDED
        if self.pressure > 1.0:
            return Word.DIFFER
        return Word.UNDECIDED if np.max(self.stated + self.round_off) > limit else Word.AGREE


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


def compared_offset(question: OffsetQuestion, construct: OffsetConstruction = cprbm_offset_points) -> OffsetComparison:
    """Both routes for every spacing, N and t of a question."""
    distances = question.sign * np.array(question.offsets)
    chains = [(name, n) for name in question.spacings for n in question.numbers]
    begun = time.perf_counter()
    found = [construct(question.curve, question.spacings[name], n, distances) for name, n in chains]
    between = time.perf_counter()
    graph = 0 if question.axis == "y" else 1
    breaks = np.cumsum([n for _, n in chains])[:-1]
    exact = [
        np.split(ordinates(question.curve, at, float(distance), along_x=graph == 0), breaks)
        for distance, at in zip(
            distances, np.concatenate([each.points[..., graph] for each in found], axis=1), strict=True
        )
    ]
    seconds = {"cprbm": between - begun, "exact": time.perf_counter() - between}
    rows = tuple(
        _row(question, name, place, each, exact[place][chain])
        for chain, ((name, _), each) in enumerate(zip(chains, found, strict=True))
        for place in range(len(distances))
    )
    return OffsetComparison(question, rows, _judged(question, rows), frozendict(seconds), _shown(question, construct))


def claim_of_offset(question: OffsetQuestion, n: int) -> OffsetClaim | None:
    """The strictest claim about a chain of ``n`` springs."""
    claims = [claim for claim in question.claims if n >= claim.numbers_from]
    return min(claims, key=lambda claim: claim.bound, default=None)


def _row(question: OffsetQuestion, name: str, place: int, found: Offsets, exact: Array) -> OffsetRow:
    """The row of a chain at the offset in a ``place`` of the question's list."""
    points, t = found.points[place], question.offsets[place]
    apart = np.abs(points[:, 1 if question.axis == "y" else 0] - exact)
    tilt = np.abs(np.cos(found.tangents) if question.axis == "y" else np.sin(found.tangents))
    over = np.full(len(exact), t) if question.relative_to == "offset" else np.abs(exact)
    stated = SAFETY * np.max(found.off_curve[place] / tilt)
    return OffsetRow(
        name,
        len(exact),
        t,
        differences=apart / over,
        stated=stated / over,
        round_off=_ROUND_OFF * (np.max(np.abs(points)) + t) / tilt / over,
        over_offset=float(np.max(apart)) / t,
    )


def _shown(question: OffsetQuestion, construct: OffsetConstruction) -> tuple[Array, ...]:
    if question.shown is None:
        return ()
    spacing, distances = next(iter(question.spacings.values())), question.sign * np.array(question.shown.offsets)
    return tuple(construct(question.curve, spacing, n, distances).points for n in question.shown.numbers)


def _judged(question: OffsetQuestion, rows: tuple[OffsetRow, ...]) -> Verdict:
    words = [row.word(question.verdict_limit) for row in rows]
    for word in (Word.DIFFER, Word.UNDECIDED, Word.AGREE):
        those = [row for row, said in zip(rows, words, strict=True) if said is word]
        if those:
            break
    row = max(those, key=lambda row: row.pressure if np.isfinite(row.pressure) else np.inf)
    if not np.isfinite(row.pressure):
        said = "some offset point lies beyond the ends of the exact curve"
    else:
        i = int(np.argmax(row.differences / (row.stated + row.round_off)))
        said = f"{percent(row.differences[i])} against a stated {percent(row.stated[i] + row.round_off[i])}"
    if word is Word.UNDECIDED and np.isfinite(row.pressure):
        largest = max(float(np.max(row.stated)) for row in those)
        said = f"the stated uncertainty reaches {percent(largest)}, more than {percent(question.verdict_limit)}"
    place = f"{row.spacing} at N = {row.n}, t = {row.offset:g}: {said}"
    match word:
        case Word.AGREE:
            sentence = f"All {len(rows)} rows agree; the closest call is {place}."
        case Word.DIFFER:
            sentence = f"{len(those)} of {len(rows)} rows differ, most of all {place}."
        case Word.UNDECIDED:
            sentence = f"{len(those)} of {len(rows)} rows are undecided, first of all {place}."
    return Verdict(word, (sentence,), tuple(words), completed=all(np.isfinite(each.difference) for each in rows))
