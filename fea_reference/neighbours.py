"""Which nodes of two lines are near each other, without looking at all pairs of them."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from cprbm_scene.answer import Array, Flags
from fea_reference.hermite import Index
from fea_reference.state import Complex

_TABLE = 40_000  # distances: so many are found faster one and all than by a tree


def nearest(points: Complex, nodes: Complex) -> tuple[Array, Index]:
    """How far points x + i y (k,) are from the nearest of the ``nodes`` (m,), and which that is."""
    if points.size * nodes.size > _TABLE:
        distance, which = KDTree(nodes.view(float).reshape(-1, 2)).query(points.view(float).reshape(-1, 2))
        return distance, which
    # of |x − y|² what tells the nodes apart, all in one product; the distance itself by its difference
    x, y = nodes.real, nodes.imag
    apart = np.array([points.real, points.imag, np.ones(points.size)]).T @ np.array([x, y, -0.5 * (x * x + y * y)])
    which = apart.argmax(axis=1)
    return np.abs(points - nodes[which]), which


def near_each_other(first: Complex, second: Complex, reach: float) -> tuple[Index, Index]:
    """Numbers, in order, of nodes x + i y (n,) and (m,) among which are all that are nearer than ``reach``.

    Of each beam at least one; the two that are nearest to each other are among them.  Left out are runs of nodes whose
    boxes are too far from all of the other's: about √n runs each, so that what is left out costs no more than the
    beams are long.
    """
    if first.size * second.size <= _TABLE:
        return np.arange(first.size), np.arange(second.size)
    runs = [_Runs(nodes) for nodes in (first, second)]
    apart = runs[0].apart(runs[1])
    here, there = np.unravel_index(apart.argmin(), apart.shape)
    # what two runs are apart at most: nearer than that is the nearest pair
    most = float(nearest(runs[0].nodes(here), runs[1].nodes(there))[0].min())
    close = apart <= max(reach, most)
    return runs[0].numbers(np.asarray(close.any(axis=1))), runs[1].numbers(np.asarray(close.any(axis=0)))


class _Runs:
    """Nodes x + i y (n,) in runs of equal length, and the boxes about these."""

    def __init__(self, nodes: Complex) -> None:
        self.all = nodes
        self.length = int(np.sqrt(nodes.size))
        starts = np.arange(0, nodes.size, self.length)
        self.low = [np.minimum.reduceat(one, starts) for one in (nodes.real, nodes.imag)]
        self.high = [np.maximum.reduceat(one, starts) for one in (nodes.real, nodes.imag)]

    def apart(self, other: _Runs) -> Array:
        """How far the boxes are apart at least, (runs, other runs)."""
        x, y = (
            np.maximum(np.maximum(low[:, None] - its_high, its_low - high[:, None]), 0.0)
            for low, high, its_low, its_high in zip(self.low, self.high, other.low, other.high, strict=True)
        )
        return np.asarray(np.hypot(x, y))

    def nodes(self, run: np.intp) -> Complex:
        """Those of one run."""
        return self.all[run * self.length : (run + 1) * self.length]

    def numbers(self, which: Flags) -> Index:
        """Of the nodes of those runs."""
        return np.flatnonzero(np.repeat(which, self.length)[: self.all.size])
