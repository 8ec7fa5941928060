"""A crew that solves nothing twice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

from comparisons.choices import Choices, Count
from comparisons.pairing import Crew, Decided, Job, Solver, Solvers
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict


def _silent(text: str) -> None:
    """Say nothing."""


@dataclass(frozen=True, slots=True)
class Remembering(Crew):
    """A crew with a memory of what ``solvers`` have answered.

    Attributes:
        solvers: so that of a run's choices those count that its solver looks at.
        say: called with a description of the next solve.
        known: every answer so far.
    """

    solvers: Solvers = field(default_factory=Solvers)
    say: Callable[[str], None] = _silent
    known: dict[Job, Answer] = field(default_factory=dict)

    def answers(self, jobs: list[Job]) -> list[Answer]:
        """The answers to some jobs, in their order; only those not known yet are solved.

        Raises:
            SceneError: a solver refuses one.
        """
        keys = [self._key(job) for job in jobs]
        new = {key: job for key, job in zip(keys, jobs, strict=True) if key not in self.known}
        if new:
            self.say("; ".join(dict.fromkeys(self._description(job) for job in new.values())))
            # not super(), which a class with slots does not know
            self.known.update(zip(new, Crew.begin(self, list(new.values()))(), strict=True))
        return [self.known[key] for key in keys]

    def begin(self, jobs: list[Job], decided: Decided | None = None) -> Callable[[], list[Answer]]:
        """As of any crew; nothing is done before the answers are asked for, since what is known changes till then.

        All jobs are solved then, whatever is ``decided``.
        """
        return partial(self.answers, jobs)

    def sizes(self, solver: Solver, scene: Scene) -> tuple[int, ...]:
        """Every number of links or elements at which a solver has answered a scene, ascending."""
        mine = [choices for who, what, choices in self.known if who == solver and what == scene]
        counts = [choices.links if solver == self.solvers.cprbm else choices.elements for choices in mine]
        return tuple(sorted({count for count in counts if isinstance(count, int)}))

    def _key(self, job: Job) -> Job:
        solver, scene, choices = job
        nothing = Choices()
        if solver == self.solvers.cprbm:
            return solver, scene, replace(nothing, links=_frozen(choices.links), formulation=choices.formulation)
        elements = _frozen(choices.elements)
        if solver == self.solvers.solid:
            return solver, scene, replace(nothing, elements=elements, across=choices.across)
        beams = replace(nothing, elements=elements, kinematics=choices.kinematics, penetration=choices.penetration)
        return solver, scene, beams

    def _description(self, job: Job) -> str:
        solver, scene, choices = job
        if solver == self.solvers.exact:
            return f"{scene.name}: exact"
        if solver == self.solvers.cprbm:
            return f"{scene.name}: CPRBM {choices.formulation}, N = {choices.links}"
        if solver == self.solvers.solid:
            return f"{scene.name}: solid, {choices.elements} × {choices.across} elements"
        return f"{scene.name}: FEA {choices.kinematics}, {choices.elements} elements"


def _frozen(count: Count) -> Count:
    return count if isinstance(count, int) else frozendict(count)
