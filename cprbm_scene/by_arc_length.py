"""Places on a line by its arc length: what its speed integrates to, and the inverse of that.

=======  =====================================================================================
symbol   meaning
=======  =====================================================================================
w        variable of the line, ascending
S(w)     arc length, S' the speed
u        fraction of the arc length
=======  =====================================================================================

S is a sum of Gauss–Legendre integrals over panels of w, halved until no end's arc length moves any more; u is inverted
by Newton's method from the panel's ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

Array = NDArray[np.float64]
Speed = Callable[[Array], Array]
_NODES, _WEIGHTS = leggauss(12)
_MOST_PANELS = 1 << 16
_SETTLED = 1e-14  # of the length
_NEWTON_STEPS = 30
_CLOSE = 1e-10  # a Newton step of this part of the range leaves nothing for a further one
_KNOWN = 24  # answers: who looks at one line at many stations asks for the same fractions again and again


@dataclass(frozen=True, slots=True)
class ByArcLength:
    """The ``speed`` S', and the ends ``w`` of the panels (p+1,) with ``S`` there (p+1,), from zero.

    ``known`` are the last answers by the fractions asked for, the latest last.
    """

    speed: Speed
    w: Array
    S: Array
    known: dict[bytes, Array] = field(default_factory=dict, repr=False, compare=False)

    @property
    def whole(self) -> float:
        """S at the end."""
        return float(self.S[-1])

    def places(self, u: Array) -> Array:
        """w (n,) at fractions ``u`` (n,) of the arc length, read-only; beyond the ends the end itself."""
        asked = np.asarray(u, dtype=np.float64).tobytes()
        found = self.known.pop(asked, None)
        if found is None:
            found = self._inverted(u)
            found.flags.writeable = False
            if len(self.known) >= _KNOWN:
                self.known.pop(next(iter(self.known)), None)
        self.known[asked] = found
        return found

    def _inverted(self, u: Array) -> Array:
        S = np.clip(u, 0.0, 1.0) * self.S[-1]
        panel = np.clip(np.searchsorted(self.S, S, side="right") - 1, 0, len(self.w) - 2)
        from_w, to_w, missing = self.w[panel], self.w[panel + 1], S - self.S[panel]
        w = from_w + (to_w - from_w) * missing / (self.S[panel + 1] - self.S[panel])
        for _ in range(_NEWTON_STEPS):
            half = 0.5 * (w - from_w)
            integral = self.speed(from_w[:, None] + half[:, None] * (1.0 + _NODES)) @ _WEIGHTS * half
            step = (missing - integral) / self.speed(w)
            w = np.clip(w + step, from_w, to_w)
            if np.max(np.abs(step), initial=0.0) <= _CLOSE * (self.w[-1] - self.w[0]):
                break
        return np.asarray(w)


def by_arc_length(speed: Speed, first: Array) -> ByArcLength:
    """Integrate a ``speed``, which takes arrays of any shape, over panels that begin with those between ``first``."""
    w, S = first, _sums(speed, first)
    while len(w) <= _MOST_PANELS:
        halved = np.empty(2 * len(w) - 1)
        halved[::2], halved[1::2] = w, 0.5 * (w[1:] + w[:-1])
        before, w, S = S, halved, _sums(speed, halved)
        if np.max(np.abs(S[::2] - before)) <= _SETTLED * S[-1]:
            break
    return ByArcLength(speed, w, S)


def _sums(speed: Speed, w: Array) -> Array:
    """S at the ends of panels."""
    half = 0.5 * np.diff(w)
    parts = speed(w[:-1, None] + half[:, None] * (1.0 + _NODES)) @ _WEIGHTS * half
    return np.concatenate(([0.0], np.cumsum(parts)))
