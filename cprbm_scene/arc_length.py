"""Arc length of a curve with a given speed, and places at given fractions of the arc length.

=======  =========================================
symbol   meaning
=======  =========================================
w        parameter of the curve, from 0 to 1
S(w)     arc length from w = 0, with S' the speed
u        fraction of the arc length
=======  =========================================

S is a sum of Gauss–Legendre integrals over panels of w.  Panels are halved until S at the panels' ends is stationary.
Newton's method, started by linear interpolation in a panel, inverts u = S(w)/S(1).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

Array = NDArray[np.float64]
_NODES, _WEIGHTS = leggauss(12)
_MOST_PANELS = 1 << 16
_SETTLED = 1e-14
"""Largest change of S by a halving of all panels, a fraction of the length: a few units of round-off."""
_NEWTON_STEPS = 30
_CLOSE = 1e-10
"""Newton step at which the iteration ends: the next step, by quadratic convergence, is below round-off."""
_REMEMBERED = 24
"""Arrays of fractions with stored places: a solver asks for the same fractions at many stations."""


class ArcLength:
    """Arc length S(w) of a curve with the ``speed`` S', from panels between ``first`` (p+1,), ascending from 0 to 1."""

    def __init__(self, speed: Callable[[Array], Array], first: Array) -> None:
        self._speed, self._w, self._S = speed, first, _sums(speed, first)
        while len(self._w) <= _MOST_PANELS:
            before, self._w = self._S, np.sort(np.append(self._w, 0.5 * (self._w[1:] + self._w[:-1])))
            self._S = _sums(speed, self._w)
            if np.max(np.abs(self._S[::2] - before)) <= _SETTLED * self._S[-1]:
                break
        self.whole = float(self._S[-1])
        self._places = lru_cache(maxsize=_REMEMBERED)(self._inverted)

    def places(self, u: Array) -> Array:
        """Parameters w (n,), read-only, at fractions ``u`` (n,), which are clipped to [0, 1]."""
        return self._places(np.asarray(u, dtype=np.float64).tobytes())

    def _inverted(self, fractions: bytes) -> Array:
        S = np.clip(np.frombuffer(fractions), 0.0, 1.0) * self.whole
        panel = np.clip(np.searchsorted(self._S, S, side="right") - 1, 0, len(self._w) - 2)
        low, high, missing = self._w[panel], self._w[panel + 1], S - self._S[panel]
        w = low + (high - low) * missing / (self._S[panel + 1] - self._S[panel])
        for _ in range(_NEWTON_STEPS):
            step = (missing - _integral(self._speed, low, w)) / self._speed(w)
            w = np.clip(w + step, low, high)
            if np.max(np.abs(step), initial=0.0) <= _CLOSE:
                break
        w.flags.writeable = False
        return w


def _integral(speed: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Gauss–Legendre integrals (n,) of the speed from ``low`` (n,) to ``high`` (n,)."""
    half = 0.5 * (high - low)
    return np.asarray(speed(low[:, None] + half[:, None] * (1.0 + _NODES)) @ _WEIGHTS * half)


def _sums(speed: Callable[[Array], Array], w: Array) -> Array:
    """S at the ends ``w`` (p+1,) of the panels."""
    return np.concatenate(([0.0], np.cumsum(_integral(speed, w[:-1], w[1:]))))
