"""Where a beam cuts off a corner: it enters what is rigid on one side of the corner and leaves it on the other.

A row that holds the corner pushes such a beam back, however sharp that is and however far through it the beam has come.
"""

from __future__ import annotations

import numpy as np

from cprbm_scene.answer import Array


def cut(course: Array, s: Array, before: Array, behind: Array) -> tuple[float, float] | None:
    """Between which arc lengths a beam cuts off a corner; None where it does not.

    Args:
        course: places along the beam (n, 2), at arc lengths ``s`` (n,), units of length.
        before, behind: the edge from the corner on (k, 2) and (j, 2), on one side and on the other.
    """
    one, other = _first_crossing(course, s, before), _first_crossing(course, s, behind)
    if one is None or other is None:
        return None
    return min(one, other), max(one, other)


def _first_crossing(course: Array, s: Array, chain: Array) -> float | None:
    """The arc length at which a ``course`` (n, 2) crosses a ``chain`` (k, 2) first, as one goes along the latter."""
    a, along = course[:-1, None], np.diff(course, axis=0)[:, None]
    b, towards = chain[:-1], np.diff(chain, axis=0)
    across, apart = _cross(along, towards), b - a
    with np.errstate(divide="ignore", invalid="ignore"):
        share, far = _cross(apart, towards) / across, _cross(apart, along) / across
    met = (share >= 0.0) & (share <= 1.0) & (far >= 0.0) & (far <= 1.0)
    pieces = np.flatnonzero(met.any(axis=0))
    if not pieces.size:
        return None
    piece = pieces[0]
    element = int(np.argmin(np.where(met[:, piece], far[:, piece], np.inf)))
    return float(s[element] + share[element, piece] * (s[element + 1] - s[element]))


def _cross(one: Array, other: Array) -> Array:
    return np.asarray(one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])
