"""A beam's deformed neutral line as a smooth curve through the chain.

==========  ==============================================================================
s, t        arc length from the beam's start and from the start of link i
e_i, n_i    direction of link i and its left normal
a, w        coordinates of a point along e_i and n_i from joint i
δ_i         change of angle at spring i, eq. (4)
b(ξ)        ½(½ − |ξ|)² for |ξ| ≤ ½: what spreading a unit turn over its element adds
==========  ==============================================================================

Every link carries its own piece of the stress-free neutral line.  A spring gathers the turning of
its element in one point; the beam turns evenly over the element.  Spreading δ_i evenly moves the
line by h·δ_i·b((s − s_i)/h) towards the inside of the bend, and nothing outside the element:

    C(s) = p_i + a⁰(t)·e_i + (w⁰(t) + h·δ_i·b(t/h) + h·δ_{i+1}·b((s_{i+1} − s)/h))·n_i

At rest this is the true neutral line; deformed it has a continuous tangent (to third order in the turn
of one element).  A force at C(s) then does the same work on the springs as on a beam whose change of
curvature is constant over each element, wherever in the element it acts: this keeps the error of a
contact force even in N.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.kinematics import Positions, State
from cprbm.model import Chain
from scene.answer import Array, Ints

LOCALS = 5  # x_i, y_i, θ_{i−1}, θ_i, θ_{i+1}


@dataclass(frozen=True, slots=True)
class Points:
    """Some points of one beam's smooth line, arrays (k,) unless said otherwise.

    Attributes:
        s: arc length; link: the link each lies on, in the beam's own numbering.
        x, y: position; psi: tangent angle.
        speed: |dC/ds|; bend: dψ/ds.
        cos, sin: of the link's angle: e = (cos, sin), n = (−sin, cos).
        a, w, a1, w1: coordinates in the link's frame and their derivatives over s.
        left, right: ½ − |ξ| of the springs before and after, zero outside their elements.
        h: element length.
    """

    s: Array
    link: Ints
    x: Array
    y: Array
    psi: Array
    speed: Array
    bend: Array
    cos: Array
    sin: Array
    a: Array
    w: Array
    a1: Array
    w1: Array
    left: Array
    right: Array
    h: float

    @property
    def e(self) -> Array:
        """Direction of the link, (k, 2)."""
        return np.stack((self.cos, self.sin), axis=1)

    @property
    def n(self) -> Array:
        """Left normal of the link, (k, 2)."""
        return np.stack((-self.sin, self.cos), axis=1)

    @property
    def b(self) -> Array:
        """∂w over δ_i and δ_{i+1}, (k, 2)."""
        return 0.5 * self.h * np.stack((self.left**2, self.right**2), axis=1)

    @property
    def b1(self) -> Array:
        """∂w' over δ_i and δ_{i+1}, (k, 2)."""
        return np.stack((-self.left, self.right), axis=1)


@dataclass(frozen=True, slots=True)
class SmoothLine:
    """One beam's smooth line in one state.

    Attributes:
        chain: the beam.
        curvature: stress-free, over units of length.
        theta, cos, sin: angles of the links (N+1,).
        turns: δ at the joints 0..N+1, zero at the ends, which carry no spring.
        x, y: joints (N+2,).
    """

    chain: Chain
    curvature: float
    theta: Array
    cos: Array
    sin: Array
    turns: Array
    x: Array
    y: Array

    def at(self, s: Array) -> Points:
        """Points at arc lengths ``s`` (k,), units of length; beyond the ends the end itself."""
        chain, h = self.chain, self.chain.h
        s = np.minimum(np.maximum(s, 0.0), chain.s[-1])
        # joints stand at 0, h/2, 3h/2, ...: link i begins at (i − ½)h
        link = np.minimum((s / h + 0.5).astype(np.intp), chain.n)
        start, stop = chain.s[link], chain.s[link + 1]
        t = s - start
        cos, sin = self.cos[link], self.sin[link]
        nothing = np.zeros(len(s))
        a, w, a1, w1, a2, w2 = t, nothing, nothing + 1.0, nothing, nothing, nothing
        if self.curvature != 0.0:
            first = chain.line.theta0 + self.curvature * start - chain.rest[link]
            half = 0.5 * self.curvature * t
            chord = t * np.sinc(half / np.pi)
            a, w = chord * np.cos(first + half), chord * np.sin(first + half)
            a1, w1 = np.cos(first + 2.0 * half), np.sin(first + 2.0 * half)
            a2, w2 = -self.curvature * w1, self.curvature * a1
        left = np.maximum(0.5 - t / h, 0.0) * (link > 0)
        right = np.maximum(0.5 - (stop - s) / h, 0.0) * (link < chain.n)
        before, after = self.turns[link], self.turns[link + 1]
        w = w + 0.5 * h * (left * left * before + right * right * after)
        w1 = w1 - left * before + right * after
        w2 = w2 + ((left > 0.0) * before + (right > 0.0) * after) / h
        squared = a1 * a1 + w1 * w1
        return Points(
            s=s,
            link=link,
            x=self.x[link] + a * cos - w * sin,
            y=self.y[link] + a * sin + w * cos,
            psi=self.theta[link] + np.arctan2(w1, a1),
            speed=np.sqrt(squared),
            bend=(a1 * w2 - w1 * a2) / squared,
            cos=cos,
            sin=sin,
            a=a,
            w=w,
            a1=a1,
            w1=w1,
            left=left,
            right=right,
            h=h,
        )


def smooth_line(chain: Chain, unit_length: float, state: State, at: Positions) -> SmoothLine:
    """The smooth line of ``chain`` in a state."""
    theta = state.theta[chain.links]
    turns = np.zeros(chain.n + 2)
    turns[1:-1] = np.diff(theta) - np.diff(chain.rest)
    return SmoothLine(
        chain=chain,
        curvature=chain.line.curvature * unit_length,
        theta=theta,
        cos=np.cos(theta),
        sin=np.sin(theta),
        turns=turns,
        x=at.x[chain.joints],
        y=at.y[chain.joints],
    )


def curvature_step(line: SmoothLine, link: Ints) -> Array:
    """Largest step of the change of curvature between elements that meet at or beside a link, (k,)."""
    n = line.chain.n
    steps = np.zeros(n + 1)  # across the far border of element i, springs i and i+1
    steps[1:n] = np.abs(np.diff(line.turns[1:-1])) / line.chain.h
    return np.asarray(
        np.maximum(steps[link], np.maximum(steps[np.maximum(link - 1, 0)], steps[np.minimum(link + 1, n)]))
    )


def halves(chain: Chain) -> Array:
    """Arc lengths of the joints and of the places half-way between them, (2N+3,)."""
    s = np.empty(2 * chain.n + 3)
    s[::2] = chain.s
    s[1::2] = 0.5 * (chain.s[1:] + chain.s[:-1])
    return s


def _over_angles(b: Array) -> Array:
    """∂w over (θ_{i−1}, θ_i, θ_{i+1}) from ∂w over (δ_i, δ_{i+1}), (k, 3)."""
    return np.stack((-b[:, 0], b[:, 0] - b[:, 1], b[:, 1]), axis=1)


def position_slopes(points: Points) -> Array:
    """∂C over the local numbers (x_i, y_i, θ_{i−1}, θ_i, θ_{i+1}), (k, 2, 5)."""
    slopes = np.zeros((len(points.s), 2, LOCALS))
    slopes[:, 0, 0] = slopes[:, 1, 1] = 1.0
    slopes[:, :, 2:] = points.n[:, :, None] * _over_angles(points.b)[:, None, :]
    slopes[:, :, 3] += points.a[:, None] * points.n - points.w[:, None] * points.e
    return slopes


def position_curvature(points: Points, along: Array) -> Array:
    """Second derivatives of along·C over the local numbers for directions ``along`` (k, 2): (k, 5, 5)."""
    second = np.zeros((len(points.s), LOCALS, LOCALS))
    on_e, on_n = np.sum(along * points.e, axis=1), np.sum(along * points.n, axis=1)
    over = -on_e[:, None] * _over_angles(points.b)
    second[:, 3, 2:] += over
    second[:, 2:, 3] += over
    second[:, 3, 3] -= points.a * on_e + points.w * on_n
    return second


def angle_slopes(points: Points) -> Array:
    """∂ψ over the local numbers, (k, 5)."""
    slopes = np.zeros((len(points.s), LOCALS))
    slopes[:, 2:] = (points.a1 / points.speed**2)[:, None] * _over_angles(points.b1)
    slopes[:, 3] += 1.0
    return slopes


def tangent_slopes(points: Points) -> Array:
    """∂C_s over the local numbers, (k, 2, 5)."""
    slopes = np.zeros((len(points.s), 2, LOCALS))
    slopes[:, :, 2:] = points.n[:, :, None] * _over_angles(points.b1)[:, None, :]
    slopes[:, :, 3] += points.a1[:, None] * points.n - points.w1[:, None] * points.e
    return slopes
