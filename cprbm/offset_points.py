"""Offset points of a chain, eqs. (8)-(10), and how far from the exact offset curve they may lie.

=========  =======================================================================================
w          place on the curve from 0 to 1: share of a polynomial's range, of a line's or an arc's length
p_i        joints, i = 0..N+1: springs 1..N between the curve's ends, (x_i, y_i)
L_i, θ_i   length and tangent angle of link i from p_i to p_{i+1}
t          offset, m; positive to the left of the curve as it runs
β          ½(θ_i − θ_{i−1}), eq. (9); τ_i = θ_{i−1} + β
b_i        p_i + t n(τ_i), n(τ) = (−sin τ, cos τ), eq. (10)
κ          curvature of the curve
ε          τ_i less the curve's own tangent angle at p_i
=========  =======================================================================================

With Taylor's series of the tangent angle along the curve, a link's angle is the mean of it over the link, so that

    ε = (½ − L_{i−1}/(L_{i−1}+L_i))(θ_i − θ_{i−1}) + L_{i−1} L_i κ'/6 + …

The first term is eq. (9) less eq. (8), whose γ are as the lengths where the curvature is even; the second is what
(8) with lengths leaves.  (The estimate takes ε from a spline, which holds further terms.)  Where neighbouring links
differ by a second order both are of second order in 1/N.

A point that stands at the distance t from p_i but ε off the normal has moved t sin ε along the exact offset curve and
t(1 − cos ε) back from its tangent.  That curve's own curvature is κ/(1 − tκ), and it leaves the tangent by
½ κ/(1 − tκ) (t sin ε)².  Together the point is off the curve by

    t ε² / (2 |1 − tκ|) + …,

the square of a small angle: fourth order in 1/N.  On the outer side (tκ < 0) it tends to ε²/(2|κ|) however large t is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.curves import neutral_line
from cprbm_scene import Line, Polynomial, Spacing, Spline
from cprbm_scene.answer import Array
from cprbm_scene.statement import Arc, Curve


@dataclass(frozen=True, slots=True)
class OffsetPoints:
    """The calculated points b_i.

    Attributes:
        points: (k, N, 2), m, for k distances.
        tangents: τ_i, (N,), rad.
        off_curve: estimated distance of each from the exact offset curve, by the leading term above, (k, N), m.
    """

    points: Array
    tangents: Array
    off_curve: Array


def offset_vectors(theta: Array, distance: Array | float) -> tuple[Array, Array, Array]:
    """τ_i (N,) and t n(τ_i) in x and y, (N,) or (k, N), at the joints between links of the angles ``theta`` (N+1,)."""
    tau = 0.5 * (theta[:-1] + theta[1:])
    return tau, -distance * np.sin(tau), distance * np.cos(tau)


def joint_places(spacing: Spacing, n: int) -> Array:
    """w of the joints 0..N+1, (N+2,): of the ends and of ``n`` springs.

    Where the spacing is one of elements, springs stand in their middles, eq. (2).
    """
    if spacing.of == "joints":
        return _law(spacing, n + 1)
    borders = _law(spacing, n)
    return np.concatenate((borders[:1], 0.5 * (borders[1:] + borders[:-1]), borders[-1:]))


def joints_on(curve: Curve, places: Array) -> Array:
    """p_i (k, 2), m, at w (k,)."""
    match curve:
        case Polynomial():
            first, last = curve.range
            variable = first + (last - first) * places
            value = np.polynomial.polynomial.polyval(variable, np.array(curve.coefficients))
            return np.column_stack((variable, value) if curve.axis == "x" else (value, variable))
        case Line() | Arc() | Spline():
            line = neutral_line(curve)
            return np.column_stack(line.position(line.length * places))


def offset_points(curve: Curve, spacing: Spacing, n: int, distances: Array) -> OffsetPoints:
    """b_1..b_N of a chain of ``n`` springs on a curve.

    Args:
        curve: the neutral line.
        spacing: by which law springs, or the elements in whose middles they are, stand along it.
        n: number of springs.
        distances: t (k,), m, positive to the left of the curve as it runs.

    Returns:
        Points (k, n, 2), m, tangents (n,), rad, and how far each point may be off the exact offset curve (k, n), m.

    Source:
        Jin et al., Mechanism and Machine Theory 145 (2020) 103700, eqs. (9) and (10).

    Example:
        Of an even chain on a circle the points lie on the circle of the larger radius.

        >>> import numpy as np
        >>> from cprbm import offset_points
        >>> from cprbm_scene import Arc, Spacing
        >>> arc = Arc(kind="arc", center=(0, 0), start=(0.07, 0), end=(0, 0.07), direction="counterclockwise")
        >>> found = offset_points(arc, Spacing(law="even", of="joints"), 5, np.array([-0.013]))
        >>> np.hypot(*found.points[0].T).round(6)
        array([0.083, 0.083, 0.083, 0.083, 0.083])
    """
    p = joints_on(curve, joint_places(spacing, n))
    dx, dy = np.diff(p, axis=0).T
    lengths, theta = np.hypot(dx, dy), np.unwrap(np.arctan2(dy, dx))
    epsilon, kappa = _normal_error(lengths, theta)
    t = distances[:, None]
    tau, nx, ny = offset_vectors(theta, t)
    off = 0.5 * np.abs(t) * epsilon**2 / np.abs(1.0 - t * kappa)
    return OffsetPoints(p[1:-1] + np.stack((nx, ny), axis=-1), tau, off)


def _law(spacing: Spacing, m: int) -> Array:
    """The spacing's w at k/m, k = 0..m."""
    even = np.arange(m + 1) / m
    return 0.5 * (1.0 - np.cos(np.pi * even)) if spacing.law == "sine" else even


def _normal_error(lengths: Array, theta: Array) -> tuple[Array, Array]:
    """|ε| and κ at the joints 1..N as far as the chain itself can tell, (N,) each.

    A link's angle is the mean of the tangent angle over it, so that the sums Σ θ L at the joints are values of a
    primitive of the tangent angle; a spline through them has the tangent angle and κ as its derivatives.  Of
    splines of two degrees the larger ε counts, and what they say differently is added.
    """
    from scipy.interpolate import make_interp_spline  # loaded when offset points are asked, not with every chain

    along = np.concatenate(([0.0], np.cumsum(lengths)))
    sums = np.concatenate(([0.0], np.cumsum(theta * lengths)))
    lower, higher = (make_interp_spline(along, sums, degree) for degree in (2, 4))
    tau, inner = 0.5 * (theta[:-1] + theta[1:]), along[1:-1]
    of_lower, of_higher = np.abs(tau - lower(inner, 1)), np.abs(tau - higher(inner, 1))
    error = np.maximum(of_lower, of_higher) + np.abs(higher(inner, 1) - lower(inner, 1))
    return error, np.asarray(higher(inner, 2), dtype=np.float64)
