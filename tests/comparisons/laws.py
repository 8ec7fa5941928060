"""Made-up solvers with laws of the error against N, and changes of answers by size."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from cprbm_scene import Ending
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp


@dataclass
class Noting:
    """A solver with a list of its questions."""

    solver: MadeUp
    asked: list

    def __hash__(self):
        return id(self)

    def __call__(self, scene, choices):
        one = self.solver.solver == "cprbm"
        mine = (choices.links, choices.formulation) if one else (choices.elements, choices.kinematics)
        self.asked.append((scene.name, choices.theory, *mine, None if one else choices.penetration))
        return self.solver(scene, choices)


class Scattered(MadeUp):
    """A solver with an error at random in N: the error at an N predicts no error at another N."""

    def __call__(self, scene, choices):
        count = choices.links if self.solver == "cprbm" else choices.elements
        spread = replace(self, error=1e-3 * (1 + count // 10 % 3) * (count / 40.0) ** 2)
        return MadeUp.__call__(spread, scene, choices)


@dataclass
class Falling:
    """A made-up solid with the error C (20/n)^p and a list of its questions."""

    C: float
    p: float
    until: int | None = None
    asked: list = field(default_factory=list)

    def __hash__(self):
        return id(self)

    def __call__(self, scene, choices):
        n = choices.elements
        self.asked.append((n, choices.across))
        error = self.C * (20.0 / n) ** self.p
        made = MadeUp("fea", error * (n / 40.0) ** 2)(scene, choices.within("bending"))
        made = replace(made, solver="solid", settings={"elements": n, "across": choices.across})
        if self.until is not None and n < self.until:
            return replace(made, ending=Ending.STEP_TOO_SMALL, stations=made.stations[:1])
        return made


def of_stage(hinge):
    """The hinge where its made-up contact has closed."""
    stage = hinge.stages[0].model_copy(update={"stations": (0.402, 0.536, 0.67), "shown": ()})
    return hinge.model_copy(update={"stages": (stage,), "claims": ()})


def changed(solver, change, *, at_most):
    """The solver with its answers changed at sizes up to ``at_most``."""

    def answer(scene, choices):
        found = solver(scene, choices)
        return change(found) if choices.links <= at_most else found

    return answer


def with_value(probe, value):
    """A change of an answer: one value at every station."""

    def changed(answer):
        stations = tuple(
            replace(station, values=frozendict({**station.values, probe: frozen_array(value)}))
            for station in answer.stations
        )
        return replace(answer, stations=stations)

    return changed
