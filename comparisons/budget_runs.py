"""The runs of an error budget, and which of them another question has had answered already.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
N, n        links and elements of the choices
p           the penetration of the choices
==========  ================================================================================================

The CPRBM runs as it was chosen and, in ``auto``, at N, 2N and 4N.  The finite elements run in the chosen theory at n
elements and p, p/4 and p/16; and in every theory up to the chosen one at n elements and p/16 and at 2n and p/256.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from frozendict import frozendict

from comparisons.choices import KINEMATICS, Choices, Count, Kinematics, check
from comparisons.pairing import ALONE, Crew, Solvers, in_paper
from scene import Answer, Scene

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
        kinematics: the beam theory that was chosen for the reference.
        cprbm: at N links, in the formulation that was chosen.
        auto: in the formulation ``auto``, at each of :data:`LEVELS`.
        paper: in ``paper`` at N; None where that cannot be asked. No sum contains it unless it was chosen.
        penalty: the finite elements in the chosen theory at n elements and each of :data:`TIGHTNESS`.
        fea: by theory, from ``bending`` up to the chosen one: at n elements and the last of those penetrations, and
            finer, at each of :data:`ELEMENTS` and with :data:`DEEPER` times its penetration.
    """

    kinematics: Kinematics
    cprbm: Answer
    auto: tuple[Answer, ...]
    paper: Answer | None
    penalty: tuple[Answer, ...]
    fea: Mapping[Kinematics, tuple[Answer, ...]]

    @property
    def reference(self) -> Answer:
        """The finite elements' answer in the chosen theory at n elements and p."""
        return self.penalty[0]

    def everything(self) -> Iterator[tuple[str, Answer]]:
        """Every answer that the sums are made of, with a name that says what it is."""
        yield "cprbm", self.cprbm
        for level, answer in zip(LEVELS, self.auto, strict=True):
            yield f"cprbm auto at {level} N", answer
        for tightness, answer in zip(TIGHTNESS, self.penalty, strict=True):
            yield f"fea {self.kinematics} at p/{tightness}", answer
        for kinematics, answers in self.fea.items():
            for times, answer in zip(ELEMENTS, answers, strict=True):
                yield f"fea {kinematics} at {times} n", answer


Asked = tuple[Literal["cprbm", "fea"], Choices]
"""A solver, and choices that differ from the standard ones only in what it heeds."""


def asked(solver: Literal["cprbm", "fea"], choices: Choices) -> Asked:
    """What a solver is asked by some choices: equal where it cannot tell them apart."""
    if solver == "cprbm":
        return solver, Choices(links=_frozen(choices.links), formulation=choices.formulation)
    return solver, Choices(
        elements=_frozen(choices.elements), kinematics=choices.kinematics, penetration=choices.penetration
    )


def budgeted(
    scene: Scene,
    choices: Choices,
    solvers: Solvers,
    crew: Crew = ALONE,
    known: Mapping[Asked, Answer] | None = None,
) -> BudgetRuns:
    """Run both solvers on a scene as often as its error budget needs.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        solvers: who answers.
        crew: processes to share the runs.
        known: answers to this scene by :func:`asked`; what is there is not run again.

    Raises:
        SceneError: a solver refuses the question.
    """
    check(choices, scene)
    even = replace(choices, formulation="auto")
    tight = [replace(choices, penetration=choices.penetration / tightness) for tightness in TIGHTNESS]
    theories = KINEMATICS[: KINEMATICS.index(choices.kinematics) + 1]
    cprbm = [asked("cprbm", choices)]
    auto = [asked("cprbm", each) for each in (even, even.finer(), even.finer().finer())]
    penalty = [asked("fea", each) for each in tight]
    fea = [asked("fea", each.within(theory)) for theory in theories for each in (tight[-1], tight[-1].finer())]
    answers = dict(known or {})
    missing = [each for each in dict.fromkeys((*cprbm, *auto, *penalty, *fea)) if each not in answers]
    functions = {"cprbm": solvers.cprbm, "fea": solvers.fea}
    found = crew.answers([(functions[solver], scene, own) for solver, own in missing])
    answers.update(zip(missing, found, strict=True))
    per_theory = len(ELEMENTS)
    return BudgetRuns(
        choices.kinematics,
        answers[cprbm[0]],
        tuple(answers[each] for each in auto),
        answers[cprbm[0]] if choices.formulation == "paper" else in_paper(scene, choices, solvers),
        tuple(answers[each] for each in penalty),
        frozendict(
            {
                theory: tuple(answers[each] for each in fea[place * per_theory : (place + 1) * per_theory])
                for place, theory in enumerate(theories)
            }
        ),
    )


def _frozen(count: Count) -> Count:
    return count if isinstance(count, int) else frozendict(count)
