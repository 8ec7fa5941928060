"""By how much beams overlap what they may touch, at most.

==========  ==============================================================================
D           distance of the neutral lines, or of one from what is rigid; T₀ where edges touch
g           D − T₀, the gap; an overlap is a negative one
r           from a sample of B, the nearest one, to one of A; t, n: B's tangent and normal
κ           curvature of B there
w           T₀ + h_A + h_B
==========  ==============================================================================

Of two beams only what is close can overlap, and D changes along A by no more than the way along it.  So where no sample
of A is within w of one of B, nothing overlaps; where D is above −w/2 at all samples that are, no other place of A lies
deeper; and else all of A is looked at, since parts of it may have gone through.

B is an arc about a sample, or nearly.  From the circle that goes on with it a place of A is by

    d = (2 n·r − κ r²)/(1 + √((κ t·r)² + (1 − κ n·r)²)),

which tells about where D is least.  There it is worked out.
"""

from __future__ import annotations

import numpy as np

from cprbm import wells
from cprbm.circle import Circle
from cprbm.kinematics import Positions, State
from cprbm.nearest import PARALLEL, Lines, Pair, distance_along, feet_near, nearest_samples, not_gone_round
from cprbm.pairs import Touching
from cprbm.smooth import Points
from scene.answer import Array, Ints

FEW = 50_000  # distances that are sooner worked out than sought
CLOSE = 1e-6  # units of length: by less a foot is off, and D by a part of the square
OPEN = np.array([np.inf])
LOWER = 0.25  # h: between two samples D is lower than at these by no more


def overlap(pair: Touching, state: State, at: Positions) -> float:
    """The largest overlap in a contact, units of length; nought where all is open."""
    if isinstance(pair, Circle):
        gap = _of_circle(pair, state, at)
    elif isinstance(pair, Pair) and not pair.tapered:
        gap = _of_beams(pair, state, at)
    else:
        gap = pair.least_gap(state, at)
    return max(0.0, -gap)


def _of_circle(circle: Circle, state: State, at: Positions) -> float:
    """Least gap of a beam and a circle, where it is negative."""
    line, here = circle.line(state, at), circle.placed(at)
    A = line.sampled
    D: Array = here.distance(A)
    least = float(D.min())
    lowest = wells.lowest(D, circle.offset + LOWER * circle.a.h)
    if lowest.size:
        A = line.at(A.s[lowest] + wells.lowest_of_parabola(A.s, D, lowest))
        slope, bend = here.slope(A), here.convexity(A)
        # on to where the slope is nought
        ahead = np.where(bend > 0.0, 0.5 * slope * slope / np.where(bend > 0.0, bend, 1.0), 0.0)
        least = min(least, float((here.distance(A) - ahead).min()))
    return least - circle.offset


def _of_beams(pair: Pair, state: State, at: Positions) -> float:
    """Least gap of two beams by their middle lines' distance, where it is negative."""
    lines = pair.lines(state, at)
    A, B = lines[0].sampled, lines[1].sampled
    within = pair.offset + float(pair.a.sizes.max()) + float(pair.b.sizes.max())
    close, nearest, ends = _close(A, B, within, pair.offset + LOWER * pair.a.h)
    least = np.inf
    if close.size:
        d, sigma = _on_circles(pair, A.x[close], A.y[close], B, nearest)
        outside = (sigma < -PARALLEL * within) | (sigma > pair.b.s[-1] + PARALLEL * within)
        D = np.full(len(A.s), np.inf)
        D[close] = np.where(outside, np.inf, d)
        D = not_gone_round(pair, lines, D, 0.0)
        least = float(D.min())
        reach = pair.offset + LOWER * pair.a.h
        if -0.5 * within <= least < reach:
            least = _least_below(pair, lines, D, reach, close, nearest)
    if ends.size:
        E, _, foot = distance_along(pair.exchanged(), lines[::-1], B.s[ends])
        E = not_gone_round(pair.exchanged(), lines[::-1], np.where(foot, E, np.inf), 0.0)
        least = min(least, float(E.min()))
    return pair.least_gap(state, at) if least < -0.5 * within else least - pair.offset


def _close(A: Points, B: Points, within: float, at_ends: float) -> tuple[Ints, Ints, Ints]:
    """Samples of A ``within`` a distance of B's springs (k,), the nearest of these among B's samples (k,), and B's ends.

    Of the ends those are told that are less than ``at_ends`` from a sample of A.
    """
    bx, by = B.x[::2], B.y[::2]
    if len(A.s) * len(bx) > FEW:
        distance, nearest = nearest_samples(np.stack((bx, by), axis=1), A, within)
        close = np.flatnonzero(np.isfinite(distance))
        nearest = nearest[close]
        last = np.array((0, len(bx) - 1))
        away = ((A.x[:, None] - bx[last]) ** 2 + (A.y[:, None] - by[last]) ** 2).min(axis=0)
    else:
        squares, y = A.x[:, None] - bx, A.y[:, None] - by
        squares *= squares
        y *= y
        squares += y
        close = (squares.min(axis=1) < within * within).nonzero()[0]
        nearest = squares[close].argmin(axis=1)
        away = squares[:, :: len(bx) - 1].min(axis=0)
    return close, 2 * nearest, (away < at_ends * at_ends).nonzero()[0] * (len(B.s) - 1)


def _on_circles(pair: Pair, x: Array, y: Array, B: Points, samples: Ints) -> tuple[Array, Array]:
    """±d of places of A (k,), and σ of their feet on the circles about ``samples`` of B (k,)."""
    x, y, psi, speed = x - B.x[samples], y - B.y[samples], B.tangent[samples], B.speed[samples]
    bend = B.bend[samples] / speed
    cos, sin = np.cos(psi), np.sin(psi)
    t_r, n_r = cos * x + sin * y, cos * y - sin * x
    left = 1.0 - bend * n_r
    d = (2.0 * n_r - bend * (x * x + y * y)) / (1.0 + np.hypot(bend * t_r, left))
    ahead = t_r / np.maximum(left, 0.2)
    turn = bend * ahead
    return pair.side * d, B.s[samples] + ahead * (1.0 - turn * turn / 3.0) / speed


def _least_below(pair: Pair, lines: Lines, D: Array, reach: float, close: Ints, nearest: Ints) -> float:
    """The least of D below ``reach``, from D at A's samples and the ``nearest`` of B to those ``close`` (k,)."""
    # at an end no parabola goes through
    D, s = np.concatenate((OPEN, D, OPEN)), np.concatenate((OPEN, lines[0].sampled.s, OPEN))
    lowest = wells.lowest(D, reach)
    A = pair.on_a(lines, s[lowest] + wells.lowest_of_parabola(s, D, lowest))
    _, sigma = _on_circles(pair, A.x, A.y, lines[1].sampled, nearest[close.searchsorted(lowest - 1)])
    distance, _, foot = feet_near(pair, lines, A, sigma, CLOSE)
    return float(np.where(foot, distance, np.inf).min())
