"""Do neutral lines cross?"""

from __future__ import annotations

import numpy as np

from fea_reference.hermite import NeutralLine
from scene.answer import Array, Flags

_PARTS = 32  # of an element that are looked at as chords: what they leave of its bow is a thousandth


def cross(first: NeutralLine, second: NeutralLine) -> bool:
    """Whether any two chords of the lines' elements intersect in their insides."""
    chords = [(line.points[:, :-1], line.points[:, 1:]) for line in (first, second)]
    (a, b), (c, d) = chords
    return bool(_intersect(a[:, :, None], b[:, :, None], c[:, None], d[:, None]).any())


def crosses_itself(line: NeutralLine) -> bool:
    """Whether a line crosses itself.

    Laps that lie in each other may be nearer than their elements bow.  Where chords of elements intersect, those of
    their parts, and of the parts of the elements beside them, decide.
    """
    a, b = line.points[:, :-1], line.points[:, 1:]
    found = np.argwhere(np.triu(_intersect(a[:, :, None], b[:, :, None], a[:, None], b[:, None])))
    if not found.size:
        return False
    around = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
    pairs = np.unique(np.clip((found[:, None] + around).reshape(-1, 2), 0, line.n - 1), axis=0)
    fine = line.at(np.arange(_PARTS * line.n + 1) / _PARTS)[0]
    i, j = (_PARTS * one[:, None] + np.arange(_PARTS) for one in pairs.T)
    ends = (fine[:, i, None], fine[:, i + 1, None], fine[:, j][:, :, None], fine[:, j + 1][:, :, None])
    return bool(_intersect(*ends).any())


def _intersect(a: Array, b: Array, c: Array, d: Array) -> Flags:
    """Whether ways from ``a`` to ``b`` and from ``c`` to ``d`` intersect in their insides, each (2, ...)."""
    return np.asarray((_turn(a, b, c) * _turn(a, b, d) < 0.0) & (_turn(c, d, a) * _turn(c, d, b) < 0.0))


def _turn(a: Array, b: Array, c: Array) -> Array:
    """Twice the signed area of the triangle a, b, c."""
    return np.asarray((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
