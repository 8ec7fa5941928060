"""A strip clamped at its start and rolled by its end until its inner lap touches the outer one: exact, by shooting.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        arc length over the strip's length, from the clamp at the origin, where it runs along +x
B(s)     bending stiffness over that at the clamp: straight between knots
θ, Θ     tangent angle; that of the end, which is turned and else free to move
M        moment at the end, without dimension: by EI/L at the clamp
T        thickness over the length: distance of the neutral lines where they touch
s₁, s₂   where the outer and the inner lap touch;  x₁, x₂ these points of the neutral line
n, P     normal to the left at s₁, towards the inside of the roll; contact force P n on the inner lap
=======  ====================================================================================

Source: Euler's elastica.  Nothing but a moment acts from outside, so the clamp has no force.  The two contact
forces are opposite on one line, so that only the lap between them feels them:

    B θ' = M + (x₂ − x) × P n  for s₁ < s < s₂,   B θ' = M  elsewhere                                      (1)

Without friction both edges are tangent to each other where they touch, one turn apart:

    x₂ = x₁ + T n,   θ(s₂) = θ(s₁) + 2π                                                                   (2)

These three and θ(1) = Θ give M, P, s₁ and s₂.  At the first touch P is zero, and Θ is what (2) makes it.
Where the end itself touches, s₂ = 1 stands in the place of the angle in (2).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from tests.references.integrated import end_of

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Strip:
    """Stiffness ``values`` (k,) over the first of them ``at`` arc lengths (k,) from 0 to 1; ``thickness`` T."""

    at: tuple[float, ...]
    values: tuple[float, ...]
    thickness: float


@dataclass(frozen=True, slots=True)
class Roll:
    """Equilibrium without dimension: Θ, M, P, s₁, s₂, where the end is (2,), and ½ ∫ m²/B ds."""

    rotation: float
    moment: float
    force: float
    outer: float
    inner: float
    tip: Array
    energy: float


def free(strip: Strip, rotation: float) -> Roll:
    """Before it touches: M by ∫ ds/B, which is closed between knots."""
    at, B = np.array(strip.at), np.array(strip.values)
    even = np.isclose(B[1:], B[:-1])
    ratio = np.where(even, 1.0, B[1:] / B[:-1])
    pieces = np.where(even, 1.0 / B[:-1], np.log(ratio) / np.where(even, 1.0, np.diff(B)))
    moment = rotation / float((pieces * np.diff(at)).sum())
    end = _along(strip, np.zeros(4), 0.0, 1.0, moment, np.zeros(2), np.zeros(2))
    return Roll(rotation, moment, 0.0, np.nan, np.nan, end[:2], float(end[3]))


def first_touch(strip: Strip, moment: float, outer: float, inner: float) -> Roll:
    """The first touch near a ``moment`` and places."""
    found = root(lambda u: _shot(strip, u[0], 0.0, u[1], u[2])[0], [moment, outer, inner], tol=1e-13)
    return _answer(strip, found.x[0], 0.0, *found.x[1:])


def touching(strip: Strip, start: Roll, rotation: float, steps: int = 3) -> Roll:
    """The equilibrium at a ``rotation``, from another one that touches, in some ``steps``."""
    u = np.array([start.moment, start.force, start.outer, start.inner])
    for value in np.linspace(start.rotation, rotation, steps + 1)[1:]:

        def conditions(u: Array, value: float = float(value)) -> Array:
            parts, end = _shot(strip, *u)
            return np.array([*parts, end[2] - value])

        u = root(conditions, u, tol=1e-13).x
        if not np.abs(conditions(u)).max() < 1e-10:
            raise ValueError(f"the branch is lost at {value} rad")
    return _answer(strip, *u)


def tip_touching(strip: Strip, rotation: float, force: float, outer: float) -> Roll:
    """Where the strip's end touches instead of a place before it: x(1) = x₁ + T n; from about a force and a place."""

    def conditions(u: Array) -> Array:
        parts, end = _shot(strip, *u, 1.0)
        return np.array([parts[0], parts[1], end[2] - rotation])

    u = root(conditions, [free(strip, rotation).moment, force, outer], tol=1e-13).x
    if not np.abs(conditions(u)).max() < 1e-10:
        raise ValueError(f"the end does not touch at {rotation} rad")
    _, end = _shot(strip, *u, 1.0)
    return Roll(float(end[2]), float(u[0]), float(u[1]), float(u[2]), 1.0, end[:2], float(end[3]))


def _answer(strip: Strip, moment: float, force: float, outer: float, inner: float) -> Roll:
    parts, end = _shot(strip, moment, force, outer, inner)
    if not np.abs(parts).max() < 1e-10:
        raise ValueError("the laps do not touch")
    return Roll(float(end[2]), float(moment), float(force), float(outer), float(inner), end[:2], float(end[3]))


def _shot(strip: Strip, moment: float, force: float, outer: float, inner: float) -> tuple[Array, Array]:
    """What is left of (2), and (x, y, θ, energy) at the end."""
    none = np.zeros(2)
    one = _along(strip, np.zeros(4), 0.0, outer, moment, none, none)
    n = np.array([-np.sin(one[2]), np.cos(one[2])])
    other = one[:2] + strip.thickness * n
    two = _along(strip, one, outer, inner, moment, other, force * n)
    end = _along(strip, two, inner, 1.0, moment, none, none)
    return np.array([*(two[:2] - other), two[2] - one[2] - 2.0 * np.pi]), end


def _along(strip: Strip, z: Array, begin: float, stop: float, moment: float, at: Array, force: Array) -> Array:
    """(x, y, θ, energy) at ``stop``, from those at ``begin``; a ``force`` acts beyond that, at a point ``at``."""
    (x, y), (fx, fy) = at.tolist(), force.tolist()
    first, low, change = 0.0, 0.0, 0.0

    def slope(s: float, z: Array) -> list[float]:
        m = moment + (x - z[0]) * fy - (y - z[1]) * fx
        bent = m / (low + change * (s - first))
        return [cos(z[2]), sin(z[2]), bent, 0.5 * m * bent]

    knots = [begin, *(s for s in strip.at if begin < s < stop), stop]
    for a, b in pairwise(knots):
        low, high = np.interp([a, b], strip.at, strip.values).tolist()
        first, change = a, (high - low) / (b - a) if b > a else 0.0
        z = end_of(slope, (a, b), z)
    return z
