"""Beams of unit length and EI that bend a little, pressed onto frictionless points: closed form.

==========  ==============================================================================
g(x, ξ)     deflection at x of a cantilever clamped at 0 under a unit force at ξ: a²(3 b − a)/6, a the lesser of both
w₀          deflection under the load alone
f ≥ 0       forces of the points on the beam, along ``sides`` (±1); gaps·f = 0
==========  ==============================================================================

A tip that is held has a force (and a moment) more, by which its deflection (and slope) vanishes.  What presses follows
from the linear complementarity problem: the beam's energy is least, as a problem of least squares with f ≥ 0.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

ROUND_OFF = 1e-12


def deflection(x, at):
    """g(x, at), of arrays."""
    low, high = np.minimum(x, at), np.maximum(x, at)
    return low**2 * (3.0 * high - low) / 6.0


@dataclass(frozen=True)
class Pressed:
    """A beam clamped at its start, its ``tip`` free, pinned or clamped (there it may go along itself).

    ``force`` acts at ``at`` across the beam, ``moment`` on its tip.
    """

    tip: str = "free"
    force: float = 0.0
    at: float = 1.0
    moment: float = 0.0

    def compliance(self, places):
        """Deflections of the load (k + 1,) at ``places`` (k,) and the tip, and of unit forces there (k + 1, k + 1)."""
        p = np.append(places, 1.0)
        unit, loaded = deflection(p[:, None], p), self.force * deflection(p, self.at) + self.moment * p**2 / 2.0
        if self.tip == "free":
            return loaded, unit
        both = 2 if self.tip == "clamped" else 1
        held = np.array([deflection(p, 1.0), p**2 / 2.0])[:both]
        own = np.array([[1.0 / 3.0, 1.0 / 2.0], [1.0 / 2.0, 1.0]])[:both, :both]
        by_load = np.array(
            [
                self.force * deflection(1.0, self.at) + self.moment / 2.0,
                self.force * self.at**2 / 2.0 + self.moment,
            ]
        )[:both]
        return loaded - held.T @ np.linalg.solve(own, by_load), unit - held.T @ np.linalg.solve(own, held)

    def onto(self, places, gaps, sides):
        """Forces of points at ``places`` (k,), as far from the beam as ``gaps`` (k,), and the tip's deflection."""
        loaded, unit = self.compliance(places)
        lam, vectors = np.linalg.eigh(sides[:, None] * unit[:-1, :-1] * sides)
        root = np.sqrt(np.maximum(lam, ROUND_OFF * lam[-1]))
        target = vectors.T @ -(sides * loaded[:-1] + gaps) / root
        forces, _ = nnls(root[:, None] * vectors.T, target, maxiter=500 * len(places))
        return forces, float(loaded[-1] + unit[-1, :-1] @ (sides * forces))
