"""The rare scenes of the folder ``rare``, their expected results, and the differences between both.

A rare scene has an awkward contact, critical point or load step.  ``rare/expected.toml`` states the expected result of
every scene.  This module asks the solvers and lists every departure.
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import comparisons
import cprbm
import fea_reference
from comparisons.choices import Choices
from cprbm_scene import Answer, Scene, read

FOLDER = Path(__file__).parent / "rare"
LINKS, ELEMENTS = 40, 40
"""Sizes of the solvers alone; an expected line may state other links."""
COMPARED = Choices(links=40, elements=28, kinematics="bending")
"""Coarser than the solvers alone, since a comparison also runs two finer sizes of both."""
CRITICAL = "critical load"


@dataclass(frozen=True)
class Expected:
    """A line of ``expected.toml``: a word or the endings, and perhaps a number.

    Attributes:
        word: the verdict of ``comparisons.compare`` in lower case.
        ends: name of the ending of both solvers, or of every solver that is named.
        of: a probe at the last station, or ``critical load`` for the load at the first critical point.
        component: index of the probe's component, from 0.
        value: the number, in SI units.
        within: the largest absolute difference allowed.
        reference: where the number comes from.
        links: links of the CPRBM, where it is asked alone.
    """

    word: str | None = None
    ends: str | dict[str, str] | None = None
    of: str | None = None
    component: int = 0
    value: float = 0.0
    within: float = 0.0
    reference: str = ""
    links: int = LINKS

    @property
    def endings(self) -> dict[str, str] | None:
        """Name of the ending by solver, for every solver that is asked alone."""
        return dict.fromkeys(ASKED, self.ends) if isinstance(self.ends, str) else self.ends


@dataclass(frozen=True)
class Result:
    """Result of the solvers: the word or the endings, and the number by solver, None where absent."""

    word: str | None
    ends: dict[str, str] | None
    numbers: dict[str, float | None]


def expectations() -> dict[str, Expected]:
    """The expected result of every scene by the scene's name."""
    lines = tomllib.loads((FOLDER / "expected.toml").read_text(encoding="utf-8"))
    return {name: Expected(**line) for name, line in lines.items()}


def scene(name: str) -> Scene:
    """The rare scene by name."""
    return read(FOLDER / f"{name}.toml")


def result(question: Scene, expected: Expected) -> Result:
    """The solvers' result for a scene, as far as the expected line asks."""
    if expected.word is not None:
        return _compared(question, expected)
    sizes = {"cprbm": expected.links, "fea": ELEMENTS}
    answers = {solver: ASKED[solver](question, sizes[solver]) for solver in expected.endings or {}}
    ends = {solver: answer.ending.name for solver, answer in answers.items()}
    return Result(None, ends, {solver: _number(answer, expected) for solver, answer in answers.items()})


def departures(expected: Expected, found: Result) -> list[str]:
    """A sentence for every departure of the result from the expected line."""
    said = [
        f"{name} is {got}, expected {wanted}"
        for name, got, wanted in (("the word", found.word, expected.word), ("the ending", found.ends, expected.endings))
        if got != wanted
    ]
    if expected.of is None:
        return said
    for solver, number in found.numbers.items():
        if number is None or abs(number - expected.value) > expected.within:
            said.append(f"{expected.of} of {solver} is {number}, expected {expected.value} ± {expected.within}")
    return said


def _cprbm(question: Scene, links: int = LINKS) -> Answer:
    return cprbm.answer(question, cprbm.Settings(links=links))


def _fea(question: Scene, elements: int = ELEMENTS) -> Answer:
    return fea_reference.answer(question, fea_reference.Settings(elements=elements, kinematics="bending"))


ASKED = {"cprbm": _cprbm, "fea": _fea}
"""The solvers by name; both in the theory without stretch and shear."""


def _number(answer: Answer, expected: Expected) -> float | None:
    """The number under the probe of the expected line, or None where the answer lacks the probe."""
    if expected.of is None:
        return None
    if expected.of == CRITICAL:
        return answer.critical[0].value if answer.critical else None
    return _part(answer.stations[-1].values[expected.of] if answer.stations else (), expected.component)


def _compared(question: Scene, expected: Expected) -> Result:
    found = comparisons.compare(question, COMPARED)
    rows = [row for row in found.rows if row.probe.name == expected.of]
    last = {"cprbm": rows[-1].cprbm, "fea": rows[-1].fea} if rows else {"cprbm": (), "fea": ()}
    numbers = {solver: _part(values, expected.component) for solver, values in last.items()}
    return Result(found.verdict.word.value.lower(), None, numbers)


def _part(values: Sequence[float], component: int) -> float | None:
    return float(values[component]) if len(values) > component else None
