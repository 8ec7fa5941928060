"""How long a beam has to be at least: the shortest way between its ends past what is in its way.

A chain of bars sees an obstacle at its nodes alone, and a small one slips through between them.  A drive that goes as
far as that chain may ask a beam to become longer than it is, which in bending it never can.  This is asked of beams
whose ends are both where drives and guides say: an end that is free to move yields.

======  =========================================================================
symbol  meaning
======  =========================================================================
p       places along a line that is pulled tight between two ends, m
d, a    their distance from an obstacle, and what it has to be, m
L       the beam's length, m
======  =========================================================================
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import FreeEnd, PinnedEnd, Scene, WeldedEnd
from cprbm_scene.statement import DisplacementDrive, FixedBody, RotationDrive, SlidingBody, TurningBody
from tests.robustness.estimate import Barrier, Estimate, State

Array = NDArray[np.float64]
Attached = WeldedEnd | PinnedEnd | FreeEnd
TAUT = 0.97  # of L: a beam whose shortest way is longer is as good as taut
LONGER = 1.005  # of L: a beam that is drawn straight is taut, and no longer than it is as nearly as this is known
ROOM = 0.01  # of the size, between an end that is led and what it would run into, unless it is closer at rest
PLACES = 48  # of a line that is pulled tight, less one
ROUNDS = 60
PARTS = 3  # of the way of its ends from one state to the next
HALVINGS = 5
OVER = 1.85  # of what a place is from the middle of its neighbours, so far it goes at once
OUT = 3  # steps out of an obstacle, each along the rise of the distance


def slack(model: Estimate, states: Sequence[State], barriers: Sequence[Barrier]) -> dict[str, float]:
    """Values of loads and drives as far as no drive has pulled a beam taut on the way through the states.

    A line follows each beam's ends from rest on, past what is in its way.  A beam that is hardly longer at rest is taut
    where the line becomes longer than it is.  Nor does an end run into something.
    """
    beams = [name for name, beam in model.scene.beams.items() if _led(model.scene, beam.start, beam.end)]
    mine = {name: [barrier for barrier in barriers if barrier.beam == name] for name in beams}
    lines = {
        name: tight(_places(model.shape(np.zeros(model.unknowns), name)), mine[name]) for name in beams if mine[name]
    }
    limits = {
        name: (TAUT if length(line) < TAUT * model.lengths[name] else LONGER) * model.lengths[name]
        for name, line in lines.items()
    }
    fences = {
        name: [np.minimum(b.distance(line[[0, -1]]), b.apart + ROOM * model.size) for b in mine[name]]
        for name, line in lines.items()
    }

    def beyond(lines: dict[str, Array]) -> bool:
        """Whether a beam would be longer, or one of its ends within something."""
        return any(
            length(line) > limits[name]
            or any(np.any(b.distance(line[[0, -1]]) < at) for b, at in zip(mine[name], fences[name], strict=True))
            for name, line in lines.items()
        )

    before: dict[str, float] = {}
    for state in states:
        ends = {name: model.shape(state.q, name)[[0, -1]] for name in lines}
        after = {name: led(line, ends[name], mine[name]) for name, line in lines.items()}
        driven = any(state.values.get(name, 0.0) != before.get(name, 0.0) for name in model.scene.drives)
        if driven and beyond(after):
            low, high = 0.0, 1.0
            for _ in range(HALVINGS):
                share = 0.5 * (low + high)
                there = {name: line[[0, -1]] + share * (ends[name] - line[[0, -1]]) for name, line in lines.items()}
                far = beyond({name: led(line, there[name], mine[name]) for name, line in lines.items()})
                low, high = (low, share) if far else (share, high)
            return {
                name: before.get(name, 0.0) + low * (value - before.get(name, 0.0))
                for name, value in state.values.items()
            }
        lines, before = after, dict(state.values)
    return before


def _led(scene: Scene, *ends: Attached) -> bool:
    """Whether all ``ends`` of a beam are where the ground, or a guide and a drive, have them."""
    turned = {drive.body for drive in scene.drives.values() if isinstance(drive, RotationDrive)}
    moved = {scene.body_of(drive.point) for drive in scene.drives.values() if isinstance(drive, DisplacementDrive)}
    for end in ends:
        if isinstance(end, FreeEnd):
            return False
        name = scene.body_of(end.point)
        match scene.bodies[name]:
            case FixedBody():
                pass
            case TurningBody() if name in turned:
                pass
            case SlidingBody(pin=pin) if name in moved and pin in (None, end.point):
                pass
            case _:
                return False
    return True


def led(line: Array, ends: Array, barriers: Sequence[Barrier]) -> Array:
    """A tight ``line`` (k, 2) as its ends have gone to others (2, 2)."""
    for part in range(1, PARTS + 1):
        share = np.linspace(0.0, 1.0, len(line))[:, None]
        gone = (ends - line[[0, -1]]) / (PARTS + 1 - part)
        line = tight(line + (1.0 - share) * gone[0] + share * gone[1], barriers)
    return line


def length(line: Array) -> float:
    """Of a line (k, 2), m."""
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def _places(line: Array) -> Array:
    u = np.linspace(0.0, len(line) - 1.0, PLACES + 1)
    return np.stack([np.interp(u, np.arange(len(line)), line[:, i]) for i in (0, 1)], axis=1)


def tight(line: Array, barriers: Sequence[Barrier]) -> Array:
    """A line (k, 2) pulled tight between its ends, past all barriers."""
    p, size = line.copy(), float(np.abs(line - line[0]).max())
    for _ in range(ROUNDS):
        for first in (1, 2):  # every other place, then those between
            these = np.arange(first, PLACES, 2)
            p[these] += OVER * (0.5 * (p[these - 1] + p[these + 1]) - p[these])
            for barrier in barriers:
                p[these] = _outside(p[these], barrier, size)
    return p


def _outside(p: Array, barrier: Barrier, size: float) -> Array:
    for _ in range(OUT):
        within = barrier.apart - barrier.distance(p)
        deep = np.flatnonzero(within > 0.0)
        if not deep.size:
            break
        beside = 1e-6 * size * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        d = barrier.distance((p[deep] + beside[:, None]).reshape(-1, 2)).reshape(4, -1)  # a single call is faster
        rise = (d[::2] - d[1::2]).T
        rise /= np.maximum(np.hypot(*rise.T), 1e-300)[:, None]
        p[deep] += within[deep, None] * rise
    return p
