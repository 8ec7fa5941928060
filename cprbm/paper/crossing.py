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
"""Allowed overlap over the mean thickness, of two lines over the longest beam."""

THINNEST = 1e-3
"""Least thickness, over the longest beam, by which an overlap with a rigid shape is measured."""

SAG = 0.25
"""Distance of a beam from the chord, over the link's length and the turn of the joint: twice the sag of an arc."""


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
        rigid, angles = self.geometry.ends.rigid[places.other], z[solved.system.angles]
        before = solved.system.joints.before
        sag = SAG * float(solved.system.metric.max() * np.abs(angles[before + 1] - angles[before]).max())
        thickness = arrays.thickness[places.piece] + arrays.thickness[places.foot] * ~rigid
        least = np.where(rigid, THINNEST, np.where(thickness > 0.0, 0.0, 1.0))
        overlap = (-gaps - sag) / np.maximum(thickness, least)
        if not len(overlap) or overlap.max() <= OVERLAP:
            return ""
        name = self.geometry.pairs[int(places.pair[np.argmax(overlap)])].name
        return f"in contact '{name}' the beams overlap by {overlap.max():.1e} of the mean thickness, allowed {OVERLAP}"


def crossings_of(m: Mechanism, geometry: Geometry) -> Crossings:
    """Crossings of the contacts of a mechanism with all rows, and the geometry of all joints."""
    z = np.concatenate([m.rest, np.zeros(len(m.rows))])
    return Crossings(geometry, sides_at_rest(geometry, z, new_counters()))
