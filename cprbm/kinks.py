"""What even curvature misses of a beam's tangent where a contact presses in a point.

==========  ===================================================================================
s, κ        arc length, and the change of curvature there
h           length of the element that is pressed; u, v what lies of it before s and behind, u + v = h
p, q        κ′ before the place and behind it; they differ by the contact's force over E·I
γ           true tangent angle less that of the smooth line
==========  ===================================================================================

A spring knows the mean of κ over its element, so that tangents are right at the elements' borders, to a part of h² that
is the same for all of them.  Between the borders the smooth line turns evenly (:mod:`cprbm.smooth`) and the beam does
not: κ is a broken line with its corner at the place, and its mean over the element is known, so

    γ(s) = −(u v/2h)·(p u + q v),      γ = 0 at both borders.

Two lines touch where their tangents are parallel.  Without γ the place is wrong by γ/D″: also of second order in h, but
as u v is, uneven in the number of elements, and the lever of the force with it.

p and q are taken from the two springs on either side.  They belong to a state that is known already (the mesh is fitted
to the same), and are constants while the next one is sought; how γ changes as the place moves is exact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm.kinematics import State
from cprbm.model import Chain, Kinks
from cprbm.smooth import Points
from scene.answer import Array, Flags, Ints

SLIGHT = 1e-3  # of h² and the largest slope: γ is at most an eighth
SPRINGS = 2  # on either side of the pressed element


@dataclass(frozen=True, slots=True)
class Missed:
    """Of the tangent at some places (k,): γ, its derivative over s, and its integral over s."""

    angle: Array
    bend: Array
    integral: Array


def missed(chain: Chain, kinks: Kinks, s: Array) -> Missed:
    """γ at arc lengths ``s`` (k,): nought but in the elements that hold a kink and in those beside them.

    The integral is from the kink, units of length.
    """
    if not kinks.places.size or not s.size:
        nothing = np.zeros(len(s))
        return Missed(nothing, nothing, nothing)
    nearest = np.argmin(np.abs(s[:, None] - kinks.places), axis=1)
    p, q, place = kinks.before[nearest], kinks.behind[nearest], kinks.places[nearest]
    here, home = _element(chain, s), _element(chain, place)
    active = np.abs(here - home) <= 1
    u, h = s - chain.borders[here], chain.sizes[here]
    v = h - u
    size = chain.sizes[home]
    start = _integral(place - chain.borders[home], size, p, q)
    # over the whole element between this one and the kink's border
    between = np.where(here > home, _integral(size, size, p, q), np.where(here < home, -_integral(h, h, p, q), 0.0))
    return Missed(
        np.where(active, -u * v / (2.0 * h) * (p * u + q * v), 0.0),
        np.where(active, -(p * u * (2.0 * v - u) + q * v * (v - 2.0 * u)) / (2.0 * h), 0.0),
        np.where(active, between + _integral(u, h, p, q) - start, 0.0),
    )


def kinked(chain: Chain, kinks: Kinks, points: Points) -> Points:
    """Points of the smooth line with the true tangents; where they lie is not changed."""
    if not kinks.places.size:
        return points
    more = missed(chain, kinks, points.s)
    return replace(points, psi=points.psi + more.angle, bend=points.bend + more.bend)


def _integral(u: Array, h: Array, p: Array, q: Array) -> Array:
    """∫ γ from the element's first border."""
    return np.asarray(
        -(p * u**3 * (h / 3.0 - u / 4.0) + q * u**2 * (h * h / 2.0 - 2.0 * h * u / 3.0 + u * u / 4.0)) / (2.0 * h)
    )


def _element(chain: Chain, s: Array) -> Ints:
    return np.clip(np.searchsorted(chain.borders, s, side="right") - 1, 0, chain.n - 1)


def within(chain: Chain, places: Array) -> Flags:
    """Whether there is an element on either side of those that arc lengths ``places`` (k,) lie in."""
    element = _element(chain, places)
    return np.asarray((element > 0) & (element < chain.n - 1))


def kinks_at(chain: Chain, state: State, places: Array) -> Kinks:
    """The kinks of ``chain`` at arc lengths ``places`` (k,) in a state, slopes nought where springs are too few."""
    element = _element(chain, places)
    seen = (element >= SPRINGS) & (element < chain.n - SPRINGS)
    kappa = (np.diff(state.theta[chain.links]) - np.diff(chain.rest)) / chain.sizes
    springs = chain.s[1:-1]

    def slope(one: int, other: int) -> Array:
        i, j = np.where(seen, element + one, 0), np.where(seen, element + other, 1)
        return np.where(seen, (kappa[j] - kappa[i]) / (springs[j] - springs[i]), 0.0)

    return Kinks(places, slope(-2, -1), slope(1, 2))


def slight(chain: Chain, kinks: Kinks) -> bool:
    """Whether γ at the places is next to nothing, as at a border or by symmetry in an element's middle."""
    size = chain.sizes[_element(chain, kinks.places)]
    return bool(np.all(np.abs(missed(chain, kinks, kinks.places).angle) <= SLIGHT * size**2 * kinks.largest))
