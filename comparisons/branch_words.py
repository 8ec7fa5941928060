"""Words of a comparison by branch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.verdict.rows import Row
from comparisons.verdict.station_events import Place
from comparisons.verdict.words import Word, worst_of


@dataclass(frozen=True, slots=True)
class BranchVerdict:
    """Word of the rows of one branch in a stage.

    Attributes:
        stage: name; number: of critical points before; first, last: stations; stations: their number.
        near: stations between events, which take no part.
        word: None without a row that takes part.
    """

    stage: str
    number: int
    first: float
    last: float
    stations: int
    near: int
    word: Word | None


def branch_verdicts(rows: Sequence[Row], words: Sequence[Word | None]) -> tuple[BranchVerdict, ...]:
    """Word of every branch, in the order of the path."""
    found: dict[tuple[str, int], list[tuple[Row, Word | None]]] = {}
    for row, word in zip(rows, words, strict=True):
        if row.branch is not None:
            found.setdefault((row.stage, row.branch), []).append((row, word))
    verdicts = []
    for (stage, number), mine in found.items():
        places = {row.station: row.place for row, _ in mine}
        stations = list(places)
        near = sum(place is Place.BETWEEN for place in places.values())
        word = worst_of(word for _, word in mine)
        verdicts.append(BranchVerdict(stage, number, stations[0], stations[-1], len(stations), near, word))
    return tuple(verdicts)
