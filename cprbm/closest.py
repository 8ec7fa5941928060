"""Where two beams are closest, and where rows of their contact stand: minima of D, joints, and the beams' ends.

Symbols are those of :mod:`cprbm.nearest`.  D is sampled at the joints of A and half-way between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cprbm import leaning, smooth, wells
from cprbm.crossing import cross
from cprbm.feet import (
    CLOSE,
    LAST,
    NO_RIDGES,
    Lines,
    distance_along,
    distance_of,
    feet_from,
    feet_of_ridges,
    nearest_samples,
    seen_from,
    up_to,
)
from cprbm.model import Chain
from cprbm_scene.answer import Array, Flags, Ints

if TYPE_CHECKING:
    from cprbm.nearest import Pair

CLOSEST_ITERATIONS = 50
PATIENCE = 4  # iterations of Newton's method, after which a minimum may be sought where B has ended
LIPSCHITZ = 1.2  # a way along B's tangent over the arc length of A that makes it, with something to spare
LEAST_CURVATURE = 1e-3  # of D, 1/ℓ: elements that end elsewhere on either beam leave as much in a zone
REACH = 0.1  # minima and ends with gaps wider than this part of the longest beam are no constraints yet
JOINT_REACH = 2.0  # joints with gaps wider than this many h²·(|ψ_A'| + |ψ_B'| + 1/ℓ) are none
SAME = 1e-3  # lengths that differ by less than this part are one
SETTLED = 1e-9  # slope of D at a minimum
STEEP = 1e-3  # slope of D where there is no minimum within CLOSE
BESIDE_END = 0.25  # a joint closer than this many h to where an end of B faces A leaves its place to that
STRAIGHT = 0.1  # of an element: by less a line is off the chords between its samples
CLEAR = 0.9  # of both half thicknesses: farther from B's line, on its other side, A lies clear of it
THIN = 0.01  # of both elements: the same where lines have no thickness
SURE = 0.25  # of a depth by which a line lies beyond another: chords that are off by less tell whether it crosses it


@dataclass(frozen=True, slots=True)
class Places:
    """Where rows stand on one beam, and their feet on the other.

    Attributes:
        s, sigma: arc lengths on the one beam and on the other (k,).
        keys: of the rows (k,): a joint's number on A, beyond those the ends of B, clamps, and places that are fixed;
            negative where s moves.
    """

    s: Array
    sigma: Array
    keys: Ints

    def joined(self, more: Places) -> Places:
        """With others."""
        return Places(
            np.concatenate((self.s, more.s)),
            np.concatenate((self.sigma, more.sigma)),
            np.concatenate((self.keys, more.keys)),
        )

    def only(self, these: Flags) -> Places:
        """Some of the places."""
        return Places(self.s[these], self.sigma[these], self.keys[these])


def closest_places(pair: Pair, lines: Lines) -> tuple[Places, Places, bool]:
    """Where rows stand on A, and on B with the beams' parts exchanged; and whether a part has come round an end."""
    ends, its_gone = _facing_ends(pair, lines)
    D, sigma, gone = _sampled(pair, lines)
    return places_along(pair, lines, D, sigma, ends.sigma), ends, gone or its_gone


def places_along(pair: Pair, lines: Lines, D: Array, sigma: Array, ends: Array) -> Places:
    """Where rows stand on A, from D and the feet at its samples (2N+3,), and from where ``ends`` of B face it."""
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    if pair.fixed:
        s = pair.kinks[0].places
        turned = distance_along(pair, lines, s)[1]
    else:
        s, turned = minima(pair, lines, D, sigma)

    near = np.zeros(a.n + 2, dtype=bool)
    facing = np.isfinite(D[::2]).nonzero()[0]
    if facing.size:
        A, B = faced(pair, lines, D, sigma, facing)
        bends = np.abs(A.bend) + np.abs(B.bend)
        near[facing] = D[2 * facing] - pair.offset < JOINT_REACH * a.h**2 * (1.0 + bends)
    for places, apart in ((s, wells.BESIDE), (ends, BESIDE_END)):
        if places.size:
            away = np.abs(a.s[1:-1, None] - places)
            near[1:-1] &= (away > apart * a.size_at(places)).all(axis=1)
    for end in (0, -1):
        near[end] = reach > D[end] and not held_together(a, b, end, float(sigma[end]))
    joints = near.nonzero()[0]
    own = a.n + 6 + np.arange(len(s)) if pair.fixed else np.zeros(len(s), dtype=np.intp) - 1
    keys = np.concatenate((joints, own))
    found = Places(np.concatenate((a.s[joints], s)), np.concatenate((sigma[2 * joints], turned)), keys)
    return found.joined(_corners(pair, lines, D, sigma)) if pair.tapered and a.section.ridges.size else found


def _corners(pair: Pair, lines: Lines, D: Array, sigma: Array) -> Places:
    """Where corners of A's edge stand out within reach, unless a joint has a row there, and their feet on B."""
    a = pair.a
    s, E, feet, number = feet_of_ridges(pair, lines, D, sigma)
    near = (pair.offset + REACH > E) & (np.min(np.abs(s[:, None] - a.s), axis=1) > SAME * a.h)
    # behind the keys of places that are fixed
    return Places(s[near], feet[near], a.n + 6 + len(pair.kinks[0].places) + number[near])


def _facing_ends(pair: Pair, lines: Lines) -> tuple[Places, bool]:
    """The ends of B that face A within reach, and their feet on A; the keys follow A's joints.

    And whether another one has come round an end of A.
    """
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    (A, B), ends = pair.samples(lines), b.s[[0, -1]]
    away = np.hypot(A.x - B.x[[0, -1], None], A.y - B.y[[0, -1], None])
    nearest = away.argmin(axis=1)
    near = (away[[0, 1], nearest] < reach + a.h).nonzero()[0]
    if near.size and not pair.tapered:
        # what is beyond an end of A has its foot there
        beyond = seen_from(A.only(nearest[near]), B.only(near * (2 * b.n + 2)))[0]
        first, last = nearest[near] == 0, nearest[near] == len(A.s) - 1
        near = near[~((first & (beyond <= 0.0)) | (last & (beyond >= 0.0)))]
    if not near.size:
        return Places(np.zeros(0), np.zeros(0), near), False
    turned = pair.exchanged()
    at_B = B.only(near * (2 * b.n + 2))
    E, foot, facing, _ = feet_from(turned, lines[::-1], at_B, A.only(nearest[near]), CLOSE)
    told = not_gone_round(turned, lines[::-1], E, pair.wider(foot, ends[near]))
    facing &= (foot > SAME * a.h) & (foot < a.s[-1] - SAME * a.h)
    gone = bool(np.any(facing & np.isinf(told)))
    facing &= reach > told
    for i, end in enumerate(near):
        facing[i] &= not held_together(b, a, int(-end), float(foot[i]))
    return Places(ends[near][facing], foot[facing], a.n + 2 + near[facing]), gone


def faced(pair: Pair, lines: Lines, D: Array, sigma: Array, joints: Ints) -> tuple[smooth.Points, smooth.Points]:
    """Some joints of A, by their numbers (k,), and their feet, ``D`` and ``sigma`` being those of A's samples."""
    known, what = lines[0].faced, pair.known_as
    if what not in known or known[what][0] is not D:
        known[what] = D, pair.samples(lines)[0].only(2 * joints), pair.on_b(lines, sigma[2 * joints])
    return known[what][1:]


def held_together(one: Chain, other: Chain, end: int, foot: float) -> bool:
    """Whether an end of ``one`` and what its foot on ``other`` lies on move with one body: their gap is no unknown."""
    mine = one.start if end == 0 else one.end
    if mine is None:
        return False
    first, last = other.s[1], other.s[-1] - other.s[-2]
    for its, away, half in ((other.start, foot, first), (other.end, other.s[-1] - foot, last)):
        if its is None or its.frame != mine.frame:
            continue
        # a welded end moves with the body as far as its half element hardly bends
        if away <= (half if its.welded and mine.welded else SAME * half):
            return True
    return False


def sampled_distances(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    """D at the joints of A and half-way between them, infinite where it is out of reach, and σ, (2N+3,) each."""
    D, sigma, _ = _sampled(pair, lines)
    return D, sigma


def _sampled(pair: Pair, lines: Lines) -> tuple[Array, Array, bool]:
    """The same, and whether any of them has come round an end to the other side."""
    known, what = lines[0].known, (pair.known_as, "samples")
    if what not in known:
        known[what] = _sampled_anew(pair, lines)
    D, sigma, gone = known[what]
    return D, sigma, gone


def _sampled_anew(pair: Pair, lines: Lines) -> tuple[Array, Array, bool]:
    D, sigma = on_either_side(pair, lines)
    told = not_gone_round(pair, lines, D, pair.wider(pair.a.halves, sigma))
    gone = told is not D
    if gone:
        D = np.where(_with_neighbours(np.isinf(told), D < 0.0), np.inf, D)
    return D if pair.offset else _not_beside_a_tip(pair, lines, D, sigma), sigma, gone


def _not_beside_a_tip(pair: Pair, lines: Lines, D: Array, sigma: Array) -> Array:
    """D of lines without thickness, but infinite where A comes round an end of B that presses it, or nearly.

    Beyond the end there is no foot, and the first places behind it are no farther from B than round-off.
    """
    below, ends = D < 0.0, pair.b.s[[0, -1]]
    for end in (0, 1):
        off = np.isinf(D) & (sigma == ends[end])
        beside = below & (np.append(off[1:], False) | np.append(False, off[:-1]))
        beside[[0, -1]] = False  # an end of A that presses B itself
        if beside.any() and _stands_on(pair, lines, end):
            D = np.where(_with_neighbours(beside, below), np.inf, D)
    return D


def _stands_on(pair: Pair, lines: Lines, end: int) -> bool:
    """Whether B stands with an end, its first or its last, on the side of A on which it lies, or nearly."""
    tip = pair.on_b(lines, pair.b.s[[-end]])
    (E,), foot, (facing,) = distance_of(pair.exchanged(), lines[::-1], tip)
    turned = float((tip.psi - pair.on_a(lines, foot).psi)[0])
    # from the end on, which way B goes
    inwards = pair.across * math.sin(turned) * (1.0 if end == 0 else -1.0)
    return bool(facing) and abs(E) < clear(pair) and inwards > 0.0


def on_either_side(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    """D and σ at the same places, also where A has come round an end."""
    known, what = lines[0].known, (pair.known_as, "either side")
    if what not in known:
        known[what] = _on_either_side_anew(pair, lines)
    D, sigma = known[what]
    return D, sigma


def _on_either_side_anew(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    A, G = pair.samples(lines)
    # far parts are left out by their distance from B's samples, which no foot can undercut by more than h
    rough, nearest = nearest_samples(G, A, pair.offset + reach(pair.a, pair.b))
    close = np.isfinite(rough).nonzero()[0]
    sigma = np.zeros(len(A.s))
    D = sigma + np.inf
    if not close.size:
        return D, sigma
    at_A, at_B = A.only(close), G.only(nearest[close])
    distance, sigma[close], foot, at_B = feet_from(pair, lines, at_A, at_B, CLOSE)
    D[close[foot]] = distance[foot]
    if not pair.tapered:  # else these are points of edges
        joints = ((close % 2 == 0) & np.isfinite(D[close])).nonzero()[0]
        lines[0].faced[pair.known_as] = D, at_A.only(joints), at_B.only(joints)
    return D, sigma


def not_gone_round(pair: Pair, lines: Lines, D: Array, wider: Array | float, gone: float = np.inf) -> Array:
    """D, but ``gone`` where A lies clear of B on its other side and has not come there through it, but round an end."""
    beyond = clear_beyond(pair, D, wider)
    if not beyond.any():
        return D
    # what is behind is asked for only where something has come there round an end
    through = not pair.behind and (
        crossing(lines, -float((D + wider)[beyond].max()))
        or (not pair.offset and (_touched(pair, lines) or _touched(pair.exchanged(), lines[::-1])))
    )
    return D if through else np.where(beyond, gone, D)


def _touched(pair: Pair, lines: Lines) -> bool:
    """Whether a part of A with feet on B lies beyond it in one place and touches it, away from its ends, in another.

    Of lines without thickness that may be where they cross: one that has turned about its end, through the other.
    """
    D, sigma = on_either_side(pair, lines)
    beyond, faces, end = clear_beyond(pair, D, 0.0), np.isfinite(D), pair.b.s[-1]
    touching = faces & ~beyond & (np.abs(sigma - 0.5 * end) < 0.5 * end - pair.b.h)
    return bool(np.any(_with_neighbours(touching, faces) & beyond))


def clear_beyond(pair: Pair, D: Array, wider: Array | float) -> Flags:
    """Where A lies clear of B on its other side."""
    return np.asarray(D + 2.0 * wider + clear(pair) < 0.0)


def clear(pair: Pair) -> float:
    """How far from B's line, on its other side, A lies clear of it, units of length."""
    # lines that touch each other may seem to lie beyond by round-off
    return CLEAR * pair.offset if pair.offset else THIN * (pair.a.h + pair.b.h)


def _with_neighbours(some: Flags, alike: Flags) -> Flags:
    """``some`` of a row of places, and those beside them and beside these that are ``alike``, (n,) each."""
    run = np.cumsum(np.append(True, alike[1:] != alike[:-1]))
    return np.asarray(some | (alike & np.isin(run, run[some & alike])))


def crossing(lines: Lines, depth: float) -> bool:
    """Whether the lines cross, by chords so short that they are off by a small part of a ``depth``.

    What touches an end seems to cross there by as much: the lines are held against each other without their last bits.
    """
    A, B = (line.sampled for line in lines)
    far, off = sum(line.chain.h for line in lines), SURE * depth
    finer = math.ceil(math.sqrt(STRAIGHT * far / off))
    runs = [
        _near(line, nearest_samples(one, other, far)[0], finer, 2.0 * off)
        for line, one, other in zip(lines, (B, A), (A, B), strict=True)
    ]
    return any(cross(P, Q) for P in runs[0] for Q in runs[1])


def _near(line: smooth.SmoothLine, apart: Array, finer: int, cut: float) -> list[Array]:
    """Parts of a line near another, by how far ``apart`` its samples are from that: places (m, 2) of each, closer
    together by ``finer``, none of them within a ``cut`` of the line's ends.
    """
    near, samples, part = np.isfinite(apart), line.chain.halves, np.arange(finer) / finer
    pieces = (near[1:] | near[:-1]).nonzero()[0]
    runs = []
    for run in np.split(pieces, (np.diff(pieces) > 1).nonzero()[0] + 1):
        if run.size:
            first, last = samples[run], samples[run + 1]
            s = np.append((first[:, None] + (last - first)[:, None] * part).ravel(), last[-1])
            at = line.at(np.clip(s, cut, max(cut, samples[-1] - cut)))
            runs.append(np.stack((at.x, at.y), axis=1))
    return runs


def minima(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array]:
    """(s, σ) of the minima of D within A that have a place of their own, from its samples.

    Newton's method on dD/ds = 0 and on (i), kept between the samples beside the lowest: where the curvature jumps
    it alone would not settle.
    """
    known, what = lines[0].known, (pair.known_as, "minima" if pair.own_places else "none")
    if what not in known or known[what][0] is not D:
        known[what] = D, *_minima_anew(pair, lines, D, sigma)
    _, s, sigma = known[what]
    return s, sigma


def _minima_anew(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array]:
    s, lowest = pair.a.halves, wells.lowest(D, pair.offset + REACH)
    if not lowest.size:
        return np.zeros(0), np.zeros(0)
    # the joints beside a common clamp press together, a place of its own among them would part them
    first, last = [4 * pair.shared if clamped else 0 for clamped in pair.clamped]
    lowest = lowest[pair.own_places & (lowest > first) & (lowest < 2 * (pair.a.n + 1) - last)]
    if not lowest.size:
        return np.zeros(0), np.zeros(0)
    parting, near = np.zeros(pair.a.n + 2) + np.inf, np.isfinite(D[::2]).nonzero()[0]
    parting[near] = pair.parting_at(lines, *faced(pair, lines, D, sigma, near), D[2 * near])
    found = wells.wells(pair.a, D - pair.offset, parting, lowest, LEAST_CURVATURE, pair.kinks[0].places)
    if not found.samples.size:
        return np.zeros(0), np.zeros(0)
    before, here, behind = found.samples - 1, found.samples, found.samples + 1
    low, high = s[before], s[behind]
    ahead = wells.lowest_of_parabola(s, D, here)
    beside = np.where(ahead > 0.0, behind, before)
    share = ahead / (s[beside] - s[here])
    # where no parabola goes through, the middle one's foot
    sigma = np.where(ahead == 0.0, sigma[here], sigma[here] + share * (sigma[beside] - sigma[here]))
    s = s[here] + ahead
    ridges = pair.b.section.ridges if pair.tapered else NO_RIDGES
    end, latest = pair.b.s[-1], np.zeros(len(s))
    for iteration in range(CLOSEST_ITERATIONS):
        A, B = pair.facing_each_other(*pair.on_both(lines, s, sigma))
        along, across = seen_from(B, A)
        turned = A.psi - B.psi
        facing, shortened = np.cos(turned), B.pace - B.bend * across
        # what is left to the foot, and the slope there
        left = along / shortened
        slope = pair.side * (np.sin(turned) - facing * B.bend * left)
        towards = facing * A.pace / shortened  # dσ/ds
        bends = pair.side * facing * (A.bend - B.bend * towards)
        convex, falls = bends > LEAST_CURVATURE, slope < 0.0
        low, high = np.where(falls, s, low), np.where(falls, high, s)
        ahead = s - slope / np.where(convex, bends, np.inf)
        newton = convex & (ahead >= low) & (ahead <= high)
        step = (ahead if newton.all() else np.where(newton, ahead, 0.5 * (low + high))) - s
        ahead = np.minimum(np.maximum(sigma + left + towards * step, 0.0), end)
        if ridges.size:
            ahead = np.where(leaning.at_corner(B), sigma, up_to(ridges, sigma, ahead))
        moved = np.maximum(np.abs(step), np.abs(ahead - sigma))
        s, sigma = s + step, ahead
        inner = (sigma > 0.0) & (sigma < end)
        # what Newton's method would leave after one more step is nothing
        known = newton & inner & (moved * moved < LAST * CLOSE * latest)
        if known.all():
            break
        there = known | ((np.abs(step) < CLOSE) & (np.abs(along) < CLOSE) & (np.abs(slope) < SETTLED))
        if not ridges.size:  # no slope as steep as that goes through zero in so little
            there |= (high - low < CLOSE) & (np.abs(slope) > STEEP)
            if iteration > PATIENCE:
                there |= _beyond_ends(pair.b, B.s, along, high - low) & (shortened > 0.0)
        if there.all():
            break
        latest = moved
    held = found.held(pair.side * across - pair.wider(s, sigma) - pair.offset)
    # beyond an end of B there is no foot: what lies there faces that end, which has a row of its own
    settled = held & convex & (known | ((np.abs(slope) < SETTLED) & (inner | (np.abs(along) < SETTLED))))
    return s[settled], sigma[settled]


def _beyond_ends(b: Chain, sigma: Array, along: Array, within: Array) -> Flags:
    """Which places of A lie so far beyond an end of B that no other place ``within`` as much (k,) of A has a foot."""
    out = np.where(sigma <= 0.0, -along, np.where(sigma >= b.s[-1], along, -np.inf))
    return np.asarray(out > LIPSCHITZ * within)


def reach(one: Chain, other: Chain) -> float:
    """Gap of two beams beyond which there are no rows, units of length."""
    return REACH + one.h + other.h
