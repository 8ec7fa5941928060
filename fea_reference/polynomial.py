"""A polynomial neutral line, y = f(x) or x = f(y), by fractions of its arc length.

=======  =============================================================================
symbol   meaning
=======  =============================================================================
v        the variable, from the range's first value to the last, m
S(v)     arc length, m, S' = √(1 + f'²), :mod:`fea_reference.pieces`
=======  =============================================================================
"""

import math

import numpy as np
from numpy.polynomial import Polynomial as Power

from cprbm_scene.answer import Array
from cprbm_scene.statement import Polynomial
from fea_reference.pieces import Speed, pieces_of, places, total


def length(curve: Polynomial) -> float:
    """Arc length, m."""
    return total(pieces_of(_speed(curve), curve.range))


def sample(curve: Polynomial, fractions: Array) -> tuple[Array, Array]:
    """Positions (n, 2) in m and tangent angles (n,) in rad, continuous, at ``fractions`` (n,) of the arc length."""
    speed, f = _speed(curve), Power(curve.coefficients)
    v = places(speed, pieces_of(speed, curve.range), fractions)
    value, slope = f(v), np.arctan(f.deriv()(v))
    backwards = curve.range[1] < curve.range[0]
    if curve.axis == "x":
        return np.stack([v, value], axis=1), slope + (math.pi if backwards else 0.0)
    return np.stack([value, v], axis=1), (-0.5 if backwards else 0.5) * math.pi - slope


def _speed(curve: Polynomial) -> Speed:
    """S'."""
    slope = Power(curve.coefficients).deriv()
    return lambda v: np.asarray(np.hypot(1.0, slope(v)))
