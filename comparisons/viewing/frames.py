"""What is to be seen at each station, and what all stations have in common, so that an animation stands still."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, inf
from typing import Literal

import numpy as np

from comparisons.bodies_drawn import Places
from comparisons.display_units import display_unit
from comparisons.geometry import longest
from comparisons.viewing.moved import Obstacle, obstacles, points_at
from comparisons.viewing.pushes import Push, pushes_at
from comparisons.viewing.strips import Strip, strips_at
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import Array

Coloured = Literal["bending_stress", "combined_stress", "moment"]
COLOURED: tuple[Coloured, ...] = ("bending_stress", "combined_stress", "moment")
UNITS: Mapping[Coloured, str] = {"bending_stress": "Pa", "combined_stress": "Pa", "moment": "N·m"}

COLOURS: Mapping[Coloured, str] = {
    "bending_stress": "RdYlBu_r",
    "combined_stress": "plasma_r",
    "moment": "RdYlBu_r",
}
"""Names of colour maps, known to matplotlib."""

TINY = 1e-300
"""The least that a scale of colours spans, where nothing is stressed."""

ARROW = 0.13
"""Length of the largest force's arrow, of the mechanism's longer side."""

LEAST = 0.02
"""Of the largest force: what is less has no arrow."""

_LARGE = 0.6  # of the longest beam: the radius up to which a circle is shown whole
_DEPTH = 0.02  # of the longest beam: how deep an edge is shown


@dataclass(frozen=True, slots=True)
class Frame:
    """The mechanism at a station: ``strips`` by beam, ``places`` of bodies' points, what presses and is rigid."""

    station: StationAnswer
    strips: Mapping[str, Strip]
    places: Places
    pushes: Sequence[Push]
    obstacles: Sequence[Obstacle]


@dataclass(frozen=True, slots=True)
class Bounds:
    """What all frames have in common.

    Attributes:
        low, high: corners (2,) of what is to be seen, m.
        least, most: of the quantity that colours.
        force: the largest resultant of a contact, N.
        reach: length of the longest beam, m.
    """

    low: Array
    high: Array
    least: float
    most: float
    force: float
    reach: float


def frames_of(scene: Scene, answer: Answer) -> list[Frame]:
    """One frame for each station, of an answer to :func:`comparisons.viewing.strips.with_stresses`."""
    reach = longest(scene)
    return [
        Frame(
            station,
            strips_at(scene, station),
            points_at(scene, station),
            pushes_at(scene, station),
            obstacles(scene, station, 4.0 * reach, _DEPTH * reach),
        )
        for station in answer.stations
    ]


def colour_values(strip: Strip, quantity: Coloured) -> Array:
    """Of each section (n,) what colours it, SI."""
    match quantity:
        case "bending_stress":
            return strip.bending_stress
        case "combined_stress":
            return strip.combined_stress
        case "moment":
            return strip.moment


def shown_unit(scene: Scene, quantity: Coloured, most: float) -> tuple[float, str]:
    """Displayed unit of the quantity with the largest value ``most``; of stresses in a file without this unit MPa."""
    stated = "stress" in scene.display_units.model_fields_set
    return (1e6, "MPa") if UNITS[quantity] == "Pa" and not stated else display_unit(scene, UNITS[quantity], most)


def bounds_of(scene: Scene, frames: Sequence[Frame], quantity: Coloured) -> Bounds:
    """Corners and limits that hold for all frames."""
    low, high, largest, force = np.full(2, inf), np.full(2, -inf), 0.0, 0.0
    reach = longest(scene)
    for frame in frames:
        parts = [np.array(list(frame.places.values())).reshape(-1, 2)]
        for strip in frame.strips.values():
            parts += [strip.layer(-1.0), strip.layer(1.0), strip.rest_layer(-1.0), strip.rest_layer(1.0)]
            largest = max(largest, float(np.abs(colour_values(strip, quantity)).max()))
        for obstacle in frame.obstacles:
            if obstacle.round and np.ptp(obstacle.outline, axis=0).max() <= 2.0 * _LARGE * reach:
                parts.append(obstacle.outline)
        force = max([force, *(hypot(*push.resultant) for push in frame.pushes)])
        both = np.concatenate(parts)
        low, high = np.minimum(low, both.min(axis=0)), np.maximum(high, both.max(axis=0))
    least = 0.0 if quantity == "combined_stress" else -largest
    return Bounds(low, high, least, largest, force, reach)
