"""N for a tolerance: N doubles until every stated uncertainty is within the tolerance.

The symbols are those of :mod:`comparisons.tolerances.result`.  Values and uncertainties at an N follow from the
answers at N/4, N/2 and N, of the CPRBM also at N/2 + N/14
(:mod:`comparisons.tolerances.limits`).  No answer is solved twice.

The finite elements come first, in the theory of the CPRBM.  Their values are the denominators of the other
solvers' f; where a solver is asked alone, its own values are.  The solid has an element across the thickness for every
20 along.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from comparisons.choices import Choices
from comparisons.crew import Crew, Job
from comparisons.pairing import Solvers, exact_or_why, in_other_theory, paired, with_solid
from comparisons.reactions import perturbed_scene
from comparisons.sentences import problem_sentences
from comparisons.store import AnswerMemory
from comparisons.tolerances.limits import Limits, limits_of
from comparisons.tolerances.result import (
    ENOUGH,
    FIRST,
    LARGEST,
    LARGEST_PAPER,
    Level,
    SolverName,
    Stated,
    Tolerance,
    worst_row,
)  # fmt: skip
from comparisons.verdict.rows import Row, rows_of
from comparisons.verdict.runs import Runs
from comparisons.verdict.station_events import Place
from cprbm_scene import Answer, Scene, SceneError
from cprbm_scene.frozendict import frozendict


def solve_within(
    scene: Scene, solver: SolverName, choices: Choices, tolerance: float, solvers: Solvers, say: Callable[[str], None]
) -> tuple[Answer, Tolerance]:
    """One solver's answer within a tolerance, or the answer at the last N.

    Args:
        scene: the question.
        solver: the solver.
        choices: formulation, theory, and the penetration at N = 40.
        tolerance: τ.
        solvers: functions of the solvers.
        say: called with a description of the next solve.

    Raises:
        SceneError: the solver refuses the question.
    """
    memory = AnswerMemory(solvers=with_solid(solvers) if solver == "solid" else solvers, say=say)
    theory = choices.kinematics_of(scene) if solver == "fea" else choices.theory_of(scene)
    search = _Search(scene, solver, choices.within(theory), memory)
    return search.run(tolerance), search.result(tolerance)


def runs_within(
    scene: Scene, choices: Choices, tolerance: float, solvers: Solvers, crew: Crew, say: Callable[[str], None]
) -> tuple[Runs, tuple[Tolerance, ...]]:
    """The runs of a comparison with all solvers within a tolerance, and the results of the searches.

    Args:
        scene, choices, tolerance, solvers, say: as of :func:`solve_within`.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    memory = AnswerMemory(pool=crew.pool, solvers=solvers, say=say)
    choices = choices.within(choices.kinematics_of(scene))
    fea = _Search(scene, "fea", choices, memory)
    reference = fea.run(tolerance)
    cprbm = _Search(scene, "cprbm", choices, memory, reference)
    value = cprbm.run(tolerance)
    at_last = replace(fea.choices_at(fea.n), links=cprbm.n, formulation=choices.formulation)
    if cprbm.limits is not None and fea.limits is not None:
        own, driven = cprbm.limits, perturbed_scene(scene)
        other, other_absence = in_other_theory(scene, replace(at_last, links=cprbm.n // 2), solvers)
        known = [(solvers.exact, scene, choices)] if solvers.exact is not None and choices.theory == "bending" else []
        exact, exact_absence = exact_or_why(*memory.answers(known))
        runs = Runs(
            choices.kinematics_of(scene),
            (value, own.coarse),
            (fea.limits.answer, fea.limits.coarse),
            auto=own.answer if choices.formulation == "paper" else None,
            other=other,
            other_absence=other_absence,
            perturbed=None if driven is None else replace(cprbm, scene=driven, reference=None).at_last(),
            exact=exact,
            exact_absence=exact_absence,
            settled=frozendict({"cprbm": own.uncertainties, "fea": fea.limits.uncertainties}),
        )
    else:
        runs = paired(scene, at_last, replace(solvers, solid=None), memory)
    found = cprbm.result(tolerance), fea.result(tolerance)
    if solvers.solid is None:
        return runs, found
    solid = _Search(scene, "solid", choices, memory, reference if fea.limits else None)
    solid.run(tolerance)
    return replace(runs, solid=tuple(solid.answers.values())), (*found, solid.result(tolerance))


@dataclass(slots=True)
class _Search:
    """The search of one solver in one theory.

    Attributes:
        reference: the answer with the denominators; None for the solver's own answer.
        n: the present N; answers: at the present N and coarser; limits: of the answers, None in trouble.
        level: result at the present N.
    """

    scene: Scene
    solver: SolverName
    choices: Choices
    memory: AnswerMemory
    reference: Answer | None = None
    n: int = 0
    answers: dict[int, Answer] = field(default_factory=dict)
    limits: Limits | None = None
    level: Level = field(default_factory=lambda: Level(0, None))

    def run(self, tolerance: float) -> Answer:
        """The answer at the found N."""
        self.n = 2 * FIRST[self.solver]
        while True:
            try:
                value = self.at_last()
            except SceneError:  # few links may be too few for the joints of a formulation
                if self.n >= ENOUGH:
                    raise
                self.n *= 2
                continue
            if self.level.fraction <= tolerance or self.end(tolerance):
                return value
            self.n *= 2

    def end(self, tolerance: float) -> str:
        """Why N does not grow further; empty where N does."""
        return self.level.end(tolerance, LARGEST_PAPER if self._paper else LARGEST[self.solver])

    def at_last(self) -> Answer:
        """The answer at the present N, with limits as values unless a run ended early."""
        jobs = {size: self._job(size) for size in self._sizes()}
        paper = [(*self._job(self.n)[:2], self.choices_at(self.n))]
        found = self.memory.answers([*jobs.values(), *(paper if self._paper else ())])
        value = found.pop() if self._paper else None
        self.answers = dict(zip(jobs, found, strict=True))
        problems = {n: next(iter(problem_sentences(self.scene, each)), "") for n, each in self.answers.items()}
        trouble = problems[self.n // 2] or problems[self.n]
        if trouble:
            self.limits, self.level = None, Level(self.n, None, trouble)
            return value or self.answers[self.n]
        self.answers = {size: answer for size, answer in self.answers.items() if not problems[size]}
        self.limits = limits_of(self.scene, self.answers)
        self.level = Level(self.n, self._worst(self.limits, value))
        return value or self.limits.answer

    def result(self, tolerance: float) -> Tolerance:
        """Result of the search."""
        probes = () if self._paper or self.limits is None else self.limits.probes
        sizes = self.memory.sizes(getattr(self.memory.solvers, self.solver), self.scene)
        ended = "" if self.level.fraction <= tolerance else self.end(tolerance)
        return Tolerance(
            tolerance, self.solver, self.level, (self.n // 2, self.n) if probes else (), probes, sizes, ended
        )

    def choices_at(self, n: int) -> Choices:
        """The choices at N."""
        return replace(self.choices.of_size(n), across=max(n // FIRST["solid"], 1))

    @property
    def _paper(self) -> bool:
        return self.solver == "cprbm" and self.choices.formulation == "paper"

    def _sizes(self) -> list[int]:
        """N/4 unless below the first N, N/2 and N; of the CPRBM also N/2 + N/14."""
        doubled = [self.n >> k for k in range(3) if self.n >> k >= FIRST[self.solver]]
        third = [self.n // 2 + max(1, round(self.n / 14))] if self.solver == "cprbm" else []
        return sorted([*doubled, *third])

    def _job(self, size: int) -> Job:
        even = replace(self.choices_at(size), formulation="auto")
        return getattr(self.memory.solvers, self.solver), self.scene, even

    def _worst(self, limits: Limits, paper: Answer | None) -> Stated | None:
        """The row with the largest f, of a value in ``paper`` with the distance from ``auto``."""
        reference = self.reference or limits.answer
        runs = Runs(
            self.choices.kinematics_of(self.scene),
            (paper or limits.answer, limits.coarse),
            (reference, reference),
            auto=None if paper is None else limits.answer,
            settled=frozendict({"cprbm": limits.uncertainties}),
        )
        return worst_row((row, _fraction(row, limits)) for row in rows_of(self.scene, runs))


def _fraction(row: Row, limits: Limits) -> float | None:
    """f; None without a value and between events, infinite where the value exists at one N and not at another."""
    if row.place is Place.BETWEEN:
        return None
    if row.bounds is not None:
        return row.fraction(row.bounds.cprbm)
    shapes = {
        station.values[row.probe.name].shape
        for answer in (limits.answer, limits.coarse)
        for station in answer.stations
        if (station.stage, station.value) == row.where
    }
    return None if len(shapes) == 1 else math.inf
