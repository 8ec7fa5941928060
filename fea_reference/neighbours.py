"""Nearby nodes of two lines, without a loop over all pairs."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from cprbm_scene.answer import Array, Flags
from fea_reference.hermite import Index
from fea_reference.state import Complex

_TABLE = 40_000  # distances: limit above which a tree search is faster than a table


def nearest(points: Complex, nodes: Complex) -> tuple[Array, Index]:
    """Distance (k,) of points x + i y (k,) to the nearest of the ``nodes`` (m,), and the number (k,) of this node."""
    if points.size * nodes.size > _TABLE:
        distance, which = KDTree(nodes.view(float).reshape(-1, 2)).query(points.view(float).reshape(-1, 2))
        return distance, which
    # a single product gives the part of |x − y|² that distinguishes the nodes; the distance follows from the difference
    x, y = nodes.real, nodes.imag
    apart = np.array([points.real, points.imag, np.ones(points.size)]).T @ np.array([x, y, -0.5 * (x * x + y * y)])
    which = apart.argmax(axis=1)
    return np.abs(points - nodes[which]), which


def near_each_other(first: Complex, second: Complex, reach: float) -> tuple[Index, Index]:
    """Numbers, in order, of nodes x + i y (n,) and (m,), including all nodes within ``reach`` of the other line.

    The nearest pair is always included. Excluded are runs of nodes whose bounding boxes are too far from all boxes of
    the other line. With about √n runs per line the cost is proportional to the length of the lines.
    """
    if first.size * second.size <= _TABLE:
        return np.arange(first.size), np.arange(second.size)
    runs = [_Runs(nodes) for nodes in (first, second)]
    apart = runs[0].apart(runs[1])
    here, there = np.unravel_index(apart.argmin(), apart.shape)
    # the nearest pair is no farther apart than these two runs
    most = float(nearest(runs[0].nodes(here), runs[1].nodes(there))[0].min())
    close = apart <= max(reach, most)
    return runs[0].numbers(np.asarray(close.any(axis=1))), runs[1].numbers(np.asarray(close.any(axis=0)))


class _Runs:
    """Nodes x + i y (n,) in runs of equal length, and their bounding boxes."""

    def __init__(self, nodes: Complex) -> None:
        self.all = nodes
        self.length = int(np.sqrt(nodes.size))
        starts = np.arange(0, nodes.size, self.length)
        self.low = [np.minimum.reduceat(coordinates, starts) for coordinates in (nodes.real, nodes.imag)]
        self.high = [np.maximum.reduceat(coordinates, starts) for coordinates in (nodes.real, nodes.imag)]

    def apart(self, other: _Runs) -> Array:
        """Least distance between boxes, (runs, other runs)."""
        x, y = (
            np.maximum(np.maximum(low[:, None] - its_high, its_low - high[:, None]), 0.0)
            for low, high, its_low, its_high in zip(self.low, self.high, other.low, other.high, strict=True)
        )
        return np.asarray(np.hypot(x, y))

    def nodes(self, run: np.intp) -> Complex:
        """Nodes of a run."""
        return self.all[run * self.length : (run + 1) * self.length]

    def numbers(self, which: Flags) -> Index:
        """Node numbers of the runs ``which``."""
        return np.flatnonzero(np.repeat(which, self.length)[: self.all.size])
