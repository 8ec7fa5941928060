"""A straight column between two clamps that come together so far that its neck closes: the elastica against a mirror.

========  ====================================================================================
L, EI     length, bending stiffness
δ         how far the clamps have come together along the column's axis x, over L
t         thickness, over L; zero for a line
s, θ      arc length from the clamp over L, tangent angle against x; κ = dθ/ds times L
s_c       where the half column touches its mirror image, by its edge
P, Q      force along x in the column between clamp and touch, and between touch and middle, times L²/EI
F         P − Q, the force of the two halves on each other, times L²/EI
M, U      moment of the ground at the clamp times L/EI; strain energy of the whole column times L/EI
========  ====================================================================================

The column is symmetric about the line on which its clamps come together half-way, so that each half is clamped at
s = 0 and held at s = ½ by a slide along that line, and touches it in a point without friction: there the tangent is
along the line, θ = π/2, and the force normal to it.  Nothing presses across x at the clamp.  Euler's elastica says

    θ'' = −P sin θ  (s < s_c),    θ'' = −Q sin θ  (s > s_c),    x' = cos θ,    U' = ½ θ'²  (of each half)

    θ(0) = x(0) = 0,    θ(s_c) = π/2,    x(s_c) = ½(1 − δ − t),    θ(½) = 0,    x(½) = ½(1 − δ)

for the four unknowns κ(0) = M, Q, s_c and δ under P.  Until the neck closes Q = P, and s_c says where it will.

Derivation: equilibrium of forces along x and of moments; nothing but a shooting method by an explicit Runge-Kutta
method of order eight.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from tests.references.integrated import end_of
from tests.references.post_buckled import post_buckled

BEFORE = 16.0 * 1.85407467730137**2 * 1.3  # P where the neck is narrow but open, for thin columns
STEPS = 4  # of P from where the neck closes


@dataclass(frozen=True, slots=True)
class Neck:
    """The column under P: δ, F, P, M and U as above, ``place`` s_c, ``height`` y of the middle over L."""

    shortening: float
    contact: float
    force: float
    moment: float
    energy: float
    place: float
    height: float


def closing(thickness: float) -> Neck:
    """The column as its neck closes.

    Raises:
        ValueError: no solution was found.
    """
    first = post_buckled(BEFORE)
    begin = _solved(_apart, np.array([first.moment, BEFORE, 0.1, first.shortening]), thickness)
    M, P, place, delta = begin
    return _neck(delta, M, P, P, place)


def closed(thickness: float, force: float) -> Neck:
    """The column under a ``force`` P beyond that at which its neck closes.

    Raises:
        ValueError: the neck is not closed there, or no solution was found.
    """
    begun = closing(thickness)
    if not force > begun.force:
        raise ValueError(f"the neck closes at {begun.force:.6g}, after {force}")
    unknowns = np.array([begun.moment, begun.force, begun.place, begun.shortening])
    for P in np.linspace(begun.force, force, STEPS)[1:]:
        unknowns = _solved(lambda z, t, P=P: _touching(z[0], P, *z[1:], t), unknowns, thickness)
    M, Q, place, delta = unknowns
    return _neck(delta, M, force, Q, place)


def curvatures(found: Neck, s: np.ndarray) -> np.ndarray:
    """κ at arc lengths ``s`` (k,) of the left half, which ascend."""
    state, at = np.array([0.0, 0.0, 0.0, found.moment, 0.0]), 0.0
    bent = []
    for place in np.sort(np.append(s, found.place)):
        force = found.force if at < found.place else found.force - found.contact
        state, at = _part(force, state, place - at) if place > at else state, place
        bent.append(state[3])
    return np.array(bent)[np.searchsorted(np.sort(np.append(s, found.place)), s)]


def _solved(residual, guess: np.ndarray, thickness: float) -> np.ndarray:
    found = root(residual, guess, args=(thickness,), method="hybr", options={"xtol": 1e-13})
    if not np.max(np.abs(residual(found.x, thickness))) < 1e-10:
        raise ValueError(f"no solution: {found.message}")
    return found.x


def _part(force: float, begin: np.ndarray, length: float) -> np.ndarray:
    """x, y, θ, κ and half of U after a ``length`` under a force along x."""

    def slope(_: float, z: np.ndarray) -> list[float]:
        return [np.cos(z[2]), np.sin(z[2]), z[3], -force * np.sin(z[2]), 0.5 * z[3] ** 2]

    return end_of(slope, (0.0, length), begin, rtol=1e-11, atol=1e-12)


def _half(M: float, P: float, Q: float, place: float) -> tuple[np.ndarray, np.ndarray]:
    touch = _part(P, np.array([0.0, 0.0, 0.0, M, 0.0]), place)
    return touch, _part(Q, touch, 0.5 - place)


def _touching(M: float, P: float, Q: float, place: float, delta: float, thickness: float) -> np.ndarray:
    touch, middle = _half(M, P, Q, place)
    return np.array(
        [touch[2] - 0.5 * np.pi, touch[0] - 0.5 * (1.0 - delta - thickness), middle[2], middle[0] - 0.5 * (1.0 - delta)]
    )


def _apart(z: np.ndarray, thickness: float) -> np.ndarray:
    M, P, place, delta = z
    return _touching(M, P, P, place, delta, thickness)


def _neck(delta: float, M: float, P: float, Q: float, place: float) -> Neck:
    _, middle = _half(M, P, Q, place)
    return Neck(
        shortening=float(delta),
        contact=float(P - Q),
        force=float(P),
        moment=float(M),
        energy=float(2.0 * middle[4]),
        place=float(place),
        height=float(middle[1]),
    )
