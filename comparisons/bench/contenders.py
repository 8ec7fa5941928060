"""Methods that a benchmark times, each as a set-up, a solve, and what is made of its result.

The project's own solvers are here; the optimisers beside them come from outside, as further contenders.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from comparisons.choices import Choices, Count
from comparisons.crew import Solver
from comparisons.pairing import Solvers, prepared
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

Name = str
OURS: tuple[Name, ...] = ("auto", "paper", "fea")
"""The project's own methods, in the order of the tables."""

Clocked = Literal["solve", "both"]
"""What a time is of: the solve alone, or set-up and solve together."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one solve came to.

    Attributes:
        ended: COMPLETED, or the name of another ending.
        why: a sentence on that.
        iterations: of each station that was reached.
        values: at the last station, by probe; empty if it was not reached.
        residual: of the measure that is common to the peers; None of the project's own, which certify themselves.
    """

    ended: str
    why: str
    iterations: tuple[int, ...]
    values: Mapping[str, Array]
    residual: float | None = None

    @property
    def completed(self) -> bool:
        """Whether it is a whole answer."""
        return self.ended == "COMPLETED"


@dataclass(frozen=True, slots=True)
class Run:
    """A run: ``set_up`` returns the solve, both on the clock; ``outcome`` of the result is off the clock."""

    set_up: Callable[[], Callable[[], Any]]
    outcome: Callable[[Any], Outcome]


@dataclass(frozen=True, slots=True)
class Contender:
    """A method.

    Attributes:
        name: as it is asked for.
        method, formulation: as the JSON has them.
        label: as tables have it.
        begin: from a scene, N and the seconds that a solve may take to a run; raises SceneError where it is refused.
        largest: size up to which the method goes if no sizes are named.
        tolerance: largest residual with which a peer's solve counts as completed; None for the project's own methods,
            which certify themselves.
        ratios: clocks of the ratios of the method's time to the time of CPRBM ``paper``.
        look: colour and marker of a peer's points in figures.
        absence: why the method cannot take part on this machine; empty if it can.
    """

    name: Name
    method: str
    formulation: str | None
    label: str
    begin: Callable[[Scene, Count, float], Run]
    largest: int = 160
    tolerance: float | None = None
    ratios: tuple[Clocked, ...] = ()
    look: tuple[str, str] = ("#606060", "x")
    absence: str = ""

    @property
    def is_peer(self) -> bool:
        """True for an optimiser on the problem of CPRBM ``paper``, which knows the last station alone."""
        return self.tolerance is not None


def contenders(solvers: Solvers, choices: Choices) -> tuple[Contender, ...]:
    """The project's own methods, in the order of ``OURS``."""
    auto, paper = replace(choices, formulation="auto"), replace(choices, formulation="paper")
    return (
        Contender(
            "auto",
            "cprbm",
            "auto",
            "CPRBM auto",
            _ours(solvers.cprbm, auto),
            largest=5120,
            ratios=("both",),
        ),
        Contender("paper", "cprbm", "paper", "CPRBM paper", _ours(solvers.cprbm, paper), largest=640),
        Contender("fea", "fea", None, f"FEA {choices.kinematics}", _ours(solvers.fea, choices), largest=1280),
    )


def mean(count: Count) -> float:
    """N: links or elements per beam, on average where beams have numbers of their own."""
    return float(count) if isinstance(count, int) else sum(count.values()) / len(count)


def _ours(solver: Solver, choices: Choices) -> Callable[[Scene, Count, float], Run]:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # a penalty whose error falls with the elements' own
        chosen = replace(choices.of_size(round(mean(count))), links=count, elements=count)
        return Run(lambda: prepared(solver, scene, chosen), _of_answer)

    return begin


def _of_answer(answer: Answer) -> Outcome:
    return Outcome(
        ended=answer.ending.name,
        why="" if answer.completed else answer.sentence,
        iterations=tuple(station.certificate.iterations for station in answer.stations),
        values=answer.stations[-1].values if answer.completed and answer.stations else frozendict(),
    )
