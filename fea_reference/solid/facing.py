"""Gap between a point and an edge of a beam, and its derivatives by the nodes.

======  ==================================================================
symbol  meaning
======  ==================================================================
x       the point, on the edge that carries the integral
y(ζ)    the other edge; ζ its closest place to x
n, τ    normal of y out of its beam, unit tangent
g       gap, (x − y)·n: negative where x lies inside
a       δx − δy, relative motion of both sides of a place
J, k    |y'| and n·y''
A       J² − g k: positive at a closest place
======  ==================================================================

δg = a·n and δζ = (J a·τ + g n·δy')/A, so

    δ²g = −[k (a·τ)² + 2 J (a·τ)(n·δy') + g (n·δy')²]/A

(Wriggers, Computational Contact Mechanics, 2nd ed., section 4.1, reduced to one parameter).
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cprbm_scene.answer import Array, Flags, Ints
from fea_reference.solid.skin import Skin

_ITERATIONS = 12
_ARRIVED = 1e-12  # nodes: last Newton step
_OPPOSED = -0.2  # cosine between both outward normals: a larger one belongs to the wrong side


@dataclass(frozen=True, slots=True)
class Gaps:
    """g, ζ and ``faced`` of k points, the latter True where a closest place is opposite to the point."""

    gap: Array
    zeta: Array
    faced: Flags


@dataclass(frozen=True, slots=True)
class Own:
    """Points of the same beam: fractions ``u`` (k,) of the arc length, and the ``way`` of the search.

    ``way`` is −1 for earlier partners and 1 for later ones.
    """

    u: Array
    way: int


def gaps(skin: Skin, x: Array, points: Array, normals: Array, reach: float, own: Own | None = None) -> Gaps:
    """Gaps of ``points`` (k, 2) with outward ``normals`` (k, 2) from an edge with nodes ``x`` (N, 2).

    The search covers distances up to ``reach`` and depths up to half of the thickness. Places of the points' ``own``
    beam are excluded by direction next to a point, and by their depth of a thickness across from the point.
    """
    node, near = nearest(skin, x, points, normals, reach, own)
    gap, zeta, faced = np.full(len(points), np.inf), np.zeros(len(points)), np.zeros(len(points), dtype=bool)
    if not near.any():
        return Gaps(gap, zeta, faced)
    p, last = points[near], float(skin.nodes.size - 1)
    place = node[near].astype(float)
    for _ in range(_ITERATIONS):
        y, slope, bend = skin.curve(x, place)
        d = p - y
        square = (slope**2).sum(axis=1)
        curvature = np.maximum(square - (d * bend).sum(axis=1), 0.2 * square)
        step = np.clip((d * slope).sum(axis=1) / curvature, -1.0, 1.0)
        moved = np.clip(place + step, 0.0, last)
        done = np.abs(moved - place).max() < _ARRIVED
        place = moved
        if done:
            break
    y, slope, _ = skin.curve(x, place)
    n = skin.outward(slope)
    d = p - y
    lateral = (d * n).sum(axis=1)
    beside = np.abs((d * slope).sum(axis=1)) / (slope**2).sum(axis=1)
    facing = (beside < 1e-6) & ((n * normals[near]).sum(axis=1) < _OPPOSED) & (lateral > -0.5 * skin.thickness)
    gap[near] = np.where(facing, lateral, np.inf)
    zeta[near], faced[near] = place, facing
    return Gaps(gap, zeta, faced)


def nearest(skin: Skin, x: Array, points: Array, normals: Array, reach: float, own: Own | None) -> tuple[Ints, Flags]:
    """Nearest node (k,) as initial guess of the closest place, and True (k,) where any node is near."""
    if own is None:
        distance, node = cKDTree(x).query(points, distance_upper_bound=reach)
        return node, np.isfinite(distance)
    n = skin.outward(skin.curve(x, np.arange(float(skin.nodes.size)))[1])
    away = points[:, None] - x
    distance = np.hypot(away[..., 0], away[..., 1])
    meets = (normals @ n.T < _OPPOSED) & ((away * n).sum(axis=2) > -0.5 * skin.thickness) & (distance < reach)
    meets &= own.way * (skin.u - own.u[:, None]) > 0.0
    distance = np.where(meets, distance, np.inf)
    return distance.argmin(axis=1), meets.any(axis=1)


def variations(skin: Skin, x: Array, points: Array, shapes: Array, zeta: Array) -> tuple[Array, Array, Array]:
    """g (k,), ∂g (k, 28) and ∂²g (k, 28, 28) at ζ.

    The 28 unknowns are (x, y) of the seven nodes of the point, with shape functions ``shapes`` (k, 7), and of the
    edge.
    """
    _, N, N1, _ = skin.shapes(zeta)
    y, slope, bend = skin.curve(x, zeta)
    n = skin.outward(slope)
    J = np.hypot(*slope.T)
    tangent = slope / J[:, None]
    g = ((points - y) * n).sum(axis=1)
    k = (n * bend).sum(axis=1)
    both = np.concatenate([shapes, -N], axis=1)
    slopes = np.concatenate([np.zeros_like(shapes), N1], axis=1)

    def along(values: Array, direction: Array) -> Array:
        return np.asarray((values[:, :, None] * direction[:, None, :]).reshape(len(values), 2 * values.shape[1]))

    first, beside, leaning = along(both, n), along(both, tangent), along(slopes, n)
    A = J**2 - g * k

    def product(left: Array, right: Array, factor: Array) -> Array:
        return np.asarray(factor[:, None, None] * left[:, :, None] * right[:, None, :])

    cross = product(beside, leaning, J / A)
    second = -(product(beside, beside, k / A) + cross + cross.transpose(0, 2, 1) + product(leaning, leaning, g / A))
    return g, first, second
