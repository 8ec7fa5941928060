"""A place at which one line is closest to another, sought by itself.

D, s, σ and ψ are those of :mod:`cprbm.nearest`, whose Newton's method this is in plain numbers (:mod:`cprbm.spot`):
where minima are few they are sooner found one after the other than all at once.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cprbm.spot import Spots

CLOSE = 1e-10  # units of length: a step after which a place is known to round-off
LAST = 0.1  # of that: what the next step would be, shorter by as much again as the last was, where none is taken
ITERATIONS = 50
PATIENCE = 4  # iterations of Newton's method, after which a minimum may be sought where B has ended
LIPSCHITZ = 1.2  # a way along B's tangent over the arc length of A that makes it, with something to spare
LEAST_CURVATURE = 1e-3  # of D, 1/ℓ: elements that end elsewhere on either beam leave as much in a zone
SETTLED = 1e-9  # slope of D at a minimum
STEEP = 1e-3  # slope of D where there is no minimum within CLOSE


class Closest(NamedTuple):
    """Where a search ended: ``s``, ``sigma``, n·r (``across``), and whether it has ``settled`` at a minimum."""

    s: float
    sigma: float
    across: float
    settled: bool


def closest(side: float, A: Spots, B: Spots, begin: tuple[float, float], within: tuple[float, float]) -> Closest:
    """The minimum of D along A from an s and σ to ``begin`` at, s ``within`` two between which the slope changes sign.

    ``side`` is that of A on B.
    """
    (s, sigma), (low, high), latest = begin, within, 0.0
    for iteration in range(ITERATIONS):
        a, b = A.at(s), B.at(sigma)
        x, y, cos, sin = a.x - b.x, a.y - b.y, math.cos(b.psi), math.sin(b.psi)
        along, across = cos * x + sin * y, cos * y - sin * x
        turned = a.psi - b.psi
        facing, shortened = math.cos(turned), b.speed - b.bend * across
        # what is left to the foot, and the slope there
        left = along / shortened if shortened else math.copysign(math.inf, along)
        slope = side * (math.sin(turned) - facing * b.bend * left)
        towards = facing * a.speed / shortened if shortened else 0.0  # dσ/ds
        bends = side * facing * (a.bend - b.bend * towards)
        convex = bends > LEAST_CURVATURE
        low, high = (s, high) if slope < 0.0 else (low, s)
        ahead = s - slope / bends if convex else s
        newton = convex and low <= ahead <= high
        step = (ahead if newton else 0.5 * (low + high)) - s
        ahead = min(max(sigma + left + towards * step, 0.0), B.end)
        moved = max(abs(step), abs(ahead - sigma))
        s, sigma = s + step, ahead
        inner = 0.0 < sigma < B.end
        # what Newton's method would leave after one more step is nothing
        known = newton and inner and moved * moved < LAST * CLOSE * latest
        if known or (abs(step) < CLOSE and abs(along) < CLOSE and abs(slope) < SETTLED):
            break
        # no slope as steep as that goes through zero in so little
        if high - low < CLOSE and abs(slope) > STEEP:
            break
        if iteration > PATIENCE and shortened > 0.0 and beyond_end(b.s, B.end, along) > LIPSCHITZ * (high - low):
            break
        latest = moved
    # beyond an end of B there is no foot: what lies there faces that end, which has a row of its own
    settled = convex and (known or (abs(slope) < SETTLED and (inner or abs(along) < SETTLED)))
    return Closest(s, sigma, across, settled)


def beyond_end(sigma: float, end: float, along: float) -> float:
    """How far along B what has its foot at ``sigma`` lies beyond an end of B; minus infinity where it is no end."""
    if sigma <= 0.0:
        return -along
    return along if sigma >= end else -math.inf
