"""The area that a beam fills: its neutral line and half the thickness to either side.

======  =====================================================================
symbol  meaning
======  =====================================================================
u       fraction of the neutral line's arc length, 0 at its start, 1 at its end
η       place across: 1 on the left of the line, −1 on its right
p, n    point of the line and its normal to the left
t       thickness
x       point of the area, p + η t/2 n
d, σ    distance from a held face, and what grows evenly from element to element
ℓ, δ    depth in which elements are shorter, and the share of it where they are shortest
======  =====================================================================
"""

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import Beam, FreeEnd, Scene

_DEPTH = 1.5
_SHORTEST = 0.125
_MOST = 0.25  # of the length, that depth


def points(beam: Beam, u: Array, eta: Array) -> Array:
    """x (k, 2), m, at places ``u`` and ``eta`` (k,)."""
    tangent = shape_of(beam.curve).tangent(u)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    half: Array = 0.5 * eta * beam.thickness_at(u)
    return np.asarray(shape_of(beam.curve).point(u) + half[:, None] * normal)


def fractions(beam: Beam, n: int) -> Array:
    """Where ``n`` elements along a beam meet, (n + 1,): graded, and the nearest ones moved to the section's knots."""
    u = graded(beam, n)
    inner = np.arange(1, n)
    for knot in beam.knots[1:-1]:
        if inner.size:
            nearest = int(np.argmin(np.abs(u[inner] - knot)))
            u[inner[nearest]] = knot
            inner = np.delete(inner, nearest)
    return np.sort(u)


def graded(beam: Beam, n: int) -> Array:
    """Where ``n`` elements would meet, (n + 1,): even but for held ends, where they are short.

    At its corners the stress of a held face has no bound.  From a depth of ``_DEPTH`` thicknesses up to the face an
    element's length falls straight to ``_SHORTEST`` of what it is elsewhere: σ = ℓ log(1 + d/δ) grows by the same in
    each, with d from the face, ℓ the depth and δ that share of it.  Of twice as many every other place is the same.
    """
    length = shape_of(beam.curve).length
    ends = zip((beam.start, beam.end), beam.thickness_at(np.array([0.0, 1.0])), strict=True)
    depths = [0.0 if isinstance(end, FreeEnd) else min(_DEPTH * t / length, _MOST) for end, t in ends]
    more = [depth * (-np.log(_SHORTEST) - 1.0 + _SHORTEST) for depth in depths]
    sigma = np.linspace(0.0, 1.0 + sum(more), n + 1)
    u = sigma - more[0]
    for depth, there in zip(depths, (sigma, sigma[::-1]), strict=True):
        near = there < -depth * np.log(_SHORTEST)
        if near.any():
            away = _SHORTEST * depth * np.expm1(there[near] / depth)
            u[near] = away if there is sigma else 1.0 - away
    u[0], u[-1] = 0.0, 1.0
    return np.asarray(u)


def too_curved(scene: Scene) -> list[Mistake]:
    """Beams whose edge has a cusp because half of the thickness is more than the line's radius."""
    return [
        Mistake(
            f"beams.{name}.thickness",
            f"{beam.thickest:g}, more than twice the least radius of the neutral line",
            "for the solid, an edge without a cusp",
        )
        for name, beam in scene.beams.items()
        if 0.5 * beam.thickest * shape_of(beam.curve).largest_curvature >= 1.0
    ]


def longest(scene: Scene) -> float:
    """Arc length of the longest beam, m."""
    return max(shape_of(beam.curve).length for beam in scene.beams.values())
