"""A rigid corner against the smooth edge of a beam: the gap and its derivatives by the edge and the corner's body.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
x       the corner; r its arm from the body's centre, X and φ the body's motion
y(ζ)    the edge; ζ its closest place to x
n, τ    normal of y out of its beam, unit tangent
g       gap, (x − y)·n
a       δx − δy, with δx = δX + S R r δφ
J, k, A |y'|, n·y'', J² − g k
======  ==========================================================================

As for two edges (:mod:`fea_reference.solid.facing`), plus the term of the corner's circular motion:

    δ²g = −[k (a·τ)² + 2 J (a·τ)(n·δy') + g (n·δy')²]/A − n·R r δφ²
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid import facing
from fea_reference.solid.bodies import BodyPart, across, turned
from fea_reference.solid.edges import Corner
from fea_reference.solid.skin import STENCIL, Skin


def place(corner: Corner, body: BodyPart, z: Array) -> tuple[Array, Array]:
    """Position (1, 2) and direction (1, 2) of a corner."""
    phi = float(body.state(z)[2])
    return body.carried(corner.point, z)[None], turned(corner.normal, phi)[None]


def gap(corner: Corner, body: BodyPart, skin: Skin, y: Array, reach: float, z: Array) -> tuple[float, float]:
    """g, infinite without an opposite place within ``reach`` on an edge with nodes ``y`` (N, 2), and ζ."""
    x, normal = place(corner, body, z)
    gaps = facing.gaps(skin, y, x, normal, reach)
    return float(gaps.gap[0]), float(gaps.zeta[0])


def variations(corner: Corner, body: BodyPart, skin: Skin, y: Array, zeta: Array, z: Array) -> tuple[Array, Array]:
    """∂g (1, 17) and ∂²g (1, 17, 17) at ζ (1,); the 17 are (x, y) of the edge's seven nodes there, and (X, Y, φ)."""
    x, _ = place(corner, body, z)
    _, N, N1, _ = skin.shapes(zeta)
    point, slope, bend = (vectors[0] for vectors in skin.curve(y, zeta))
    n = skin.outward(slope[None])[0]
    J = float(np.hypot(*slope))
    tangent = slope / J
    g, k = float((x[0] - point) @ n), float(n @ bend)
    arm = turned(corner.point, float(body.state(z)[2]))
    moved = np.concatenate([np.eye(2), across(arm)[:, None]], axis=1)  # δx by (X, Y, φ)

    def along(direction: Array) -> Array:
        return np.concatenate([np.outer(-N[0], direction).ravel(), direction @ moved])

    first, beside = along(n), along(tangent)
    leaning = np.concatenate([np.outer(N1[0], n).ravel(), np.zeros(3)])
    A = J**2 - g * k
    mixed = J * np.outer(beside, leaning)
    second = -(k * np.outer(beside, beside) + mixed + mixed.T + g * np.outer(leaning, leaning)) / A
    second[2 * STENCIL + 2, 2 * STENCIL + 2] -= n @ arm
    return first[None], second[None]
