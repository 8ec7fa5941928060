"""Records of a drawing: curves as places along them, and named points."""

from __future__ import annotations

from dataclasses import dataclass

from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class DrawnCurve:
    """A curve of a drawing.

    Attributes:
        tag: name of the group or layer; without either a name with the number.
        number: number of the curve in the drawing.
        kind: name of the curve's kind in the drawing.
        points: places along the curve, (k, 3), in the drawing's unit.
        directions: unit tangents (2, 3) at both ends; None for a curve known by places alone.
    """

    tag: str
    number: int
    kind: str
    points: Array
    directions: Array | None


@dataclass(frozen=True, slots=True)
class Drawing:
    """Content of a drawing: curves; places (k, 3) of named points; sentences on entities without a curve."""

    curves: tuple[DrawnCurve, ...]
    points: dict[str, Array]
    tagged: bool
    refused: tuple[str, ...] = ()
