"""Do two neutral lines cross?"""

from __future__ import annotations

import numpy as np

from fea_reference.hermite import NeutralLine
from scene.answer import Array


def cross(first: NeutralLine, second: NeutralLine) -> bool:
    """Whether any two chords of the lines' elements intersect in their insides."""
    a, b = first.points[:, :-1, None], first.points[:, 1:, None]
    c, d = second.points[:, None, :-1], second.points[:, None, 1:]
    return bool(((_turn(a, b, c) * _turn(a, b, d) < 0.0) & (_turn(c, d, a) * _turn(c, d, b) < 0.0)).any())


def _turn(a: Array, b: Array, c: Array) -> Array:
    """Twice the signed area of the triangle a, b, c."""
    return np.asarray((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
