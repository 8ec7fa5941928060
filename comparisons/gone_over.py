"""Ends of branches that answers went on over, where these are why they differ from there on.

A stage that asks for no ends is gone on over one beside which there is a state.  Two answers may go on over the same
end and come to different states, or one where the other tells of no end.  Stations before it then agree, and the first
that differs lies behind it.
"""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.branches import gone_over_by
from comparisons.criticals import mechanism
from comparisons.formats import number
from comparisons.measures import Row, load_unit
from comparisons.pairing import Runs
from comparisons.words import Word
from cprbm_scene import Answer, GoneOver, Scene


def why_apart(scene: Scene, runs: Runs, rows: Sequence[Row], words: Sequence[Word | None]) -> tuple[str, ...]:
    """What the two compared answers went on over between the last station that agrees and the first that differs."""
    stations = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    said = {word: set[int]() for word in (*Word, None)}
    for row, word in zip(rows, words, strict=True):
        said[word].add(stations.index((row.stage, row.station)))
    if not said[Word.DIFFER]:
        return ()
    first = min(said[Word.DIFFER])
    last = max((i for word in Word for i in said[word] if i < first), default=-1)
    names = {"the CPRBM": runs.cprbm[0], "the finite elements": runs.reference}
    found = {name: _between(scene, answer, last, first) for name, answer in names.items()}
    ways = [
        f"{name} at {_where(scene, one)} to a state turned by {number(one.turned, 3)} rad"
        for name, one in found.items()
        if one is not None
    ]
    if not ways:
        return ()
    both = "Both went on over an end of the branch and came to different states"
    who = both if len(ways) == len(names) else "One alone went on over an end of the branch"
    return (f"{who}: {'; '.join(ways)}.",)


def _between(scene: Scene, answer: Answer, last: int, first: int) -> GoneOver | None:
    """The last end that an answer went on over between two stations of the scene, by their numbers; −1 is rest."""
    by = [0]
    for stage in scene.stages:
        before = by[-1]
        by += [before + count for count in gone_over_by(scene, stage, answer)]
    return answer.gone_over[by[first + 1] - 1] if by[first + 1] > by[last + 1] else None


def _where(scene: Scene, one: GoneOver) -> str:
    stage = next(stage for stage in scene.stages if stage.name == one.end.stage)
    return f"{stage.name} {number(one.end.value, 5)} {load_unit(scene, stage)} ({mechanism(one.end)})"
