"""A beam's deformed neutral line as a smooth curve through the chain.

==========  ==============================================================================
s, t        arc length from the beam's start and from the start of link i
e_i, n_i    direction of link i and its left normal
a, w        coordinates of a point along e_i and n_i from joint i
δ_i         change of angle at spring i, eq. (4)
Θ, Θ⁰       turning of the beam along an element of length h, Θ⁰ + δ; stress-free
u, ξ        arc length from the border of the element that lies on the link; u/h ≤ ½
φ           Θξ, turning between the border and the point
A, W        coordinates of the arc from the border, along its tangent and towards the inside
R           radius of the arc times Θ/h; x = Θ⁰/2
==========  ==============================================================================

Every link carries its own piece of the stress-free neutral line.  A spring gathers the turning of
its element in one point; the beam turns evenly over the element, along a circular arc that touches
both links at the element's borders.  The border lies on the link's own piece, so that

    A = h R sin φ/Θ,    W = h R (1 − cos φ)/Θ,    R = (Θ/2) cot(Θ/2) sin x/x + Θ (1 − cos x)/(2x)
    C(s) = p_i + (a⁰ ∓ (A − A⁰))·e + (w⁰ + W − W⁰)·n      (− before the border, + after it)

where A⁰, W⁰ belong to δ = 0, and e, n are turned with the piece's tangent at the border.  R is such that
the pieces of neighbouring links meet at the joint, and the arcs of a chain that turns evenly lie on one circle, at
the joints as well as at the borders: a polygon round a circle closes all its gaps at once, and what each contact
force is follows from equilibrium even where a gap hardly yields, beside a clamp.  At rest C is the true neutral
line.  A force at C(s) does the same work on the springs as on a beam whose curvature is even over each element,
wherever in the element it acts: this keeps the error of a contact force even in N.

Where the stress-free curvature varies, what is added to the piece is still the difference of two arcs, and the
pieces meet as before.  Their tangents there differ by ½ε²δ, with ε the excess of turning in one half of the
element, κ⁰′h²/8: of fifth order in h.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from cprbm.kinematics import Positions, State
from cprbm.model import Chain
from cprbm.once import once
from cprbm.polynomial import ComplexArray
from cprbm_scene.answer import Array, Ints

STRAIGHT = 1e-150  # rad, nothing beside any other angle: added to one that is nought, its sine over it is one

# Taylor coefficients, lowest first, of sin z/z and (1 − cos z)/z² in z² and of y cot y in y²
SINE = (1.0, -1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800)
VERSINE = (1 / 2, -1 / 24, 1 / 720, -1 / 40320, 1 / 3628800, -1 / 479001600)
COTANGENT = (1.0, -1 / 3, -1 / 45, -2 / 945, -1 / 4725, -2 / 93555, -1382 / 638512875)


def _with_slopes(*series: tuple[float, ...]) -> Array:
    """Coefficients of some series, each before those of its first and second derivative, row by row."""
    tables = []
    for coefficients in np.array(series):
        k = np.arange(len(coefficients))
        once = np.append((k * coefficients)[1:], 0.0)
        tables += [coefficients, once, np.append((k * once)[1:], 0.0)]
    return np.array(tables)


ARCS, COTANGENTS = _with_slopes(SINE, VERSINE), _with_slopes(COTANGENT)


class Points(NamedTuple):
    """Some points of one beam's smooth line, arrays (k,) unless said otherwise.

    Attributes:
        line: whose points they are.
        half: number of the half of an element that each lies in, (k,).
        s: arc length; off: from the border at the half's end, negative before it.
        x, y: position; tangent: angle of the line's tangent; psi: that of the beam's, the same but for kinks.
        speed: |dC/ds|; bend: dψ/ds; gain: d|dC/ds|/ds.
        pace: what of dC/ds goes along ψ, where that is the tangent of an edge (:mod:`cprbm.leaning`); else the speed.
    """

    line: SmoothLine
    half: Ints
    s: Array
    off: Array
    x: Array
    y: Array
    tangent: Array
    psi: Array
    speed: Array
    bend: Array
    gain: Array
    pace: Array

    def only(self, these: Ints) -> Points:
        """Some of the points."""
        return Points(
            self.line,
            self.half[these],
            self.s[these],
            self.off[these],
            self.x[these],
            self.y[these],
            self.tangent[these],
            self.psi[these],
            self.speed[these],
            self.bend[these],
            self.gain[these],
            self.pace[these],
        )

    def turned(self, psi: Array, bend: Array) -> Points:
        """The same with other tangents."""
        line, half, s, off, x, y, tangent, _, speed, _, gain, pace = self
        return Points(line, half, s, off, x, y, tangent, psi, speed, bend, gain, pace)

    @property
    def link(self) -> Ints:
        """The link each lies on, in the beam's own numbering."""
        return (self.half + 1) // 2

    @property
    def lead(self) -> Array:
        """ψ less the angle of the line's tangent (k,)."""
        return self.psi - self.tangent


@dataclass(frozen=True)
class SmoothLine:
    """One beam's smooth line in one state.

    Attributes:
        chain: the beam.
        unit_length: ℓ, m.
        theta, cos, sin: angles of the links (N+1,).
        turns, radii: δ and R of the springs (N,); cotangents: of y = Θ/2, y cot y and its derivatives over y² (3, N).
        x, y: joints (N+2,).
        known: what contacts have found along it, by the contact's name and what it is.
        faced: by the contact's name, distances along it, and points of it and their feet for those.
    """

    chain: Chain
    unit_length: float
    theta: Array
    cos: Array
    sin: Array
    turns: Array
    radii: Array
    cotangents: Array
    x: Array
    y: Array
    known: dict[tuple[str, str], tuple[Any, ...]] = field(default_factory=dict, init=False, repr=False, compare=False)
    faced: dict[str, tuple[Array, Points, Points]] = field(default_factory=dict, init=False, repr=False, compare=False)

    @once
    def sampled(self) -> Points:
        """Points at :func:`halves`."""
        half, off = self.chain.in_halves
        return self._points(self.chain.halves, half, off, self.arcs.take(half, axis=1), self.chain.excess_at_halves)

    @once
    def radii_1(self) -> Array:
        """∂R over δ (N,)."""
        sine, versine = _of_rest(self.chain)
        found: Array = sine * (0.5 * (self.chain.turns + self.turns)) * self.cotangents[1] + versine
        return found

    @once
    def radii_2(self) -> Array:
        """∂²R over δ (N,)."""
        q = 0.25 * (self.chain.turns + self.turns) ** 2
        found: Array = 0.5 * _of_rest(self.chain)[0] * (self.cotangents[1] + 2.0 * q * self.cotangents[2])
        return found

    @once
    def arcs(self) -> Array:
        """Of every half of an element its border, Θ/h and R, and there x, y and the tangent's cos, sin and angle."""
        chain = self.chain
        lean_cos, lean_sin = chain.lean
        cos, sin = self.cos * lean_cos - self.sin * lean_sin, self.sin * lean_cos + self.cos * lean_sin
        a, w = chain.at_borders
        x, y = self.x[:-1] + a * self.cos - w * self.sin, self.y[:-1] + a * self.sin + w * self.cos
        arcs = np.empty((8, 2 * chain.n))
        tangent = self.theta + np.arctan2(lean_sin, lean_cos)
        for row, of in enumerate((chain.borders, x, y, cos, sin, tangent)):
            arcs[row, ::2], arcs[row, 1::2] = of[:-1], of[1:]
        arcs[6:, ::2] = arcs[6:, 1::2] = (chain.turns + self.turns) / chain.sizes, self.radii
        return arcs

    @once
    def carried(self) -> Array:
        """Of every half of an element x and y of its link's joint, cos and sin of the tangent at its border, h, Θ, R,
        ∂R and ∂²R over δ, (9, 2N).
        """
        carried = np.empty((9, 2 * self.chain.n))
        for row, of in enumerate((self.x, self.y)):
            carried[row, ::2], carried[row, 1::2] = of[:-2], of[1:-1]
        carried[2:4] = self.arcs[3:5]
        springs = self.chain.sizes, self.chain.turns + self.turns, self.radii, self.radii_1, self.radii_2
        carried[4:, ::2] = carried[4:, 1::2] = springs
        return carried

    def at(self, s: Array) -> Points:
        """Points at arc lengths ``s`` (k,), units of length; beyond the ends the end itself."""
        chain = self.chain
        s = np.minimum(np.maximum(s, 0.0), chain.s[-1])
        half = chain.breaks.searchsorted(s, side="right")
        arcs = self.arcs.take(half, axis=1)
        off = s - arcs[0]
        return self._points(s, half, off, arcs, None if chain.excess is None else chain.excess.seen(half, off))

    def _points(self, s: Array, half: Ints, off: Array, arcs: Array, excess: ComplexArray | None) -> Points:
        """Points at arc lengths ``s`` within the beam, as :func:`placed` says."""
        x, y, tangent, speed, bend, gain = placed(arcs, off, excess)
        return Points(self, half, s, off, x, y, tangent, tangent, speed, bend, gain, speed)


def placed(arcs: Array, off: Array, excess: ComplexArray | None) -> tuple[Array, ...]:
    """x, y, the tangent's angle, speed, bend and gain (k,) on halves of elements with these ``arcs`` (8, k).

    They are ``off`` (k,) from the borders, and lie off the arcs by an ``excess`` (3, k), if they do.
    """
    _, x, y, cos, sin, tangent, rate, R = arcs
    if excess is not None:
        along, across, lead, speed, bend, gain = _beside(excess, off, rate, R)
        tangent = tangent + lead
    else:
        # stress-free piece and difference of two arcs make one arc, from the border on
        along, across = _arc(off, rate, R)
        tangent, speed, bend, gain = tangent + rate * off, R, rate, np.zeros(off.size)
    return x + along * cos - across * sin, y + along * sin + across * cos, tangent, speed, bend, gain


def _beside(excess: ComplexArray, off: Array, rate: Array, R: Array) -> tuple[Array, ...]:
    """Of arcs with an ``excess``: the place along and across the border's tangent, how far its own leads, speed,
    bend and gain, (k,) each.

    All in numbers a + i·w from the border along its tangent.
    """
    turned = 0.5 * off * rate + STRAIGHT
    sin = np.sin(turned)
    middle = np.cos(turned) + 1j * sin
    arc = R * middle * middle
    place = (R * off * (sin / turned)) * middle + excess[2]
    first = arc + excess[1]
    turning = first.conj() * ((1j * rate) * arc + excess[0])
    squared = first.real**2 + first.imag**2
    speed = np.sqrt(squared)
    lead = np.arctan2(first.imag, first.real)
    return place.real, place.imag, lead, speed, turning.imag / squared, turning.real / speed


def _arc(off: Array, rate: Array, R: Array | float) -> tuple[Array, Array]:
    """±A and W of arcs that turn by ``rate`` per length."""
    half = 0.5 * rate * off + STRAIGHT
    sin = np.sin(half)
    chord = R * off * (sin / half)
    return chord * np.cos(half), chord * sin


def smooth_line(chain: Chain, unit_length: float, state: State, at: Positions) -> SmoothLine:
    """The smooth line of ``chain`` in a state, the same one each time it is asked for at the same positions."""
    line: SmoothLine | None = at.known.get(chain.first_link)
    if line is None:
        line = at.known[chain.first_link] = _smooth_line(chain, unit_length, state, at)
    return line


def _smooth_line(chain: Chain, unit_length: float, state: State, at: Positions) -> SmoothLine:
    theta = state.theta[chain.links]
    turns = theta[1:] - theta[:-1] - chain.rest_turns
    turning = chain.turns + turns
    cotangents, (sine, versine) = series(COTANGENTS, 0.25 * turning * turning), _of_rest(chain)
    return SmoothLine(
        chain=chain,
        unit_length=unit_length,
        theta=theta,
        cos=np.cos(theta),
        sin=np.sin(theta),
        turns=turns,
        radii=sine * cotangents[0] + turning * versine,
        cotangents=cotangents,
        x=at.x[chain.joints],
        y=at.y[chain.joints],
    )


def series(table: Array, z: Array) -> Array:
    """Σ c_k z^k for every row of coefficients c, at places (k,): (rows, k)."""
    total: Array = table[:, -1:] * z
    for k in range(table.shape[1] - 2, 0, -1):
        total += table[:, k : k + 1]
        total *= z
    total += table[:, :1]
    return total


@lru_cache(maxsize=64)
def _of_rest(chain: Chain) -> tuple[Array, Array]:
    """sin x/x and (1 − cos x)/(2x), what is in R of the stress-free turning, (N,) each."""
    x = 0.5 * chain.turns
    found = series(ARCS, x * x)
    return found[0], 0.5 * x * found[3]
