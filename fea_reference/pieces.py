"""Arc length of a line by its parameter, as piecewise Chebyshev sums, and the inverse function.

=======  =============================================================================
symbol   meaning
=======  =============================================================================
v        the parameter, from the line's first value to the last
S(v)     arc length, m, |S'| the speed
t        place within a piece, in [−1, 1]
T_k      Chebyshev polynomials
=======  =============================================================================

S' is Σ c_k T_k(t) on pieces, halved until the last coefficients vanish; the integral is another such sum. The
parameter at a given length is the root of S in its piece, by Newton's method limited to the piece.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from cprbm_scene.answer import Array

DEGREE = 24  # of the sum on a piece
TAIL = 4  # number of last coefficients that have to vanish
VANISHED = 3e-14  # times the largest coefficient; the truncation error is smaller still
SMALLEST = 2.0**-10  # times the distance of two given ends: smallest piece
ITERATIONS = 50
POINTS = chebyshev.chebpts1(DEGREE + 1)
VALUES = chebyshev.chebvander(POINTS, DEGREE)  # T_k at the collocation points of S'

Speed = Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece: ``begin`` and ``half`` width (of v, signed), and S from ``begin`` as a sum of T_k (``series``)."""

    begin: float
    half: float
    series: Array

    @property
    def length(self) -> float:
        """S over the piece."""
        return float(chebyshev.chebval(1.0, self.series))


def pieces_of(speed: Speed, ends: Sequence[float]) -> list[Piece]:
    """Pieces between given ``ends``, in order, whose sums represent the ``speed`` to round-off."""
    done: list[Piece] = []
    for first, last in pairwise(ends):
        open_ = [(first, 0.5 * (last - first))]
        while open_:
            begin, half = open_.pop()
            c = np.linalg.solve(VALUES, speed(begin + half * (POINTS + 1.0)))
            cut = abs(half) > SMALLEST * abs(last - first)
            if cut and np.max(np.abs(c[-TAIL:])) > VANISHED * np.max(np.abs(c)):
                open_ += [(begin + half, 0.5 * half), (begin, 0.5 * half)]
            else:
                series = np.asarray(chebyshev.chebint(abs(half) * c, lbnd=-1.0), dtype=np.float64)
                done.append(Piece(begin, half, series))
    return done


def total(pieces: Sequence[Piece]) -> float:
    """Arc length of all pieces."""
    return math.fsum(piece.length for piece in pieces)


def places(speed: Speed, pieces: Sequence[Piece], fractions: Array) -> Array:
    """v at ``fractions`` (n,) of the arc length."""
    sums = np.concatenate(([0.0], np.cumsum([piece.length for piece in pieces])))
    wanted = fractions * sums[-1]
    owner = np.clip(np.searchsorted(sums, wanted, side="right") - 1, 0, len(pieces) - 1)
    v = np.empty_like(wanted)
    for i in np.unique(owner):
        v[owner == i] = _root(speed, pieces[i], wanted[owner == i] - sums[i])
    return np.asarray(v)


def _root(speed: Speed, piece: Piece, lengths: Array) -> Array:
    """v at ``lengths`` (n,) from the beginning of the piece."""
    t = 2.0 * lengths / piece.length - 1.0
    for _ in range(ITERATIONS):
        missing = lengths - chebyshev.chebval(t, piece.series)
        step = missing / (abs(piece.half) * speed(piece.begin + piece.half * (t + 1.0)))
        t, before = np.clip(t + step, -1.0, 1.0), t
        if np.max(np.abs(t - before)) <= 1e-9:  # the square is below round-off
            break
    return np.asarray(piece.begin + piece.half * (t + 1.0))
