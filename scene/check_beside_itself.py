"""Beams whose edges meet across the way: rings that close to less than a thickness.

======  ====================================================================
symbol  meaning
======  ====================================================================
t       thickness, m; of a ring whose thickness varies, the mean at its ends
s       arc length, m; Δs between two places of one neutral line
d       distance of these places in the plane, m
κ       curvature, 1/m; t κ < 1 is asked of every beam
φ       tangent angle against the axis of a graph
======  ====================================================================

By Schur's comparison theorem d ≥ (2/κ) sin(κ Δs/2) for Δs ≤ 2π/κ with the largest κ.  With t κ < 1, places of d < t
are therefore either neighbours, with Δs ≤ 1.05 d, or have Δs > 5 t.

Of an arc the second kind's nearest places are its ends.  A polynomial has none: the way between them keeps within a
strip of width d < t along the axis, and with Δs > 5 t its tangents spread by more than 2 arccos(1/5), 157°.  But a
graph that turns so far moves along its axis by ∫ cos φ dφ/κ > 1.9 t.  A line has none either.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from scene.check_overlaps import OVERLAP
from scene.check_shapes import is_beam
from scene.geometry import arc_angle, distance
from scene.mistakes import Mistake
from scene.statement import Arc, Scene


def beside_themselves(scene: Scene) -> Iterator[Mistake]:
    """Beams that overlap themselves where they start."""
    for name, beam in scene.beams.items():
        curve = beam.curve
        if not (isinstance(curve, Arc) and is_beam(beam) and abs(arc_angle(curve)) > pi):
            continue
        apart = distance(curve.start, curve.end)
        thickness = float(np.mean(beam.thickness_at(np.array([0.0, 1.0]))))
        if thickness - apart > OVERLAP * thickness:
            yield Mistake(
                f"beams.{name}.curve",
                f"a ring that overlaps itself: its ends are {apart:.3g} m apart, and they are {thickness:g} m thick",
                "ends of an arc that are at least its thickness apart",
            )
