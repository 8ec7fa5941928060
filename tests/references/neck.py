"""An arch whose clamps are pushed together until its neck closes and the strip touches itself: exact, by shooting.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        arc length over that of half of the strip, from the clamp (0) to the apex (1)
x, y     from the mirror plane (x = 0), of which the left half lies at x < 0; the clamp is at x = −D, y = 0
β        tangent angle at the clamp, which it keeps; free of stress the half is an arc: θ = β (1 − s)
T        thickness over the length: twice the distance of the neutral line from the mirror where it touches
m, H     bending moment; the push of the clamp, in units of EI over the half's length squared
P, c     contact force, and where it acts; P goes along −x on the left half
=======  ====================================================================================

Source: Euler's elastica with a natural curvature.  Mirror symmetry leaves at the apex neither rotation nor a force
along the mirror, so that what the later part exerts on the earlier one is −H before c and P − H beyond it:

    x' = cos θ,  y' = sin θ,  θ' = −β + m,  m' = −H sin θ  (s < c),  (P − H) sin θ  (s > c)                (1)

    x(1) = 0,  θ(1) = 0;   while it touches  x(c) = −T/2,  θ(c) = π/2                                       (2)

The unknowns are m(0) and H; P and c with the last two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import cos, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from tests.references.integrated import end_of

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Neck:
    """Equilibrium of a half without dimension: D, H, P, c (no number while open), m(0), y(1), ½ ∫ m² ds."""

    clamp: float
    push: float
    force: float
    place: float
    moment: float
    height: float
    energy: float


@cache
def opened(beta: float, clamp: float) -> Neck:
    """Before it touches, the clamp brought from where it is without stress to D."""
    u = np.zeros(2)
    for D in np.linspace(np.sin(beta) / beta, clamp, 25)[1:]:
        u = root(lambda u, D=D: _half(beta, D, u[0], u[1], 0.0, 0.5)[1][[0, 2]], u, tol=1e-13).x
    return _answer(beta, clamp, u[0], u[1], 0.0, np.nan)


@cache
def first_touch(beta: float, T: float, near: float, place: float) -> Neck:
    """Where the neck closes, from a D and a place near by: (2) without a force."""
    start = opened(beta, near)

    def conditions(u: Array) -> Array:
        at, end = _half(beta, u[3], u[0], u[1], 0.0, u[2])
        return np.array([end[0], end[2], at[0] + 0.5 * T, at[2] - 0.5 * np.pi])

    u = root(conditions, [start.moment, start.push, place, near], tol=1e-13).x
    if not np.abs(conditions(u)).max() < 1e-10:
        raise ValueError(f"the neck does not close near {near}")
    return _answer(beta, u[3], u[0], u[1], 0.0, u[2])


def closed(beta: float, T: float, start: Neck, clamp: float, steps: int = 3) -> Neck:
    """The equilibrium at D, from another one that touches, in some ``steps``."""
    u = np.array([start.moment, start.push, start.force, start.place])
    for D in np.linspace(start.clamp, clamp, steps + 1)[1:]:

        def conditions(u: Array, D: float = float(D)) -> Array:
            at, end = _half(beta, D, *u)
            return np.array([end[0], end[2], at[0] + 0.5 * T, at[2] - 0.5 * np.pi])

        u = root(conditions, u, tol=1e-13).x
        if not np.abs(conditions(u)).max() < 1e-10:
            raise ValueError(f"the branch is lost at {D}")
    return _answer(beta, clamp, *u)


def _half(beta: float, clamp: float, moment: float, push: float, force: float, place: float) -> tuple[Array, Array]:
    """(x, y, θ, m, energy) at c and at the apex."""

    def piece(z: Array, begin: float, stop: float, ahead: float) -> Array:
        def slope(_: float, z: Array) -> list[float]:
            return [cos(z[2]), sin(z[2]), z[3] - beta, ahead * sin(z[2]), 0.5 * z[3] ** 2]

        return end_of(slope, (begin, stop), z)

    at = piece(np.array([-clamp, 0.0, beta, moment, 0.0]), 0.0, place, -push)
    return at, piece(at, place, 1.0, force - push)


def _answer(beta: float, clamp: float, moment: float, push: float, force: float, place: float) -> Neck:
    _, end = _half(beta, clamp, moment, push, force, 0.5 if np.isnan(place) else place)
    if not (abs(end[0]) < 1e-10 and abs(end[2]) < 1e-10):
        raise ValueError(f"no equilibrium at {clamp}")
    return Neck(clamp, float(push), float(force), float(place), float(moment), float(end[1]), float(end[4]))
