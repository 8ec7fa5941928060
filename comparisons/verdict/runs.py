"""All answers to one scene in a comparison, by the part that each takes in the verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from comparisons.choices import Kinematics
from comparisons.verdict.uncertainty import Error
from cprbm_scene import Answer
from cprbm_scene.frozendict import frozendict

Solver = Literal["cprbm", "fea"]
SOLVERS: tuple[Solver, ...] = ("cprbm", "fea")
"""The solvers, and the names of the two compared runs."""

Uncertainties: TypeAlias = Mapping[tuple[str, float, str], Error]
"""Stated uncertainties by stage, station and probe."""


@dataclass(frozen=True, slots=True)
class Runs:
    """All answers to one scene in a comparison; a failed run is a failed answer.

    Attributes:
        theory: beam theory of the comparison.
        cprbm: the CPRBM at N and 2N links, at 2N always in the formulation ``auto``; at N alone where the answers at N
            and n have nothing in common.
        fea: the finite elements at n and 2n elements; at n alone likewise.
        auto: the CPRBM at N links in ``auto``, if another formulation is chosen.
        paper: the CPRBM at N links in ``paper`` and in ``bending``, beside ``auto``; no part of the verdict.
        beside: the CPRBM in ``auto`` at N + N/7 links.
        ratio: N over N + N/7.
        fea_beside: the finite elements at n + n/7.
        fea_ratio: n over n + n/7.
        other: the CPRBM at N links in ``auto`` in :attr:`other_theory`; None without this run.
        other_absence: why the CPRBM refuses the other theory; empty otherwise.
        perturbed: the CPRBM at N links at :func:`comparisons.reactions.perturbed_scene`; no part of the verdict.
        exact: the exact answer at the covered stations; None without any, and outside ``bending``.
        exact_absence: why the exact reference covers no station; empty if the reference was not asked.
        solid: the solid at n and 2n elements, or on the meshes of a tolerance, from coarse to fine; no part of the
            verdict.
        settled: stated uncertainties by stage, station and probe, by name of a run with extrapolated values or further
            grids.
    """

    theory: Kinematics
    cprbm: tuple[Answer, ...]
    fea: tuple[Answer, ...]
    auto: Answer | None = None
    paper: Answer | None = None
    beside: Answer | None = None
    ratio: float = 1.0
    fea_beside: Answer | None = None
    fea_ratio: float = 1.0
    other: Answer | None = None
    other_absence: str = ""
    perturbed: Answer | None = None
    exact: Answer | None = None
    exact_absence: str = ""
    solid: tuple[Answer, ...] | None = None
    settled: Mapping[str, Uncertainties] = frozendict()

    @property
    def reference(self) -> Answer:
        """The finite elements' answer at n elements."""
        return self.fea[0]

    @property
    def other_theory(self) -> Kinematics:
        """``bending``, the paper's theory; ``shear`` where the comparison is in ``bending``."""
        return other_theory(self.theory)

    @property
    def formulations(self) -> tuple[Answer, Answer] | None:
        """The CPRBM at N links in ``paper`` and in ``auto``, in one theory; None without both runs."""
        if self.auto is not None:
            return self.cprbm[0], self.auto
        even = self.cprbm[0] if self.theory == "bending" else self.other
        return None if self.paper is None or even is None else (self.paper, even)

    def everything(self) -> Iterator[tuple[str, Answer]]:
        """Names and answers of all runs in the theory of the comparison."""
        for name, answers in (("cprbm", self.cprbm), ("fea", self.fea)):
            for level, answer in enumerate(answers):
                yield f"{name} finer" if level else name, answer
        others = {"cprbm auto": self.auto, "cprbm beside": self.beside, "fea beside": self.fea_beside}
        yield from ((name, answer) for name, answer in others.items() if answer is not None)


def other_theory(theory: Kinematics) -> Kinematics:
    """``bending``, the paper's theory; ``shear`` for ``bending``."""
    return "shear" if theory == "bending" else "bending"
