"""A scene's image under a relation: its data, and what the first scene's answer says of the image's."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from cprbm_scene import Answer, Probe, Scene
from cprbm_scene.answer import Array

Data = dict[str, Any]
"""A scene as a TOML file's plain data."""

Expected = Callable[[Probe, str, Array], Array | None]
"""Of a probe, the name of the stage that its value belongs to, and the first scene's value: the image's, or None."""

Place = Callable[[str, float], float]
"""Of a stage's name and a station: the image's station."""

Beyond = Callable[[Scene, Answer], dict[str, dict[tuple[str, float], float]]]
"""Of an image and the answer to it, by the name of each condition: at stages and stations its violation, a fraction."""


def copied(data: Data) -> Data:
    """Data of one's own to change."""
    new: Data = json.loads(json.dumps(data))
    return new


def plain(data: Data) -> Data:
    """A scene's data without what only a formulation or a publication says of it: ``paper`` and ``claims``."""
    new = copied(data)
    new.pop("claims", None)
    for each in (*new["beams"].values(), *new.get("contacts", {}).values()):
        each.pop("paper", None)
    return new


def as_it_was(probe: Probe, stage: str, value: Array) -> Array | None:
    """The same value."""
    return value


def where_it_was(stage: str, value: float) -> float:
    """The same station."""
    return value


@dataclass(frozen=True, slots=True)
class Image:
    """A scene to which something was done.

    Attributes:
        what: what was done, in words.
        data: the image's.
        expected: what a value of the first scene is in the image.
        place: what a station of the first scene is in the image; one that the image does not have is not compared.
        beyond: what an answer to the image must be by itself.
        discretised_anew: whether the image has another discretisation than the scene.
    """

    what: str
    data: Data
    expected: Expected = as_it_was
    place: Place = where_it_was
    beyond: Beyond | None = None
    discretised_anew: bool = False
