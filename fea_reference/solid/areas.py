"""The area that a beam fills: its neutral line and half the thickness to either side.

======  =====================================================================
symbol  meaning
======  =====================================================================
u       fraction of the neutral line's arc length, 0 at its start, 1 at its end
η       place across: 1 on the left of the line, −1 on its right
p, n    point of the line and its normal to the left
t       thickness
x       point of the area, p + η t/2 n
======  =====================================================================
"""

from __future__ import annotations

import numpy as np

from scene.answer import Array
from scene.geometry import arc_length, largest_curvature, points_on, tangents_on
from scene.mistakes import Mistake
from scene.statement import Beam, Scene


def points(beam: Beam, u: Array, eta: Array) -> Array:
    """x (k, 2), m, at places ``u`` and ``eta`` (k,)."""
    tangent = tangents_on(beam.curve, u)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    half: Array = 0.5 * eta * beam.thickness_at(u)
    return np.asarray(points_on(beam.curve, u) + half[:, None] * normal)


def fractions(beam: Beam, n: int) -> Array:
    """Where ``n`` elements along a beam meet, (n + 1,): even, and the nearest ones moved to the section's knots."""
    u = np.linspace(0.0, 1.0, n + 1)
    inner = np.arange(1, n)
    for knot in beam.knots[1:-1]:
        if inner.size:
            nearest = int(np.argmin(np.abs(u[inner] - knot)))
            u[inner[nearest]] = knot
            inner = np.delete(inner, nearest)
    return np.sort(u)


def too_curved(scene: Scene) -> list[Mistake]:
    """Beams whose edge has a cusp because half of the thickness is more than the line's radius."""
    return [
        Mistake(
            f"beams.{name}.thickness",
            f"{beam.thickest:g}, more than twice the least radius of the neutral line",
            "for the solid, an edge without a cusp",
        )
        for name, beam in scene.beams.items()
        if 0.5 * beam.thickest * largest_curvature(beam.curve) >= 1.0
    ]


def longest(scene: Scene) -> float:
    """Arc length of the longest beam, m."""
    return max(arc_length(beam.curve) for beam in scene.beams.values())
