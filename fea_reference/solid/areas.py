"""The area of a beam: its neutral line and half the thickness on either side.

======  =====================================================================
symbol  meaning
======  =====================================================================
u       fraction of the neutral line's arc length, 0 at its start, 1 at its end
η       place across: 1 on the left of the line, −1 on its right
p, n    point of the line and its normal to the left
t       thickness
x       point of the area, p + η t/2 n
d, σ    distance from a held face, and a coordinate with equal increments per element
ℓ, δ    depth of the graded elements, and its share with the shortest elements
======  =====================================================================
"""

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import Beam, FreeEnd, Scene

_DEPTH = 1.5
_SHORTEST = 0.125
_MOST = 0.25  # of the length: largest depth


def points(beam: Beam, u: Array, eta: Array) -> Array:
    """x (k, 2), m, at places ``u`` and ``eta`` (k,)."""
    tangent = shape_of(beam.curve).tangent(u)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    half: Array = 0.5 * eta * beam.thickness_at(u)
    return np.asarray(shape_of(beam.curve).point(u) + half[:, None] * normal)


def fractions(beam: Beam, n: int) -> Array:
    """Element boundaries (n + 1,) along a beam: graded, with the nearest ones moved to the section's knots."""
    u = graded(beam, n)
    inner = np.arange(1, n)
    for knot in beam.knots[1:-1]:
        if inner.size:
            nearest = int(np.argmin(np.abs(u[inner] - knot)))
            u[inner[nearest]] = knot
            inner = np.delete(inner, nearest)
    return np.sort(u)


def graded(beam: Beam, n: int) -> Array:
    """Graded element boundaries (n + 1,): equal lengths except near held ends, where elements are shorter.

    The stress at the corners of a held face is unbounded. From a depth of ``_DEPTH`` thicknesses to the face the
    element length decreases linearly to the share ``_SHORTEST``: σ = ℓ log(1 + d/δ) has equal increments, where d is
    the distance from the face, ℓ the depth and δ its share. With twice as many elements every other boundary is
    unchanged.
    """
    length = shape_of(beam.curve).length
    ends = zip((beam.start, beam.end), beam.thickness_at(np.array([0.0, 1.0])), strict=True)
    depths = [0.0 if isinstance(end, FreeEnd) else min(_DEPTH * t / length, _MOST) for end, t in ends]
    extra = [depth * (-np.log(_SHORTEST) - 1.0 + _SHORTEST) for depth in depths]
    sigma = np.linspace(0.0, 1.0 + sum(extra), n + 1)
    u = sigma - extra[0]
    for depth, there in zip(depths, (sigma, sigma[::-1]), strict=True):
        near = there < -depth * np.log(_SHORTEST)
        if near.any():
            away = _SHORTEST * depth * np.expm1(there[near] / depth)
            u[near] = away if there is sigma else 1.0 - away
    u[0], u[-1] = 0.0, 1.0
    return np.asarray(u)


def too_curved(scene: Scene) -> list[Mistake]:
    """Mistakes for beams with a cusp of the edge, where half of the thickness exceeds the line's radius."""
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
