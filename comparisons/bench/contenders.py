"""Methods that a benchmark times: a set-up, a solve, and the outcome of the result.

The methods here are the project's own solvers.  Optimisers come from outside as further contenders.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from comparisons.choices import Choices, Count
from comparisons.executor import Solver
from comparisons.pairing import Solvers, prepared
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

OURS: tuple[str, ...] = ("auto", "paper", "fea")
"""Names of the project's own methods, in the order of the tables."""

Clocked = Literal["solve", "both"]
"""Extent of a time: the solve alone, or set-up and solve together."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """Outcome of a solve.

    Attributes:
        ended: COMPLETED, or the name of another ending; why: a sentence on another ending.
        iterations: at every reached station.
        values: at the last station, by probe; empty without the last station.
        residual: in the common measure of the peers; None of the project's own methods, which certify themselves.
    """

    ended: str
    why: str
    iterations: tuple[int, ...]
    values: Mapping[str, Array]
    residual: float | None = None

    @property
    def completed(self) -> bool:
        """True for a complete answer."""
        return self.ended == "COMPLETED"


@dataclass(frozen=True, slots=True)
class Run:
    """A run: ``set_up`` returns the solve, both on the clock; ``outcome`` of the result is off the clock."""

    set_up: Callable[[], Callable[[], Any]]
    outcome: Callable[[Any], Outcome]


Begin = Callable[[Scene, Count, float], Run]
"""A run from a scene, N and the largest seconds of a solve; raises SceneError where the method refuses the scene."""


@dataclass(frozen=True, slots=True)
class Contender:
    """A method.

    Attributes:
        name: in the option ``--method``; method, formulation: in the JSON; label: in tables.
        begin: begin of a run.
        largest: largest of the standard sizes.
        tolerance: largest residual of a complete solve of a peer; None for the project's own methods.
        ratios: clocks of the ratios of the method's time to the time of CPRBM ``paper``.
        look: colour and marker of the points in figures.
        absence: why the method cannot take part on this machine; empty if it can.
    """

    name: str
    method: str
    formulation: str | None
    label: str
    begin: Begin
    largest: int = 160
    tolerance: float | None = None
    ratios: tuple[Clocked, ...] = ()
    look: tuple[str, str] = ("#606060", "x")
    absence: str = ""

    @property
    def is_peer(self) -> bool:
        """True for an optimiser on the problem of CPRBM ``paper``, which solves the last station only."""
        return self.tolerance is not None


def contenders(solvers: Solvers, choices: Choices) -> tuple[Contender, ...]:
    """The project's own methods, in the order of ``OURS``."""
    auto, paper = (_ours(solvers.cprbm, replace(choices, formulation=name)) for name in ("auto", "paper"))
    fea = _ours(solvers.fea, choices)
    return (
        Contender("auto", "cprbm", "auto", "CPRBM auto", auto, 5120, ratios=("both",), look=("#1f5fa8", "o")),
        Contender("paper", "cprbm", "paper", "CPRBM paper", paper, 640, look=("#5aa0e0", "s")),
        Contender("fea", "fea", None, f"FEA {choices.kinematics}", fea, 1280, look=("#c8321e", "^")),
    )


def _ours(solver: Solver, choices: Choices) -> Begin:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # a penalty whose error falls with the error of the elements
        chosen = replace(choices.of_size(round(mean(count))), links=count, elements=count)
        return Run(lambda: prepared(solver, scene, chosen), outcome_of)

    return begin


def mean(count: Count) -> float:
    """N: links or elements per beam, on average where beams have numbers of their own."""
    return float(count) if isinstance(count, int) else sum(count.values()) / len(count)


def outcome_of(answer: Answer) -> Outcome:
    """Outcome of a solve of our solvers."""
    return Outcome(
        ended=answer.ending.name,
        why="" if answer.completed else answer.sentence,
        iterations=tuple(station.certificate.iterations for station in answer.stations),
        values=answer.stations[-1].values if answer.completed and answer.stations else frozendict(),
    )
