"""A neutral line that is a polynomial, by fractions of its arc length.

=======  =====================================================================================
symbol   meaning
=======  =====================================================================================
D, σ     extent of the range, m, and its sense along the axis, ±1
w        place on the axis from the start, over D, in [0, 1]
g(w)     (f − f at the start)/D: the line in a frame of its own, from (0, 0)
S(w)     arc length over D, S' = √(1 + g'²)
u        fraction of the arc length
κ        |g''|/(D S'³), absolute curvature, 1/m
=======  =====================================================================================

How S is integrated and inverted stands in :mod:`cprbm_scene.by_arc_length`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from cprbm_scene.by_arc_length import ByArcLength, by_arc_length
from cprbm_scene.sampling import least
from cprbm_scene.statement import Point, Polynomial

Array = NDArray[np.float64]
_FIRST_PANELS = 32
_SAMPLES = 2001
_NOTHING = 1e-14  # of the largest coefficient: a higher power that does not count
_REAL = 1e-6  # imaginary part of a root that is taken as real


@dataclass(frozen=True, slots=True)
class _Graph:
    """``g`` and its first two derivatives' coefficients, D, σ, and S(w)."""

    g: Array
    g1: Array
    g2: Array
    extent: float
    sense: float
    arc: ByArcLength


def terms(curve: Polynomial) -> float:
    """The largest term |c_k v^k| of f in the range, m; not finite where floating point does not hold it."""
    variable, power, largest = max(abs(v) for v in curve.range), 1.0, 0.0
    for coefficient in curve.coefficients:
        largest = max(largest, abs(coefficient) * power if coefficient else 0.0)
        power *= variable
    return largest


def steepest(curve: Polynomial) -> float:
    """The largest |f'| in the range; not finite where floating point does not hold it."""
    w = np.linspace(0.0, 1.0, _SAMPLES)
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.max(np.abs(polynomial.polyval(w, polynomial.polyder(_local(curve))))))


def length(curve: Polynomial) -> float:
    """Arc length, m."""
    graph = _graph(curve)
    return graph.arc.whole * graph.extent


def largest_curvature(curve: Polynomial) -> float:
    """The largest κ, 1/m."""
    from scipy.optimize import minimize_scalar  # loaded when a curve is measured, not with every scene

    graph = _graph(curve)
    # a steep line turns sharply where it is level
    level = polynomial.polyroots(polynomial.polytrim(graph.g1, _NOTHING * np.max(np.abs(graph.g1))))
    level = level.real[(np.abs(level.imag) < _REAL) & (level.real > 0.0) & (level.real < 1.0)]
    w = np.unique(np.concatenate((np.linspace(0.0, 1.0, _SAMPLES), level)))
    kappa = _curvature(graph, w)
    best = int(np.argmax(kappa))
    beside = (float(w[max(best - 1, 0)]), float(w[min(best + 1, len(w) - 1)]))
    refined = minimize_scalar(
        lambda w: -float(_curvature(graph, w)), bounds=beside, method="bounded", options={"xatol": 1e-12}
    )
    return max(float(kappa[best]), -float(refined.fun)) / graph.extent


def curvature(curve: Polynomial, u: Array) -> Array:
    """κ (n,), 1/m, at the fractions ``u`` (n,)."""
    graph = _graph(curve)
    return _curvature(graph, graph.arc.places(u)) / graph.extent


def points(curve: Polynomial, u: Array) -> Array:
    """Points (n, 2), m, at the fractions ``u`` (n,)."""
    graph = _graph(curve)
    w = graph.arc.places(u)
    across = np.asarray(polynomial.polyval(w, graph.g), dtype=np.float64)
    return np.asarray(np.array(curve.start) + graph.extent * _in_plane(curve, graph.sense * w, across))


def tangents(curve: Polynomial, u: Array) -> Array:
    """Unit tangents (n, 2) at the fractions ``u`` (n,), from start to end."""
    graph = _graph(curve)
    w = graph.arc.places(u)
    speed = _speed(graph.g1, w)
    return _in_plane(curve, graph.sense / speed, np.asarray(polynomial.polyval(w, graph.g1) / speed, dtype=np.float64))


def distance_to(curve: Polynomial, point: Point) -> float:
    """Distance of the nearest point from ``point``, m."""
    graph = _graph(curve)
    offset = (np.array(point) - np.array(curve.start)) / graph.extent
    along, across = offset if curve.axis == "x" else offset[::-1]

    def distance(w: Array) -> Array:
        return np.asarray(np.hypot(graph.sense * w - along, polynomial.polyval(w, graph.g) - across))

    return least(distance, graph.arc.places(np.linspace(0.0, 1.0, _SAMPLES))) * graph.extent


def scaled(curve: Polynomial, size: float) -> Polynomial:
    """The same curve with every coordinate divided by ``size``."""
    coefficients, factor = [curve.coefficients[0] / size], 1.0
    for coefficient in curve.coefficients[1:]:
        coefficients.append(coefficient * factor if coefficient else 0.0)
        factor *= size
    ends = curve.range[0] / size, curve.range[1] / size
    return curve.model_copy(update={"coefficients": tuple(coefficients), "range": ends})


def _local(curve: Polynomial) -> Array:
    """Coefficients of g."""
    first, last = curve.range
    extent = abs(last - first)
    c, factor = np.zeros(len(curve.coefficients)), 1.0
    for k, coefficient in enumerate(curve.coefficients[1:], start=1):
        c[k] = coefficient * factor if coefficient else 0.0
        factor *= extent
    # Taylor's shift by repeated synthetic division, in units in which the range is one; g has no constant
    for i in range(len(c) - 1):
        for k in range(len(c) - 2, max(i, 1) - 1, -1):
            c[k] += first / extent * c[k + 1]
    if last < first:
        c[1::2] *= -1.0
    return c


@lru_cache(maxsize=128)
def _graph(curve: Polynomial) -> _Graph:
    first, last = curve.range
    g = _local(curve)
    g1 = np.asarray(polynomial.polyder(g), dtype=np.float64)
    g2 = np.asarray(polynomial.polyder(g1), dtype=np.float64)
    arc = by_arc_length(lambda w: _speed(g1, w), np.linspace(0.0, 1.0, _FIRST_PANELS + 1))
    return _Graph(g, g1, g2, abs(last - first), float(np.sign(last - first)), arc)


def _speed(g1: Array, w: Array) -> Array:
    return np.asarray(np.hypot(1.0, polynomial.polyval(w, g1)))


def _curvature(graph: _Graph, w: Array) -> Array:
    """κ·D."""
    return np.asarray(np.abs(polynomial.polyval(w, graph.g2)) / _speed(graph.g1, w) ** 3)


def _in_plane(curve: Polynomial, along: Array, across: Array) -> Array:
    """Vectors (n, 2) from their parts along and across the axis."""
    return np.column_stack((along, across) if curve.axis == "x" else (across, along))
