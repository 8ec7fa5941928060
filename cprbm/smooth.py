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

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm.kinematics import Positions, State
from cprbm.model import Chain
from scene.answer import Array, Flags, Ints

LOCALS = 5  # x_i, y_i, θ_{i−1}, θ_i, θ_{i+1}

# Taylor coefficients, lowest first, of sin z/z and (1 − cos z)/z² in z² and of y cot y in y²
SINE = (1.0, -1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800)
VERSINE = (1 / 2, -1 / 24, 1 / 720, -1 / 40320, 1 / 3628800, -1 / 479001600)
COTANGENT = (1.0, -1 / 3, -1 / 45, -2 / 945, -1 / 4725, -2 / 93555, -1382 / 638512875)


@dataclass(frozen=True)
class Points:
    """Some points of one beam's smooth line, arrays (k,) unless said otherwise.

    Attributes:
        s: arc length; link: the link each lies on, in the beam's own numbering.
        x, y: position; psi: tangent angle.
        speed: |dC/ds|; bend: dψ/ds; gain: d|dC/ds|/ds.
        cos, sin: of the link's angle: e = (cos, sin), n = (−sin, cos).
        a, w, a1, w1: coordinates in the link's frame and their derivatives over s.
        before: whether each lies before the border, in the element of the link's first joint.
        h, turn, radius, ratio, xi: of its element h, Θ, R, Θ⁰; ξ.
        lean: (2, k), cos and sin of the tangent at the border against the link.
    """

    s: Array
    link: Ints
    x: Array
    y: Array
    psi: Array
    speed: Array
    bend: Array
    gain: Array
    cos: Array
    sin: Array
    a: Array
    w: Array
    a1: Array
    w1: Array
    before: Flags
    h: Array
    turn: Array
    radius: Array
    ratio: Array
    xi: Array
    lean: Array

    @cached_property
    def over_turn(self) -> tuple[Array, Array, Array]:
        """∂(a, w), ∂(a′, w′) and ∂²(a, w) over δ of the point's element, (2, k) each; ′ is the derivative over s."""
        return _over_turn(self)

    @cached_property
    def e(self) -> Array:
        """Direction of the link, (k, 2)."""
        return np.stack((self.cos, self.sin), axis=1)

    @cached_property
    def n(self) -> Array:
        """Left normal of the link, (k, 2)."""
        return np.stack((-self.sin, self.cos), axis=1)


@dataclass(frozen=True)
class SmoothLine:
    """One beam's smooth line in one state.

    Attributes:
        chain: the beam.
        unit_length: ℓ, m.
        theta, cos, sin: angles of the links (N+1,).
        turns, radii: δ and R of the springs (N,).
        x, y: joints (N+2,).
    """

    chain: Chain
    unit_length: float
    theta: Array
    cos: Array
    sin: Array
    turns: Array
    radii: Array
    x: Array
    y: Array

    @cached_property
    def sampled(self) -> Points:
        """Points at :func:`halves`."""
        return self.at(halves(self.chain))

    def at(self, s: Array) -> Points:
        """Points at arc lengths ``s`` (k,), units of length; beyond the ends the end itself."""
        chain = self.chain
        s = np.minimum(np.maximum(s, 0.0), chain.s[-1])
        link = np.minimum(np.searchsorted(chain.s, s, side="right") - 1, chain.n)
        t = s - chain.s[link]
        off = s - chain.borders[link]
        before = (off < 0.0) | (link == chain.n)
        spring = link - before
        h, sign = chain.sizes[spring], np.where(before, -1.0, 1.0)
        cos, sin = self.cos[link], self.sin[link]
        xi = np.abs(off) / h
        ratio = chain.turns[spring]
        turn = ratio + self.turns[spring]
        R, phi = self.radii[spring], turn * xi
        R_cos, R_sin = R * np.cos(phi), R * np.sin(phi)
        # A − A⁰ and W − W⁰ and their derivatives over u
        A, W = h * xi * R * _series(SINE, phi * phi), h * xi * R * phi * _series(VERSINE, phi * phi)
        A_u, W_u, A_uu, W_uu = R_cos, R_sin, -turn / h * R_sin, turn / h * R_cos
        lean = chain.lean[:, link]
        if chain.pieces is None:
            nothing = np.zeros(len(s))
            a, w, a1, w1, a2, w2 = t, nothing, nothing + 1.0, nothing, nothing, nothing
            A, A_u = A - h * xi, A_u - 1.0
        else:
            a, w, a1, w1, a2, w2 = chain.pieces.seen(link, s, t, self.unit_length)
            phi = ratio * xi
            A, W = A - h * xi * _series(SINE, phi * phi), W - h * xi * phi * _series(VERSINE, phi * phi)
            A_u, W_u = A_u - np.cos(phi), W_u - np.sin(phi)
            A_uu, W_uu = A_uu + ratio / h * np.sin(phi), W_uu - ratio / h * np.cos(phi)
        along, across = _leant(lean, sign * A, W)
        a, w = a + along, w + across
        along, across = _leant(lean, A_u, sign * W_u)
        a1, w1 = a1 + along, w1 + across
        along, across = _leant(lean, sign * A_uu, W_uu)
        a2, w2 = a2 + along, w2 + across
        squared = a1 * a1 + w1 * w1
        return Points(
            s=s,
            link=link,
            x=self.x[link] + a * cos - w * sin,
            y=self.y[link] + a * sin + w * cos,
            psi=self.theta[link] + np.arctan2(w1, a1),
            speed=np.sqrt(squared),
            bend=(a1 * w2 - w1 * a2) / squared,
            gain=(a1 * a2 + w1 * w2) / np.sqrt(squared),
            cos=cos,
            sin=sin,
            a=a,
            w=w,
            a1=a1,
            w1=w1,
            before=before,
            h=h,
            turn=turn,
            radius=R,
            ratio=ratio,
            xi=xi,
            lean=lean,
        )


def smooth_line(chain: Chain, unit_length: float, state: State, at: Positions) -> SmoothLine:
    """The smooth line of ``chain`` in a state."""
    theta = state.theta[chain.links]
    turns = np.diff(theta) - np.diff(chain.rest)
    return SmoothLine(
        chain=chain,
        unit_length=unit_length,
        theta=theta,
        cos=np.cos(theta),
        sin=np.sin(theta),
        turns=turns,
        radii=_radius(chain.turns + turns, chain.turns),
        x=at.x[chain.joints],
        y=at.y[chain.joints],
    )


def halves(chain: Chain) -> Array:
    """Arc lengths of the joints and of the places half-way between them, (2N+3,)."""
    s = np.empty(2 * chain.n + 3)
    s[::2] = chain.s
    s[1::2] = 0.5 * (chain.s[1:] + chain.s[:-1])
    return s


def _series(coefficients: tuple[float, ...], z: Array) -> Array:
    """Σ c_k z^k."""
    total = coefficients[-1] * z
    total += coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        total *= z
        total += coefficient
    return total


def _slope(coefficients: tuple[float, ...]) -> tuple[float, ...]:
    """Coefficients of the derivative."""
    return tuple(k * coefficient for k, coefficient in enumerate(coefficients))[1:]


SINE_1, VERSINE_1, COTANGENT_1 = _slope(SINE), _slope(VERSINE), _slope(COTANGENT)
SINE_2, VERSINE_2, COTANGENT_2 = _slope(SINE_1), _slope(VERSINE_1), _slope(COTANGENT_1)


def _radius(turn: Array, ratio: Array) -> Array:
    """R."""
    x = 0.5 * ratio
    return np.asarray(
        _series(SINE, x * x) * _series(COTANGENT, 0.25 * turn * turn) + 0.5 * turn * x * _series(VERSINE, x * x)
    )


def _leant(lean: Array, along: Array, across: Array) -> tuple[Array, Array]:
    """Coordinates in the link's frame of a vector given along and across the border's tangent."""
    return lean[0] * along - lean[1] * across, lean[1] * along + lean[0] * across


def _over_turn(points: Points) -> tuple[Array, Array, Array]:
    x, y, xi, turn = 0.5 * points.ratio, 0.5 * points.turn, points.xi, points.turn
    phi, q = turn * xi, (turn * xi) ** 2
    s0, s1 = _series(SINE, x * x), 0.5 * x * _series(VERSINE, x * x)
    T1, T2 = _series(COTANGENT_1, y * y), _series(COTANGENT_2, y * y)
    R = points.radius
    R_1, R_2 = s0 * y * T1 + s1, 0.5 * s0 * (T1 + 2.0 * y * y * T2)
    S1, S2 = _series(SINE_1, q), _series(SINE_2, q)
    V, V1, V2 = _series(VERSINE, q), _series(VERSINE_1, q), _series(VERSINE_2, q)
    P, P_1, P_2 = _series(SINE, q), 2.0 * phi * S1, 2.0 * S1 + 4.0 * q * S2
    Q, Q_1, Q_2 = phi * V, V + 2.0 * q * V1, 6.0 * phi * V1 + 4.0 * phi * q * V2
    u, sign = points.h * xi, np.where(points.before, -1.0, 1.0)
    A, W = u * (R_1 * P + R * xi * P_1), u * (R_1 * Q + R * xi * Q_1)
    A_2 = u * (R_2 * P + 2.0 * R_1 * xi * P_1 + R * xi * xi * P_2)
    W_2 = u * (R_2 * Q + 2.0 * R_1 * xi * Q_1 + R * xi * xi * Q_2)
    cos, sin = np.cos(phi), np.sin(phi)
    A_u, W_u = R_1 * cos - R * xi * sin, R_1 * sin + R * xi * cos
    return (
        np.stack(_leant(points.lean, sign * A, W)),
        np.stack(_leant(points.lean, A_u, sign * W_u)),
        np.stack(_leant(points.lean, sign * A_2, W_2)),
    )


def _over_angles(points: Points) -> Array:
    """∂δ of the point's element over (θ_{i−1}, θ_i, θ_{i+1}), (k, 3)."""
    return np.where(points.before[:, None], (-1.0, 1.0, 0.0), (0.0, -1.0, 1.0))


def _vector(points: Points, local: Array) -> Array:
    """Vectors (k, 2) from their coordinates (2, k) in the links' frames."""
    return np.asarray(local[0][:, None] * points.e + local[1][:, None] * points.n)


def position_slopes(points: Points) -> Array:
    """∂C over the local numbers (x_i, y_i, θ_{i−1}, θ_i, θ_{i+1}), (k, 2, 5)."""
    slopes = np.zeros((len(points.s), 2, LOCALS))
    slopes[:, 0, 0] = slopes[:, 1, 1] = 1.0
    slopes[:, :, 2:] = _vector(points, points.over_turn[0])[:, :, None] * _over_angles(points)[:, None, :]
    slopes[:, :, 3] += points.a[:, None] * points.n - points.w[:, None] * points.e
    return slopes


def position_curvature(points: Points, along: Array) -> Array:
    """Second derivatives of along·C over the local numbers for directions ``along`` (k, 2): (k, 5, 5)."""
    second = np.zeros((len(points.s), LOCALS, LOCALS))
    on_e, on_n = np.sum(along * points.e, axis=1), np.sum(along * points.n, axis=1)
    once, _, twice = points.over_turn
    turns = _over_angles(points)
    second[:, 2:, 2:] = (twice[0] * on_e + twice[1] * on_n)[:, None, None] * turns[:, :, None] * turns[:, None, :]
    over = (once[0] * on_n - once[1] * on_e)[:, None] * turns
    second[:, 3, 2:] += over
    second[:, 2:, 3] += over
    second[:, 3, 3] -= points.a * on_e + points.w * on_n
    return second


def angle_slopes(points: Points) -> Array:
    """∂ψ over the local numbers, (k, 5)."""
    slopes = np.zeros((len(points.s), LOCALS))
    a1_, w1_ = points.over_turn[1]
    slopes[:, 2:] = ((points.a1 * w1_ - points.w1 * a1_) / points.speed**2)[:, None] * _over_angles(points)
    slopes[:, 3] += 1.0
    return slopes


def tangent_slopes(points: Points) -> Array:
    """∂C_s over the local numbers, (k, 2, 5)."""
    slopes = np.zeros((len(points.s), 2, LOCALS))
    slopes[:, :, 2:] = _vector(points, points.over_turn[1])[:, :, None] * _over_angles(points)[:, None, :]
    slopes[:, :, 3] += points.a1[:, None] * points.n - points.w1[:, None] * points.e
    return slopes
