"""A neutral line that is a polynomial, y = f(x) or x = f(y), by fractions of its arc length.

=======  =============================================================================
symbol   meaning
=======  =============================================================================
v        the variable, from the range's first value to its last, m
S(v)     arc length, m, S' = √(1 + f'²)
t        place within a piece of the range, in [−1, 1]
T_k      Chebyshev polynomials
=======  =============================================================================

S' is Σ c_k T_k(t) on pieces of the range, which are cut in two until the last of the coefficients vanish; its
integral is another such sum.  The place at a fraction of the length is the root of S in its piece, by Newton's
method kept within the piece.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial as Power
from numpy.polynomial import chebyshev

from scene.answer import Array
from scene.statement import Polynomial

DEGREE = 24  # of the sum on one piece
TAIL = 4  # coefficients that must have vanished
VANISHED = 3e-14  # of the largest; what is left out behind them is smaller still
SMALLEST = 2.0**-10  # of the range: no piece is cut below
ITERATIONS = 50
POINTS = chebyshev.chebpts1(DEGREE + 1)
VALUES = chebyshev.chebvander(POINTS, DEGREE)  # T_k at the points at which the sum is S'


@dataclass(frozen=True, slots=True)
class _Piece:
    """``begin`` and ``half`` the width (both of v, signed) and S from ``begin`` as a sum of T_k (``series``)."""

    begin: float
    half: float
    series: Array

    @property
    def length(self) -> float:
        return float(chebyshev.chebval(1.0, self.series))


def length(curve: Polynomial) -> float:
    """Arc length, m."""
    return math.fsum(piece.length for piece in _pieces(curve))


def sample(curve: Polynomial, fractions: Array) -> tuple[Array, Array]:
    """Positions (n, 2) in m and tangent angles (n,) in rad, continuous, at ``fractions`` (n,) of the arc length."""
    pieces = _pieces(curve)
    sums = np.concatenate(([0.0], np.cumsum([piece.length for piece in pieces])))
    wanted = fractions * sums[-1]
    owner = np.clip(np.searchsorted(sums, wanted, side="right") - 1, 0, len(pieces) - 1)
    f = Power(curve.coefficients)
    v = np.empty_like(wanted)
    for i in np.unique(owner):
        v[owner == i] = _root(f.deriv(), pieces[i], wanted[owner == i] - sums[i])
    value, slope = f(v), np.arctan(f.deriv()(v))
    backwards = curve.range[1] < curve.range[0]
    if curve.axis == "x":
        return np.stack([v, value], axis=1), slope + (math.pi if backwards else 0.0)
    return np.stack([value, v], axis=1), (-0.5 if backwards else 0.5) * math.pi - slope


def _pieces(curve: Polynomial) -> list[_Piece]:
    """The range in pieces on each of which the sum holds S' to round-off, in order."""
    first, last = curve.range
    slope = Power(curve.coefficients).deriv()
    done: list[_Piece] = []
    open_ = [(first, 0.5 * (last - first))]
    while open_:
        begin, half = open_.pop()
        c = np.linalg.solve(VALUES, _speed(POINTS, slope, begin, half))
        cut = abs(half) > SMALLEST * abs(last - first)
        if cut and np.max(np.abs(c[-TAIL:])) > VANISHED * np.max(np.abs(c)):
            open_ += [(begin + half, 0.5 * half), (begin, 0.5 * half)]
        else:
            series = np.asarray(chebyshev.chebint(abs(half) * c, lbnd=-1.0), dtype=np.float64)
            done.append(_Piece(begin, half, series))
    return done


def _speed(t: Array, slope: Power, begin: float, half: float) -> Array:
    """S' at places t of a piece."""
    return np.asarray(np.hypot(1.0, slope(begin + half * (t + 1.0))))


def _root(slope: Power, piece: _Piece, lengths: Array) -> Array:
    """v at ``lengths`` (n,) from the piece's beginning."""
    t = 2.0 * lengths / piece.length - 1.0
    for _ in range(ITERATIONS):
        missing = lengths - chebyshev.chebval(t, piece.series)
        step = missing / (abs(piece.half) * _speed(t, slope, piece.begin, piece.half))
        t, before = np.clip(t + step, -1.0, 1.0), t
        if np.max(np.abs(t - before)) <= 1e-9:  # squared, it is below round-off
            break
    return np.asarray(piece.begin + piece.half * (t + 1.0))
