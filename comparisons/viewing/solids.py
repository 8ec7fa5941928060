"""Beams, obstacles and contact forces in space: what a station is as cells with values at their corners.

A beam is extruded to its width: hexahedra between neighbouring sections, ACROSS of them through the thickness, one
through the width, which lies along z with the plane of the mechanism in its middle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from comparisons.viewing.frames import Frame
from comparisons.viewing.moved import Obstacle
from comparisons.viewing.strips import Strip
from cprbm_scene.answer import Array, Ints

ACROSS = 4
Kind = Literal["hexahedron", "vertex"]


@dataclass(frozen=True, slots=True)
class Block:
    """Cells of a ``kind``: ``places`` (k, 3), m, ``cells`` (c, corners), ``values`` (k,) or (k, 3) by name, SI."""

    kind: Kind
    places: Array
    cells: Ints
    values: Mapping[str, Array]


def beams(frame: Frame) -> Block:
    """All beams, by number in the scene's order.

    Values: ``displacement`` (k, 3) from where the same fibre was drawn, ``bending_stress`` of the place, positive in
    tension, ``combined_stress`` (the largest magnitude of the section), ``moment``, ``arc_length`` and ``beam``.
    """
    return together([_beam(number, strip) for number, strip in enumerate(frame.strips.values())])


def _beam(number: int, strip: Strip) -> Block:
    n = len(strip.s)
    eta = np.linspace(-1.0, 1.0, ACROSS + 1)
    flat = np.stack([strip.layer(each) for each in eta], axis=1)  # (n, ACROSS + 1, 2)
    rest = np.stack([strip.rest_layer(each) for each in eta], axis=1)
    half = 0.5 * np.broadcast_to(strip.width[:, None], flat.shape[:2])
    places = np.stack([np.concatenate([flat, side * half[..., None]], axis=2) for side in (-1.0, 1.0)], axis=2)
    moved = np.concatenate([flat - rest, np.zeros((*flat.shape[:2], 1))], axis=2)
    stress = -eta * strip.bending_stress[:, None]

    def at_all(values: Array) -> Array:
        """Of every section, of every place of a section, or of every place, (n, ...), to all corners."""
        wide = values.reshape(n, -1) if values.ndim < 3 else values
        both = np.stack([np.broadcast_to(wide, (n, ACROSS + 1, *wide.shape[2:]))] * 2, axis=2)
        return both.reshape(-1, *wide.shape[2:])

    def corner(i: Ints, j: Ints, k: int) -> Ints:
        return (i * (ACROSS + 1) + j) * 2 + k

    i, j = (each.ravel() for each in np.meshgrid(np.arange(n - 1), np.arange(ACROSS), indexing="ij"))
    base = [(0, 0), (1, 0), (1, 1), (0, 1)]  # along x(s), then to its left: counter-clockwise seen from +z
    cells = np.stack([corner(i + di, j + dj, k) for k in (0, 1) for di, dj in base], axis=1)
    return Block(
        "hexahedron",
        places.reshape(-1, 3),
        cells,
        {
            "displacement": at_all(moved),
            "bending_stress": at_all(stress),
            "combined_stress": at_all(strip.combined_stress),
            "moment": at_all(strip.moment),
            "arc_length": at_all(strip.s),
            "beam": at_all(np.full(n, float(number))),
        },
    )


def obstacles(frame: Frame) -> Block | None:
    """What is rigid, as wide as the beam that may touch it."""
    parts = [_obstacle(number, obstacle) for number, obstacle in enumerate(frame.obstacles)]
    return together(parts) if parts else None


def _obstacle(number: int, obstacle: Obstacle) -> Block:
    """Pieces of the outline and what is behind each, as hexahedra; those to a middle have two edges in one."""
    flat = np.stack([obstacle.outline, obstacle.solid], axis=1)  # (k, 2, 2)
    half = np.full((*flat.shape[:2], 1), 0.5 * obstacle.width)
    places = np.stack([np.concatenate([flat, side * half], axis=2) for side in (-1.0, 1.0)], axis=2).reshape(-1, 3)
    i = np.arange(len(flat) - 1)
    way, inwards = flat[1, 0] - flat[0, 0], flat[0, 1] - flat[0, 0]
    base = [(0, 0), (1, 0), (1, 1), (0, 1)]
    if way[0] * inwards[1] - way[1] * inwards[0] < 0.0:  # what is rigid lies at the right
        base = base[::-1]
    cells = np.stack([((i + di) * 2 + side) * 2 + k for k in (0, 1) for di, side in base], axis=1)
    return Block("hexahedron", places, cells, {"obstacle": np.full(len(places), float(number))})


def contact_forces(frame: Frame) -> Block | None:
    """Places on which contacts press, with ``contact_force`` (k, 3), N; None where nothing presses or none is told."""
    if not frame.pushes:
        return None
    flat = np.concatenate([push.places for push in frame.pushes])
    forces = np.concatenate([push.forces for push in frame.pushes])
    zero = np.zeros((len(flat), 1))
    return Block(
        "vertex",
        np.concatenate([flat, zero], axis=1),
        np.arange(len(flat))[:, None],
        {"contact_force": np.concatenate([forces, zero], axis=1)},
    )


def together(blocks: Sequence[Block]) -> Block:
    """Blocks of one kind and the same values as one."""
    first = np.cumsum([0, *(len(block.places) for block in blocks)])[:-1]
    return Block(
        blocks[0].kind,
        np.concatenate([block.places for block in blocks]),
        np.concatenate([block.cells + shift for block, shift in zip(blocks, first, strict=True)]),
        {name: np.concatenate([block.values[name] for block in blocks]) for name in blocks[0].values},
    )
