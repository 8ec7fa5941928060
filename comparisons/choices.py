"""Numerical choices of a run: mesh sizes, contact formulation and beam theory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from cprbm_scene import Scene

Kinematics = Literal["bending", "stretch", "shear"]
KINEMATICS: tuple[Kinematics, ...] = ("bending", "stretch", "shear")
"""Beam theories of both solvers; every theory has a freedom more than the theory before."""

Count = int | dict[str, int]

LOOSEST = 0.05
"""Largest penetration of a family of sizes, over the thickness."""


@dataclass(frozen=True, slots=True)
class Choices:
    """Mesh sizes and variants of a solve.

    Attributes:
        links: links of the CPRBM per beam: a number for all beams, or numbers by name of the beam.
        formulation: of the CPRBM's contact.
        elements: finite elements per beam, in the same form.
        kinematics: beam theory of the finite elements; None for ``theory``.
        penetration: allowed overlap of the finite elements, a fraction of the thickness.
        across: elements of the solid across a beam's thickness; along the beam the solid has ``elements``.
        theory: beam theory of both solvers; None for the scene's.
    """

    links: Count = 40
    formulation: Literal["auto", "paper"] = "auto"
    elements: Count = 80
    kinematics: Kinematics | None = None
    penetration: float = 1e-4
    across: int = 2
    theory: Kinematics | None = None

    def finer(self) -> Choices:
        """The choices with twice the links, twice the elements along and across, and a sixteenth of the penetration.

        The error of a penalty is proportional to the penetration.  Two runs with one penetration share this error, and
        their change does not show the error.  A quarter is enough for an error of second order, but a solver may leave
        down to a quarter of the allowed penetration.
        """
        links, elements = (_changed(count, lambda n: 2 * n) for count in (self.links, self.elements))
        return replace(
            self, links=links, elements=elements, penetration=self.penetration / 16.0, across=2 * self.across
        )

    def of_size(self, n: int) -> Choices:
        """The choices with N = ``n`` links and elements; the error of the penetration falls with the elements' error.

        The penetration is unchanged at N = 40 and falls with the fourth power of N up to N = 160, then with the
        square: below, round-off in the positions is a share of the penetration.
        """
        share = (40.0 / min(n, 160)) ** 4 * (160.0 / max(n, 160)) ** 2
        return replace(self, links=n, elements=n, penetration=min(LOOSEST, self.penetration * share))

    def beside(self) -> Choices:
        """The choices with a seventh more links and elements: joints and nodes are elsewhere, and errors hardly other.

        The penetration falls with the fourth power of the elements, as in the finer choices.
        """
        links, elements = (_changed(n, lambda n: n + max(1, round(n / 7))) for n in (self.links, self.elements))
        more = _total(elements) / _total(self.elements)
        return replace(self, links=links, elements=elements, penetration=self.penetration / more**4)

    def ratios_beside(self) -> tuple[float, float]:
        """The links here over the links beside, and the elements."""
        beside = self.beside()
        return _total(self.links) / _total(beside.links), _total(self.elements) / _total(beside.elements)

    def within(self, theory: Kinematics) -> Choices:
        """The choices with a beam theory of both solvers."""
        return replace(self, kinematics=theory, theory=theory)

    def theory_of(self, scene: Scene) -> Kinematics:
        """Beam theory of the CPRBM on a scene."""
        return self.theory or scene.theory

    def kinematics_of(self, scene: Scene) -> Kinematics:
        """Beam theory of the finite elements on a scene; both solvers answer in this theory in a comparison."""
        return self.kinematics or self.theory_of(scene)


def check_counts(choices: Choices, scene: Scene) -> None:
    """Check that the choices fit the scene.

    Raises:
        SceneError: a count by beams lacks a beam, or names an unknown beam.
    """
    from cprbm_scene import Mistake, SceneError  # loaded with a scene, not with the names of the options

    allowed = f"one number, or one for each of the beams {', '.join(scene.beams)}"
    mistakes = [
        Mistake(key, ", ".join(f"{beam}={number}" for beam, number in count.items()), allowed)
        for key, count in (("links", choices.links), ("elements", choices.elements))
        if not isinstance(count, int) and {*count} != {*scene.beams}
    ]
    if mistakes:
        raise SceneError(mistakes)


def _changed(count: Count, change: Callable[[int], int]) -> Count:
    return change(count) if isinstance(count, int) else {beam: change(number) for beam, number in count.items()}


def _total(count: Count) -> int:
    return count if isinstance(count, int) else sum(count.values())
