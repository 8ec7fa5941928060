"""Numerical settings of the finite-element reference."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, get_args

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, SceneError

Kinematics = Literal["bending", "stretch", "shear"]


@dataclass(frozen=True, slots=True)
class Settings:
    """Mesh, beam theory and numerical tolerances of a solution.

    Attributes:
        elements: number per beam, equal for all or by name.
        kinematics: ``bending`` (exactly inextensible, no shear), ``stretch`` (with axial flexibility) or ``shear``
            (with axial and shear flexibility).
        penetration: largest penetration of contact penalties, relative to the mean thickness of the two beams (to a
            hundredth of the longest beam for contacts of lines). On a circle or an edge the penalty is the stiffest
            that the elements resolve; the penetration only limits the penalty on fine meshes. A beam's end or a
            corner in contact counts as a pair of beams.
        quadrature: Gauss points on every interval of a contact zone.
        residual: unbalanced generalised force of an accepted equilibrium, relative to the largest force.
        correction: last Newton correction of an accepted equilibrium (lengths relative to the longest beam, and
            angles).
        newton_limit: Newton iterations before a load step is cut, unless convergence is near.
        iteration_limit: Newton iterations, over all load steps, before a station is given up.

    Raises:
        SceneError: a value is out of its bounds.
    """

    elements: int | Mapping[str, int] = 80
    kinematics: Kinematics = "shear"
    penetration: float = 1e-4
    quadrature: int = 6
    residual: float = 1e-10
    correction: float = 1e-8
    newton_limit: int = 25
    iteration_limit: int = 1000

    def __post_init__(self) -> None:
        if isinstance(self.elements, Mapping):
            object.__setattr__(self, "elements", frozendict(self.elements))
            counts: list[tuple[str, object]] = [(f"elements.{k}", n) for k, n in self.elements.items()]
        else:
            counts = [("elements", self.elements)]
        counts += [
            ("quadrature", self.quadrature),
            ("newton_limit", self.newton_limit),
            ("iteration_limit", self.iteration_limit),
        ]
        mistakes = [
            Mistake(f"settings.{key}", repr(count), "a whole number of at least 1")
            for key, count in counts
            if not isinstance(count, int) or isinstance(count, bool) or count < 1
        ]
        shares = {"penetration": self.penetration, "residual": self.residual, "correction": self.correction}
        mistakes += [
            Mistake(f"settings.{key}", repr(value), "a number between 0 and 1")
            for key, value in shares.items()
            if not (math.isfinite(value) and 0.0 < value < 1.0)
        ]
        if self.kinematics not in get_args(Kinematics):
            allowed = ", ".join(get_args(Kinematics))
            mistakes.append(Mistake("settings.kinematics", repr(self.kinematics), f"one of {allowed}"))
        if mistakes:
            raise SceneError(mistakes)

    def elements_of(self, beams: Iterable[str]) -> dict[str, int]:
        """The number of elements of every beam.

        Raises:
            SceneError: ``elements`` names an unknown beam or omits a beam.
        """
        names = list(beams)
        if not isinstance(self.elements, Mapping):
            return dict.fromkeys(names, self.elements)
        allowed = "one number for each of " + ", ".join(names)
        mistakes = [
            Mistake("settings.elements", f"the unknown beam {name!r}", allowed)
            for name in self.elements
            if name not in names
        ]
        mistakes += [
            Mistake("settings.elements", f"nothing for the beam {name!r}", allowed)
            for name in names
            if name not in self.elements
        ]
        if mistakes:
            raise SceneError(mistakes)
        return {name: self.elements[name] for name in names}

    def finer(self) -> Settings:
        """The settings with twice the elements."""
        if isinstance(self.elements, Mapping):
            return replace(self, elements={name: 2 * n for name, n in self.elements.items()})
        return replace(self, elements=2 * self.elements)

    def plain(self) -> dict[str, object]:
        """The settings as plain values."""
        elements = self.elements
        return {
            "elements": dict(elements) if isinstance(elements, Mapping) else elements,
            "kinematics": self.kinematics,
            "penetration": self.penetration,
            "quadrature": self.quadrature,
            "residual": self.residual,
            "correction": self.correction,
            "newton_limit": self.newton_limit,
            "iteration_limit": self.iteration_limit,
        }
