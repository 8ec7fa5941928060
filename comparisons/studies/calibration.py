"""Both solvers' stated uncertainties beside their true errors, on every built-in case with an exact answer.

The exact answer is one of the theory ``bending``, in which the finite elements are therefore run.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from comparisons import cases
from comparisons.case import Verdict, compare
from comparisons.choices import Choices
from comparisons.crew import ALONE, Crew
from comparisons.pairing import Solvers, exact_if_covered, paired
from comparisons.verdict.calibration import ErrorRatio, Tally, error_ratios, tally
from comparisons.verdict.completeness import complete_part
from comparisons.verdict.runs import SOLVERS, Solver
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict

SIZES = ((17, 40), (20, 60), (40, 80), (80, 160))
"""Links per beam of the CPRBM and finite elements per beam."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One case at one discretisation: the verdict, and the true errors worth the name."""

    case: str
    choices: Choices
    verdict: Verdict
    held: tuple[ErrorRatio, ...]

    def size(self, solver: Solver) -> int:
        """Links or elements per beam."""
        count = self.choices.links if solver == "cprbm" else self.choices.elements
        assert isinstance(count, int)
        return count


@dataclass(frozen=True, slots=True)
class Calibration:
    """All that is measured so far.

    Attributes:
        trials: in the order of the cases and sizes.
        covered: by case, for how many of its stations an exact answer is known, of how many.
        why: by case, what the exact answer says of its end, where it covers not every station.
    """

    trials: tuple[Trial, ...] = ()
    covered: Mapping[str, tuple[int, int]] = field(default_factory=frozendict)
    why: Mapping[str, str] = field(default_factory=frozendict)

    @property
    def cases(self) -> tuple[str, ...]:
        """Those that were tried."""
        return tuple(dict.fromkeys(trial.case for trial in self.trials))

    def of_case(self, case: str) -> tuple[Trial, ...]:
        """A case's trials."""
        return tuple(trial for trial in self.trials if trial.case == case)


def tallies(trials: tuple[Trial, ...]) -> tuple[Tally, ...]:
    """What some trials say of each solver."""
    found = [each for trial in trials for each in trial.held]
    return tuple(tally(found, solver) for solver in SOLVERS)


@dataclass(frozen=True, slots=True)
class Piece:
    """What is measured at once: a case at all sizes."""

    scene: Scene
    sizes: tuple[tuple[int, int], ...] = SIZES


def pieces() -> tuple[Piece, ...]:
    """A piece for each built-in scene."""
    return tuple(Piece(scene) for scene in map(cases.asked, cases.names()) if isinstance(scene, Scene))


def with_piece(found: Calibration, piece: Piece, solvers: Solvers, crew: Crew = ALONE) -> Calibration:
    """What was found, and a piece more; a case without an exact answer has no trials.

    Raises:
        SceneError: a solver refuses the question.
    """
    scene = piece.scene
    whole = (solvers.exact or exact_if_covered)(scene, Choices(theory="bending"))
    exact = complete_part(scene, whole)
    asked = sum(len(stage.stations) for stage in scene.stages)
    known = len(exact.stations)
    trials = [tried(scene, links, elements, exact, solvers, crew) for links, elements in piece.sizes if known]
    said = {} if known == asked else {scene.name: whole.sentence or whole.ending.value}
    return Calibration(
        (*found.trials, *trials),
        frozendict({**found.covered, scene.name: (known, asked)}),
        frozendict({**found.why, **said}),
    )


def tried(scene: Scene, links: int, elements: int, exact: Answer, solvers: Solvers, crew: Crew = ALONE) -> Trial:
    """One case at one discretisation, beside an exact answer that is there already.

    Raises:
        SceneError: a solver refuses the question.
    """
    choices = Choices(links=links, elements=elements, theory="bending")
    runs = paired(scene, choices, replace(solvers, exact=None), crew, bare=True)
    comparison = compare(scene, replace(runs, exact=exact))
    return Trial(scene.name, choices, comparison.verdict, error_ratios(comparison.rows))
