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
        e, n: direction and normal of the link, (k, 2).
        a, w, a1, w1, a2, w2: coordinates in the link's frame and their derivatives over s.
        b, b1: ∂w over δ_i and δ_{i+1} and its derivative over s, (k, 2).
    """

    s: Array
    link: Ints
    x: Array
    y: Array
    psi: Array
    speed: Array
    bend: Array
    e: Array
    n: Array
    a: Array
    w: Array
    a1: Array
    w1: Array
    a2: Array
    w2: Array
    b: Array
    b1: Array


def points_at(chain: Chain, unit_length: float, state: State, at: Positions, s: Array) -> Points:
    """The smooth line of ``chain`` at arc lengths ``s`` (k,), units of length."""
    s = np.clip(s, 0.0, chain.s[-1])
    # joints stand at 0, h/2, 3h/2, ...: link i begins at (i − ½)h
    link = np.clip(np.floor(s / chain.h + 0.5).astype(np.intp), 0, chain.n)
    start, stop = chain.s[link], chain.s[link + 1]
    theta = state.theta[chain.links]
    turn = np.diff(theta) - np.diff(chain.rest)
    padded = np.concatenate(([0.0], turn, [0.0]))  # δ at joints 0..N+1; the ends carry no spring
    curvature, rest_angle = chain.line.curvature * unit_length, chain.rest[link]
    t = s - start
    first = chain.line.theta0 + curvature * start - rest_angle
    half = 0.5 * curvature * t
    chord = t * np.sinc(half / np.pi)
    a, w0 = chord * np.cos(first + half), chord * np.sin(first + half)
    slope = first + curvature * t
    a1, w1 = np.cos(slope), np.sin(slope)
    a2, w2 = -curvature * w1, curvature * a1
    from_left = np.maximum(0.5 - t / chain.h, 0.0) * (link > 0)
    from_right = np.maximum(0.5 - (stop - s) / chain.h, 0.0) * (link < chain.n)
    b = np.stack((0.5 * chain.h * from_left**2, 0.5 * chain.h * from_right**2), axis=1)
    b1 = np.stack((-from_left, from_right), axis=1)
    b2 = np.stack((from_left > 0.0, from_right > 0.0), axis=1) / chain.h
    turns = np.stack((padded[link], padded[link + 1]), axis=1)
    w = w0 + np.sum(b * turns, axis=1)
    w1 = w1 + np.sum(b1 * turns, axis=1)
    w2 = w2 + np.sum(b2 * turns, axis=1)
    angle = theta[link]
    e = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    n = np.stack((-e[:, 1], e[:, 0]), axis=1)
    joint = chain.first_joint + link
    squared = a1 * a1 + w1 * w1
    return Points(
        s=s,
        link=link,
        x=at.x[joint] + a * e[:, 0] + w * n[:, 0],
        y=at.y[joint] + a * e[:, 1] + w * n[:, 1],
        psi=angle + np.arctan2(w1, a1),
        speed=np.sqrt(squared),
        bend=(a1 * w2 - w1 * a2) / squared,
        e=e,
        n=n,
        a=a,
        w=w,
        a1=a1,
        w1=w1,
        a2=a2,
        w2=w2,
        b=b,
        b1=b1,
    )


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


def chosen(points: Points, which: Array) -> Points:
    """Some of the points."""
    return Points(*(getattr(points, name)[which] for name in Points.__slots__))
