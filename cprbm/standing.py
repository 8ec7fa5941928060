"""How two beams stand to each other free of stress: which lies on which side, and which of their ends are clamped so.

========  ====================================================================================
A, B      neutral lines of the two beams
s, σ      arc lengths on A and B
t, n      tangent and left normal of B at σ
r         A(s) − B(σ); σ is the foot of s where t·r = 0
κ         curvature of B
T         half a thickness; T′ its slope, which is the sine of the angle by which an edge leans
========  ====================================================================================

A lies on the side of B on which it is where the two are closest; of lines that touch there, on that where most of A is.
The foot is found from the nearest of some places of B, going on along the circle of curvature: by
atan(κ x)/κ ≈ x/(1 + (κ x)²/3) with x = t·r/(1 − κ n·r).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from cprbm.curves import NeutralLine
from cprbm.polynomial import Places
from cprbm.section import Section
from cprbm_scene.answer import Array, Ints

PLACES = 65  # of a beam, even in arc length
ITERATIONS = 8
CLOSE = 1e-9  # of the longest beam: a step whose square is nothing
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot
LEAST = 0.2  # of 1 − κ n·r: round the centre of curvature there is no foot
ON_IT = 1e-9  # gap and slope of two clamped ends, and how far they lie apart along the beams, where they touch


@dataclass(frozen=True, slots=True)
class Attachment:
    """What a beam's end is joined to: ``body`` (−1 for the ground), the point there, and whether it is welded.

    ``point`` is the point's position on the body: from the body's reference place for a free body,
    absolute for the ground; units of length.  A body ``stays`` that is held as the ground is, and is ``led`` if
    stages step drives of those that hold it so (:mod:`cprbm.staying`).
    """

    body: int
    point: tuple[float, float]
    welded: bool
    stays: bool = False
    led: bool = False

    @property
    def told(self) -> bool:
        """Whether the place is none of the unknowns: the ground's, or what guides and drives say."""
        return self.frame < 0 or self.led

    @property
    def at_home(self) -> Attachment:
        """The same while the body, where drives lead it, is where it is drawn."""
        return replace(self, stays=True) if self.led else self

    @property
    def frame(self) -> int:
        """The body again, but the ground (−1) where it stays: what is of one frame cannot move against each other."""
        return -1 if self.stays else self.body


@dataclass(frozen=True, slots=True)
class Side:
    """One beam of two: its neutral line, m, its section, without units, and what its ends are joined to."""

    line: NeutralLine
    section: Section
    ends: tuple[Attachment | None, Attachment | None]


@dataclass(frozen=True, slots=True)
class Standing:
    """Two beams A and B.

    Attributes:
        side: +1 where A lies on the left of B at their closest places, −1 on the right.
        across: +1 where B lies on the left of A, −1 on the right.
        clamps: for the start and the end of A and of B, whether it is clamped together with an end of the other,
            touching and parallel.
        seen: whether any place of A has a foot on B, which tells ``side``, and of B on A; else it is a guess.
    """

    side: float
    across: float
    clamps: tuple[tuple[bool, bool], tuple[bool, bool]]
    seen: tuple[bool, bool] = (True, True)


def standing(one: Side, other: Side, unit_length: float, *, thick: bool) -> Standing:
    """How two beams stand that touch by their edges, if ``thick``, or by their neutral lines; ``unit_length`` in m."""
    shares = np.arange(PLACES) / (PLACES - 1)
    A, B = (each.line.at(each.line.length * shares) for each in (one, other))
    # A against where B starts
    x, y = A.x + (one.line.x0 - other.line.x0), A.y + (one.line.y0 - other.line.y0)
    squares = (x[:, None] - B.x) ** 2 + (y[:, None] - B.y) ** 2
    back_x, back_y = B.x + (other.line.x0 - one.line.x0), B.y + (other.line.y0 - one.line.y0)
    side, seen = _side(x, y, other.line, B, squares.argmin(axis=1), unit_length)
    across, its_seen = _side(back_x, back_y, one.line, A, squares.argmin(axis=0), unit_length)
    mine, its = _ends(one, A, unit_length, thick=thick), _ends(other, B, unit_length, thick=thick)
    return Standing(side, across, (_clamped(mine, its, side), _clamped(its, mine, across)), (seen, its_seen))


def _side(
    x: Array, y: Array, line: NeutralLine, sampled: Places, nearest: Ints, unit_length: float
) -> tuple[float, bool]:
    """+1 where places ``x``, ``y`` (k,) lie on the left of B where they are closest to it, else −1.

    And whether one of them has a foot on B.  Of B some places are ``sampled``, of which those ``nearest`` (k,) to the
    others are known.
    """
    step, close = line.length / (PLACES - 1), CLOSE * unit_length
    B, sigma = sampled.only(nearest), step * nearest
    along, across = _seen(x, y, B)
    k = int((along * along + across * across).argmin())
    if step < abs(across[k]) > abs(along[k]) and 0 < nearest[k] < PLACES - 1:
        # so far off that a foot beside the nearest place sees it no otherwise
        return math.copysign(1.0, across[k]), True
    for _ in range(ITERATIONS):
        left = along / np.maximum(1.0 - B.curvature * across, LEAST)
        left /= 1.0 + (B.curvature * left) ** 2 / 3.0
        ahead = np.minimum(np.maximum(sigma + np.minimum(np.maximum(left, -step), step), 0.0), line.length)
        if np.abs(ahead - sigma).max() < close:
            break
        sigma, B = ahead, line.at(ahead)
        along, across = _seen(x, y, B)
    size = np.abs(across)
    foot = np.abs(along) <= PARALLEL * np.maximum(size, step)
    if foot.any():
        size[~foot] = np.inf
    if size.min() > ON_IT * unit_length:
        return 1.0 if across[size.argmin()] >= 0.0 else -1.0, bool(foot.any())
    # lines that touch show their side elsewhere: where they do it is a matter of round-off
    return 1.0 if across[np.isfinite(size)].sum() >= 0.0 else -1.0, bool(foot.any())


def _seen(x: Array, y: Array, B: Places) -> tuple[Array, Array]:
    """t·r and n·r (k,) of places ``x``, ``y`` (k,) in the frames of places of B."""
    r = ((x - B.x) + 1j * (y - B.y)) * B.tangent.conj()
    return r.real, r.imag


class _End(NamedTuple):
    """One end of a beam: what it is joined to; place and direction of the neutral line; T and T′ there."""

    held: Attachment | None
    x: float
    y: float
    angle: float
    half: float
    slope: float


def _ends(side: Side, sampled: Places, unit_length: float, *, thick: bool) -> tuple[_End, _End]:
    """Both ends of a beam, without units; ``sampled`` are places from the first to the last."""
    t, s, line = 0.5 * side.section.thickness, side.section.places, side.line
    start, end = (
        _End(
            held=side.ends[k],
            x=float(line.x0 + sampled.x[k]) / unit_length,
            y=float(line.y0 + sampled.y[k]) / unit_length,
            angle=cmath.phase(sampled.tangent[k]),
            half=float(t[k]) if thick else 0.0,
            slope=float((t[k] - t[inner]) / (s[k] - s[inner])) if thick else 0.0,
        )
        for k, inner in ((0, 1), (-1, -2))
    )
    return start, end


def _clamped(mine: tuple[_End, _End], its: tuple[_End, _End], side: float) -> tuple[bool, bool]:
    """For the start and the end of A, whether it is clamped beside an end of B, touching and parallel."""
    start, end = (any(_together(one, other, side, k) for k, other in enumerate(its)) for one in mine)
    return start, end


def _together(one: _End, other: _End, side: float, number: int) -> bool:
    """Whether an end of A touches an end of B, its start or its end by ``number``, and moves with the same body."""
    if one.held is None or other.held is None or one.held.frame != other.held.frame:
        return False
    rx, ry, wide = one.x - other.x, one.y - other.y, one.half + other.half
    if math.hypot(rx, ry) > wide + 2.0 * ON_IT:
        return False
    # tangents of the edges that face each other
    facing = math.copysign(1.0, math.cos(one.angle - other.angle))
    direction = other.angle + side * math.asin(max(-1.0, min(other.slope, 1.0)))
    turn = one.angle - side * facing * math.asin(max(-1.0, min(one.slope, 1.0))) - direction
    cos, sin = math.cos(direction), math.sin(direction)
    along, across = cos * rx + sin * ry, cos * ry - sin * rx
    beyond = along if number else -along
    foot = -ON_IT <= beyond <= max(ON_IT, PARALLEL * abs(across))
    return foot and abs(side * across - wide) <= ON_IT and abs(math.sin(turn)) <= ON_IT
