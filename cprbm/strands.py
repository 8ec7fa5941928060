"""Which parts of a beam face others further along it, and by which of their sides.

==========  ==================================================================================
s, σ        arc lengths of two places of one beam, s < σ; C, ψ, t, n its smooth line there
r           C(s) − C(σ)
Θ           ψ(σ) − ψ(s), the turning of the beam from the one to the other, counted through full turns
a           +1 where C(s) lies on the left of the beam at σ, −1 on the right: the sign of n(σ)·r
==========  ==================================================================================

Let r be normal to the beam at σ, and let it cross the beam nowhere.  Beam and r are then a closed curve without a
double point, whose turning, corners included, is ±2π (Hopf's Umlaufsatz).  The corner at σ turns by aπ/2, that at s
by an angle ω between −π and π:

    Θ + aπ/2 + ω = ±2π,    |ω| < π,    hence    π < |Θ + aπ/2| < 3π.

So nothing faces a place unless the beam has turned by more than π/2 between them, however long it is.  At
π/2 < |Θ| < 3π/2, the neck of a hairpin, a is the sign of Θ; at 5π/2 < |Θ| < 7π/2, the neck of a loop whose ends have
wound past each other, it is the opposite; farther on there is always something in between.  Only about 2π, in a coil,
may a be either, as the next lap lies inside or outside of the last: there it is what it was before the two met.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cprbm_scene.answer import Array, Flags, Ints

QUARTER = 0.5 * np.pi
NEAR = 0.1  # of the longest beam: places whose side is known tell that of others as close, along s and σ together
AT_ONCE = 512  # samples that are held against the others together: a table of all pairs has no room
LINKED = 8  # samples by which what faces a place may go on from one sample to the next


@dataclass(frozen=True, slots=True)
class Faces:
    """Places (k,) that face each other, and from which side: ``s``, ``sigma``, and ``side``, a."""

    s: Array
    sigma: Array
    side: Array

    def know(self, s: Array, sigma: Array) -> tuple[Flags, Array]:
        """Whether places near by are known (k,), and a of the nearest (k,)."""
        if not self.s.size:
            return np.zeros(len(s), dtype=bool), np.zeros(len(s))
        nearest = np.zeros(len(s), dtype=np.intp)
        for first in range(0, len(s), AT_ONCE):
            some = slice(first, first + AT_ONCE)
            away = np.abs(s[some, None] - self.s) + np.abs(sigma[some, None] - self.sigma)
            nearest[some] = np.argmin(away, axis=1)
        away = np.abs(s - self.s[nearest]) + np.abs(sigma - self.sigma[nearest])
        return np.asarray(away <= NEAR), self.side[nearest]

    def of(self, s: Array, sigma: Array, seen: Array, *, crossed: bool) -> Array:
        """a at other places (k,): that of the nearest known, or as ``seen`` where none is near and nothing ``crossed``.

        Args:
            s, sigma: the places.
            seen: sign of n(σ)·r (k,).
            crossed: whether the line crosses itself, so that what is seen need not be true.
        """
        if not self.s.size:
            return seen
        near, side = self.know(s, sigma)
        return np.where(near | crossed, side, seen)

    def joined(self, s: float, sigma: float, side: float) -> Faces:
        """With one place more."""
        return Faces(np.append(self.s, s), np.append(self.sigma, sigma), np.append(self.side, side))


NO_FACES = Faces(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True, slots=True)
class Strand:
    """A part of a beam that faces another, sample by sample.

    Attributes:
        side: a.
        turns: Θ/π to the nearest whole number.
        D: a·n·r from the samples (2N+3,), infinite where they are no part of it.
        sigma: σ of the samples (2N+3,).
    """

    side: float
    turns: int
    D: Array
    sigma: Array

    @property
    def across(self) -> float:
        """+1 where C(σ) lies on the left of the beam at s: of strands that run the same way the other side."""
        return -self.side if self.turns % 2 == 0 else self.side


def turned_enough(turn: Array) -> Flags:
    """Whether places between which the beam turns by ``turn`` may face each other."""
    size = np.abs(turn)
    return np.asarray((size > QUARTER) & (size < 7.0 * QUARTER))


def in_coil(turn: Array) -> Flags:
    """Whether ``turn`` leaves open on which side what faces a place lies."""
    return np.asarray(np.abs(np.abs(turn) - 4.0 * QUARTER) <= QUARTER)


def sides(turn: Array) -> Array:
    """a of places between which the beam turns by ``turn``, where that tells."""
    return np.asarray(np.where(np.abs(turn) < 3.0 * QUARTER, 1.0, -1.0) * np.sign(turn))


def facing_samples(x: Array, y: Array) -> tuple[Ints, Ints]:
    """Samples (k,) and those further along (k,) to which the distance is less than to their neighbours.

    Args:
        x, y: places of three samples or more (m,).
    """
    last = len(x) - 1
    here, there = [], []
    for first in range(0, last - 1, AT_ONCE):
        i = np.arange(first, min(first + AT_ONCE, last - 1))[:, None]
        # from the first of them on; what lies before is no part of the answer
        d = (x[i] - x[first:]) ** 2 + (y[i] - y[first:]) ** 2
        low = np.zeros(d.shape, dtype=bool)
        low[:, 1:-1] = (d[:, 1:-1] <= d[:, :-2]) & (d[:, 1:-1] < d[:, 2:])
        if first == 0:
            # where the start faces the last half of an element the end is closest, of the samples
            low[0, -1] = d[0, -1] <= d[0, -2]
        of, to = np.nonzero(np.triu(low, 2))
        here.append(first + of)
        there.append(first + to)
    return np.concatenate(here), np.concatenate(there)


def strands(s: Array, here: Ints, sigma: Array, distance: Array, turn: Array, side: Array) -> tuple[Strand, ...]:
    """Places that face others, one behind the other.

    Args:
        s: arc lengths of the samples (2N+3,).
        here: sample of each place (k,), ascending.
        sigma, distance, turn, side: σ, n·r, Θ and a (k,).
    """
    samples = len(s)
    found: list[list[int]] = []
    open_: list[list[int]] = []
    place = np.interp(sigma, s, np.arange(samples))
    begins = np.searchsorted(here, np.arange(samples + 1)).tolist()
    for first, last in pairwise(begins):
        going = []
        for k in range(first, last):
            away = [abs(place[strand[-1]] - place[k]) if side[strand[-1]] == side[k] else np.inf for strand in open_]
            nearest = int(np.argmin(away)) if away else -1
            if away and away[nearest] <= LINKED:
                strand = open_.pop(nearest)
                strand.append(k)
            else:
                strand = [k]
                found.append(strand)
            going.append(strand)
        open_ = going
    return tuple(_strand(samples, here[k], sigma[k], side[k] * distance[k], turn[k], float(side[k[0]])) for k in found)


def _strand(samples: int, here: Ints, sigma: Array, D: Array, turn: Array, side: float) -> Strand:
    along, feet = np.full(samples, np.inf), np.zeros(samples)
    along[here], feet[here] = D, sigma
    return Strand(side, round(float(turn[np.argmin(D)] / np.pi)), along, feet)
