"""Who takes part: the project's solvers and the peers, each as a set-up, a solve, and what is made of its result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from comparisons.choices import Choices, Count
from comparisons.converging.families import at
from comparisons.pairing import Solver, Solvers, discretised, prepared
from comparisons.peers import ipopt, slsqp, trust_constr
from comparisons.peers.judged import judged
from comparisons.peers.solving import Optimiser, Solved
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

Name = Literal["auto", "paper", "fea", "slsqp", "trust-constr", "ipopt"]
NAMES: tuple[Name, ...] = ("auto", "paper", "fea", "slsqp", "trust-constr", "ipopt")
PEERS: tuple[Name, ...] = ("slsqp", "trust-constr", "ipopt")

LARGEST: Mapping[Name, int] = frozendict(
    {"auto": 5120, "paper": 640, "fea": 1280, "slsqp": 80, "trust-constr": 160, "ipopt": 160}
)
"""Up to which size each goes if no sizes are named."""


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
    """One run: ``set_up`` and then ``solve`` what it hands back, both on the clock; ``told`` of the result is not."""

    set_up: Callable[[], Callable[[], Any]]
    told: Callable[[Any], Outcome]


@dataclass(frozen=True, slots=True)
class Contender:
    """A method.

    Attributes:
        name: as it is asked for.
        method, formulation: as the JSON has them.
        label: as tables have it.
        begin: from a scene, N and the seconds that a solve may take to a run; raises SceneError where it is refused.
    """

    name: Name
    method: str
    formulation: str | None
    label: str
    begin: Callable[[Scene, Count, float], Run]


def contenders(names: tuple[Name, ...], solvers: Solvers, choices: Choices) -> tuple[Contender, ...]:
    """The methods of some names, in the order of ``NAMES``."""
    every: dict[Name, Contender] = {
        "auto": Contender(
            "auto", "cprbm", "auto", "CPRBM auto", _ours(solvers.cprbm, replace(choices, formulation="auto"))
        ),
        "paper": Contender(
            "paper", "cprbm", "paper", "CPRBM paper", _ours(solvers.cprbm, replace(choices, formulation="paper"))
        ),
        "fea": Contender("fea", "fea", None, f"FEA {choices.kinematics}", _ours(solvers.fea, choices)),
        "slsqp": Contender("slsqp", "slsqp", "paper", "SLSQP", _peer(slsqp.prepared)),
        "trust-constr": Contender(
            "trust-constr", "trust-constr", "paper", "trust-constr", _peer(trust_constr.prepared)
        ),
        "ipopt": Contender("ipopt", "ipopt", "paper", "IPOPT", _peer(ipopt.prepared)),
    }
    return tuple(every[name] for name in NAMES if name in names)


def mean(count: Count) -> float:
    """N: links or elements per beam, on average where beams have numbers of their own."""
    return float(count) if isinstance(count, int) else sum(count.values()) / len(count)


def missing(name: Name) -> str:
    """Why a method cannot take part on this machine; empty if it can."""
    if name == "ipopt" and not ipopt.there():
        return "CasADi is not installed (the extra 'peers')"
    return ""


def _ours(solver: Solver, choices: Choices) -> Callable[[Scene, Count, float], Run]:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # a penalty whose error falls with the elements' own
        chosen = replace(at(choices, round(mean(count))), links=count, elements=count)
        return Run(lambda: prepared(solver, scene, chosen), _of_answer)

    return begin


def _of_answer(answer: Answer) -> Outcome:
    return Outcome(
        ended=answer.ending.name,
        why="" if answer.completed else answer.sentence,
        iterations=tuple(station.certificate.iterations for station in answer.stations),
        values=answer.stations[-1].values if answer.completed and answer.stations else frozendict(),
    )


def _peer(optimiser: Optimiser) -> Callable[[Scene, Count, float], Run]:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # cutting beams into links is no part of an optimiser's time
        problem = discretised(scene, count)

        def told(solved: Solved) -> Outcome:
            found = judged(scene, problem, solved)
            return Outcome(found.ended, found.why, (solved.iterations,), found.values, found.residual)

        return Run(lambda: optimiser(problem, at_most), told)

    return begin
