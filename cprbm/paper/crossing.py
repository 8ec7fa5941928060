"""Beams that pass through a contact where no related joint holds them.

Joints of a zone dip by a part of h², and joints beyond the related range are free.  An overlap of more than half the
mean thickness anywhere means that the beams have crossed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.chain import Mechanism
from cprbm.contact import Geometry, fixed_places, near_pairs, new_counters, settle, sides_at_rest
from cprbm.equilibrium.newton import Solved
from cprbm_scene.answer import Array

OVERLAP = 0.5
"""Allowed overlap over the mean thickness, of lines over the longest beam."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """All joints of the beams in contact: ``geometry``, and the ``sides`` as drawn."""

    geometry: Geometry
    sides: Array

    def found(self, solved: Solved) -> str:
        """Sentence on a contact whose beams have crossed; empty without any."""
        z, counters = solved.state.z, new_counters()
        arrays, pairs = self.geometry.arrays, self.geometry.columns
        near = near_pairs(z, arrays, pairs, np.zeros(len(pairs)), counters)
        places = fixed_places(self.geometry, z, self.sides, near, counters)
        gaps = np.empty(len(places.pair))
        settle(z, arrays, places, gaps, np.empty(len(gaps)), counters, 0)
        thickness = (
            arrays.thickness[places.piece] + arrays.thickness[places.foot] * (arrays.last > arrays.first)[places.other]
        )
        overlap = -gaps / np.where(thickness > 0.0, thickness, 1.0)
        if not len(overlap) or overlap.max() <= OVERLAP:
            return ""
        name = self.geometry.pairs[int(places.pair[np.argmax(overlap)])].name
        return f"in contact '{name}' the beams overlap by {overlap.max():.1e} of the mean thickness, allowed {OVERLAP}"


def crossings_of(m: Mechanism, geometry: Geometry) -> Crossings:
    """Crossings of the contacts of a mechanism with all rows, and the geometry of all joints."""
    z = np.concatenate([m.rest, np.zeros(len(m.rows))])
    return Crossings(geometry, sides_at_rest(geometry, z, new_counters()))
