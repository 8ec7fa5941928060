"""A scene in the making: the plain data of a file, to which bodies, beams and what acts on them are added."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.random import Generator

from tests.robustness.chance import any_of, between, happens, rounded, spread
from tests.robustness.curves import curve_between
from tests.robustness.frame import Frame, Place, drawn_frame

Data = dict[str, Any]

MATERIALS = (
    ("abs", 2.3e9, 0.35),
    ("polypropylene", 1.37e9, 0.42),
    ("titanium", 1.14e11, 0.33),
    ("steel", 2.07e11, 0.29),
)
THINNEST, THICKEST = 1.0 / 300.0, 1.0 / 15.0  # of a beam's length


@dataclass
class Draft:
    """What there is so far; beams are about ``slenderness`` times as long as they are thick."""

    rng: Generator
    frame: Frame
    material: str
    slenderness: float
    data: Data = field(default_factory=dict)

    def body(self, name: str, motion: str, points: dict[str, Place], **guide: object) -> None:
        """Add a body; its points are places of the layout."""
        placed = {point: list(self.frame.world(place)) for point, place in points.items()}
        self.data["bodies"][name] = {"motion": motion, **guide, "points": placed}

    def place(self, point: str) -> Place:
        """Where a body's point is, m."""
        (found,) = [body["points"][point] for body in self.data["bodies"].values() if point in body["points"]]
        return found[0], found[1]

    def beam(self, name: str, start: tuple[str, str], end: tuple[str, str], *, bowed: float = 1.0) -> None:
        """Add a beam between two points, each with its joint."""
        curve = curve_between(self.rng, self.frame, self.place(start[1]), self.place(end[1]), bowed=bowed)
        self.beam_of(name, curve, _end(*start), _end(*end))

    def beam_of(self, name: str, curve: Data, start: Data, end: Data) -> None:
        """Add a beam of a given line."""
        self.data["beams"][name] = {
            "curve": curve,
            **self.section(),
            "material": self.material,
            "start": start,
            "end": end,
        }

    def section(self) -> Data:
        """Thickness and width of a beam."""
        rng, size = self.rng, self.frame.size
        ratio = np.clip(spread(rng, 0.75, 1.3) / self.slenderness, THINNEST, THICKEST)
        thickness = rounded(float(ratio) * size, 3)
        width = rounded(size * between(rng, 0.05, 0.3), 3)
        return {
            "thickness": _varied(rng, thickness, 0.25) if happens(rng, 0.24) else thickness,
            "width": _varied(rng, width, 0.4) if happens(rng, 0.16) else width,
        }


def _end(joint: str, point: str) -> Data:
    return {"joint": joint} if joint == "free" else {"joint": joint, "point": point}


def _varied(rng: Generator, mean: float, by: float) -> Data:
    """A size that grows or shrinks along the beam, or changes its slope on the way."""
    at = [0.0, 1.0] if happens(rng, 0.6) else [0.0, round(between(rng, 0.3, 0.7), 2), 1.0]
    return {"at": at, "values": [rounded(mean * between(rng, 1.0 - by, 1.0 + by), 3) for _ in at]}


def started(rng: Generator) -> Draft:
    """One with a material and a frame, and nothing in it."""
    material, modulus, ratio = any_of(rng, MATERIALS)
    data: Data = {
        "name": "random",
        "theory": "bending",
        "materials": {material: {"youngs_modulus": modulus, "poisson_ratio": ratio}},
    }
    slenderness = spread(rng, 1.0 / THICKEST, 1.0 / THINNEST)
    return Draft(rng, drawn_frame(rng), material, slenderness, data | {"bodies": {}, "beams": {}})
