"""Offset points of a chain on a curve, eqs. (8)-(10), and the estimated distance from the exact offset curve.

=========  =======================================================================================
w          place on the curve from 0 to 1: share of a polynomial's range, of another curve's length
p_i        joints, i = 0..N+1: springs 1..N between the curve's ends
L_i, θ_i   length and tangent angle of link i from p_i to p_{i+1}
t          offset, m; positive to the left of the curve
τ_i, b_i   ½ (θ_{i−1} + θ_i), eq. (9); p_i + t (−sin τ_i, cos τ_i), eq. (10)
κ          curvature of the curve
ε          τ_i less the curve's own tangent angle at p_i
=========  =======================================================================================

The angle of a link is the mean of the tangent angle along the link.  By Taylor's series

    ε = (½ − L_{i−1}/(L_{i−1}+L_i))(θ_i − θ_{i−1}) + L_{i−1} L_i κ'/6 + …

The first term is eq. (9) less eq. (8) with the lengths for γ, the second the error of (8) with lengths.  Both are of
second order in 1/N where the lengths of neighbours differ by a second order.  A point at the distance t from p_i and ε
off the normal has moved t sin ε along the exact offset curve, whose curvature is κ/(1 − tκ), and t(1 − cos ε) away from
the tangent.  The distance from the curve is t ε²/(2 |1 − tκ|) + …, of fourth order in 1/N.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene import Polynomial, Spacing
from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import Curve

DEGREES = (2, 4)
"""Degrees of the two splines that estimate ε and κ."""


@dataclass(frozen=True, slots=True)
class OffsetPoints:
    """The calculated points b_i.

    Attributes:
        points: (k, N, 2), m, for k distances.
        tangents: τ_i, (N,), rad.
        off_curve: estimated distance from the exact offset curve, by the leading term above, (k, N), m.
    """

    points: Array
    tangents: Array
    off_curve: Array


def joint_places(spacing: Spacing, n: int) -> Array:
    """w (N + 2,) of the ends and of ``n`` springs, which stand in the middles of spaced elements, eq. (2)."""
    if spacing.of == "joints":
        return _law(spacing, n + 1)
    borders = _law(spacing, n)
    return np.concatenate((borders[:1], 0.5 * (borders[1:] + borders[:-1]), borders[-1:]))


def joints_on(curve: Curve, places: Array) -> Array:
    """p_i (k, 2), m, at w (k,)."""
    if not isinstance(curve, Polynomial):
        return shape_of(curve).point(places)
    first, last = curve.range
    variable = first + (last - first) * places
    value = np.polynomial.polynomial.polyval(variable, np.array(curve.coefficients))
    return np.column_stack((variable, value) if curve.axis == "x" else (value, variable))


def offset_points(curve: Curve, spacing: Spacing, n: int, distances: Array) -> OffsetPoints:
    """b_1..b_N of a chain of ``n`` springs on a curve.

    Args:
        curve: the neutral line.
        spacing: law of the springs' places, or of the elements' ends.
        n: number of springs.
        distances: t (k,), m, positive to the left of the curve.

    Returns:
        Points (k, n, 2), m, tangents (n,), rad, and estimated distances from the exact offset curve (k, n), m.

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
    t, tau = distances[:, None], 0.5 * (theta[:-1] + theta[1:])
    off = 0.5 * np.abs(t) * epsilon**2 / np.abs(1.0 - t * kappa)
    return OffsetPoints(p[1:-1] + np.stack((-t * np.sin(tau), t * np.cos(tau)), axis=-1), tau, off)


def _law(spacing: Spacing, m: int) -> Array:
    """w of the spacing at k/m, k = 0..m."""
    even = np.arange(m + 1) / m
    return 0.5 * (1.0 - np.cos(np.pi * even)) if spacing.law == "sine" else even


def _normal_error(lengths: Array, theta: Array) -> tuple[Array, Array]:
    """Estimates of |ε| and κ at the joints 1..N, (N,) each, from the chain alone.

    The sums Σ θ L are values of a primitive of the tangent angle; a spline through them has the tangent angle and κ for
    derivatives.  The estimate is the larger ε of two splines and their difference.
    """
    from scipy.interpolate import make_interp_spline  # a solve without offset points does not load the splines

    along = np.concatenate(([0.0], np.cumsum(lengths)))
    sums = np.concatenate(([0.0], np.cumsum(theta * lengths)))
    lower, higher = (make_interp_spline(along, sums, degree) for degree in DEGREES)
    tau, inner = 0.5 * (theta[:-1] + theta[1:]), along[1:-1]
    of_lower, of_higher = np.abs(tau - lower(inner, 1)), np.abs(tau - higher(inner, 1))
    error = np.maximum(of_lower, of_higher) + np.abs(higher(inner, 1) - lower(inner, 1))
    return error, np.asarray(higher(inner, 2), dtype=np.float64)
