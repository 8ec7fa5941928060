"""Least gap between two beams as strips about their neutral lines.

======  ==================================================
symbol  meaning
======  ==================================================
u       fraction of a beam's arc length
d       distance of places u₁, u₂ of the neutral lines, m
T       half of the thickness at a place, m
======  ==================================================

A beam fills the circles of radius T about its neutral line.  The gap of two beams is the least d − T₁ − T₂.  A KD-tree
of samples yields candidates.  Nested grids refine the lowest: places of the first beam, and places of the second beam
about the foot of the perpendicular, with the kinks of both thicknesses.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cprbm_scene.beam_records import Beam
from cprbm_scene.curve_records import shape_of
from cprbm_scene.curves import Array

Range = tuple[float, float]

WHOLE: Range = (0.0, 1.0)
_SAMPLES = 1001
_LOWEST = 5
"""Sampled minima that are refined: the least gap may lie beside a sample that is a little higher."""
_GRID = np.linspace(-1.0, 1.0, 13)
_FINER = 0.4
"""Width of a grid over the width of the grid before, whose least value lay inside."""
_STEPS = 80
_PROJECTIONS = 2
"""Steps along the tangent to the foot of the perpendicular, from the foot of the step before."""
_SETTLED = 1e-10
"""Width of the last grid, of a beam's length: at a crossing the gap has this error, at a smooth minimum none."""


@dataclass(frozen=True, slots=True)
class ClosestPair:
    """Least ``gap`` of two beams, m, negative for an overlap, with the fractions ``u1`` and ``u2`` of the places."""

    gap: float
    u1: float
    u2: float


def half_thickness(beam: Beam, u: Array, *, thick: bool) -> Array:
    """T (n,), m, at the fractions ``u`` (n,); zeros for a beam that touches as a line."""
    return 0.5 * beam.thickness_at(u) if thick else np.zeros(len(u))


@lru_cache(maxsize=512)
def closest_pair(
    first: Beam, second: Beam, range1: Range = WHOLE, range2: Range = WHOLE, *, thick: bool = True
) -> ClosestPair:
    """Least gap of two beams within ranges of u; a gap far above the samples' distance is not refined."""
    from scipy.spatial import cKDTree  # scenes without contact of beams need no SciPy

    shape1, shape2 = shape_of(first.curve), shape_of(second.curve)

    def gap(u1: Array, u2: Array) -> Array:
        d = np.hypot(*(shape1.point(u1) - shape2.point(u2)).T)
        return np.asarray(d - half_thickness(first, u1, thick=thick) - half_thickness(second, u2, thick=thick))

    u1, u2 = _samples(first, range1), _samples(second, range2)
    p1, p2 = shape1.point(u1), shape2.point(u2)
    _, near = cKDTree(p2).query(p1)
    # a step along the tangent leads to the foot of the perpendicular: samples alone would hide a shallow crossing
    along = ((p1 - p2[near]) * shape2.tangent(u2[near])).sum(axis=1)
    foot = np.clip(u2[near] + along / shape2.length, *range2)
    gaps = gap(u1, foot)
    fence = np.pad(gaps, 1, constant_values=np.inf)
    minima = np.flatnonzero((gaps <= fence[:-2]) & (gaps <= fence[2:]))
    lowest = minima[np.argsort(gaps[minima], kind="stable")[:_LOWEST]]
    best = ClosestPair(float(gaps[lowest[0]]), float(u1[lowest[0]]), float(foot[lowest[0]]))
    if best.gap > 2.0 * (shape1.length + shape2.length) / _SAMPLES:
        return best
    for i in lowest:
        at, width = (float(u1[i]), float(foot[i])), 4.0 / _SAMPLES
        for _ in range(_STEPS):
            a, feet = _grid(first, at[0], width, range1), np.full(1, at[1])
            for _ in range(_PROJECTIONS):
                along = ((shape1.point(a) - shape2.point(feet)) * shape2.tangent(feet)).sum(axis=1)
                feet = np.clip(feet + along / shape2.length, *range2)
            kinks = np.tile(_knots(second, range2), (len(a), 1))
            b = np.hstack((np.clip(feet[:, None] + width * _GRID, *range2), kinks))
            values = gap(np.repeat(a, b.shape[1]), b.ravel()).reshape(b.shape)
            k, m = np.unravel_index(np.argmin(values), b.shape)
            moved = max(abs(float(a[k]) - at[0]), abs(float(b[k, m] - feet[k])))
            at = (float(a[k]), float(b[k, m]))
            best = min(best, ClosestPair(float(values[k, m]), *at), key=lambda pair: pair.gap)
            width *= _FINER if moved < 0.5 * width else 1.0
            if width < _SETTLED:
                break
    return best


def _knots(beam: Beam, span: Range) -> Array:
    return beam.knots[(beam.knots > span[0]) & (beam.knots < span[1])]


def _samples(beam: Beam, span: Range) -> Array:
    return np.union1d(np.linspace(*span, _SAMPLES), _knots(beam, span))


def _grid(beam: Beam, place: float, width: float, span: Range) -> Array:
    knots = beam.knots[np.abs(beam.knots - place) < width]
    return np.unique(np.clip(np.concatenate([place + width * _GRID, knots]), *span))
