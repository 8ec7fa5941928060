"""Places on the smooth lines of two beams, found in the same calls.

A foot or a minimum is sought by places on both beams at once, and a call costs what it costs however few they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cprbm.excess import Tabulated
from cprbm.kinks import Missed, polynomials
from cprbm.model import Chain, Kinks
from cprbm.smooth import Points, SmoothLine, placed
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Made:
    """What two beams have in every state, the halves of the one's elements before those of the other's.

    Attributes:
        bent: coefficients of what is missed of the tangents, (4, 2N_A + 2N_B); None where there are no kinks.
        excess: by what they lie off their arcs; None where neither does.
        ends: their lengths.
    """

    bent: Array | None
    excess: Tabulated | None
    ends: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Both:
    """Two beams' lines in a state: what they ``made`` for every one, and their arcs (8, 2N_A + 2N_B)."""

    one: SmoothLine
    other: SmoothLine
    made: Made
    arcs: Array

    def at(self, s: Array, sigma: Array) -> tuple[Points, Points]:
        """Points at arc lengths ``s`` (k,) of the one and ``sigma`` (j,) of the other, bent as their kinks say."""
        made, k = self.made, s.size
        every, half = np.empty(k + sigma.size), np.empty(k + sigma.size, dtype=np.intp)
        np.minimum(s, made.ends[0], out=every[:k])
        np.minimum(sigma, made.ends[1], out=every[k:])
        np.maximum(every, 0.0, out=every)
        half[:k] = self.one.chain.breaks.searchsorted(every[:k], side="right")
        on_other = self.other.chain.breaks.searchsorted(every[k:], side="right")
        np.add(on_other, 2 * self.one.chain.n, out=half[k:])
        arcs = self.arcs.take(half, axis=1)
        off = every - arcs[0]
        at = placed(arcs, off, None if made.excess is None else made.excess.seen(half, off))
        psi, bend = at[2], at[4]
        if made.bent is not None:
            angle, bends = Missed(made.bent.take(half, axis=1), off).tangent
            psi, bend = psi + angle, bend + bends
        x, y, tangent, speed, _, gain = at
        found = np.array((every, off, x, y, tangent, psi, speed, bend, gain, speed))
        return Points(self.one, half[:k], *found[:, :k]), Points(self.other, on_other, *found[:, k:])


@lru_cache(maxsize=64)
def made(one: Chain, other: Chain, kinks: tuple[Kinks, ...]) -> Made | None:
    """Of two beams; None where a stress-free line has to be asked each time."""
    tables = []
    for chain in (one, other):
        if chain.excess is None:
            tables.append(Tabulated(np.zeros((2 * chain.n, 1, 6))))
        elif isinstance(chain.excess, Tabulated):
            tables.append(chain.excess)
        else:
            return None
    bent = None
    if any(each.places.size for each in kinks):
        bent = np.concatenate([polynomials(*each) for each in zip((one, other), kinks, strict=True)], axis=1)
    alike = one.excess is None and other.excess is None
    return Made(bent, None if alike else _joined(*tables), (float(one.s[-1]), float(other.s[-1])))


def _joined(one: Tabulated, other: Tabulated) -> Tabulated:
    """Halves of the one and then of the other, by polynomials with as many coefficients."""
    (first, its, _), (second, more, _) = one.coefficients.shape, other.coefficients.shape
    coefficients = np.zeros((first + second, max(its, more), 6))
    coefficients[:first, :its], coefficients[first:, :more] = one.coefficients, other.coefficients
    return Tabulated(coefficients)
