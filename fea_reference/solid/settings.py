"""Numerical settings of the solid."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, SceneError

_LEAST = 3  # elements along a beam for a smooth edge, see fea_reference.solid.skin


@dataclass(frozen=True, slots=True)
class Settings:
    """Mesh and numerical tolerances of a solution as a solid.

    Attributes:
        elements: along a beam, equal for all or by name.
        across: elements across the thickness.
        stiffness: of a contact's penalty, relative to E over the length of an element along the beam.
        penetration: largest penetration of the penalty, relative to the mean thickness; the penalty is raised as
            needed.
        quadrature: Gauss points on every part of a contact zone between two nodes.
        residual: unbalanced generalised force of an accepted equilibrium, relative to the largest.
        newton_limit: iterations before a load step is cut.
        iteration_limit: iterations, over all load steps, before a station is given up.

    Raises:
        SceneError: a value is out of its bounds.
    """

    elements: int | Mapping[str, int] = 80
    across: int = 2
    stiffness: float = 10.0
    penetration: float = 1e-3
    quadrature: int = 4
    residual: float = 1e-9
    newton_limit: int = 25
    iteration_limit: int = 2000

    def __post_init__(self) -> None:
        if isinstance(self.elements, Mapping):
            object.__setattr__(self, "elements", frozendict(self.elements))
            counts: list[tuple[str, object]] = [(f"elements.{k}", n) for k, n in self.elements.items()]
        else:
            counts = [("elements", self.elements)]
        counts += [
            ("across", self.across),
            ("quadrature", self.quadrature),
            ("newton_limit", self.newton_limit),
            ("iteration_limit", self.iteration_limit),
        ]
        least = {key: _LEAST if key.startswith("elements") else 1 for key, _ in counts}
        mistakes = [
            Mistake(f"settings.{key}", repr(count), f"a whole number of at least {least[key]}")
            for key, count in counts
            if not isinstance(count, int) or isinstance(count, bool) or count < least[key]
        ]
        mistakes += [
            Mistake(f"settings.{key}", repr(value), "a number between 0 and 1")
            for key, value in (("penetration", self.penetration), ("residual", self.residual))
            if not (math.isfinite(value) and 0.0 < value < 1.0)
        ]
        if not (math.isfinite(self.stiffness) and self.stiffness > 0.0):
            mistakes.append(Mistake("settings.stiffness", repr(self.stiffness), "a number greater than 0"))
        if mistakes:
            raise SceneError(mistakes)

    def elements_of(self, beams: Iterable[str]) -> dict[str, int]:
        """The number of elements along every beam.

        Raises:
            SceneError: ``elements`` names an unknown beam or omits a beam.
        """
        names = list(beams)
        if not isinstance(self.elements, Mapping):
            return dict.fromkeys(names, self.elements)
        if set(self.elements) != set(names):
            counts = ", ".join(f"{name}={n}" for name, n in self.elements.items())
            raise SceneError([Mistake("settings.elements", counts, "one number for each of " + ", ".join(names))])
        return {name: self.elements[name] for name in names}

    def finer(self) -> Settings:
        """The settings with twice the elements, along and across."""
        if isinstance(self.elements, Mapping):
            return replace(self, elements={name: 2 * n for name, n in self.elements.items()}, across=2 * self.across)
        return replace(self, elements=2 * self.elements, across=2 * self.across)

    def plain(self) -> dict[str, object]:
        """The settings as plain values."""
        elements = self.elements
        return {
            "elements": dict(elements) if isinstance(elements, Mapping) else elements,
            "across": self.across,
            "stiffness": self.stiffness,
            "penetration": self.penetration,
            "quadrature": self.quadrature,
            "residual": self.residual,
            "newton_limit": self.newton_limit,
            "iteration_limit": self.iteration_limit,
        }
