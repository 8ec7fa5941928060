"""Feet of perpendiculars: which place of one beam faces a place of another, and how far away it is.

==========  ==================================================================================
C_A, C_B    smooth neutral lines of the two beams, :mod:`cprbm.smooth`
s, σ        arc lengths on A and B
r           C_A(s) − C_B(σ)
t, n        tangent and left normal of B at σ
D           side·n·r: distance of the neutral lines, negative where they have passed each other
==========  ==================================================================================

σ is the foot of what stands at s where t·r = 0 (i).  Where thickness varies t and n lean, :mod:`cprbm.nearest`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cprbm import smooth
from cprbm_scene.answer import Array, Flags, Ints

if TYPE_CHECKING:
    from cprbm.nearest import Pair

FOOT_ITERATIONS = 8
CORNER_ITERATIONS = 40  # where edges have corners that stand out, at each of which a step ends
NO_RIDGES = np.zeros(0)
CLOSE = 1e-10  # units of length: a step after which a place is known to round-off
LAST = 0.1  # of that: what the next step would be, shorter by as much again as the last was, where none is taken
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot
MANY = 27_000  # distances of samples, up to which all are looked at sooner than a tree is made

Lines = tuple[smooth.SmoothLine, smooth.SmoothLine]


def nearest_samples(G: smooth.Points, A: smooth.Points, within: float) -> tuple[Array, Ints]:
    """Distance from points of ``A`` (k,) to the nearest of ``G`` (m,), infinite beyond ``within``; its number."""
    return nearest_places((G.x, G.y), (A.x, A.y), within)


def nearest_places(G: tuple[Array, Array], A: tuple[Array, Array], within: float) -> tuple[Array, Ints]:
    """The same of places by their x and y, (m,) and (k,) each."""
    if G[0].size * A[0].size <= MANY:
        apart, across = A[0][:, None] - G[0], A[1][:, None] - G[1]
        apart *= apart
        across *= across
        apart += across
        number = apart.argmin(axis=1)
        distance = np.sqrt(np.minimum.reduce(apart, axis=1))
        return np.where(distance < within, distance, np.inf), number
    from scipy.spatial import cKDTree  # loaded where beams with many links may touch each other

    # places follow each other along lines: a tree that is not levelled is soon made and soon gone through
    tree = cKDTree(np.array(G).T, balanced_tree=False, compact_nodes=False)
    distance, number = tree.query(np.array(A).T, distance_upper_bound=within)
    return np.asarray(distance), np.asarray(number)


def seen_from(B: smooth.Points, A: smooth.Points) -> tuple[Array, Array]:
    """t·r and n·r of points of A in the frames of points of B, (k,) each."""
    rx, ry = A.x - B.x, A.y - B.y
    cos, sin = np.cos(B.psi), np.sin(B.psi)
    return cos * rx + sin * ry, cos * ry - sin * rx


def distance_along(pair: Pair, lines: Lines, s: Array) -> tuple[Array, Array, Flags]:
    """Signed distance D of A from B at arc lengths ``s``: D, σ (k,), and whether a foot exists (k,)."""
    return distance_of(pair, lines, pair.on_a(lines, s))


def distance_of(pair: Pair, lines: Lines, A: smooth.Points) -> tuple[Array, Array, Flags]:
    """The same of points of A (k,)."""
    nearest = nearest_samples(lines[1].sampled, A, np.inf)[1]
    return feet_from(pair, lines, A, pair.samples(lines)[1].only(nearest), CLOSE)[:3]


def past_foot(pair: Pair, lines: Lines, s: Array, sigma: Array) -> Array:
    """How far beyond their feet σ (k,) points of A at arc lengths ``s`` (k,) lie along B: nothing but at its ends."""
    A = pair.on_a(lines, s)
    return seen_from(pair.foot(lines, A, sigma), A)[0]


def feet_near(
    pair: Pair, lines: Lines, A: smooth.Points, sigma: Array, close: float = CLOSE
) -> tuple[Array, Array, Flags]:
    """D, σ and whether there is a foot, by Newton's method on (i) from the guess ``sigma`` to steps as ``close``."""
    return feet_from(pair, lines, A, pair.on_b(lines, sigma), close)[:3]


def feet_from(
    pair: Pair, lines: Lines, A: smooth.Points, B: smooth.Points, close: float
) -> tuple[Array, Array, Flags, smooth.Points]:
    """The same from points of B (k,), and the points of B to which D belongs."""
    sigma, h, end, last = B.s, pair.b.h, pair.b.s[-1], 0.0
    ridges = pair.b.section.ridges if pair.tapered else NO_RIDGES
    for iteration in range(FOOT_ITERATIONS if not ridges.size else CORNER_ITERATIONS):
        B = pair.on_b(lines, sigma) if iteration else B
        B = pair.facing(A, B) if pair.tapered else B
        along, across = seen_from(B, A)
        # along the circle of curvature, where that is round the foot
        left = along / np.maximum(B.pace - B.bend * across, 0.2)
        turn = B.bend * left
        step = left / (1.0 + turn * turn / 3.0)
        before = sigma
        sigma = np.minimum(np.maximum(before + np.minimum(np.maximum(step, -h), h), 0.0), end)
        if ridges.size:
            sigma = up_to(ridges, before, sigma)
        moved = float(np.maximum.reduce(np.abs(sigma - before)))
        if moved < close or (not ridges.size and moved * moved < LAST * close * last):
            break
        last = moved
    foot = np.abs(along) <= PARALLEL * np.maximum(np.abs(across), pair.b.h)
    return pair.side * across - (pair.wider(A.s, sigma) if pair.tapered else 0.0), sigma, foot, B


def up_to(ridges: Array, before: Array, after: Array) -> Array:
    """Places ``after`` (k,), but the first of the ``ridges`` (j,) where one lies between them and those ``before``."""
    fenced = np.concatenate(([-np.inf], ridges, [np.inf]))
    low = fenced[np.searchsorted(ridges, before, side="left")]
    high = fenced[np.searchsorted(ridges, before, side="right") + 1]
    return np.minimum(np.maximum(after, low), high)


def feet_of_ridges(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array, Array, Ints]:
    """Corners of A's edge that stand out and face B: s, D, σ and which they are (k,), from D and σ at A's samples."""
    ridges, known = pair.a.section.ridges if pair.tapered else NO_RIDGES, np.isfinite(D)
    samples = pair.a.halves
    behind = np.searchsorted(samples, ridges)
    number = np.flatnonzero(known[behind - 1] & known[behind])
    if not number.size:
        return NO_RIDGES, NO_RIDGES, NO_RIDGES, number
    s = ridges[number]
    E, feet, foot = feet_near(pair, lines, pair.on_a(lines, s), np.interp(s, samples[known], sigma[known]))
    return s[foot], E[foot], feet[foot], number[foot]
