"""How far apart the surfaces of two beams are whose thickness varies along them.

======  ====================================================================
symbol  meaning
======  ====================================================================
u       fraction of a beam's arc length
d       distance of places u₁, u₂ of the neutral lines
T       half of the thickness at a place
======  ====================================================================

A beam fills the circles of radius T about its neutral line: two are apart by the least d − T₁ − T₂ over all places.
It has kinks where the thickness has: it is sampled and looked for in ever finer grids that hold the knots.
"""

from __future__ import annotations

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.geometry import arc_length, points_on, tangents_on
from cprbm_scene.statement import Beam, Curve

Range = tuple[float, float]

_SAMPLES = 2001
_REFINED = 5  # of the lowest minima
_GRID = np.linspace(-1.0, 1.0, 13)
_FINER = 0.4  # of a grid that holds its least value inside
_STEPS = 80
_ARRIVED = 1e-9  # of a beam's length


def surfaces_apart(
    beams: tuple[Beam, Beam], curves: tuple[Curve, Curve], size: float, ranges: tuple[Range, Range]
) -> float:
    """The least d − T₁ − T₂ within ranges of u, over ``size``, in metres; the ``curves`` are over it already."""
    from scipy.spatial import cKDTree  # loaded when two curves are compared, not with every scene

    (beam1, beam2), (curve1, curve2) = beams, curves

    def apart(u1: Array, u2: Array) -> Array:
        """At pairs of places (k,)."""
        d = np.hypot(*(points_on(curve1, u1) - points_on(curve2, u2)).T)
        return np.asarray(d - 0.5 * (beam1.thickness_at(u1) + beam2.thickness_at(u2)) / size)

    u1, u2 = (
        np.union1d(np.linspace(*both, _SAMPLES), beam.knots[(beam.knots > both[0]) & (beam.knots < both[1])])
        for beam, both in zip(beams, ranges, strict=True)
    )
    p1, p2 = points_on(curve1, u1), points_on(curve2, u2)
    _, neighbour = cKDTree(p2).query(p1)
    beside = ((p1 - p2[neighbour]) * tangents_on(curve2, u2[neighbour])).sum(axis=1)
    foot = np.clip(u2[neighbour] + beside / arc_length(curve2), *ranges[1])
    found = apart(u1, foot)
    fence = np.pad(found, 1, constant_values=np.inf)
    minima = np.flatnonzero((found <= fence[:-2]) & (found <= fence[2:]))
    best = np.inf
    for i in minima[np.argsort(found[minima], kind="stable")[:_REFINED]]:
        at, width = (float(u1[i]), float(foot[i])), 4.0 / _SAMPLES
        for _ in range(_STEPS):
            grids = []
            for place, beam, (low, high) in zip(at, beams, ranges, strict=True):
                inside = beam.knots[(np.abs(beam.knots - place) < width)]
                grids.append(np.unique(np.clip(np.concatenate([place + width * _GRID, inside]), low, high)))
            a, b = (grid.ravel() for grid in np.meshgrid(*grids, indexing="ij"))
            values = apart(a, b)
            least = int(np.argmin(values))
            best = min(best, float(values[least]))
            moved = max(abs(float(a[least]) - at[0]), abs(float(b[least]) - at[1]))
            at = (float(a[least]), float(b[least]))
            if moved < 0.5 * width:
                width *= _FINER
            if width < _ARRIVED:
                break
    return best
