"""Comparisons of made-up solvers, and changes of their answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from comparisons.case import Comparison, compare
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers, paired
from comparisons.verdict import Reason, Word
from comparisons.verdict.rows import Row
from cprbm_scene import Answer, Ending, Scene, StationAnswer
from cprbm_scene.answer import ContactState, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp

C, F = MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)
"""Right solvers: their errors at the default sizes are 0.2 % and an eighth of 0.1 %."""

Change = Callable[[StationAnswer], StationAnswer]


def compared(
    scene: Scene, cprbm: Solver, fea: Solver, choices: Choices | None = None, *, exact: Solver | None = None
) -> Comparison:
    """The comparison of two made-up solvers."""
    return compare(paired(scene, choices or Choices(), Solvers(cprbm, fea, exact=exact)))


def row_of(comparison: Comparison, probe: str, station: float = 0.67) -> Row:
    """The row of a probe at a station."""
    return next(row for row in comparison.rows if (row.probe.name, row.station) == (probe, station))


def words(judged: Iterable[Word | Reason | None]) -> str:
    """Word and reason as text, such as ``UNDECIDED COARSE``; empty for a row that takes no part."""
    return " ".join(each.value for each in judged if each is not None)


def said_of(comparison: Comparison, probe: str, station: float = 0.67) -> str:
    """Word and reason of the row of a probe at a station."""
    row = row_of(comparison, probe, station)
    return words((row.word, row.reason))


def counted(comparison: Comparison) -> Counter[str]:
    """Numbers of the words and reasons of all rows that take part."""
    return Counter(words((row.word, row.reason)) for row in comparison.rows if row.word is not None)


def word_of(comparison: Comparison) -> str:
    """Word and reason of the case."""
    return words((comparison.verdict.word, comparison.verdict.reason))


def altered(solver: Solver, change: Change, *stations: float) -> Solver:
    """A solver with a change at some stations, or at all."""

    def answer(scene: Scene, choices: Choices) -> Answer:
        found = solver(scene, choices)
        changed = (change(each) if not stations or each.value in stations else each for each in found.stations)
        return replace(found, stations=tuple(changed))

    return answer


def only(solver: Solver, other: Solver, when: Callable[[Choices], bool]) -> Solver:
    """The ``other`` solver for some choices, else the first."""
    return lambda scene, choices: (other if when(choices) else solver)(scene, choices)


def ending(solver: Solver, stations: int) -> Solver:
    """A solver that ends early, after some stations."""

    def answer(scene: Scene, choices: Choices) -> Answer:
        found = solver(scene, choices)
        return replace(found, stations=found.stations[:stations], ending=Ending.STEP_TOO_SMALL, sentence="It stuck.")

    return answer


def opened(station: StationAnswer) -> StationAnswer:
    """The station with an open contact; all other values stay."""
    nothing = {"contact.force": [0.0], "contact.centre": [], "contact.closing_load": []}
    values = {name: frozen_array(nothing.get(name, value)) for name, value in station.values.items()}
    contacts = frozendict({"contact": ContactState(False, frozen_array(np.zeros((0, 2))))})
    return replace(station, values=frozendict(values), touching=frozendict(), contacts=contacts, forces=PointForces())
