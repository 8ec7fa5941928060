"""How the free bodies stand, and numbers that are linear in it: where their points are, how far these are apart.

======  ======================================================================================
w       (u, v, φ) of every body, then cos φ − 1 of every body, then sin φ (5B,)
ℓ       b + A w, r numbers; A (r, 5B), b (r,)
f       (r,), or rows of them (k, r): weights of the numbers
W       ∂w over (u, v, φ) of every body, then ∂²w over φ of every body (5B, 4B); ∂ℓ and ∂²ℓ are A W
======  ======================================================================================

A body's point, r = (r_x, r_y) from its reference place o, is at

    o + r + (u, v) + (cos φ − 1)(r_x, r_y) + sin φ (−r_y, r_x),

in which small rotations stay exact, and of a body's φ

    ∂(cos φ − 1, sin φ) = (−sin φ, cos φ),    ∂²(cos φ − 1, sin φ) = (−cos φ, −sin φ).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from cprbm_scene.answer import Array, Ints


@dataclass(frozen=True, slots=True)
class Posture:
    """``w`` (5B,) and ``derivatives`` W (5B, 4B)."""

    w: Array
    derivatives: Array


def posture(bodies: Array) -> Posture:
    """Of ``bodies`` (B, 3), their u, v, φ."""
    turns = bodies[:, 2].tolist()  # a handful, for which plain numbers are faster
    # cos φ − 1 as −2 sin²(φ/2), which keeps small rotations exact
    less, sin = [-2.0 * math.sin(0.5 * phi) ** 2 for phi in turns], [math.sin(phi) for phi in turns]
    cos, minus = [1.0 + each for each in less], [-each for each in sin]
    even, places = _even(len(turns))
    derivatives = even.copy()
    derivatives.reshape(-1)[places] = [*minus, *cos, *[-each for each in cos], *minus]
    return Posture(np.array([*bodies.ravel().tolist(), *less, *sin]), derivatives)


def stood(bodies: Array) -> Array:
    """w of some postures at once (k, 5B), of ``bodies`` (k, B, 3)."""
    turns = bodies[:, :, 2]
    return np.concatenate((bodies.reshape(len(bodies), -1), -2.0 * np.sin(0.5 * turns) ** 2, np.sin(turns)), axis=1)


@cache
def _even(count: int) -> tuple[Array, Ints]:
    """W where it is the same in all postures of ``count`` bodies, and the places in it of −sin, cos, −cos and −sin."""
    even, b = np.eye(5 * count, 4 * count), np.arange(count)
    even[3 * count :] = 0.0
    rows = 3 * count + np.concatenate((b, count + b, b, count + b))
    columns = np.concatenate((3 * b + 2, 3 * b + 2, 3 * count + b, 3 * count + b))
    return even, rows * (4 * count) + columns


@dataclass(frozen=True, slots=True)
class Linear:
    """ℓ = b + A w: ``base`` b (r,), ``over`` A (r, 5B)."""

    base: Array
    over: Array

    def __neg__(self) -> Linear:
        return Linear(-self.base, -self.over)

    def __sub__(self, other: Linear) -> Linear:
        return Linear(self.base - other.base, self.over - other.over)

    def values(self, standing: Posture) -> Array:
        """ℓ (r,)."""
        found: Array = self.base + self.over @ standing.w
        return found

    def gradient(self, standing: Posture, weights: Array) -> tuple[Array, Array]:
        """f·∂ℓ over the bodies (..., 3B) and f·∂²ℓ over φ of each (..., B), for ``weights`` f (..., r)."""
        both = weights @ self.over @ standing.derivatives
        bodies = 3 * (both.shape[-1] // 4)
        return both[..., :bodies], both[..., bodies:]


def points_of(points: Sequence[tuple[int, tuple[float, float]]], references: Array) -> Linear:
    """x and y of one point after the other, r on one of the bodies with ``references`` o (B, 2) or the ground (−1)."""
    count, places = len(references), references.tolist()
    base, over = list[float](), np.zeros((2 * len(points), 5 * count))
    for row, (body, (px, py)) in enumerate(points):
        ox, oy = places[body] if body >= 0 else (0.0, 0.0)
        base += ox + px, oy + py
        if body >= 0:
            x, y = over[2 * row], over[2 * row + 1]
            x[3 * body] = y[3 * body + 1] = 1.0
            x[3 * count + body], y[3 * count + body] = px, py
            x[4 * count + body], y[4 * count + body] = -py, px
    return Linear(np.array(base), over)


def point_of(body: int, point: tuple[float, float], references: Array) -> Linear:
    """Both coordinates of one point, as in :func:`points_of`."""
    return points_of([(body, point)], references)


def turn_of(body: int, count: int) -> Array:
    """φ of one of ``count`` bodies by its ``over``, (1, 5B); nought of the ground (−1)."""
    over = np.zeros((1, 5 * count))
    if body >= 0:
        over[0, 3 * body + 2] = 1.0
    return over


def stacked(parts: list[Linear], count: int) -> Linear:
    """Numbers behind each other, of ``count`` bodies."""
    return Linear(
        np.concatenate([np.zeros(0), *(part.base for part in parts)]),
        np.concatenate([np.zeros((0, 5 * count)), *(part.over for part in parts)]),
    )
