"""How the free bodies stand, and numbers that are linear in it: where their points are, how far these are apart.

======  ======================================================================================
w       (u, v, φ) of every body, then cos φ − 1 of every body, then sin φ (5B,)
A       (r, 5B), in the parts A_u over (u, v, φ), A_c and A_s; b (r,)
ℓ       b + A w, r numbers
f       (r,), or rows of them (k, r): weights of the numbers
======  ======================================================================================

A body's point, r = (r_x, r_y) from its reference place o, is at

    o + r + (u, v) + (cos φ − 1)(r_x, r_y) + sin φ (−r_y, r_x),

in which small rotations stay exact, and over a body's φ

    ∂ℓ/∂φ = A_φ − sin φ A_c + cos φ A_s,    ∂²ℓ/∂φ² = −cos φ A_c − sin φ A_s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from scene.answer import Array


@dataclass(frozen=True, slots=True)
class Posture:
    """w (5B,), and of every body cos φ and sin φ (B,)."""

    w: Array
    cos: Array
    sin: Array


def posture(bodies: Array) -> Posture:
    """Of ``bodies`` (B, 3), their u, v, φ."""
    count, phi = len(bodies), bodies[:, 2]
    w = np.empty(5 * count)
    w[: 3 * count] = bodies.ravel()
    less, sin = w[3 * count : 4 * count], w[4 * count :]
    # cos φ − 1 as −2 sin²(φ/2), which keeps small rotations exact
    half = np.sin(0.5 * phi)
    np.multiply(half, -2.0 * half, out=less)
    np.sin(phi, out=sin)
    return Posture(w, 1.0 + less, sin)


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
        return np.asarray(self.base + self.over @ standing.w)

    def over_phi(self, standing: Posture) -> Array:
        """∂ℓ/∂φ without A_φ, (r, B)."""
        count = len(standing.cos)
        return np.asarray(standing.cos * self.over[:, 4 * count :] - standing.sin * self.over[:, 3 * count : 4 * count])

    def gradient(self, standing: Posture, weights: Array) -> tuple[Array, Array]:
        """f·∂ℓ over the bodies (..., 3B) and f·∂²ℓ over φ of each (..., B), for ``weights`` f (..., r)."""
        return turned(standing, weights @ self.over)


def turned(standing: Posture, over: Array) -> tuple[Array, Array]:
    """The derivatives of ``over`` · w, (..., 5B): over the bodies (..., 3B), and the second over φ of each (..., B)."""
    count = len(standing.cos)
    first, c, s = over[..., : 3 * count].copy(), over[..., 3 * count : 4 * count], over[..., 4 * count :]
    first[..., 2::3] += standing.cos * s - standing.sin * c
    return first, -(standing.cos * c + standing.sin * s)


def point_of(body: int, point: tuple[float, float], references: Array) -> Linear:
    """Both coordinates of a ``point``, r on one of the bodies with ``references`` o (B, 2); itself on the ground (−1)."""
    count = len(references)
    over = np.zeros((2, 5 * count))
    if body < 0:
        return Linear(np.array(point), over)
    px, py = point
    over[:, 3 * body : 3 * body + 2] = np.eye(2)
    over[:, 3 * count + body] = px, py
    over[:, 4 * count + body] = -py, px
    return Linear(references[body] + point, over)


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
