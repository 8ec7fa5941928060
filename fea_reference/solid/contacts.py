"""Evaluation of contacts in a state: gaps, forces and stiffness.

======  ===============================================================================
symbol  meaning
======  ===============================================================================
g       gap at a point of the edge that carries the integral
ε       penalty, pressure per depth; ρ its factor on E/h of the softer side
p       pressure, ε max(−g, 0)
w, ds   width, and undeformed length of the edge
======  ===============================================================================

The energy is ½ ∫ ε w g² ds over the places with g < 0; force and tangent are its derivatives. A convex rigid corner
presses in a point of the edge, with ε over an element's length. The corner of a beam's end does the same, joined or
free. Without the latter only a wedge of the edge would support the end, whose size varies with the depth.

During Newton's iterations the part ε w g ∂²g of the tangent uses the g predicted by the last step. The excessive
pressure of an edge that has gone too deep then does not affect the stability. A corner with a predicted force stays
active for an iteration even without overlap, or the active set would cycle.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Ints
from fea_reference.solid import facing, pricking, rigid
from fea_reference.solid.bodies import turned
from fea_reference.solid.edges import Broken, Corner, Graph
from fea_reference.solid.model import Model
from fea_reference.solid.pairs import CornerOnEdge, CornerOnShape, Pair
from fea_reference.solid.rigid import Shape
from fea_reference.solid.skin import STENCIL, Skin
from fea_reference.solid.zones import NOWHERE, Gap, Zones, least, zones

_REACH = 1.0  # thicknesses, plus a few nodes: range of the gap search
_FLAT = -0.9  # cosine between normals of a beam and a rigid side: a larger angle belongs to a corner


PredictedGap = tuple[Array, Array]
"""Places ζ (k,), ascending, and the predicted g ≤ 0 (k,) there."""


@dataclass(frozen=True, slots=True)
class Touch:
    """A pair in a state.

    Attributes:
        pair: the pair.
        zones: zones of overlap.
        zeta: ζ of the points (k,).
        facing: ζ of the opposite places on the other edge (k,); empty for a rigid body.
        points: positions (k, 2).
        push: contact forces on the first edge (k, 2).
        dofs: numbers (k, 28 or 17) among the mesh's q, followed by three unknowns of every body.
        gradient: derivative of the energy by these (k, 28 or 17).
        hessian: second derivative (k, 28 or 17, 28 or 17).
        gap: g of the points (k,), and the derivative ``slope`` (k, 28 or 17).
        energy: of the penalty.
    """

    pair: Pair
    zones: Zones
    zeta: Array
    facing: Array
    points: Array
    push: Array
    dofs: Ints
    gradient: Array
    hessian: Array
    gap: Array
    slope: Array
    energy: float

    def predicted_gap(self, step: Array) -> PredictedGap:
        """Gaps after a ``step`` of the numbered unknowns, to first order."""
        return self.zeta, np.minimum(self.gap + (self.slope * step[self.dofs]).sum(axis=1), 0.0)

    @property
    def penetration(self) -> float:
        """The largest penetration."""
        return max(0.0, -self.zones.least)


def touch(
    model: Model, pair: Pair, factor: float, quadrature: int, q: Array, z: Array, predicted: PredictedGap | None = None
) -> Touch:
    """Evaluation of a pair in a state.

    Args:
        model: the mechanism.
        pair: the pair.
        factor: ρ of the penalty.
        quadrature: Gauss points on every part of a zone.
        q: displacements (2N,).
        z: unknowns.
        predicted: predicted gap for the second part of the tangent; None for the state's own.
    """
    places = model.mesh.places + q.reshape(-1, 2)
    skin, other = pair.skin, pair.other
    if isinstance(other, Corner):
        return _corner_on_edge(model, pair, other, factor, places, z, predicted)
    if isinstance(other, CornerOnEdge):
        return _end_corner_on_edge(model, pair, other, factor, places, predicted)
    if isinstance(other, CornerOnShape):
        return _end_corner_on_shape(model, pair, other, factor, places, z, predicted)
    x = places[skin.nodes]
    zones_found = overlap(model, pair, places, z)
    zeta, weights = zones_found.points(quadrature)
    nodes, N, _, _ = skin.shapes(zeta)
    here = (N[:, None] @ x[nodes])[:, 0]
    _, stretch, _ = skin.curve(skin.places, zeta)
    ds = np.hypot(*stretch.T) * weights * skin.at(skin.width, zeta)
    own = skin.nodes[nodes]
    dofs = np.stack([2 * own, 2 * own + 1], axis=2).reshape(-1, 2 * STENCIL)
    if isinstance(other, Skin):
        outward = skin.outward(skin.curve(x, zeta)[1])
        there = facing.gaps(other, places[other.nodes], here, outward, np.inf, _own_places(pair, zeta))
        opposite = there.zeta
        g, first, second = facing.variations(other, places[other.nodes], here, N, opposite)
        g = np.where(there.faced, g, 0.0)
        faced = other.nodes[other.shapes(opposite)[0]]
        dofs = np.concatenate([dofs, np.stack([2 * faced, 2 * faced + 1], axis=2).reshape(-1, 2 * STENCIL)], axis=1)
        softer = np.minimum(skin.at(skin.stiffness, zeta), other.at(other.stiffness, opposite))
    else:
        opposite = np.empty(0)
        g, first, second = rigid.variations(other, model.bodies[pair.body], here, N, z)
        moved = 2 * len(places) + 3 * pair.body + np.arange(3)
        dofs = np.concatenate([dofs, np.broadcast_to(moved, (len(dofs), 3))], axis=1)
        softer = skin.at(skin.stiffness, zeta)
    g = np.minimum(g, 0.0)
    bent = g
    if predicted is not None:
        bent = np.interp(zeta, *predicted, left=0.0, right=0.0) if predicted[0].size else np.zeros_like(g)
    penalty = factor * softer * ds
    gradient = (penalty * g)[:, None] * first
    hessian = penalty[:, None, None] * (first[:, :, None] * first[:, None, :] + bent[:, None, None] * second)
    push = -gradient[:, : 2 * STENCIL].reshape(-1, STENCIL, 2).sum(axis=1)
    energy = 0.5 * float((penalty * g**2).sum())
    return Touch(pair, zones_found, zeta, opposite, here, push, dofs, gradient, hessian, g, first, energy)


def _corner_on_edge(
    model: Model, pair: Pair, corner: Corner, factor: float, places: Array, z: Array, predicted: PredictedGap | None
) -> Touch:
    """Evaluation of a rigid corner against an edge, with the nodes at ``places`` (N, 2)."""
    skin, body = pair.skin, model.bodies[pair.body]
    y = places[skin.nodes]
    zones_found = overlap(model, pair, places, z)
    if not _is_active(zones_found.least, predicted):
        return _no_contact(pair, zones_found)
    zeta = np.array([zones_found.place])
    first, second = pricking.variations(corner, body, skin, y, zeta, z)
    g = np.array([zones_found.least])
    bent = g if predicted is None else np.array([predicted[1].min(initial=0.0)])
    own = skin.nodes[skin.shapes(zeta)[0]]
    moved = 2 * len(places) + 3 * pair.body + np.arange(3)
    dofs = np.concatenate([np.stack([2 * own, 2 * own + 1], axis=2).reshape(1, -1), moved[None]], axis=1)
    penalty = factor * _point_stiffness(skin, zeta)
    gradient = (penalty * g)[:, None] * first
    hessian = penalty[:, None, None] * (first[:, :, None] * first[:, None, :] + bent[:, None, None] * second)
    push = -gradient[:, : 2 * STENCIL].reshape(-1, STENCIL, 2).sum(axis=1)
    here, _ = pricking.place(corner, body, z)
    energy = 0.5 * float((penalty * g**2).sum())
    return Touch(pair, zones_found, zeta, np.empty(0), here, push, dofs, gradient, hessian, g, first, energy)


def _end_corner_on_edge(
    model: Model, pair: Pair, tip: CornerOnEdge, factor: float, places: Array, predicted: PredictedGap | None
) -> Touch:
    """Evaluation of an end's corner against an edge, with the nodes at ``places`` (N, 2)."""
    pointed, pressed = tip.roles(pair)
    g_least, zeta = _end_corner_gap(pair, tip, places)
    own, y = _place_of(tip, pointed), places[pressed.nodes]
    at = np.array([own if tip.own else zeta])
    zones_found = _in_one_place(g_least, float(at[0]))
    if not _is_active(g_least, predicted):
        return _no_contact(pair, zones_found)
    there = np.array([zeta])
    numbers, N, _, _ = pointed.shapes(np.array([own]))
    here = (N[:, None] @ places[pointed.nodes][numbers])[:, 0]
    g, first, second = facing.variations(pressed, y, here, N, there)
    bent = g if predicted is None else np.array([predicted[1].min(initial=0.0)])
    both = np.concatenate([pointed.nodes[numbers], pressed.nodes[pressed.shapes(there)[0]]], axis=1)
    dofs = np.stack([2 * both, 2 * both + 1], axis=2).reshape(1, -1)
    penalty = factor * np.minimum(_point_stiffness(pressed, there), _point_stiffness(pointed, np.array([own])))
    gradient = (penalty * g)[:, None] * first
    hessian = penalty[:, None, None] * (first[:, :, None] * first[:, None, :] + bent[:, None, None] * second)
    on_corner = -gradient[:, : 2 * STENCIL].reshape(-1, STENCIL, 2).sum(axis=1)
    push = on_corner if tip.own else -on_corner
    energy = 0.5 * float((penalty * g**2).sum())
    opposite = there if tip.own else np.array([own])
    return Touch(pair, zones_found, at, opposite, here, push, dofs, gradient, hessian, g, first, energy)


def _end_corner_on_shape(
    model: Model,
    pair: Pair,
    butt: CornerOnShape,
    factor: float,
    places: Array,
    z: Array,
    predicted: PredictedGap | None,
) -> Touch:
    """Evaluation of an end's corner against a rigid shape, with the nodes at ``places`` (N, 2)."""
    skin, body = pair.skin, model.bodies[pair.body]
    g_least, at = _end_corner_gap_to_shape(model, pair, butt, places, z)
    zones_found = _in_one_place(g_least, at)
    if not _is_active(g_least, predicted):
        return _no_contact(pair, zones_found)
    there = np.array([at])
    numbers, N, _, _ = skin.shapes(there)
    own = skin.nodes[numbers]
    here = (N[:, None] @ places[own])[:, 0]
    g, first, second = rigid.variations(butt.shape, body, here, N, z)
    bent = g if predicted is None else np.array([predicted[1].min(initial=0.0)])
    moved = 2 * len(places) + 3 * pair.body + np.arange(3)
    dofs = np.concatenate([np.stack([2 * own, 2 * own + 1], axis=2).reshape(1, -1), moved[None]], axis=1)
    penalty = factor * _point_stiffness(skin, there)
    gradient = (penalty * g)[:, None] * first
    hessian = penalty[:, None, None] * (first[:, :, None] * first[:, None, :] + bent[:, None, None] * second)
    push = -gradient[:, : 2 * STENCIL].reshape(-1, STENCIL, 2).sum(axis=1)
    energy = 0.5 * float((penalty * g**2).sum())
    return Touch(pair, zones_found, there, np.empty(0), here, push, dofs, gradient, hessian, g, first, energy)


def _is_active(g: float, predicted: PredictedGap | None) -> bool:
    """True if a corner is active in this iteration: overlapping, or near with a predicted force."""
    return g < 0.0 or (np.isfinite(g) and predicted is not None and bool((predicted[1] < 0.0).any()))


def _no_contact(pair: Pair, zones_found: Zones) -> Touch:
    """A corner without contact."""
    none, n = np.empty(0), 2 * STENCIL
    rows, points, dofs = np.empty((0, n)), np.empty((0, 2)), np.empty((0, n), dtype=np.intp)
    return Touch(pair, zones_found, none, none, points, points, dofs, rows, np.empty((0, n, n)), none, rows, 0.0)


def _point_stiffness(skin: Skin, zeta: Array) -> Array:
    """ε w times an element's length, (k,)."""
    element = 2.0 * np.hypot(*skin.curve(skin.places, zeta)[1].T)
    return np.asarray(skin.at(skin.stiffness, zeta) * skin.at(skin.width, zeta) * element)


def _place_of(tip: CornerOnEdge, pointed: Skin) -> float:
    return pointed.nodes.size - 1.0 if tip.last else 0.0


def _edges_near(pair: Pair, other: Skin, x: Array, y: Array, reach: float) -> bool:
    """True if any node of one edge of a beam, at ``x`` (N, 2), is near the other edge, at ``y`` (N, 2)."""
    nodes = np.arange(float(pair.skin.nodes.size))
    outward = pair.skin.outward(pair.skin.curve(x, nodes)[1])
    return bool(facing.nearest(other, y, x, outward, reach, _own_places(pair, nodes))[1].any())


def _in_one_place(g: float, at: float) -> Zones:
    return Zones(np.full((2, 1 if g < 0.0 else 0), at), g, at)


def _own_places(pair: Pair, zeta: Array) -> facing.Own | None:
    """Places along the beam of points ζ (k,) of an edge in self-contact; None otherwise."""
    return None if pair.way == 0 else facing.Own(pair.skin.at(pair.skin.u, zeta), pair.way)


def _end_corner_gap_to_shape(
    model: Model, pair: Pair, butt: CornerOnShape, places: Array, z: Array
) -> tuple[float, float]:
    """g of an end's corner, infinite if no side is opposite, and its ζ."""
    at = pair.skin.nodes.size - 1 if butt.last else 0
    there = rigid.in_body_frame(model.bodies[pair.body], places[pair.skin.nodes[[at]]], z)
    return float(butt.shape.measured(there)[0][0]), float(at)


def _end_corner_gap(pair: Pair, tip: CornerOnEdge, places: Array) -> tuple[float, float]:
    """g of an end's corner, infinite if no place is opposite, and ζ of the other edge."""
    pointed, pressed = tip.roles(pair)
    at = np.array([_place_of(tip, pointed)])
    here, slope, _ = pointed.curve(places[pointed.nodes], at)
    out = pointed.outward(slope) + (1.0 if tip.last else -1.0) * slope / np.hypot(*slope.T)[:, None]
    y = places[pressed.nodes]
    reach = _REACH * pressed.thickness + float(np.hypot(*np.diff(y, axis=0).T).max())
    gaps = facing.gaps(pressed, y, here, out / np.sqrt(2.0), reach, _own_places(pair, at))
    return float(gaps.gap[0]), float(gaps.zeta[0])


def overlap(model: Model, pair: Pair, places: Array, z: Array) -> Zones:
    """Zones of overlap of a pair, with the nodes at ``places`` (N, 2)."""
    if isinstance(pair.other, Corner):
        return _in_one_place(*_corner_gap(model, pair, pair.other, places, z))
    assert not isinstance(pair.other, CornerOnEdge | CornerOnShape)  # tips and butts have no extent
    gap = _gap(model, pair, pair.other, places, z)
    return NOWHERE if gap is None else zones(gap, pair.skin.nodes.size)


def least_gap(model: Model, pair: Pair, places: Array, z: Array) -> float:
    """The least gap of a pair, with the nodes at ``places`` (N, 2)."""
    if isinstance(pair.other, Corner):
        return _corner_gap(model, pair, pair.other, places, z)[0]
    if isinstance(pair.other, CornerOnEdge):
        return _end_corner_gap(pair, pair.other, places)[0]
    if isinstance(pair.other, CornerOnShape):
        return _end_corner_gap_to_shape(model, pair, pair.other, places, z)[0]
    gap = _gap(model, pair, pair.other, places, z)
    return np.inf if gap is None else least(gap, pair.skin.nodes.size)


def _corner_gap(model: Model, pair: Pair, corner: Corner, places: Array, z: Array) -> tuple[float, float]:
    x = places[pair.skin.nodes]
    reach = _REACH * pair.skin.thickness + float(np.hypot(*np.diff(x, axis=0).T).max())
    return pricking.gap(corner, model.bodies[pair.body], pair.skin, x, reach, z)


def _gap(model: Model, pair: Pair, other: Skin | Shape, places: Array, z: Array) -> Gap | None:
    """The gap along the first edge; None where the other is far from the whole edge."""
    skin = pair.skin
    x = places[skin.nodes]
    if isinstance(other, Skin):
        y = places[other.nodes]
        apart = max(float(np.hypot(*np.diff(nodes, axis=0).T).max()) for nodes in (x, y))
        reach = _REACH * (skin.thickness + other.thickness) + apart
        low, high = x.min(axis=0) - reach, x.max(axis=0) + reach
        if np.any(y.min(axis=0) > high) or np.any(y.max(axis=0) < low):
            return None
        if pair.way and not _edges_near(pair, other, x, y, reach):
            return None

        def to_edge(zeta: Array) -> Array:
            here, slope, _ = skin.curve(x, zeta)
            return facing.gaps(other, y, here, skin.outward(slope), reach, _own_places(pair, zeta)).gap

        return to_edge
    flat = _FLAT if isinstance(other, Broken | Graph) else 0.0
    body = model.bodies[pair.body]

    def to_shape(zeta: Array) -> Array:
        here, slope, _ = skin.curve(x, zeta)
        g, h, _ = other.measured(rigid.in_body_frame(body, here, z))
        opposed = (turned(h, float(body.state(z)[2])) * skin.outward(slope)).sum(axis=1) < flat
        return np.asarray(np.where(opposed, g, np.inf))

    return to_shape


def closed(touches: tuple[Touch, ...]) -> Mapping[str, tuple[Touch, ...]]:
    """Touching pairs by the name of their contact."""
    names = dict.fromkeys(contact.pair.name for contact in touches)
    return {
        name: pressing
        for name in names
        if (pressing := tuple(contact for contact in touches if contact.pair.name == name and contact.zeta.size))
    }
