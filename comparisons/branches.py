"""On which branch each answer is at each station, and where answers cannot be held against each other.

A branch is compared with the same branch: the number of a station's branch is how many have ended before it
(:class:`cprbm_scene.answer.StationAnswer`).  Two answers that find the same critical value a little apart are on
different branches at the stations between, and close to it their differences are those of the critical values,
magnified: the state at a fold goes with the square root of the distance from it.

==========  ==========================================================================================
place       what is at a station
==========  ==========================================================================================
COMPARED    all answers are on one branch, and neither compared one has a critical value near by
NEAR        all are on one branch, and a compared one has a critical value within the margin, or both have one or an
            end that they went on over (:class:`cprbm_scene.answer.GoneOver`)
DOUBTFUL    one alone of the compared answers has gone on over an end within the margin: the other may have it just
            behind
BETWEEN     some have left a branch and others have not, and all do leave it in this stage, or go on over its end
APART       the two solvers are on different branches, and not because one leaves it a little later
UNSETTLED   the same of the answers of one solver
==========  ==========================================================================================

Only where it is COMPARED, or DOUBTFUL, a station has a part in AGREE; one where answers are APART says DIFFER, an
UNSETTLED one UNDECIDED, and so does a DOUBTFUL one that would differ.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import accumulate

from comparisons.stations import station_of
from cprbm_scene import Answer, Scene, Stage
from cprbm_scene.statement import RotationDrive

NEAR_TURN = math.radians(1.0)
"""Margin about a critical rotation, rad."""

NEAR_SHARE = 0.01
"""Margin about any other critical value, a share of the stage's span."""


class Place(Enum):
    """Where a station stands; the value says it in tables."""

    COMPARED = "compared"
    NEAR = "near a critical value"
    DOUBTFUL = "near an end that one alone went on over"
    BETWEEN = "between the critical values"
    APART = "on different branches"
    UNSETTLED = "on different branches of one solver"


MEASURED = frozenset({Place.COMPARED, Place.DOUBTFUL})
"""Places at which it is stated what may lie between answers."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A station of the scene: its place, and the branch that all answers are on; None where there is no such."""

    stage: str
    value: float
    place: Place
    branch: int | None


@dataclass(frozen=True, slots=True)
class Branch:
    """The stations (n,) of a stage, in their order, at which all answers are on the branch of a ``number``."""

    stage: str
    number: int
    stations: tuple[float, ...]


def spots_of(scene: Scene, everyone: Mapping[str, Answer], compared: tuple[Answer, Answer]) -> tuple[Spot, ...]:
    """Where every station of the scene stands, in order.

    Args:
        scene: the question.
        everyone: all answers by name, whole ones; names of the CPRBM's begin with ``cprbm``.
        compared: the two that are compared.

    Raises:
        KeyError: an answer lacks a station.
    """
    found = []
    for stage in scene.stages:
        margin = margin_of(scene, stage)
        near = [one.value for answer in compared for one in answer.critical if one.stage == stage.name]
        ends = [_ends(stage, answer) for answer in compared]
        gone = {name: gone_over_by(scene, stage, answer) for name, answer in everyone.items()}
        alike = len({each[-1] for each in gone.values()}) == 1
        for i, value in enumerate(stage.stations):
            branches = {name: station_of(answer, stage.name, value).branch for name, answer in everyone.items()}
            numbers = set(branches.values())
            branch = numbers.pop() if len(numbers) == 1 else None
            if branch is None:
                place = _divided(stage, everyone, branches)
            elif alike and len({each[i] for each in gone.values()}) > 1:
                place, branch = Place.BETWEEN, None
            else:
                ending = any(abs(value - critical) <= margin for critical in near)
                beside = [any(abs(value - end) <= margin for end in mine) for mine in ends]
                place = Place.NEAR if ending or all(beside) else Place.DOUBTFUL if any(beside) else Place.COMPARED
            found.append(Spot(stage.name, value, place, branch))
    return tuple(found)


def branches_of(spots: tuple[Spot, ...]) -> tuple[Branch, ...]:
    """All branches that some station is on, in the order in which they are followed."""
    found: dict[tuple[str, int], list[float]] = {}
    for spot in spots:
        if spot.branch is not None:
            found.setdefault((spot.stage, spot.branch), []).append(spot.value)
    return tuple(Branch(stage, number, tuple(values)) for (stage, number), values in found.items())


def begins_at(scene: Scene, stage: Stage) -> float:
    """The value at which a stage finds its load or drive: where the last stage that steps it has left it, or 0."""
    before = scene.stages[: scene.stages.index(stage)]
    return next((earlier.stations[-1] for earlier in reversed(before) if earlier.steps == stage.steps), 0.0)


def span_of(scene: Scene, stage: Stage) -> float:
    """From the least to the largest value that a stage goes through, in its load's or drive's unit."""
    visited = (begins_at(scene, stage), *stage.stations)
    return max(visited) - min(visited)


def margin_of(scene: Scene, stage: Stage) -> float:
    """How close to a critical value a station is near it, in the unit of the stage's load or drive."""
    return NEAR_TURN if turns(scene, stage) else NEAR_SHARE * span_of(scene, stage)


def gone_over_by(scene: Scene, stage: Stage, answer: Answer) -> tuple[int, ...]:
    """How many ends an answer has gone on over in a stage by each of its stations."""
    found, before = [], begins_at(scene, stage)
    for value in stage.stations:
        least, most = sorted((before, value))
        found.append(sum(one.end.stage == stage.name and least < one.end.value <= most for one in answer.gone_over))
        before = value
    return tuple(accumulate(found))


def turns(scene: Scene, stage: Stage) -> bool:
    """Whether a stage steps a rotation."""
    return isinstance(scene.stepped(stage), RotationDrive)


def _ends(stage: Stage, answer: Answer) -> list[float]:
    """Where an answer has an end of a branch in a stage, whether it ends, jumps or is gone on over there."""
    every = (*answer.critical, *(one.end for one in answer.gone_over))
    return [end.value for end in every if end.stage == stage.name]


def _divided(stage: Stage, everyone: Mapping[str, Answer], branches: Mapping[str, int]) -> Place:
    """The place of a station at which answers are on different branches."""
    ends = range(min(branches.values()), max(branches.values()))
    left = [answer.critical[ends.start : ends.stop] for answer in everyone.values()]
    if all(len(each) == len(ends) and all(one.stage == stage.name for one in each) for each in left):
        return Place.BETWEEN
    cprbm = {number for name, number in branches.items() if name.startswith("cprbm")}
    fea = {number for name, number in branches.items() if not name.startswith("cprbm")}
    return Place.APART if len(cprbm) == len(fea) == 1 else Place.UNSETTLED
