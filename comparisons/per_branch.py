"""The verdict branch by branch, and that on the critical values, in records and in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.branches import Place
from comparisons.criticals import CriticalRow, mechanism
from comparisons.formats import number
from comparisons.measures import Row
from comparisons.words import Word, worst_of
from cprbm_scene import Critical


@dataclass(frozen=True, slots=True)
class BranchVerdict:
    """What the rows of one branch in one stage say.

    Attributes:
        stage: name of the stage.
        number: how many branches have ended before this one.
        first, last: the first and the last station at which all answers are on it.
        stations: how many such stations there are.
        near: how many of them are near a critical value and take no part.
        word: of the rows that take part; None where there is none.
    """

    stage: str
    number: int
    first: float
    last: float
    stations: int
    near: int
    word: Word | None


def branch_verdicts(rows: Sequence[Row], words: Sequence[Word | None]) -> tuple[BranchVerdict, ...]:
    """The verdict of every branch, in the order in which they are followed; ``words`` are those of the rows."""
    found: dict[tuple[str, int], list[tuple[Row, Word | None]]] = {}
    for row, word in zip(rows, words, strict=True):
        if row.branch is not None:
            found.setdefault((row.stage, row.branch), []).append((row, word))
    return tuple(_of_branch(stage, number, mine) for (stage, number), mine in found.items())


def critical_word(row: CriticalRow) -> Word:
    """What a critical value says."""
    if row.differs:
        return Word.DIFFER
    return Word.AGREE if row.tellable else Word.UNDECIDED


def told(rows: Sequence[Row], branches: Sequence[BranchVerdict], criticals: Sequence[CriticalRow]) -> tuple[str, ...]:
    """What the branches and the critical values say; nothing where no branch ends."""
    if not criticals and all(row.place is Place.COMPARED for row in rows):
        return ()
    said = "; ".join(
        f"{each.stage} {each.first:g} to {each.last:g} {each.word.value if each.word else 'takes no part'}"
        for each in branches
    )
    sentences = [f"Branch by branch: {said}."] if branches else []
    for place in (Place.BETWEEN, Place.NEAR, Place.DOUBTFUL):
        stations = dict.fromkeys(f"{row.stage} {row.station:g}" for row in rows if row.place is place)
        if stations:
            sentences.append(f"Listed as {place.value}: {', '.join(stations)}.")
    return (*(critical_sentence(each) for each in criticals), *sentences)


def critical_sentence(row: CriticalRow) -> str:
    """What is found of a critical value, and what it says."""
    found = {"the CPRBM": row.cprbm, "the finite elements": row.fea}
    said = " and ".join(
        f"{_value(each, row.unit)} ({mechanism(each)}) in {name}" if each is not None else f"nowhere in {name}"
        for name, each in found.items()
    )
    if row.bounds is None:
        why = "" if row.steady else ", and the runs of one solver are not of one mind"
    else:
        bounds = row.bounds
        sizes = (row.difference, bounds.theory, row.same_theory, bounds.same_theory, row.allowed)
        apart, theory, own, stated, allowed = (distance(size, row.unit) for size in sizes)
        why = f", {apart} apart and {theory} by theory; within one theory {own} against a stated {stated}, "
        why += f"{allowed} allowed"
    said = f"The branch ends in {row.stage} at {said}{why}"
    over = _beyond(row) if row.turned else ""
    return f"{said}{over}: {critical_word(row).value}."


def _beyond(row: CriticalRow) -> str:
    """What is to be said of an end that some runs have gone on over, and others not."""
    who, most = ", ".join(row.turned), number(max(row.turned.values()), 3)
    return f". {who} went on over it, to a state beside it turned by {most} rad, and others ended there; beyond it"


def value_and_unit(value: float, unit: str) -> str:
    """A value of a load or drive with its unit, of a rotation also in degrees."""
    degrees = f" ({number(math.degrees(value), 4)}°)" if unit == "rad" else ""
    return f"{number(value, 5)} {unit}{degrees}"


def distance(value: float, unit: str) -> str:
    """A distance along a load or drive; of a rotation in degrees."""
    if not math.isfinite(value):
        return "–"
    return f"{number(math.degrees(value), 2)}°" if unit == "rad" else f"{number(value, 2)} {unit}"


def _value(critical: Critical, unit: str) -> str:
    return value_and_unit(critical.value, unit)


def _of_branch(stage: str, branch: int, mine: Sequence[tuple[Row, Word | None]]) -> BranchVerdict:
    stations = {row.station: row.place for row, _ in mine}
    values = list(stations)
    return BranchVerdict(
        stage=stage,
        number=branch,
        first=values[0],
        last=values[-1],
        stations=len(values),
        near=sum(place is Place.NEAR for place in stations.values()),
        word=worst_of(word for _, word in mine),
    )
