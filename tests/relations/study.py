"""By how much both solvers' answers break what must hold of any scene: the worst violation of every relation."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import chain

from comparisons import cases
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers
from cprbm_scene import SceneError
from tests.relations.image import Data
from tests.relations.measured import Violation, violations


@dataclass(frozen=True, slots=True)
class Asked:
    """What is measured at once: all images of one scene's data, by one solver."""

    solver: str
    answer: Solver
    data: Data
    choices: Choices


@dataclass(frozen=True, slots=True)
class Seen:
    """A violation, and whose: ``case`` is the scene's name."""

    solver: str
    case: str
    violation: Violation


@dataclass(frozen=True, slots=True)
class Relations:
    """All that is measured so far; ``refused`` are scenes that a solver was not asked about, with the reason."""

    seen: tuple[Seen, ...] = ()
    refused: tuple[tuple[str, str, str], ...] = ()

    def of(self, relation: str, solver: str) -> tuple[Seen, ...]:
        """A relation's violations in a solver's answers, the worst first."""
        found = [each for each in self.seen if (each.violation.relation, each.solver) == (relation, solver)]
        return tuple(sorted(found, key=lambda each: (-each.violation.worst.pressure, -each.violation.worst.size)))

    @property
    def broken(self) -> tuple[Seen, ...]:
        """Those that are more than they may be."""
        return tuple(each for each in self.seen if not each.violation.holds)


def pieces(scenes: Iterable[str], choices: Choices, solvers: Solvers) -> tuple[Asked, ...]:
    """What is to be measured of built-in cases and files; of no name all built-in scenes.

    Raises:
        SceneError: there is no such case, or it is no scene of beams.
    """
    named = tuple(scenes) or cases.scenes()
    data = [_scene_data(name) for name in named]
    return tuple(
        Asked(solver, answer, each, choices)
        for each in data
        for solver, answer in (("cprbm", solvers.cprbm), ("fea", solvers.fea))
    )


def _scene_data(case: str) -> Data:
    cases.opened(case)
    return cases.data(case)


def with_piece(found: Relations, piece: Asked) -> Relations:
    """What was found, and a scene more."""
    case = str(piece.data["name"])
    try:
        measured = tuple(violations(piece.data, piece.answer, piece.choices))
    except SceneError as error:
        return replace(found, refused=(*found.refused, (piece.solver, case, str(error))))
    return replace(found, seen=tuple(chain(found.seen, (Seen(piece.solver, case, each) for each in measured))))
