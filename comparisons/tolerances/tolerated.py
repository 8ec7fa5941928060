"""A scene answered within a tolerance: by one solver, or by both for a comparison.

The finite elements are asked first: the uncertainties of the CPRBM and of the solid are fractions of their values, as
in the rows of the comparison.  Both beam solvers answer in one theory.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from comparisons.bench.timing import LARGEST, Method
from comparisons.choices import Choices
from comparisons.crew import Crew
from comparisons.pairing import Runs, Solvers, in_other_theory, paired, with_solid
from comparisons.reactions import perturbed_scene
from comparisons.store import AnswerMemory
from comparisons.tolerances.levels import SceneLevels
from comparisons.tolerances.search import Found, Tolerance, search
from comparisons.tolerances.settled import Settled
from comparisons.tolerances.solids import meshed, settled
from comparisons.verdict.completeness import problems
from comparisons.verdict.rows import rows_of
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict

LARGEST_PAPER = 640
"""Most links in the formulation ``paper``, whose time grows with the cube of N; ``auto`` beside it has twice that."""


@dataclass(frozen=True, slots=True)
class _Reached:
    """Where a search has ended, with the levels that it went through."""

    levels: SceneLevels
    found: Found

    @property
    def settled(self) -> Settled:
        """The values settled on n/2, n and 2n."""
        return self.levels.pair(self.found.n, self.found.estimate.extrapolated)

    @property
    def value(self) -> Answer:
        """The answer."""
        return self.settled.answer if self.found.settled else self.levels.answer(self.found.n)


def solved(
    scene: Scene,
    solver: Literal["cprbm", "fea", "solid"],
    choices: Choices,
    tolerance: float,
    solvers: Solvers,
    say: Callable[[str], None],
) -> tuple[Answer, Tolerance]:
    """One solver's answer within a tolerance, or the best that was solved.

    Args:
        scene: the question.
        solver: who is asked.
        choices: formulation, theory and the penetration at the fewest elements; its numbers do not count.
        tolerance: of every row's stated uncertainty, a fraction.
        solvers: who answers.
        say: called with a description of the next solve.

    Raises:
        SceneError: the solver refuses the question.
    """
    if solver == "solid":
        solvers = with_solid(solvers)
        assert solvers.solid is not None
        found = meshed(scene, solvers.solid, choices, tolerance, AnswerMemory(solvers=solvers, say=say))
        return settled(scene, found.answers), found.reached
    memory = AnswerMemory(solvers=solvers, say=say)
    theory = choices.kinematics_of(scene) if solver == "fea" else choices.theory_of(scene)
    reached = _reached(scene, solver, choices.within(theory), tolerance, memory, None)
    return reached.value, _tolerance(reached, solver, tolerance)


def paired_within(
    scene: Scene, choices: Choices, tolerance: float, solvers: Solvers, crew: Crew, say: Callable[[str], None]
) -> tuple[Runs, tuple[Tolerance, ...]]:
    """What a comparison rests on, with all solvers within a tolerance, and what their searches came to.

    The arguments are those of :func:`solved`, and processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    memory = AnswerMemory(pool=crew.pool, solvers=solvers, say=say)
    choices = choices.within(choices.kinematics_of(scene))
    runs, reached = _both_within(scene, choices, tolerance, replace(solvers, solid=None), memory)
    if solvers.solid is None:
        return runs, reached
    whole = not any(problems(scene, answer) for _, answer in runs.everything())
    rows = rows_of(scene, runs) if whole else None
    third = meshed(scene, solvers.solid, choices, tolerance, memory, rows)
    return replace(runs, solid=third.answers), (*reached, third.reached)


def _both_within(
    scene: Scene, choices: Choices, tolerance: float, solvers: Solvers, memory: AnswerMemory
) -> tuple[Runs, tuple[Tolerance, Tolerance]]:
    fea = _reached(scene, "fea", choices, tolerance, memory, None)
    cprbm = _reached(scene, "cprbm", choices, tolerance, memory, fea.value)
    tolerances = _tolerance(cprbm, "cprbm", tolerance), _tolerance(fea, "fea", tolerance)
    chosen = replace(fea.levels.choices(fea.found.n), links=cprbm.found.n)
    runs = paired(scene, chosen, solvers, memory, bare=cprbm.found.settled)
    if fea.found.settled:
        pair = fea.settled
        settled_runs = frozendict({"fea": pair.uncertainties})
        runs = replace(runs, fea=(pair.answer, pair.coarse), fea_beside=None, settled=settled_runs)
    if cprbm.found.settled:
        driven, pair = perturbed_scene(scene), cprbm.settled
        other, other_absence = in_other_theory(scene, chosen, solvers)
        runs = replace(
            runs,
            cprbm=(pair.answer, pair.coarse),
            other=other,
            other_absence=other_absence,
            perturbed=None if driven is None else _perturbed(cprbm, driven),
            settled=frozendict({**runs.settled, "cprbm": pair.uncertainties}),
        )
    return runs, tolerances


def _reached(
    scene: Scene,
    solver: Method,
    choices: Choices,
    tolerance: float,
    memory: AnswerMemory,
    reference: Answer | None,
) -> _Reached:
    is_cprbm = solver == "cprbm"
    paper = is_cprbm and choices.formulation == "paper"
    answers = memory.solvers.cprbm if is_cprbm else memory.solvers.fea
    levels = SceneLevels(scene, answers, choices, memory, beside=is_cprbm, reference=reference)
    largest = 2 * LARGEST_PAPER if paper else LARGEST[solver]
    found = search(levels, tolerance, largest, extrapolates=not paper)
    return _Reached(levels, found)


def _perturbed(cprbm: _Reached, driven: Scene) -> Answer:
    """The settled answer at the perturbed stations, its energies settled as the energies of the scene."""
    return replace(cprbm, levels=replace(cprbm.levels, scene=driven, reference=None)).value


def _tolerance(reached: _Reached, solver: Method, tolerance: float) -> Tolerance:
    found, levels = reached.found, reached.levels
    estimate = found.estimate
    return Tolerance(
        asked=tolerance,
        met=found.met,
        solver=solver,
        n=2 * found.n if found.settled else found.n,
        worst=None if estimate.trouble else estimate.worst,
        trouble=estimate.trouble,
        extrapolated=(found.n, 2 * found.n) if estimate.extrapolated else (),
        probes=tuple(sorted(estimate.extrapolated)),
        solved=levels.solved(),
    )
