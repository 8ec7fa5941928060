"""The gap between two curves and the derivatives, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
A, B       curve of the place and curve of the foot; C_A(ξ), C_B(η) their points, primes by ξ and η
F          contact force of a place, positive in pressure
c_A, c_B   lost compliance of a point force, :mod:`cprbm.chain.spline`; zero unless the place moves
T_A, T_B   half thickness, less F c/2 of a point force
σ          side of B on which A lies, seen along B: +1 left, −1 right
t, n       unit tangent of B, its left normal
N, t̂       σ n and t, turned by arcsin(T_B'/|C_B'|): N·C_B' = −T_B'
r, R       C_A − C_B, and N·r
λ          gap plus F (c_A + c_B)/2: R − T_A − T_B
K, τ       N·C_B'', t̂·C_B'
D          τ² − R (K + T_B'')
=========  =====================================================================================

**Energy.**  A place adds −F λ(u, ξ, η, F) to the Lagrangian, u the positions of the nodes.  The derivative by F is
−(g + F c), with the gap g and c = c_A + c_B: the curves overlap by the lost compliance.  A point force changes the half
thickness by −F c/2.  Place and foot are stationary points of λ and follow c like the thickness of a tapered beam: both
are variational.

**Foot.**  λ as a distance, |r| − T_A − T_B with r = R N at the foot, has the derivatives by η and by the nodes, with
q = t̂·(dC_A − dC_B) and e = N·dC_B':

    λ_η = −N·C_B' − T_B' = 0,    λ_ηη = D/R,    λ_ηu = −(τ q/R + e),    λ_uu = q²/R,    λ_u = N·(dC_A − dC_B).

With dη = (τ q + R e)/D the foot is eliminated, and nothing is singular where two lines meet (R = 0):

    λ_uu = −[(K + T_B'') q² + 2 τ q e + R e²]/D,    λ_uF = c_B' dη/2,    λ_FF = −c_B'² R/(4 D).

At an end of B, a convex corner and a circle the foot is a point: N = r/|r|, λ_uu = q²/R, and no other term.

**Place.**  By ξ, with q_ξ = t̂·C_A' and η_ξ = τ q_ξ/D (zero at a point),

    λ_ξ  = N·C_A' − T_A',     λ_ξξ = s_qq q_ξ² + N·C_A'' − T_A'',    λ_ξF = (c_A' + c_B' η_ξ)/2,
    λ_ξu = N·dC_A' + q_ξ (s_qq q + s_qe e),

s the coefficients of λ_uu.  A moving place has λ_ξ = 0.  Newton's method eliminates the change of the place:
dξ = −(λ_ξ + λ_ξu + λ_ξF dF)/λ_ξξ.  At a corner C_A' = 0 and all derivatives by ξ vanish.  The equilibrium takes the
:class:`Row` below and vectors over the nodes; λ_uu less λ_ξu²/λ_ξξ is a form of rank three in q, e and λ_ξu.
"""

from math import hypot, sqrt
from typing import NamedTuple, Protocol

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact.closest import curve_jet, curve_point, lost_at, thickness_between, weight_at
from cprbm.contact.curve import STENCIL, CurveArrays
from cprbm_scene.answer import Array, Flags, Ints

LOCAL = 4 * STENCIL
"""Entries of a vector over the nodes of a place: x and y of A's stencil, then of B's."""

STEEPEST = 0.5
"""Largest sine of the angle between N and B's normal: wild forces of Newton's method must not turn N round."""

GRADIENT, COUPLING, TANGENT, TURN, SHIFT = range(5)
"""Rows of a place's vectors: λ_u, derivative of the row's value by u, q, e, λ_ξu."""


class Places(NamedTuple):
    """Places of contact; the entries are places.

    Attributes:
        pair: number of the pair of curves.
        curve, piece, xi: curve A, piece and parameter of the place.
        other, foot, eta: curve B, piece and parameter of the foot.
        at_point: whether the foot is a point.
        side: σ; 0 for a beam with itself: the side on which the place is now.
        moves: whether the place is a point contact: at a corner, or moving to the minimum of λ.
        shares: offset of the place whose force the place has; 0 with a force of its own.
        force: F.
    """

    pair: Ints
    curve: Ints
    piece: Ints
    xi: Array
    other: Ints
    foot: Ints
    eta: Array
    at_point: Flags
    side: Array
    moves: Flags
    shares: Ints
    force: Array


class Columns(NamedTuple):
    """Border columns of closed places: columns of forces first, then columns of local motions.

    Attributes:
        values: of the rows with a force of their own (forces,).
        negative: number of negative eigenvalues of the local motions' block.
        diagonal, beside: block of the columns: diagonal, and entry beside the column before (columns,).
        entry_column, entry_index, entry_value: entries by column, unknown and value.
    """

    values: Array
    negative: int
    diagonal: Array
    beside: Array
    entry_column: Ints
    entry_index: Ints
    entry_value: Array


class Law(Protocol):
    """A contact law for some pairs of curves."""

    def measures(self, places: Places) -> Flags:
        """Places that the law measures; the last of all places."""

    def write_gaps(self, z: Array, places: Places, gaps: Array) -> None:
        """Write the gaps of the law's places at a state."""

    def columns(self, z: Array, places: Places, closed: Flags, gradient: Array) -> Columns:
        """Columns of all places marked ``closed``; adds the gradient of all −F λ to ``gradient``."""

    def force(self, z: Array, places: Places, k: int) -> Array:
        """Force (2,) on a place of the law."""

    def invalid(self, z: Array, places: Places, closed: Flags) -> str:
        """Reason why the law does not hold at a state; empty if it holds."""


class Frame(NamedTuple):
    """Derivatives of λ at a place, the foot eliminated.

    ``gap`` g; N, t̂; coefficients ``qq``, ``qe``, ``ee`` of λ_uu; ``along`` q_ξ; ``slope`` λ_ξ,
    ``curvature`` λ_ξξ, ``slope_by_force`` λ_ξF; ``foot_q``, ``foot_e`` of dη; ``lost`` c, ``foot_lost`` c_B',
    ``by_force`` λ_FF.
    """

    gap: float
    nx: float
    ny: float
    tx: float
    ty: float
    qq: float
    qe: float
    ee: float
    along: float
    slope: float
    curvature: float
    slope_by_force: float
    foot_q: float
    foot_e: float
    lost: float
    foot_lost: float
    by_force: float


class Row(NamedTuple):
    """Row of a place in the linear system, the place's change eliminated.

    Attributes:
        frame: derivatives of λ at the place.
        value: g + F c, which a closed place makes zero.
        by_force: derivative of the value by F.
        shift: the Hessian of λ is qq q² + 2 qe q e + ee e² + shift λ_ξu².
    """

    frame: Frame
    value: float
    by_force: float
    shift: float


@compiled_inner
def gap_frame(z: Array, curves: CurveArrays, places: Places, k: int) -> Frame:  # pragma: no cover
    """Derivatives at a place with known foot."""
    piece, xi, foot, eta, side = places.piece[k], places.xi[k], places.foot[k], places.eta[k], places.side[k]
    ax, ay, ux, uy, wx, wy = curve_jet(z, curves, piece, xi)
    bx, by, vx, vy, kx, ky = curve_jet(z, curves, foot, eta)
    rx, ry = ax - bx, ay - by
    force = places.force[k] if places.moves[k] else 0.0
    # a fixed place loses nothing
    own, own1, own2 = _lost(curves, piece, xi, 1.0 * places.moves[k])
    other, other1, other2 = _lost(curves, foot, eta, 1.0 * places.moves[k])
    thickness = thickness_between(curves, piece, xi, foot, eta)
    if places.at_point[k]:
        other1 = 0.0
        R = hypot(rx, ry)
        # a place on the point itself has no direction, and no force
        qq = 1.0 / R if R > 0.0 else 0.0
        nx, ny = rx * qq, ry * qq
        tx, ty = ny, -nx
        qe, ee, foot_q, foot_e = 0.0, 0.0, 0.0, 0.0
    else:
        speed = hypot(vx, vy)
        tx, ty = vx / speed, vy / speed
        if side == 0.0:
            side = 1.0 if rx * -ty + ry * tx >= 0.0 else -1.0
        sine = min(STEEPEST, max(-STEEPEST, (curves.thickening[foot] - 0.5 * force * other1) / speed))
        cosine = sqrt(1.0 - sine * sine)
        nx, ny = -side * ty, side * tx
        nx, tx = cosine * nx - sine * tx, cosine * tx + sine * nx
        ny, ty = cosine * ny - sine * ty, cosine * ty + sine * ny
        R, tau = nx * rx + ny * ry, tx * vx + ty * vy
        bend = nx * kx + ny * ky - 0.5 * force * other2
        D = tau * tau - R * bend
        qq, qe, ee, foot_q, foot_e = -bend / D, -tau / D, -R / D, tau / D, R / D
    along = tx * ux + ty * uy
    slope = nx * ux + ny * uy - curves.thickening[piece] + 0.5 * force * own1
    curvature = qq * along * along + nx * wx + ny * wy + 0.5 * force * own2
    return Frame(
        R - thickness, nx, ny, tx, ty, qq, qe, ee, along, slope, curvature,
        0.5 * (own1 + other1 * foot_q * along), foot_q, foot_e, own + other, other1, -0.25 * other1 * other1 * foot_e,
    )  # fmt: skip


@compiled
def touching_points(
    z: Array, curves: CurveArrays, places: Places, which: Ints
) -> tuple[Array, Array]:  # pragma: no cover
    """Points (k, 2, 2) of some places on both curves, and normals (k, 2) from the feet to the places."""
    points, normals = np.empty((which.size, 2, 2)), np.empty((which.size, 2))
    for i in range(which.size):
        k = which[i]
        frame = gap_frame(z, curves, places, k)
        normals[i, 0], normals[i, 1] = frame.nx, frame.ny
        points[i, 0] = curve_point(z, curves, places.piece[k], places.xi[k])
        points[i, 1] = curve_point(z, curves, places.foot[k], places.eta[k])
    return points, normals


@compiled_inner
def _lost(curves: CurveArrays, piece: int, xi: float, share: float) -> tuple[float, float, float]:  # pragma: no cover
    """A ``share`` of c, c' and c''."""
    c, slope, bend = lost_at(curves, piece, xi, 0), lost_at(curves, piece, xi, 1), lost_at(curves, piece, xi, 2)
    return share * c, share * slope, share * bend


@compiled_inner
def _add(
    out: Array, curves: CurveArrays, piece: int, xi: float, order: int, vx: float, vy: float, factor: float
) -> None:  # pragma: no cover
    """Add factor v·dC to a vector over the nodes of a piece, or factor v·dC' with ``order`` 1."""
    for i in range(STENCIL):
        a, b = weight_at(curves, piece, i, xi, order)
        out[2 * i] += factor * (vx * a + vy * b)
        out[2 * i + 1] += factor * (vy * a - vx * b)


@compiled_inner
def gap_row(z: Array, curves: CurveArrays, places: Places, k: int, vectors: Array) -> Row:  # pragma: no cover
    """Row of a place; writes vectors (5, LOCAL)."""
    f = gap_frame(z, curves, places, k)
    piece, xi, foot, eta, force = places.piece[k], places.xi[k], places.foot[k], places.eta[k], places.force[k]
    vectors[:] = 0.0
    of_a, of_b = vectors[:, : 2 * STENCIL], vectors[:, 2 * STENCIL :]
    _add(of_a[GRADIENT], curves, piece, xi, 0, f.nx, f.ny, 1.0)
    _add(of_b[GRADIENT], curves, foot, eta, 0, f.nx, f.ny, -1.0)
    _add(of_a[TANGENT], curves, piece, xi, 0, f.tx, f.ty, 1.0)
    _add(of_b[TANGENT], curves, foot, eta, 0, f.tx, f.ty, -1.0)
    if not places.at_point[k]:
        _add(of_b[TURN], curves, foot, eta, 1, f.nx, f.ny, 1.0)
    value, by_force, shift = f.gap + force * f.lost, f.lost + force * f.by_force, 0.0
    if places.moves[k] and f.curvature != 0.0:
        shift = -1.0 / f.curvature
        _add(of_a[SHIFT], curves, piece, xi, 1, f.nx, f.ny, 1.0)
        for i in range(LOCAL):
            vectors[SHIFT, i] += f.along * (f.qq * vectors[TANGENT, i] + f.qe * vectors[TURN, i])
            vectors[GRADIENT, i] += shift * f.slope * vectors[SHIFT, i]
    lean = shift * f.slope_by_force
    for i in range(LOCAL):
        foot = 0.5 * f.foot_lost * (f.foot_q * vectors[TANGENT, i] + f.foot_e * vectors[TURN, i])
        vectors[COUPLING, i] = vectors[GRADIENT, i] + force * (foot + lean * vectors[SHIFT, i])
    value += f.slope * (shift * f.slope + force * lean)
    return Row(f, value, by_force + force * lean * f.slope_by_force, shift)


@compiled_inner
def local_indices(curves: CurveArrays, places: Places, k: int, index: Ints) -> None:  # pragma: no cover
    """Write the unknowns (LOCAL,) of a place's vectors; an unknown may come twice."""
    for i in range(STENCIL):
        index[2 * i], index[2 * (STENCIL + i)] = curves.stencil[places.piece[k], i], curves.stencil[places.foot[k], i]
        index[2 * i + 1], index[2 * (STENCIL + i) + 1] = index[2 * i] + 1, index[2 * (STENCIL + i)] + 1
