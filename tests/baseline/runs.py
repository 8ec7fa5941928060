"""The runs of a record: scene, solver and size.

Built-in cases run at N = 20, 40, 41, 80 links and at 20, 40, 80 elements; random scenes at 40 and 80 of both.
Two sizes of a run give an estimate of its error where the comparison states none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from comparisons import cases
from cprbm_scene import Scene, scene_from
from tests.robustness.drawing import drawn

SolverName = Literal["cprbm", "fea", "comparison"]
Theory = Literal["bending", "stretch", "shear"]
THEORIES: tuple[Theory, ...] = ("bending", "stretch", "shear")

BUILT_IN_SIZES: dict[SolverName, tuple[int, ...]] = {"cprbm": (20, 40, 41, 80), "fea": (20, 40, 80)}
RANDOM_SIZES: dict[SolverName, tuple[int, ...]] = {"cprbm": (40, 80), "fea": (40, 80)}
DEFAULT_SIZES: dict[SolverName, int] = {"cprbm": 40, "fea": 80}
"""Links and elements of the comparison at the defaults."""


@dataclass(frozen=True, slots=True)
class Run:
    """One answer of a record.

    Attributes:
        scene: name of a built-in case, or ``random-SEED-INDEX``.
        solver: ``cprbm``, ``fea``, or ``comparison`` for both at the defaults with the verdict.
        size: links or elements per beam; 0 for the comparison.
        theory: beam theory of every solver that offers more than one; None for the default of the program.
    """

    scene: str
    solver: SolverName
    size: int
    theory: Theory | None = None

    @property
    def name(self) -> str:
        """The name of the run; records are matched by names."""
        size = f" {self.size}" if self.size else ""
        return f"{self.scene} {self.solver}{size}"


def open_scene(name: str) -> Scene:
    """The scene of a built-in case or of a random scene.

    Raises:
        SceneError: no such case exists.
    """
    if not name.startswith("random-"):
        return cases.opened(name)
    _, seed, index = name.split("-")
    return scene_from(drawn(int(seed), int(index)).data)


def planned_runs(built_in: Sequence[str], scenes: int, seed: int, theory: Theory | None) -> Iterator[Run]:
    """All runs of a record: the built-in cases first, then random scenes 0 to ``scenes`` − 1 of ``seed``."""
    random = [f"random-{seed}-{index}" for index in range(scenes)]
    for names, sizes in ((built_in, BUILT_IN_SIZES), (random, RANDOM_SIZES)):
        for name in names:
            for solver, counts in sizes.items():
                yield from (Run(name, solver, count, theory) for count in counts)
            yield Run(name, "comparison", 0, theory)
