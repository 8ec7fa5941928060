"""The runs of an error budget.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
N, n        links and elements of the choices
p           the penetration of the choices
==========  ================================================================================================

All runs have one beam theory.  The CPRBM runs as it was chosen and, in ``auto``, at N, 2N and 4N.  The finite elements
run at n elements and p, p/4 and p/16, and at 2n elements and p/256.
Where the solid is among the solvers it runs at n and 2n elements along, and m and 2m across.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

from comparisons.choices import Choices, Kinematics, check
from comparisons.pairing import in_paper
from comparisons.store import AnswerMemory
from cprbm_scene import Answer, Scene

LEVELS = (1, 2, 4)
"""Links over N."""

ELEMENTS = (1, 2)
"""Elements over n."""

DEEPER = (1.0, 1.0 / 16.0)
"""Penetration over that at n elements, for each of them; as :meth:`Choices.finer` has it."""

TIGHTNESS = (1, 4, 16)
"""p over the penetration of a run."""


@dataclass(frozen=True, slots=True)
class BudgetRuns:
    """All answers to one scene that its error budget rests on.

    Attributes:
        theory: the beam theory.
        cprbm: at N links, in the formulation that was chosen.
        auto: in the formulation ``auto``, at each of :data:`LEVELS`.
        paper: in ``paper`` at N; None where that cannot be asked. No sum contains it unless it was chosen.
        penalty: the finite elements at n elements and each of :data:`TIGHTNESS`.
        fea: the finite elements at n elements and the last of those penetrations, and finer, at each of
            :data:`ELEMENTS` and with :data:`DEEPER` times its penetration.
        solid: the mechanism as a solid, at each of :data:`ELEMENTS`; None where it was not asked. No sum contains it.
    """

    theory: Kinematics
    cprbm: Answer
    auto: tuple[Answer, ...]
    paper: Answer | None
    penalty: tuple[Answer, ...]
    fea: tuple[Answer, ...]
    solid: tuple[Answer, Answer] | None = None

    @property
    def reference(self) -> Answer:
        """The finite elements' answer at n elements and p."""
        return self.penalty[0]

    def everything(self) -> Iterator[tuple[str, Answer]]:
        """Every answer that the sums are made of, with a name that says what it is."""
        yield "cprbm", self.cprbm
        for level, answer in zip(LEVELS, self.auto, strict=True):
            yield f"cprbm auto at {level} N", answer
        for tightness, answer in zip(TIGHTNESS, self.penalty, strict=True):
            yield f"fea at p/{tightness}", answer
        for times, answer in zip(ELEMENTS, self.fea, strict=True):
            yield f"fea at {times} n", answer


def budgeted(scene: Scene, choices: Choices, memory: AnswerMemory) -> BudgetRuns:
    """Run both solvers on a scene as often as its error budget needs.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        memory: who answers; what it knows already is not run again.

    Raises:
        SceneError: a solver refuses the question.
    """
    check(choices, scene)
    theory = choices.kinematics_of(scene)
    choices = choices.within(theory)
    even = replace(choices, formulation="auto")
    tight = [replace(choices, penetration=choices.penetration / tightness) for tightness in TIGHTNESS]
    finest = even.finer().finer()
    cprbm, fea, solid = memory.solvers.cprbm, memory.solvers.fea, memory.solvers.solid
    found = iter(
        memory.answers(
            [
                *((cprbm, scene, own) for own in (choices, even, even.finer(), finest)),
                *((fea, scene, own) for own in tight),
                *((fea, scene, own) for own in _both(tight[-1])),
                *((solid, scene, own) for own in _both(choices) if solid is not None),
            ]
        )
    )
    chosen = next(found)
    return BudgetRuns(
        theory,
        chosen,
        tuple(islice(found, len(LEVELS))),
        chosen if choices.formulation == "paper" else in_paper(scene, choices, memory.solvers),
        tuple(islice(found, len(TIGHTNESS))),
        tuple(islice(found, len(ELEMENTS))),
        None if solid is None else (next(found), next(found)),
    )


def _both(choices: Choices) -> tuple[Choices, Choices]:
    """At each of :data:`ELEMENTS`."""
    return choices, choices.finer()
