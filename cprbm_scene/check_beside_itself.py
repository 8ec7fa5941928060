"""Beams whose edges meet across the way: rings that close to less than a thickness, splines that come back.

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
graph that turns so far moves along its axis by ∫ cos φ dφ/κ > 1.9 t.  A line has none either.  A spline may have them
anywhere: they are looked for among samples with Δs > 5 t, and refined.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from cprbm_scene.check_overlaps import OVERLAP
from cprbm_scene.check_shapes import is_beam
from cprbm_scene.geometry import Array, arc_angle, arc_length, closest_pair, distance, points_on
from cprbm_scene.mistakes import Mistake, written_place
from cprbm_scene.statement import Arc, Beam, Scene, Spline

NEIGHBOURS = 5.0  # thicknesses along the beam
_SAMPLES = 1501
_EVERY = 10  # of them are looked at first: mostly they tell that none is near another


def beside_themselves(scene: Scene) -> Iterator[Mistake]:
    """Beams that overlap themselves where they start."""
    for name, beam in scene.beams.items():
        if isinstance(beam.curve, Arc) and is_beam(beam) and abs(arc_angle(beam.curve)) > pi:
            mistake = _closed_ring(name, beam, beam.curve)
        elif isinstance(beam.curve, Spline) and is_beam(beam):
            mistake = _come_back(name, beam)
        else:
            continue
        if mistake is not None:
            yield mistake


def _closed_ring(name: str, beam: Beam, curve: Arc) -> Mistake | None:
    apart = distance(curve.start, curve.end)
    thickness = float(np.mean(beam.thickness_at(np.array([0.0, 1.0]))))
    if not thickness - apart > OVERLAP * thickness:
        return None
    return Mistake(
        f"beams.{name}.curve",
        f"a ring that overlaps itself: its ends are {apart:.3g} m apart, and they are {thickness:g} m thick",
        "ends of an arc that are at least its thickness apart",
    )


def _apart(u: Array, p: Array, half: Array, away: float) -> Array:
    """Distances (n, n) of places' edges, in lengths; infinite where ``u`` differ by less than ``away``."""
    x, y = p[:, None, 0] - p[:, 0], p[:, None, 1] - p[:, 1]
    apart = np.sqrt(x * x + y * y) - half[:, None] - half
    apart[u - u[:, None] < away] = np.inf
    return np.asarray(apart)


def _come_back(name: str, beam: Beam) -> Mistake | None:
    u = np.linspace(0.0, 1.0, _SAMPLES)
    p, half = points_on(beam.curve, u) / arc_length(beam.curve), 0.5 * beam.thickness_at(u) / arc_length(beam.curve)
    away = NEIGHBOURS * beam.thickest / arc_length(beam.curve)
    # of the samples left out none is farther from a kept one than half of their step, and so much nearer to others
    kept = slice(None, None, _EVERY)
    step = _EVERY / (_SAMPLES - 1)
    nearer = step + float(np.abs(np.diff(half)).max()) * _EVERY
    if _apart(u[kept], p[kept], half[kept], away - step).min() > nearer:
        return None
    apart = _apart(u, p, half, away)
    i, j = np.unravel_index(np.argmin(apart), apart.shape)
    if not np.isfinite(apart[i, j]):
        return None
    step = 2.0 / (_SAMPLES - 1)
    ranges = ((max(0.0, at - step), min(1.0, at + step)) for at in (float(u[i]), float(u[j])))
    nearest = closest_pair(beam.curve, beam.curve, *ranges)
    places = np.array([nearest.u1, nearest.u2])
    thickness = float(np.mean(beam.thickness_at(places)))
    if not thickness - nearest.distance > OVERLAP * thickness:
        return None
    x, y = points_on(beam.curve, places[:1])[0]
    return Mistake(
        f"beams.{name}.curve",
        f"a beam that overlaps itself: near {written_place((float(x), float(y)))} m it comes to "
        f"{nearest.distance:.3g} m from itself, and is {thickness:g} m thick",
        "a curve that keeps a thickness away from itself",
    )
