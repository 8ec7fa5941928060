"""Zones of overlap along an edge, and their Gauss points.

======  =======================================
symbol  meaning
======  =======================================
ζ       place along the edge, in nodes
g(ζ)    gap, infinite without an opposite place
======  =======================================

The gap is sampled; sign changes bracket the ends of zones, and minima between samples are evaluated. The points move
with the zone's ends. The pressure vanishes there, so that this motion adds nothing to the energy's derivatives.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array

SAMPLES = 6  # samples between two nodes
_SECANTS = 12
_VANISHES = 1e-13  # lengths of the longest beam: gap at the end of a zone

Gap = Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Zones:
    """Zones (2, z) with g < 0, ascending, and the ``least`` gap anywhere with its ``place``."""

    zones: Array
    least: float
    place: float

    def points(self, quadrature: int) -> tuple[Array, Array]:
        """Gauss points ζ (k,) and weights (k,), ``quadrature`` on each part of a zone between two nodes."""
        nodes, weights = np.polynomial.legendre.leggauss(quadrature)
        places, shares = [np.empty(0)], [np.empty(0)]
        for begin, end in self.zones.T:
            inner = np.arange(np.floor(begin) + 1.0, np.ceil(end))
            fence = np.concatenate([[begin], inner[(inner > begin) & (inner < end)], [end]])
            half = 0.5 * np.diff(fence)
            places.append((fence[:-1] + half + half * nodes[:, None]).T.ravel())
            shares.append((half * weights[:, None]).T.ravel())
        return np.concatenate(places), np.concatenate(shares)


NOWHERE = Zones(np.empty((2, 0)), np.inf, 0.0)


def zones(gap: Gap, nodes: int) -> Zones:
    """The zones of an edge with ``nodes`` nodes."""
    zeta, g = _sampled(gap, nodes)
    lowest = int(np.argmin(g))
    if not g[lowest] < 0.0:
        return Zones(np.empty((2, 0)), float(g[lowest]), float(zeta[lowest]))
    within = g < 0.0
    steps = np.diff(np.concatenate([[False], within, [False]]).astype(int))
    begins, ends = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1) - 1
    lower, upper = zeta[begins].copy(), zeta[ends].copy()
    for edge, index, beside in ((lower, begins, -1), (upper, ends, 1)):
        other = index + beside
        inside = (other >= 0) & (other < zeta.size)
        inside[inside] &= np.isfinite(g[other[inside]])
        if inside.any():
            i, o = index[inside], other[inside]
            edge[inside] = _roots(gap, zeta[i], zeta[o], g[i], g[o])
    return Zones(np.stack([lower, upper]), float(g[lowest]), float(zeta[lowest]))


def least(gap: Gap, nodes: int) -> float:
    """The least gap along an edge with ``nodes`` nodes."""
    return float(_sampled(gap, nodes)[1].min())


def _sampled(gap: Gap, nodes: int) -> tuple[Array, Array]:
    """Sampled places along an edge, and the gaps there."""
    zeta = np.linspace(0.0, nodes - 1.0, SAMPLES * (nodes - 1) + 1)
    return _with_minima(gap, zeta, gap(zeta))


def _with_minima(gap: Gap, zeta: Array, g: Array) -> tuple[Array, Array]:
    """The samples and, for every local minimum, the vertex of the parabola through three samples."""
    with np.errstate(invalid="ignore"):
        middle = (g[1:-1] <= g[:-2]) & (g[1:-1] < g[2:]) & np.isfinite(g[:-2]) & np.isfinite(g[2:])
    i = np.flatnonzero(middle) + 1
    if not i.size:
        return zeta, g
    left, right = g[i - 1] - g[i], g[i + 1] - g[i]
    vertex = zeta[i] + 0.5 * (left - right) / (left + right) * (zeta[i] - zeta[i - 1])
    new = vertex[np.abs(vertex - zeta[i]) > 1e-9]
    if not new.size:
        return zeta, g
    all_places = np.concatenate([zeta, new])
    order = np.argsort(all_places, kind="stable")
    return all_places[order], np.concatenate([g, gap(new)])[order]


def _roots(gap: Gap, inner: Array, outer: Array, g_inner: Array, g_outer: Array) -> Array:
    """Zeros of g between places inside (g < 0) and outside, by the Illinois variant of false position."""
    a, b, fa, fb = inner.copy(), outer.copy(), g_inner.copy(), g_outer.copy()
    side = np.zeros(a.size)
    for _ in range(_SECANTS):
        c = b - fb * (b - a) / np.where(fb == fa, 1.0, fb - fa)
        fc = gap(c)
        fc = np.where(np.isfinite(fc), fc, np.abs(fb))
        negative = fc < 0.0
        fb = np.where(negative & (side == -1), 0.5 * fb, fb)
        fa = np.where(~negative & (side == 1), 0.5 * fa, fa)
        a, fa = np.where(negative, c, a), np.where(negative, fc, fa)
        b, fb = np.where(negative, b, c), np.where(negative, fb, fc)
        side = np.where(negative, -1.0, 1.0)
        if np.abs(b - a).max() < 1e-13 or np.abs(fc).max() < _VANISHES:
            break
    return np.asarray(np.where(np.abs(fa) < np.abs(fb), a, b))
