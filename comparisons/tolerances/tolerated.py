"""A scene answered within a tolerance: by one solver, or by both for a comparison.

The finite elements are asked first, in every theory whose uncertainty a row states (the chosen one and ``bending``);
what their values are is what the CPRBM's and the solid's uncertainties are fractions of, as in the rows of the
comparison.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from comparisons.bench.timing import LARGEST, Method
from comparisons.choices import KINEMATICS, Choices, Kinematics
from comparisons.crew import Crew
from comparisons.pairing import Runs, Solvers, Uncertainties, known_exactly, paired, with_solid
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

    def settled(self, theory: Kinematics) -> Settled:
        """The values settled on n/2, n and 2n."""
        return self.levels.pair(theory, self.found.n, self.found.estimate.extrapolated)

    def value(self, theory: Kinematics) -> Answer:
        """The answer."""
        return self.settled(theory).answer if self.found.settled else self.levels.answer(theory, self.found.n)


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
    theory: Kinematics = choices.kinematics if solver == "fea" else "bending"
    reached = _reached(scene, solver, choices, (theory,), tolerance, memory, None)
    return reached.value(theory), _tolerance(reached, solver, tolerance)


def paired_within(
    scene: Scene, choices: Choices, tolerance: float, solvers: Solvers, crew: Crew, say: Callable[[str], None]
) -> tuple[Runs, tuple[Tolerance, ...]]:
    """What a comparison rests on, with all solvers within a tolerance, and what their searches came to.

    The arguments are those of :func:`solved`, and processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    memory = AnswerMemory(pool=crew.pool, solvers=solvers, say=say)
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
    theories: tuple[Kinematics, ...] = tuple(dict.fromkeys(("bending", choices.kinematics)))
    fea = _reached(scene, "fea", choices, theories, tolerance, memory, None)
    cprbm = _reached(scene, "cprbm", choices, ("bending",), tolerance, memory, fea.value(choices.kinematics))
    tolerances = _tolerance(cprbm, "cprbm", tolerance), _tolerance(fea, "fea", tolerance)
    if cprbm.found.settled:
        driven, n, pair = perturbed_scene(scene), cprbm.found.n, cprbm.settled("bending")
        families, uncertainties = _families(fea, choices.kinematics)
        exact, exact_absence = known_exactly(scene, choices, solvers, memory)
        return Runs(
            choices.kinematics,
            (pair.answer, pair.coarse),
            families,
            beside=cprbm.levels.beside_it(n),
            ratio=cprbm.levels.ratio(n),
            perturbed=None if driven is None else _perturbed(cprbm, driven),
            exact=exact,
            exact_absence=exact_absence,
            settled=frozendict({"cprbm": pair.uncertainties, **uncertainties}),
        ), tolerances
    elements = fea.levels.choices(choices.kinematics, fea.found.n)
    runs = paired(scene, replace(elements, links=cprbm.found.n, formulation=choices.formulation), solvers, memory)
    if fea.found.settled:
        families, uncertainties = _families(fea, choices.kinematics)
        runs = replace(runs, fea=families, fea_beside=None, settled=frozendict(uncertainties))
    return runs, tolerances


def _reached(
    scene: Scene,
    solver: Method,
    choices: Choices,
    theories: tuple[Kinematics, ...],
    tolerance: float,
    memory: AnswerMemory,
    reference: Answer | None,
) -> _Reached:
    is_cprbm = solver == "cprbm"
    paper = is_cprbm and choices.formulation == "paper"
    answers = memory.solvers.cprbm if is_cprbm else memory.solvers.fea
    levels = SceneLevels(scene, answers, choices, theories, memory, beside=is_cprbm, reference=reference)
    largest = 2 * LARGEST_PAPER if paper else LARGEST[solver]
    found = search(levels, tolerance, largest, extrapolates=not paper)
    return _Reached(levels, found)


def _families(
    fea: _Reached, chosen: Kinematics
) -> tuple[Mapping[Kinematics, tuple[Answer, ...]], dict[str, Uncertainties]]:
    """The finite elements' answers by theory, in a theory between alone, and the uncertainties of settled ones."""
    families: dict[Kinematics, tuple[Answer, ...]] = {}
    uncertainties: dict[str, Uncertainties] = {}
    for kinematics in KINEMATICS[: KINEMATICS.index(chosen) + 1]:
        if kinematics not in fea.levels.theories:
            families[kinematics] = (_between(fea, kinematics),)
        elif fea.found.settled:
            pair = fea.settled(kinematics)
            families[kinematics] = pair.answer, pair.coarse
            uncertainties[f"fea {kinematics}"] = pair.uncertainties
        else:
            n = fea.found.n
            families[kinematics] = fea.levels.answer(kinematics, n), fea.levels.answer(kinematics, 2 * n)
    return frozendict(families), uncertainties


def _between(fea: _Reached, kinematics: Kinematics) -> Answer:
    return replace(fea, levels=replace(fea.levels, theories=(kinematics,))).value(kinematics)


def _perturbed(cprbm: _Reached, driven: Scene) -> Answer:
    """The settled answer at the perturbed stations, its energies settled as the energies of the scene."""
    return replace(cprbm, levels=replace(cprbm.levels, scene=driven, reference=None)).value("bending")


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
