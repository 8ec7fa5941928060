"""What even curvature misses of a beam's tangent where a contact presses in a point.

==========  ===================================================================================
s, κ        arc length, and the change of curvature there
h           length of the element that is pressed; u, v what lies of it before s and behind, u + v = h
p, q        κ′ before the place and behind it; they differ by the contact's force over E·I
γ, Γ        true tangent angle less that of the smooth line, without the mean over the element; its integral
==========  ===================================================================================

A spring knows the mean of κ over its element.  Between the borders the smooth line turns evenly (:mod:`cprbm.smooth`)
and the beam does not: κ is a broken line with its corner at the place, and its mean over the element is known.  So the
tangent differs by −(u v/2h)·(p u + q v), which is nought at both borders, and by less its mean over the element by

    γ(s) = (p + q) h²/24 − (u v/2h)·(p u + q v).

Two lines touch where their tangents are parallel.  Without γ the place is wrong by γ/D″: of second order in h, but as
u v is, uneven in the number of elements, and the lever of the force with it.  The mean is the same wherever in the
element the place is, and is left out: then Γ is nought at every border, and a function of the place alone by which the
line lies elsewhere.  With a Γ that is nought at the place itself the gap would become another function as the place
goes on, and what a drive does would not be what the energy gains.

p and q are taken from the two springs on either side.  They belong to a state that is known already (the mesh is fitted
to the same), and are constants while the next one is sought; how γ changes as the place moves is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cprbm.kinematics import State
from cprbm.model import Chain, Kinks
from cprbm.smooth import Points
from cprbm_scene.answer import Array, Flags, Ints

SPRINGS = 2  # on either side of the pressed element


@dataclass(frozen=True, slots=True)
class Missed:
    """What is missed at some places (k,) of a chain.

    Attributes:
        coefficients: of γ as a polynomial of ``off``, lowest power first (4, k).
        off: way from the border of the half of an element, negative before it (k,).
    """

    coefficients: Array
    off: Array

    @property
    def tangent(self) -> tuple[Array, Array]:
        """γ and dγ/ds (k,)."""
        (mean, first, second, third), off = self.coefficients, self.off
        # Horner's rule, and the same once more for the slope
        one = third * off
        two = one + second
        three = two * off + first
        return three * off + mean, (two + one) * off + three

    @property
    def angle(self) -> Array:
        """γ (k,)."""
        return self.tangent[0]

    @property
    def bend(self) -> Array:
        """dγ/ds (k,)."""
        return self.tangent[1]

    @property
    def integral(self) -> Array:
        """Γ (k,), units of length, nought at both borders of the element."""
        c, off = self.coefficients, self.off
        found: Array = (((c[3] / 4.0 * off + c[2] / 3.0) * off + c[1] / 2.0) * off + c[0]) * off
        return found


def missed(chain: Chain, kinks: Kinks, points: Points) -> Missed:
    """What is missed at some ``points`` (k,) of a ``chain``."""
    if not kinks.places.size:
        return Missed(np.zeros((4, len(points.s))), points.off)
    return Missed(polynomials(chain, kinks).take(points.half, axis=1), points.off)


def kinked(chain: Chain, kinks: Kinks, points: Points) -> Points:
    """Points of the smooth line with the true tangents; where they lie is not changed."""
    if not kinks.places.size:
        return points
    angle, bend = missed(chain, kinks, points).tangent
    return points.turned(points.psi + angle, points.bend + bend)


@lru_cache(maxsize=64)
def polynomials(chain: Chain, kinks: Kinks) -> Array:
    """Coefficients of γ in all halves of elements, over the way from the half's border, lowest power first, (4, 2N).

    An element has the kink that is nearest to its middle, and nought where that is not within it or beside it.
    """
    found = np.zeros((4, 2 * chain.n))
    if not kinks.places.size:
        return found
    home, middle = _element(chain, kinks.places), 0.5 * (chain.borders[1:] + chain.borders[:-1])
    nearest = np.abs(middle[:, None] - kinks.places).argmin(axis=1)
    felt = np.abs(np.arange(chain.n) - home[nearest]) <= 1
    p, q = np.where(felt, (kinks.before[nearest], kinks.behind[nearest]), 0.0)
    h = chain.sizes
    mean, steepest = (p + q) * h * h / 24.0, (p - q) / (2.0 * h)
    found[:, ::2] = mean, -0.5 * q * h, q - 0.5 * p, steepest
    found[:, 1::2] = mean, 0.5 * p * h, p - 0.5 * q, steepest
    found.flags.writeable = False
    return found


def _element(chain: Chain, s: Array) -> Ints:
    return np.minimum(np.maximum(chain.borders.searchsorted(s, side="right") - 1, 0), chain.n - 1)


def within(chain: Chain, places: Array) -> Flags:
    """Whether there is an element on either side of those that arc lengths ``places`` (k,) lie in."""
    element = _element(chain, places)
    return np.asarray((element > 0) & (element < chain.n - 1))


def kinks_at(chain: Chain, state: State, places: Array) -> Kinks:
    """The kinks of ``chain`` at arc lengths ``places`` (k,) in a state, slopes nought where springs are too few.

    Two springs on one side tell the slope there, and so do the nearer of them and the pressed one less what the other
    side has bent of it.  From one border of the pressed element to the other the slope goes from the first to the
    second, so that it is continuous as the place goes on.
    """
    e = _element(chain, places)
    seen = (e >= SPRINGS) & (e < chain.n - SPRINGS)
    e = np.where(seen, e, SPRINGS if chain.n > 2 * SPRINGS else 0)
    nothing = np.zeros(len(places))
    if chain.n <= 2 * SPRINGS:
        return Kinks(places, nothing, nothing)
    theta = state.theta[chain.links]
    kappa = (theta[1:] - theta[:-1] - chain.rest_turns) / chain.sizes
    springs, h = chain.s[1:-1], chain.sizes[e]
    u = np.minimum(np.maximum(places - chain.borders[e], 0.0), h)
    far_p = (kappa[e - 1] - kappa[e - 2]) / (springs[e - 1] - springs[e - 2])
    far_q = (kappa[e + 2] - kappa[e + 1]) / (springs[e + 2] - springs[e + 1])
    bent = (far_q - far_p) / (2.0 * h)
    near_p = (kappa[e] - bent * (h - u) ** 2 - kappa[e - 1]) / (springs[e] - springs[e - 1])
    near_q = (kappa[e + 1] - kappa[e] + bent * u**2) / (springs[e + 1] - springs[e])
    f = u / h
    return Kinks(
        places,
        np.where(seen, far_p + f * (near_p - far_p), 0.0),
        np.where(seen, near_q + f * (far_q - near_q), 0.0),
    )
