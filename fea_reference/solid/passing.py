"""Check for a beam that passed through an opposite body between two equilibria.

Neither end of a long step may show an overlap. For a circle, an edge must not sweep over the centre, in the frame of
the circle's body. Before that the closest place of the edge faces the centre and shows an overlap; a beam that lies
on the centre shows none on either edge. For a corner the neutral line is checked, which is sufficient for a point.
For two beams the neutral lines must not cross, at the end or on the straight way: a beam that passed through
another's end may lie free on the wrong side. A half-plane needs no check.
"""

from collections.abc import Iterable

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid.edges import Corner
from fea_reference.solid.model import Model
from fea_reference.solid.pairs import Pair
from fea_reference.solid.rigid import Round, in_body_frame
from fea_reference.solid.skin import Skin

_LOOKS = 16


def contact_passed_through(model: Model, pairs: Iterable[Pair], before: Array, after: Array) -> str:
    """Name of the contact that a beam passed through between unknowns ``before`` and ``after``; empty if none."""
    places = [model.mesh.places + model.displacements(z).reshape(-1, 2) for z in (before, after)]
    looked_at = set()
    for pair in pairs:
        eta = pair.skin.side if isinstance(pair.other, Round) else 0.0
        own = model.mesh.line(pair.skin.beam, eta)
        if isinstance(pair.other, Skin):
            both = pair.skin.beam, pair.other.beam
            other = model.mesh.line(pair.other.beam, 0.0)
            if both not in looked_at and lines_cross_on_way(*(x[line] for line in (own, other) for x in places)):
                return pair.name
            looked_at.add(both)
        elif isinstance(pair.other, Round | Corner):
            body = model.bodies[pair.body]
            a, b = (in_body_frame(body, x[own], z) for x, z in zip(places, (before, after), strict=True))
            if sweeps_over(a, b, pair.other.centre if isinstance(pair.other, Round) else pair.other.point):
                return pair.name
    return ""


def sweeps_over(a: Array, b: Array, point: Array) -> bool:
    """True if a line through points (n, 2), moving straight from ``a`` to ``b``, sweeps over ``point`` (2,)."""
    return bool(_within(a[:-1], a[1:], b[:-1], point).any() or _within(a[1:], b[1:], b[:-1], point).any())


def _within(p: Array, q: Array, r: Array, point: Array) -> Array:
    """True (k,) for triangles (k, 2) that contain the point."""
    sides = np.stack([_side(p, q, point), _side(q, r, point), _side(r, p, point)])
    return np.asarray((sides > 0.0).all(axis=0) | (sides < 0.0).all(axis=0))


def _side(p: Array, q: Array, r: Array) -> Array:
    """Positive where ``r`` is on the left of the line from ``p`` to ``q``, (..., 2) all."""
    return np.asarray(
        (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])
    )


def lines_cross_on_way(a: Array, b: Array, c: Array, d: Array) -> bool:
    """True if lines cross while moving straight from ``a`` to ``b`` (n, 2) and from ``c`` to ``d`` (m, 2)."""
    shares = np.linspace(0.0, 1.0, _LOOKS + 1)[1:]
    return any(lines_cross(a + share * (b - a), c + share * (d - c)) for share in shares)


def lines_cross(first_line: Array, second_line: Array) -> bool:
    """True if two lines through points (n, 2) and (m, 2) cross."""
    a, b = first_line[:-1, None], first_line[1:, None]
    c, d = second_line[None, :-1], second_line[None, 1:]
    apart = (_side(a, b, c) * _side(a, b, d) < 0.0) & (_side(c, d, a) * _side(c, d, b) < 0.0)
    return bool(apart.any())
