"""The numerical choices of a run, in words that belong to neither solver."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from cprbm_scene import Scene

Kinematics = Literal["bending", "stretch", "shear"]
KINEMATICS: tuple[Kinematics, ...] = ("bending", "stretch", "shear")
"""The beam theories of both solvers, each with one freedom more than the one before."""

Count = int | dict[str, int]

LOOSEST = 0.05
"""Largest penetration of a family of sizes, over the thickness."""


@dataclass(frozen=True, slots=True)
class Choices:
    """How finely and by which variant a scene is to be solved.

    Attributes:
        links: the CPRBM's links per beam: one number, or one for each beam by name.
        formulation: of the CPRBM's contact.
        elements: finite elements per beam, given in the same way.
        kinematics: beam theory of the finite elements; None for ``theory``.
        penetration: the overlap that the finite elements may leave, as a fraction of the thickness.
        across: elements of the solid across a beam's thickness; along it has as many as the beam elements.
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
        """The same with twice the links, twice the elements along and across, and a sixteenth of the penetration.

        The error that a penalty leaves is proportional to the penetration.  Were that kept, the two runs
        would share it and their change would not show it.  To fall as an error of second order it need only be
        quartered, but a solver may leave less than it was allowed, and down to a quarter of that is provided for.
        """
        return replace(
            self,
            links=_twice(self.links),
            elements=_twice(self.elements),
            penetration=self.penetration / 16.0,
            across=2 * self.across,
        )

    def of_size(self, n: int) -> Choices:
        """The same with N = ``n`` links and elements, and a penetration whose error falls with the elements' own error.

        The penetration is the present one at N = 40 and falls with the fourth power of N up to N = 160, then with the
        square: below, round-off in the positions is a share of the penetration.
        """
        share = (40.0 / min(n, 160)) ** 4 * (160.0 / max(n, 160)) ** 2
        return replace(self, links=n, elements=n, penetration=min(LOOSEST, self.penetration * share))

    def beside(self) -> Choices:
        """The same with a seventh more links and elements: joints and nodes are elsewhere, and errors hardly other.

        The penetration falls by the power of the elements by which it does in the finer ones.
        """
        elements = _seventh_more(self.elements)
        more = _whole(elements) / _whole(self.elements)
        return replace(self, links=_seventh_more(self.links), elements=elements, penetration=self.penetration / more**4)

    def ratios_beside(self) -> tuple[float, float]:
        """The links here over those beside, and the elements."""
        beside = self.beside()
        return _whole(self.links) / _whole(beside.links), _whole(self.elements) / _whole(beside.elements)

    def within(self, theory: Kinematics) -> Choices:
        """The same with a beam theory of both solvers."""
        return replace(self, kinematics=theory, theory=theory)

    def theory_of(self, scene: Scene) -> Kinematics:
        """Beam theory of the CPRBM on a scene."""
        return self.theory or scene.theory

    def kinematics_of(self, scene: Scene) -> Kinematics:
        """Beam theory of the finite elements on a scene; both solvers answer in this theory in a comparison."""
        return self.kinematics or self.theory_of(scene)


def check(choices: Choices, scene: Scene) -> None:
    """See that the choices fit the scene.

    Raises:
        SceneError: a count that names beams leaves one out or names one that is not there.
    """
    from cprbm_scene import Mistake, SceneError  # loaded when a scene is there, not with the options' names

    mistakes: list[Mistake] = []
    for key, count in (("links", choices.links), ("elements", choices.elements)):
        if isinstance(count, int):
            continue
        if set(count) != set(scene.beams):
            found = ", ".join(f"{beam}={number}" for beam, number in count.items())
            allowed = f"one number, or one for each of the beams {', '.join(scene.beams)}"
            mistakes.append(Mistake(key, found, allowed))
    if mistakes:
        raise SceneError(mistakes)


def _seventh_more(count: Count) -> Count:
    if isinstance(count, int):
        return count + max(1, round(count / 7))
    return {beam: number + max(1, round(number / 7)) for beam, number in count.items()}


def _whole(count: Count) -> int:
    return count if isinstance(count, int) else sum(count.values())


def _twice(count: Count) -> Count:
    return 2 * count if isinstance(count, int) else {beam: 2 * number for beam, number in count.items()}
