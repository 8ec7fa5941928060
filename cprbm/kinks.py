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

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from cprbm.kinematics import State
from cprbm.model import Chain, Kinks
from cprbm.smooth import Points
from scene.answer import Array, Flags, Ints

SPRINGS = 2  # on either side of the pressed element


@dataclass(frozen=True)
class Missed:
    """What is missed at some places (k,) of a chain.

    Attributes:
        active: whether a place lies in the element of a kink or in one beside it; nothing is missed elsewhere.
        before, behind: p and q of the nearest kink.
        u, h: of the element of the place.
    """

    active: Flags
    before: Array
    behind: Array
    u: Array
    h: Array

    @property
    def angle(self) -> Array:
        """γ (k,)."""
        if not self.active.any():
            return np.zeros(len(self.u))
        u, h, p, q = self.u, self.h, self.before, self.behind
        v = h - u
        return np.where(self.active, (p + q) * h * h / 24.0 - u * v / (2.0 * h) * (p * u + q * v), 0.0)

    @property
    def bend(self) -> Array:
        """dγ/ds (k,)."""
        if not self.active.any():
            return np.zeros(len(self.u))
        u, h, p, q = self.u, self.h, self.before, self.behind
        v = h - u
        return np.where(self.active, -(p * u * (2.0 * v - u) + q * v * (v - 2.0 * u)) / (2.0 * h), 0.0)

    @property
    def integral(self) -> Array:
        """Γ (k,), units of length, nought at both borders of the element."""
        if not self.active.any():
            return np.zeros(len(self.u))
        u, h, p, q = self.u, self.h, self.before, self.behind
        bent = p * u**3 * (h / 3.0 - u / 4.0) + q * u**2 * (h * h / 2.0 - 2.0 * h * u / 3.0 + u * u / 4.0)
        return np.where(self.active, (p + q) * h * h / 24.0 * u - bent / (2.0 * h), 0.0)


def missed(chain: Chain, kinks: Kinks, s: Array) -> Missed:
    """What is missed at arc lengths ``s`` (k,) of a ``chain``."""
    if not kinks.places.size:
        nothing = np.zeros(len(s))
        return Missed(np.zeros(len(s), dtype=bool), nothing, nothing, nothing, np.ones(len(s)))
    here = _element(chain, s)
    nearest = np.abs(s[:, None] - kinks.places).argmin(axis=1)
    return Missed(
        active=np.abs(here - _reached(chain, kinks)[1][nearest]) <= 1,
        before=kinks.before[nearest],
        behind=kinks.behind[nearest],
        u=s - chain.borders[here],
        h=chain.sizes[here],
    )


def kinked(chain: Chain, kinks: Kinks, points: Points) -> Points:
    """Points of the smooth line with the true tangents; where they lie is not changed."""
    if not kinks.places.size:
        return points
    near = np.zeros(len(points.s), dtype=bool)
    for low, high in _reached(chain, kinks)[0]:
        near |= (points.s > low) & (points.s < high)
    if not near.any():
        return points
    more = missed(chain, kinks, points.s[near])
    psi, bend = points.psi.copy(), points.bend.copy()
    psi[near] += more.angle
    bend[near] += more.bend
    return replace(points, psi=psi, bend=bend)


def _element(chain: Chain, s: Array) -> Ints:
    return np.minimum(np.maximum(chain.borders.searchsorted(s, side="right") - 1, 0), chain.n - 1)


@lru_cache(maxsize=64)
def _reached(chain: Chain, kinks: Kinks) -> tuple[list[tuple[float, float]], Ints]:
    """Between which arc lengths each kink is felt, and in which element it is."""
    homes = _element(chain, kinks.places)
    borders = chain.borders
    return [(borders[max(home - 1, 0)], borders[min(home + 2, chain.n)]) for home in homes], homes


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
    kappa = (np.diff(state.theta[chain.links]) - np.diff(chain.rest)) / chain.sizes
    springs, h = chain.s[1:-1], chain.sizes[e]
    u = np.clip(places - chain.borders[e], 0.0, h)
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
