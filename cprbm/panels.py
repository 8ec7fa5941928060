"""Arc length along a line that is known by a variable, and the variable by arc length.

======  ==========================================================================
v       the variable, ascending along the line
s(v)    arc length, ds/dv the speed
======  ==========================================================================

ds/dv is integrated over panels of v by Gauss's rule, which are halved until their ends' arc lengths settle, and on
until the cubics through the panels' ends with the slopes there are v(s).  If they never are, v(s) is Newton's, which
begins there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints

ABSCISSAE, WEIGHTS = (0.5 * part for part in np.polynomial.legendre.leggauss(8))  # on [−½, ½]
MOST_PANELS = 1 << 15
SETTLED = 1e-14  # of the length: eight points err by 2⁻¹⁶ of this after a further halving
NEWTON_ITERATIONS = 20
CLOSE = 1e-9  # of the length: a step whose square is nothing


@dataclass(frozen=True, slots=True)
class Panels:
    """Ends ``v`` of the panels, arc length ``s`` and ``slope`` dv/ds there, and the ``speed`` ds/dv at any places.

    ``fine`` says whether the cubics through the ends are v(s).
    """

    v: Array
    s: Array
    slope: Array
    speed: Callable[[Array], Array]
    fine: bool

    @property
    def length(self) -> float:
        """s at the end."""
        return float(self.s[-1])

    def inverted(self, s: Array) -> Array:
        """v(s) (k,); beyond the ends the end itself."""
        s = np.minimum(np.maximum(s, 0.0), self.length)
        panel = np.minimum(self.s.searchsorted(s, side="right") - 1, len(self.v) - 2)
        v = self._cubic(panel, s)
        if self.fine:
            return v
        v0, v1, s0 = self.v[panel], self.v[panel + 1], self.s[panel]
        for _ in range(NEWTON_ITERATIONS):
            v = np.minimum(np.maximum(v, v0), v1)
            step = (s - s0 - _arc(self.speed, v0, v)) / self.speed(v)
            v = v + step
            if np.max(np.abs(step), initial=0.0) <= CLOSE * self.length:
                break
        return np.asarray(v)

    def _cubic(self, panel: Ints, s: Array) -> Array:
        v0, s0 = self.v[panel], self.s[panel]
        rise, size = self.v[panel + 1] - v0, self.s[panel + 1] - s0
        t, d0, d1 = (s - s0) / size, size * self.slope[panel], size * self.slope[panel + 1]
        return np.asarray(v0 + t * (d0 + t * (3.0 * rise - 2.0 * d0 - d1 + t * (d0 + d1 - 2.0 * rise))))


def panelled(speed: Callable[[Array], Array], ends: Array) -> Panels:
    """Panels that begin with those between ``ends`` and are halved until they are enough."""
    found, times = Panels(ends, _summed(speed, ends), 1.0 / speed(ends), speed, fine=False), 1
    while len(found.v) <= MOST_PANELS and not found.fine:
        v = found.v
        for _ in range(times):
            v = _halved(v)
        s, each = _summed(speed, v), 1 << times
        middle = each // 2
        off = np.max(np.abs(found._cubic(np.arange(len(found.v) - 1), s[middle::each]) - v[middle::each]))
        least = SETTLED * (v[-1] - v[0])
        summed = np.max(np.abs(s[::each] - found.s)) <= SETTLED * s[-1]
        found = Panels(v, s, 1.0 / speed(v), speed, fine=bool(summed and off <= least))
        # cubics err by the fourth power of a panel's size: so many halvings are wanted at least, of which some are done
        times = max(1, int(0.25 * math.log2(max(off / least, 1.0))) - times)
    return found


def _halved(v: Array) -> Array:
    finer = np.empty(2 * len(v) - 1)
    finer[::2], finer[1::2] = v, 0.5 * (v[1:] + v[:-1])
    return finer


def _summed(speed: Callable[[Array], Array], v: Array) -> Array:
    return np.concatenate(([0.0], np.cumsum(_arc(speed, v[:-1], v[1:]))))


def _arc(speed: Callable[[Array], Array], v0: Array, v1: Array) -> Array:
    """Arc lengths (k,) between places v (k,) of one panel."""
    points = 0.5 * (v0 + v1)[:, None] + (v1 - v0)[:, None] * ABSCISSAE
    return np.asarray((v1 - v0) * (speed(points) @ WEIGHTS))
