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

from collections.abc import Sequence

import numpy as np

from cprbm import wells
from cprbm.circle import Circle
from cprbm.closest import STRAIGHT, not_gone_round
from cprbm.feet import PARALLEL, Lines, distance_along, feet_near, nearest_places
from cprbm.kinematics import Positions, State
from cprbm.nearest import Pair
from cprbm.pairs import Touching
from cprbm.smooth import Points
from cprbm_scene.answer import Array, Ints

FEW = 50_000  # distances that are sooner worked out than sought
CLOSE = 1e-6  # units of length: by less a foot is off, and D by a part of the square
OPEN = np.array([np.inf])
NEARLY = 0.05  # h: where an end of B is farther than this from touching, its distance is not worked out
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
        least = min(least, float(here.lowest_near(line, lowest).min()))
    return least - circle.offset


def _of_beams(pair: Pair, state: State, at: Positions) -> float:
    """Least gap of two beams by their middle lines' distance, where it is negative."""
    lines = pair.lines(state, at)
    A, B = lines[0].sampled, lines[1].sampled
    within = pair.offset + float(pair.a.sizes.max()) + float(pair.b.sizes.max())
    distance, springs, d, sigma = _from_springs(pair, lines)
    least, end = np.inf, pair.b.s[-1]
    seen = (distance < within) & (np.abs(sigma - 0.5 * end) <= 0.5 * end + PARALLEL * within)
    if seen.any():
        D = np.where(seen, d, np.inf)
        told = not_gone_round(pair, lines, D, 0.0)
        if told is not D:
            return pair.least_gap(state, at)
        least, reach = float(D.min()), pair.offset + LOWER * pair.a.h
        if -0.5 * within <= least < reach:
            least = _least_below(pair, lines, D, reach, springs)
    ends = np.array((0, len(B.s) - 1))
    E, _ = _on_circles(pair.across, B.x[ends], B.y[ends], A, _nearest_springs(B.x[ends], B.y[ends], A)[1])
    ends = ends[(-within < E) & (pair.offset + NEARLY * pair.a.h > E)]
    if ends.size:
        E, _, foot = distance_along(pair.exchanged(), lines[::-1], B.s[ends])
        E = not_gone_round(pair.exchanged(), lines[::-1], np.where(foot, E, np.inf), 0.0)
        least = min(least, float(E.min()))
    return pair.least_gap(state, at) if least < -0.5 * within else least - pair.offset


def may_be_beyond(pair: Pair, state: State, at: Positions) -> bool:
    """Whether, as it seems from the springs, a part of a beam lies beyond the other; never False where one does."""
    lines, ends = pair.lines(state, at), pair.b.s[[0, -1]]
    A, B = lines[0].sampled, lines[1].sampled
    # what is beyond is so by more than twice this: a place and its foot are known to less than an element
    least = -pair.offset - 0.5 * STRAIGHT * (pair.a.h + pair.b.h)
    _, _, d, sigma = _from_springs(pair, lines)
    if (d < least).any() and ((d < least) & (np.abs(sigma - 0.5 * ends[1]) < 0.5 * ends[1] + pair.b.h)).any():
        return True
    x, y = B.x[[0, -1]], B.y[[0, -1]]
    d, s = _on_circles(pair.across, x, y, A, _nearest_springs(x, y, A)[1])
    return bool(((d < least) & (np.abs(s - 0.5 * pair.a.s[-1]) < 0.5 * pair.a.s[-1] + pair.a.h)).any())


def never_beyond(pair: Pair, way: Sequence[tuple[State, Positions]], allowed: float) -> bool:
    """Whether the joints tell of some states that no joint of A with a foot on B has D < −``allowed`` there.

    The foot lies beside a joint p of B, e ≤ h along B from it, and that joint is no farther than the nearest by more
    than h.  B turns by at most Θ in an element, at rest and since, so that with n̄ the normal there

        n̄·(C_A − p) ≤ D cos Θ + e²Θ/(2h) + hΘ/8 < −allowed·cos Θ + ¾ hΘ,

    the last but one what the line is off its joint.  Where no such joint says so there is no such place.
    """
    if pair.tapered or not way:
        return False
    a, b = pair.a, pair.b
    theta = np.array([state.theta[b.links] for state, _ in way])
    h, turn = float(b.sizes.max()), float((np.abs(theta[:, 1:] - theta[:, :-1]) + np.abs(b.turns)).max())
    most = -allowed * np.cos(turn) + 0.75 * h * turn
    if turn > 0.5 * np.pi or most >= 0.0 or len(a.s) * len(b.s) > FEW:
        return False
    psi = np.concatenate((theta[:, :1], 0.5 * (theta[:, 1:] + theta[:, :-1]), theta[:, -1:]), axis=1)
    A, B = (np.array([(at.x[chain.joints], at.y[chain.joints]) for _, at in way]) for chain in (a, b))
    normals = pair.side * np.array((-np.sin(psi), np.cos(psi))).transpose(1, 0, 2)
    # of each state and joint of A those of B with n̄·(C_A − p) below that
    beyond = A.transpose(0, 2, 1) @ normals < ((normals * B).sum(axis=1) + most)[:, None]
    if not beyond.any():
        return True
    # as seen from every joint of B, that is not one of the nearest
    # (squares of the distances, but for that of C_A itself, which is the same for all of B)
    apart = (-2.0 * A).transpose(0, 2, 1) @ B
    apart += (B * B).sum(axis=1)[:, None]
    own = (A * A).sum(axis=1)
    reach = np.sqrt(np.maximum(apart.min(axis=2) + own, 0.0)) + h
    return not (beyond & (apart <= (reach * reach - own)[:, :, None])).any()


def _from_springs(pair: Pair, lines: Lines) -> tuple[Array, Array, Array, Array]:
    """Of A's samples (k,) the distance to the nearest spring or end of B, where that is on B, ±d and σ."""
    known, what = lines[0].known, (pair.known_as, "springs")
    if what not in known:
        A, B = lines[0].sampled, lines[1].sampled
        distance, nearest = _nearest_springs(A.x, A.y, B)
        known[what] = distance, B.s[nearest], *_on_circles(pair.side, A.x, A.y, B, nearest)
    distance, places, d, sigma = known[what]
    return distance, places, d, sigma


def _nearest_springs(x: Array, y: Array, B: Points) -> tuple[Array, Ints]:
    """Distance of places (k,) to the nearest spring or end of B, and its number among B's samples, (k,) each."""
    bx, by = B.x[::2], B.y[::2]
    if len(x) * len(bx) > FEW:
        distance, nearest = nearest_places((bx, by), (x, y), np.inf)
        return distance, 2 * nearest
    squares, across = x[:, None] - bx, y[:, None] - by
    squares *= squares
    across *= across
    squares += across
    nearest = squares.argmin(axis=1)
    return np.sqrt(squares[np.arange(len(x)), nearest]), 2 * nearest


def _on_circles(side: float, x: Array, y: Array, B: Points, samples: Ints) -> tuple[Array, Array]:
    """±d of places of A (k,), and σ of their feet on the circles about ``samples`` of B (k,)."""
    x, y, psi, speed = x - B.x[samples], y - B.y[samples], B.tangent[samples], B.speed[samples]
    bend = B.bend[samples] / speed
    cos, sin = np.cos(psi), np.sin(psi)
    t_r, n_r = cos * x + sin * y, cos * y - sin * x
    left = 1.0 - bend * n_r
    d = (2.0 * n_r - bend * (x * x + y * y)) / (1.0 + np.hypot(bend * t_r, left))
    ahead = t_r / np.maximum(left, 0.2)
    turn = bend * ahead
    return side * d, B.s[samples] + ahead * (1.0 - turn * turn / 3.0) / speed


def _least_below(pair: Pair, lines: Lines, D: Array, reach: float, springs: Array) -> float:
    """The least of D below ``reach``, from D at A's samples (k,) and the ``springs`` of B that are nearest (k,)."""
    # at an end no parabola goes through
    D, s = np.concatenate((OPEN, D, OPEN)), np.concatenate((OPEN, lines[0].sampled.s, OPEN))
    lowest, B = wells.lowest(D, reach), lines[1].sampled
    A = pair.on_a(lines, s[lowest] + wells.lowest_of_parabola(s, D, lowest))
    _, sigma = _on_circles(pair.side, A.x, A.y, B, B.s.searchsorted(springs[lowest - 1]))
    distance, _, foot = feet_near(pair, lines, A, sigma, CLOSE)
    return float(np.where(foot, distance, np.inf).min())
