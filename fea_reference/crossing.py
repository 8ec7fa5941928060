"""Intersection of neutral lines."""

import numpy as np
from scipy.spatial import KDTree

from cprbm_scene.answer import Array, Flags
from fea_reference.hermite import Index, NeutralLine
from fea_reference.zones import Zones

_BESIDE = 1.5  # elements: neighbourhood of a zone within which lines may cross
_ROUNDED = 1e-9  # relative to chord lengths: tolerance of distances
_PARTS = 32  # chords per element: their sagitta is a thousandth of the element's


def lines_cross(first: NeutralLine, second: NeutralLine) -> bool:
    """True if any two chords of the lines' elements intersect in their interiors."""
    i, j = _near(first, second)
    return bool(
        _intersect(first.points[:, i], first.points[:, i + 1], second.points[:, j], second.points[:, j + 1]).any()
    )


def crosses_itself(line: NeutralLine, contact_zones: Zones) -> bool:
    """True if a line crosses itself outside the ``contact_zones``.

    Coils may be closer than the sagitta of their elements. Where chords of elements intersect, the chords of their
    parts, and of the neighbours' parts, decide. In contact, lines may cross by the penetration, which is held and
    measured.
    """
    i, j = _near(line, line)
    i, j = i[i < j], j[i < j]
    crossing = _intersect(line.points[:, i], line.points[:, i + 1], line.points[:, j], line.points[:, j + 1])
    candidates = np.stack([i[crossing], j[crossing]], axis=1)
    if contact_zones.intervals.size and candidates.size:
        places = np.sort(
            np.stack([contact_zones.intervals, contact_zones.zeta_m]), axis=0
        )  # the earlier of both places, then the later
        low, high = (
            side[..., None] + _BESIDE * sign for side, sign in ((places.min(axis=2), -1), (places.max(axis=2), 1))
        )
        middle = candidates.T[:, None] + 0.5
        candidates = candidates[~((low < middle) & (middle < high)).all(axis=0).any(axis=0)]
    if not candidates.size:
        return False
    around = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
    pairs = np.unique(np.clip((candidates[:, None] + around).reshape(-1, 2), 0, line.n - 1), axis=0)
    fine = line.at(np.arange(_PARTS * line.n + 1) / _PARTS)[0]
    i, j = (_PARTS * element[:, None] + np.arange(_PARTS) for element in pairs.T)
    ends = (fine[:, i, None], fine[:, i + 1, None], fine[:, j][:, :, None], fine[:, j + 1][:, :, None])
    return bool(_intersect(*ends).any())


def _near(first: NeutralLine, second: NeutralLine) -> tuple[Index, Index]:
    """Pairs (k,) of element numbers of two lines, including all pairs with intersecting chords.

    Their midpoints are no farther apart than the sum of both half chords.
    """
    lines = (first, second)
    trees = [KDTree(0.5 * (line.points[:, :-1] + line.points[:, 1:]).T) for line in lines]
    halves = sum(0.5 * float(np.abs(np.diff(line.nodes)).max()) for line in lines)
    pairs = trees[0].sparse_distance_matrix(trees[1], halves * (1.0 + _ROUNDED), output_type="ndarray")
    return pairs["i"], pairs["j"]


def _intersect(a: Array, b: Array, c: Array, d: Array) -> Flags:
    """True where segments from ``a`` to ``b`` and from ``c`` to ``d``, (2, ...) all, intersect in their interiors."""
    return np.asarray((_turn(a, b, c) * _turn(a, b, d) < 0.0) & (_turn(c, d, a) * _turn(c, d, b) < 0.0))


def _turn(a: Array, b: Array, c: Array) -> Array:
    """Twice the signed area of the triangle a, b, c."""
    return np.asarray((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
