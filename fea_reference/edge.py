"""Distance of a beam's edge from its neutral line, along the beam.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
ζ       place on the beam: element number plus ξ in [0, 1] within the element
T       half of the thickness, zero for a line, linear between the section's knots
======  =====================================================================================
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Beam

_EVEN = 1e-9  # times the largest slope: negligible jump


@dataclass(frozen=True)
class Edge:
    """``half`` (k,) is T at the ``knots`` (k,), places ζ from the beam's start to its end; dimensionless."""

    knots: tuple[float, ...]
    half: tuple[float, ...]

    @property
    def inner(self) -> tuple[float, ...]:
        """The knots between the first and the last."""
        return self.knots[1:-1]

    @cached_property
    def nearest(self) -> float:
        """The least T."""
        return min(self.half)

    @cached_property
    def farthest(self) -> float:
        """The largest T."""
        return max(self.half)

    @cached_property
    def varies(self) -> bool:
        """True if T varies."""
        return self.nearest < self.farthest

    @cached_property
    def corners(self) -> tuple[Array, Array, Array]:
        """Inner knots (c,) with a jump of ∂T/∂ζ, and ∂T/∂ζ before and behind."""
        places, _, slopes = self._table
        jumps = np.abs(np.diff(slopes)) > _EVEN * np.abs(slopes).max()
        return places[1:-1][jumps], slopes[:-1][jumps], slopes[1:][jumps]

    def at(self, zeta: Array) -> Array:
        """T at places ``zeta`` (k,)."""
        if not self.varies:
            return np.full(zeta.shape, self.nearest)
        places, half, _ = self._table
        return np.asarray(np.interp(zeta, places, half))

    def slope(self, zeta: Array) -> Array:
        """∂T/∂ζ at places ``zeta`` (k,); at a knot the value behind."""
        if not self.varies:
            return np.zeros(zeta.shape)
        places, _, slopes = self._table
        return np.asarray(slopes[np.searchsorted(places[1:-1], zeta, side="right")])

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Knots and their T (k,), and ∂T/∂ζ between knots (k−1,)."""
        places, half = np.array(self.knots), np.array(self.half)
        return places, half, np.diff(half) / np.diff(places)


def edge_of(beam: Beam, elements: int, unit_length: float, *, thick: bool) -> Edge:
    """The edge of a ``thick`` beam with equal ``elements``; of other beams the neutral line."""
    half = 0.5 * beam.thickness_at(beam.knots) / unit_length if thick else np.zeros_like(beam.knots)
    # rounded, so that a knot at a node coincides with the node
    return Edge(tuple(np.round(beam.knots * elements, 9).tolist()), tuple(half.tolist()))
