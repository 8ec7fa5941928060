"""Closest point of a beam's surface to a point: the place of the neutral line that a point faces.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, x_m  a point, and the place of the beam's neutral line that it faces, at ζ_m
T_m     half of the beam's thickness at ζ_m, linear between knots; T_m' by ζ_m
D, u    distance of x from x_m, negative on the other side, and the unit vector: x = x_m + D u
u₀, d   side·u and side·D, so that u₀ points to the left of the beam
w       u₀ turned clockwise
α       lean of u₀ from the normal: side·α counter-clockwise, sin α = T_m'/|x_m'|
c, a    w·x_m' and u₀·x_m'';  Z = c² − d a
======  =====================================================================================

A beam is the union of the circles of radius T about its neutral line, and its surface is their envelope. The distance
of x from the surface is the minimum along the beam of

    D − T_m,     where  u·x_m' + T_m' = 0:   u leans from the normal by α.

For constant thickness, and for a line, α = 0; x_m is the closest point and w the tangent. A motion of x moves ζ_m by
c (w·δx)/Z. D − T_m is stationary, so that the motion of ζ_m adds nothing to its derivative. The contact force acts
along u, on the line through both places, without a moment.

A point beyond an end of the beam faces the circle about the end: ζ_m is fixed, and u points from the end to x.

Where T_m' decreases at a knot, the surface has a convex corner, an arc about the knot: ζ_m stays there while u turns
from the lean before to the lean behind. Where T_m' increases, the corner is concave. Then the mean of both leans
separates the places before from the places behind; both circles are equally near there, up to third order in T_m'.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Flags, Ints
from fea_reference.edge import Edge
from fea_reference.hermite import Around, NeutralLine
from fea_reference.projection import closest
from fea_reference.state import Complex

_ITERATIONS = 40
_ARRIVED = 1e-8  # elements: last Newton step, with an error of the order of its square
_STEEPEST = 0.99  # largest sine of a lean
_NEAR = 2.0  # times the motion along the beam from the largest lean: knots farther away keep their sign of distance
_NOTHING = 1e-300


@dataclass(frozen=True)
class Tapers:
    """Half thickness T of two beams with varying thickness; for self-contact the same edge twice."""

    first: Edge
    second: Edge

    def thinner(self, zeta: Array, zeta_m: Array) -> Array:
        """Reduction (k,) of the distance of neutral lines in contact, against the thickest sections."""
        return (self.first.farthest - self.first.at(zeta)) + (self.second.farthest - self.second.at(zeta_m))


@dataclass(frozen=True, slots=True)
class Facing:
    """Places faced by k points: ζ_m, ``found``, the line ``across`` at ζ_m, w and c.

    ``fixed`` marks places at a knot or an end; None without any.
    """

    zeta_m: Array
    found: Flags
    across: Around
    w: Complex
    c: Array
    fixed: Flags | None


@dataclass(frozen=True, slots=True)
class Borders:
    """Rays of points that face a place with a jump of curvature or lean.

    Places ``zeta`` (b,), their ``points`` x + i y (b,), and w (b,).
    """

    zeta: Array
    points: Complex
    w: Complex

    def among(self, nodes: Ints) -> Borders:
        """Rays at ``nodes`` (k,) of the beam and at adjacent places."""
        if nodes.size == int(self.zeta.max()) + 1:
            return self
        wanted = np.zeros(int(self.zeta.max()) + 2, dtype=bool)
        wanted[nodes] = True
        at = self.zeta.astype(np.int64)
        here = wanted[at] | wanted[at + 1]
        return Borders(self.zeta[here], self.points[here], self.w[here])


def facing(
    second: NeutralLine,
    edge: Edge | None,
    points: Complex,
    guess: Array,
    sides: Callable[[Array, Array], Array | float],
    *,
    ended: bool,
) -> Facing:
    """Places faced by points x + i y (k,), with initial guesses ``guess`` (k,) and the thickness variation ``edge``.

    ``sides`` gives the sides (k,) from the closest places ζ_m (k,) and d (k,). Points beyond an end face nothing, or
    the end of a beam ``ended`` by circles.
    """
    faced = _between_ends(second, edge, points, guess, sides)
    return _with_ends(second, points, faced, sides) if ended else faced


def _between_ends(
    second: NeutralLine,
    edge: Edge | None,
    points: Complex,
    guess: Array,
    sides: Callable[[Array, Array], Array | float],
) -> Facing:
    """Places between the ends of the beam; points beyond an end face nothing."""
    zeta, found, across = closest(second, points, guess)
    J = np.abs(across.ahead)
    w = across.ahead / J
    foot = Facing(zeta, found, across, w, J, None)
    if edge is None or not edge.varies or not zeta.size:
        return foot
    d = ((1j * w).conj() * (points - second.nodes[across.element] - across.way)).real
    return _with_lean(second, edge, points, foot, d, np.broadcast_to(sides(zeta, d), zeta.shape))


def _with_ends(
    second: NeutralLine, points: Complex, faced: Facing, sides: Callable[[Array, Array], Array | float]
) -> Facing:
    """Places with the ends of the beam included."""
    at_end = ~faced.found & ((faced.zeta_m == 0.0) | (faced.zeta_m == second.n))
    if not at_end.any():
        return faced
    r = points - second.nodes[faced.across.element] - faced.across.way
    ahead = (faced.w.conj() * r).real
    at_end &= np.where(faced.zeta_m == 0.0, ahead < 0.0, ahead > 0.0)
    out = sides(faced.zeta_m, ((1j * faced.w).conj() * r).real) * r  # u₀
    w = np.where(at_end, -1j * out / np.maximum(np.abs(out), _NOTHING), faced.w)
    return Facing(
        faced.zeta_m,
        faced.found | at_end,
        faced.across,
        w,
        (w.conj() * faced.across.ahead).real,
        at_end if faced.fixed is None else faced.fixed | at_end,
    )


def lean(ahead: Complex, slope: Array, side: Array | float) -> Complex:
    """w (k,) for x_m' = ``ahead`` (k,) and T_m' = ``slope`` (k,)."""
    J = np.abs(ahead)
    sine = np.clip(slope / J, -_STEEPEST, _STEEPEST)
    return np.asarray(ahead / J * (np.sqrt(1.0 - sine**2) + 1j * side * sine))


def borders(second: NeutralLine, edge: Edge | None, side: float) -> Borders:
    """Rays at the nodes of a beam and the corners of its ``edge``, on a ``side``."""
    nodes = np.arange(second.n + 1.0)
    if edge is None or not edge.varies:
        return Borders(nodes, second.nodes, second.aheads)
    corners, before, behind = edge.corners
    nodes = np.setdiff1d(nodes, corners)
    at_node, at_corner = second.around(nodes), second.around(corners)
    first, last, middle = _rays(at_corner.ahead, before, behind, side)
    out = before > behind
    w = np.concatenate([lean(at_node.ahead, edge.slope(nodes), side), np.where(out, first, middle), last[out]])
    zeta = np.concatenate([nodes, corners, corners[out]])
    there = second.around(zeta)
    return Borders(zeta, second.nodes[there.element] + there.way, w)


def _rays(ahead: Complex, before: Array, behind: Array, side: Array | float) -> tuple[Complex, Complex, Complex]:
    """w for the leans before and behind corners, and for their mean."""
    first, last = lean(ahead, before, side), lean(ahead, behind, side)
    middle = first + last
    return first, last, middle / np.abs(middle)


def _with_lean(second: NeutralLine, edge: Edge, points: Complex, foot: Facing, d: Array, side: Array) -> Facing:
    """Places faced by points (k,) with closest places ``foot``, at distance ``d`` on a ``side`` (k,)."""
    slope, corner = _piece(second, edge, points, foot, d, side)
    zeta, done = foot.zeta_m, False
    for iteration in range(_ITERATIONS):
        there = second.around(zeta)
        w = lean(there.ahead, slope, side)
        r = points - second.nodes[there.element] - there.way
        f, across = (w.conj() * r).real, (1j * w).conj()
        c = (w.conj() * there.ahead).real
        turned = c - (across * there.bent).real * (across * r).real / c
        step = np.clip(f / np.where(turned > 0.1 * c, turned, c), -1.0, 1.0)
        if iteration > _ITERATIONS // 4:
            step *= 0.5  # as in the closest-point projection
        moved = np.clip(zeta + step, 0.0, float(second.n))
        done = bool(np.abs(moved - zeta).max(initial=0.0) < _ARRIVED)
        zeta = moved
        if done:
            break
    found = np.abs(f) <= 1e-6 * np.sqrt(r.real**2 + r.imag**2 + c**2)
    at_corner = corner >= 0
    fixed = at_corner if at_corner.any() else None
    if fixed is not None:
        zeta = np.where(fixed, edge.corners[0][corner], zeta)
        found |= fixed
    there = second.around(zeta)
    w = lean(there.ahead, slope, side)
    if fixed is not None:
        r = points - second.nodes[there.element] - there.way
        out = np.where(d < 0.0, -1.0, 1.0) * r  # u₀
        w = np.where(fixed, -1j * out / np.maximum(np.abs(out), _NOTHING), w)
    return Facing(zeta, found, there, w, (w.conj() * there.ahead).real, fixed)


def _piece(second: NeutralLine, edge: Edge, points: Complex, foot: Facing, d: Array, side: Array) -> tuple[Array, Ints]:
    """T_m' (k,) at the faced places, and the number of the faced corner (k,), or −1."""
    corners, before, behind = edge.corners
    if not corners.size:
        return edge.slope(foot.zeta_m), np.full(foot.zeta_m.shape, -1)
    slopes = np.append(before, behind[-1:])
    at = second.around(corners)
    r = points[:, None] - (second.nodes[at.element] + at.way)
    first, last, middle = ((w.conj() * r).real for w in _rays(at.ahead, before, behind, side[:, None]))
    is_before, is_behind = first < 0.0, last > 0.0
    parted = (before <= behind) | (is_before & is_behind)
    where = np.where(parted, np.where(middle > 0.0, 1, -1), is_behind.astype(int) - is_before)
    reach = _NEAR * np.abs(d) * np.abs(slopes).max() / foot.c**2 + _ARRIVED
    away = foot.zeta_m[:, None] - corners
    where = np.where(np.abs(away) > reach[:, None], np.sign(away).astype(int), where)
    corner = np.where((where == 0).any(axis=1), np.argmax(where == 0, axis=1), -1)
    return slopes[(where > 0).sum(axis=1)], corner
