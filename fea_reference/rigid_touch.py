"""Contact of a beam with a rigid body, evaluated at the Gauss points of the zones: derivatives of the gap.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, r    point of the neutral line, and the point measured from the body's reference centre
X, φ    displacement and rotation of the body
n, b    gradient of the distance from the body, and its second derivative along τ;  τ is n turned clockwise
k ×     a vector turned counter-clockwise
======  =====================================================================================

With the relative motion of the point against the body, δu = δx − δX − δφ k × r,

    δg = n·δu,     δ²g = n·δ²x − 2 δφ n·k × (δx − δX) − n·r δφ² + b (τ·δu)².
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import TypeVar

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import CircleContact, EdgeContact
from fea_reference.edge import Edge, edge_of
from fea_reference.hermite import (
    Index,
    NeutralLine,
    as_plane,
    projected_gradient,
    projected_hessian,
    shapes,
)
from fea_reference.model import Model
from fea_reference.state import State
from fea_reference.touch import Penalty, Places, Rigid, Touch, count_points_per_place
from fea_reference.zones import Zones

LAYERS = 32.0
"""Layers per beam length, for the first penalty."""

_RESOLVED = 3.0  # layers per element: their error is of second order in the layer's width
# Layers per beam length at the standard penetration: their error is below 1e-7, while thinner layers amplify the
# round-off of a clamp's place. Penetration goes with the fourth power of the layer, so that a smaller requested
# penetration has thinner layers.
_THINNEST, _STANDARD = 800.0, 1e-4
C = TypeVar("C", CircleContact, EdgeContact)


def on_bodies(
    model: Model, contacts: Mapping[str, C], penetration: float
) -> Iterator[tuple[str, C, int, int, Edge, float, float]]:
    """Name, record, numbers of beam and body, edge, element's length and stiffest penalty of ``contacts`` with bodies.

    The ``penetration`` is the requested one of the settings.
    """
    thinnest = _THINNEST * (_STANDARD / penetration) ** 0.25
    beams, bodies = [beam.name for beam in model.beams], [body.name for body in model.bodies]
    for name, contact in contacts.items():
        first, body = beams.index(contact.beam), bodies.index(contact.body)
        beam = model.beams[first]
        edge = edge_of(beam.record, beam.elements.stop - beam.elements.start, model.units.length, thick=contact.thick)
        h = float(model.elements.length[beam.elements.start])
        yield name, contact, first, body, edge, h, beam.softest / max(h / _RESOLVED, beam.length / thinnest) ** 4


def rigid_touch(
    model: Model,
    pair: Rigid,
    penalty: Penalty,
    quadrature: int,
    z: State,
    zones: Zones,
    places: Places,
    surface: tuple[Array, Array, Array, Array],
) -> Touch:
    """The contact at ``places`` of :func:`fea_reference.touch.gauss_places`.

    ``surface`` are the gap (k,), n (2, k), b (k,), and the distance (k,) of the line from the body.
    """
    beam, body, (zeta, there, ds) = model.beams[pair.first], model.bodies[pair.body], places
    g, n, bend, distance = surface
    line, e, moves = model.line(beam, z), there.element, body.dofs is not None
    H, x = shapes(zeta - e), as_plane(line.nodes[e] + there.way)
    r = x - (body.centre + model.body_state(body, z)[:2])[:, None]

    def by_twice() -> Array:
        p = by_motions(np.array([n[1], -n[0]]), H, line, e, r, moves=moves)
        g_qq = (bend * p)[:, None] * p
        g_qq[:7, :7] += projected_hessian(n, H, line, e)
        if moves:
            across = np.array([-n[1], n[0]])  # across·w = −n·k × w
            turning = np.concatenate([projected_gradient(across, H, line, e), -across])
            g_qq[:9, 9] += turning
            g_qq[9, :9] += turning
            g_qq[9, 9] -= (n * r).sum(axis=0)
        return np.asarray(g_qq)

    points_per_place = count_points_per_place(quadrature, e)
    return Touch(
        pair=pair,
        zones=zones,
        chain=model.chain(((beam, e[::points_per_place]),), z, body.dofs),
        points_per_place=points_per_place,
        stiffness=penalty.stiffness * ds,
        gap=g - penalty.lead,
        gap_by=cache(lambda: by_motions(n, H, line, e, r, moves=moves)),
        gap_by_twice=cache(by_twice),
        zeta=zeta,
        zeta_m=np.empty(0),
        x=x,
        x_m=x - distance * n,
        normal=n,
    )


def by_motions(v: Array, H: Array, line: NeutralLine, e: Index, r: Array, *, moves: bool) -> Array:
    """Derivatives of v·δu (m, k) by the line's element, and by the body's three unknowns if it ``moves``."""
    own = projected_gradient(v, H, line, e)
    return np.concatenate([own, -v, -(v[1] * r[0] - v[0] * r[1])[None]]) if moves else own
