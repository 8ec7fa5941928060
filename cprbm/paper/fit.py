"""The paper's contact of two beams, eqs. (8)-(11): gaps, gradients and local motions, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
p_i, θ_i   related joint of the boundary's beam, angle of the link behind the joint
τ_i, n_i   ½ (θ_{i−1} + θ_i), eq. (9); offset h (−sin τ_i, cos τ_i)
b_i        offset point p_i + n_i, eq. (10); (A_i, B_i) along the axis of the fit and across
h          ½ (t₁ + t₂), positive to the left of the boundary's beam
φ_r        Chebyshev polynomials of the present range of A; V_ir = φ_r(A_i), primes by A
q, P       coefficients by least squares, VᵀV q = VᵀB; P = Σ q_r φ_r is the boundary g_s
a_j, o_j   related joint of the other beam, along and across; σ side of the joints, +1 or −1
g_j        gap σ (o_j − P(a_j)) ≥ 0, eq. (11); F_j its force
=========  =====================================================================================

The boundary is the same for any basis of polynomials: middle and width of the range count as constants.

**Gradient.**  With ρ_i = P(A_i) − B_i and G = (VᵀV)⁻¹ the derivatives K = ∂q/∂(A, B) are

    K_A = −G (V′ᵀ ρ + Vᵀ P′),    K_B = G Vᵀ,    ∂P(a_j)/∂(A, B) = φ(a_j) K.

**Second derivatives.**  The Lagrangian has −Σ F g = L = Σ w_j (P(a_j) − o_j), w = σ F.  The adjoint of the fit is
μ = −G Σ w_j φ(a_j); with U_i = V_i·μ, C the derivatives of L + μ·Vᵀ(V q − B) by q and by (a, A, B),

    C_a = w_j φ′(a_j),    C_A = U′_i V_i + U_i V′_i,    C_B = 0,

the second derivative of L by (a, A, B) is

    Σ w_j P″(a_j) da_j² + Σ [α_i dA_i² − 2 U′_i dA_i dB_i] + Σ_r 2 C_r K_r,    α = U″ρ + 2 U′P′ + U P″.

The offset points turn, dA_i = dx_i + A_τ dτ_i, and with them goes Σ t_i dτ_i², t = −L_A n_A − L_B n_B.

**Columns.**  A square s v² has the column v and −1/s on the diagonal; a product 2 C_r K_r has both columns with −1
beside the diagonal; a point's block has its two eigenvectors (:mod:`cprbm.equilibrium.columns`).
"""

from __future__ import annotations

from math import atan2, cos, hypot, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain.compiled import compiled
from cprbm.contact import Columns
from cprbm_scene.answer import Array, Flags, Ints

REAL = 1e-14
"""Curvature of a point's block, over the larger curvature, below which round-off remains."""


class Boundary(NamedTuple):
    """A fitted boundary and the joints on one side.

    Attributes:
        along: axis of the polynomial's variable, 0 for x and 1 for y.
        sense: σ; offset: h.
        degree: of the polynomial.
        joints: index of the x of the constrained joints (m,).
        points: index of the x of the boundary's joints (n,); angles: of the angles of the links around (n + 1,).
    """

    along: int
    sense: float
    offset: float
    degree: int
    joints: Ints
    points: Ints
    angles: Ints


class Fit(NamedTuple):
    """The polynomial at a state.

    ``points`` (2, n) A and B, ``offsets`` (2, n) n_i, ``turns`` (2, n) derivatives of A and B by τ; ``V``
    (n, 3, degree + 1) V, V′, V″; ``inverse`` G; q; ``middle`` and half ``width`` of the range.
    """

    points: Array
    offsets: Array
    turns: Array
    V: Array
    inverse: Array
    q: Array
    middle: float
    width: float


@compiled
def write_basis(x: float, middle: float, width: float, values: Array) -> None:  # pragma: no cover
    """Write the Chebyshev polynomials and two derivatives (3, degree + 1)."""
    t = (x - middle) / width
    values[0, 0], values[1, 0], values[2, 0] = 1.0, 0.0, 0.0
    values[0, 1], values[1, 1], values[2, 1] = t, 1.0 / width, 0.0
    for r in range(2, values.shape[1]):
        values[0, r] = 2.0 * t * values[0, r - 1] - values[0, r - 2]
        values[1, r] = 2.0 * (values[0, r - 1] / width + t * values[1, r - 1]) - values[1, r - 2]
        values[2, r] = 2.0 * (2.0 * values[1, r - 1] / width + t * values[2, r - 1]) - values[2, r - 2]


@compiled
def fitted(z: Array, b: Boundary) -> Fit:  # pragma: no cover
    """The polynomial through the offset points."""
    n, size, x, y = b.points.size, b.degree + 1, b.along, 1 - b.along
    points, offsets, turns, V = np.empty((2, n)), np.empty((2, n)), np.empty((2, n)), np.empty((n, 3, size))
    for i in range(n):
        tau = 0.5 * (z[b.angles[i]] + z[b.angles[i + 1]])
        nx, ny = -b.offset * sin(tau), b.offset * cos(tau)
        points[x, i], points[y, i] = z[b.points[i]] + nx, z[b.points[i] + 1] + ny
        offsets[x, i], offsets[y, i] = nx, ny
        turns[x, i], turns[y, i] = -ny, nx
    low, high = points[0].min(), points[0].max()
    middle, width = 0.5 * (low + high), 0.5 * (high - low)
    normal, load = np.zeros((size, size)), np.zeros(size)
    for i in range(n):
        write_basis(points[0, i], middle, width, V[i])
        for r in range(size):
            load[r] += V[i, 0, r] * points[1, i]
            for s in range(size):
                normal[r, s] += V[i, 0, r] * V[i, 0, s]
    inverse, q = np.empty((size, size)), np.zeros(size)
    inverse[:] = np.linalg.inv(normal)
    for r in range(size):
        for s in range(size):
            q[r] += inverse[r, s] * load[s]
    return Fit(points, offsets, turns, V, inverse, q, middle, width)


@compiled
def write_fitted_gaps(z: Array, b: Boundary, gaps: Array) -> None:  # pragma: no cover
    """Write the gaps (m,) of the constrained joints."""
    fit, basis = fitted(z, b), np.empty((3, b.degree + 1))
    for j in range(b.joints.size):
        a, o = z[b.joints[j] + b.along], z[b.joints[j] + 1 - b.along]
        write_basis(a, fit.middle, fit.width, basis)
        gaps[j] = b.sense * (o - basis[0] @ fit.q)


@compiled
def slopes_of_fit(b: Boundary, fit: Fit) -> tuple[Array, Array, Array]:  # pragma: no cover
    """P, P′, P″ at the points (n, 3), ρ (n,) and K (degree + 1, 2 n)."""
    n, size = b.points.size, b.degree + 1
    P, rest, K = np.empty((n, 3)), np.empty(n), np.zeros((size, 2 * n))
    for i in range(n):
        P[i] = fit.V[i] @ fit.q
        rest[i] = P[i, 0] - fit.points[1, i]
        for r in range(size):
            for s in range(size):
                K[r, i] -= fit.inverse[r, s] * (fit.V[i, 1, s] * rest[i] + fit.V[i, 0, s] * P[i, 1])
                K[r, n + i] += fit.inverse[r, s] * fit.V[i, 0, s]
    return P, rest, K


@compiled
def _add(
    entries: tuple[Ints, Ints, Array], used: int, column: int, index: int, value: float
) -> int:  # pragma: no cover
    """Append an entry; the number of all entries."""
    entries[0][used], entries[1][used], entries[2][used] = column, index, value
    return used + 1


@compiled
def _add_point(
    entries: tuple[Ints, Ints, Array], used: int, column: int, b: Boundary, fit: Fit, i: int, A: float, B: float
) -> int:  # pragma: no cover
    """Append the entries of A dA_i + B dB_i."""
    turn = 0.5 * (A * fit.turns[0, i] + B * fit.turns[1, i])
    used = _add(entries, used, column, b.points[i] + b.along, A)
    used = _add(entries, used, column, b.points[i] + 1 - b.along, B)
    used = _add(entries, used, column, b.angles[i], turn)
    return _add(entries, used, column, b.angles[i + 1], turn)


@compiled
def fitted_columns(z: Array, b: Boundary, force: Array, closed: Flags, gradient: Array) -> Columns:  # pragma: no cover
    """Columns of the constrained joints marked ``closed`` (m,); adds the gradient of −Σ F g to ``gradient``."""
    n, size, joints = b.points.size, b.degree + 1, np.flatnonzero(closed)
    k, fit = joints.size, fitted(z, b)
    P, rest, K = slopes_of_fit(b, fit)
    most = 2 * k + 3 * n + 2 * size
    diagonal, beside, values = np.zeros(most), np.zeros(most), np.empty(k)
    most = k * (3 + 4 * n) + 10 * n + size * (k + 8 * n)
    entries, used = (np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most)), 0
    basis, slope, mu = np.empty((k, 3, size)), np.zeros(2 * n), np.zeros(size)
    for c in range(k):
        a, o = b.joints[joints[c]] + b.along, b.joints[joints[c]] + 1 - b.along
        write_basis(z[a], fit.middle, fit.width, basis[c])
        values[c] = b.sense * (z[o] - basis[c, 0] @ fit.q)
        first, over, F = used, basis[c, 0] @ K, force[joints[c]]
        used = _add(entries, used, c, a, b.sense * (basis[c, 1] @ fit.q))
        used = _add(entries, used, c, o, -b.sense)
        for i in range(n):
            used = _add_point(entries, used, c, b, fit, i, b.sense * over[i], b.sense * over[n + i])
        for t in range(first, used):
            gradient[entries[1][t]] += F * entries[2][t]
        slope += b.sense * F * over
        mu -= b.sense * F * (fit.inverse @ basis[c, 0])
    at, negative = k, 0
    if np.any(mu != 0.0):
        for c in range(k):
            weight = b.sense * force[joints[c]]
            square = weight * (basis[c, 2] @ fit.q)
            if square != 0.0:
                diagonal[at] = -1.0 / square
                negative += square > 0.0
                used = _add(entries, used, at, b.joints[joints[c]] + b.along, 1.0)
                at += 1
        for i in range(n):
            U = fit.V[i] @ mu
            cross, turn = -U[1], -slope[i] * fit.offsets[0, i] - slope[n + i] * fit.offsets[1, i]
            square = U[2] * rest[i] + 2.0 * U[1] * P[i, 1] + U[0] * P[i, 2]
            lean, size_of = 0.5 * atan2(2.0 * cross, square), hypot(0.5 * square, cross)
            for sign in (1.0, -1.0):
                value = 0.5 * square + sign * size_of
                if abs(value) > REAL * size_of:
                    A, B = (cos(lean), sin(lean)) if sign > 0.0 else (-sin(lean), cos(lean))
                    diagonal[at] = -1.0 / value
                    negative += value > 0.0
                    used = _add_point(entries, used, at, b, fit, i, A, B)
                    at += 1
            if turn != 0.0:
                diagonal[at] = -1.0 / turn
                negative += turn > 0.0
                used = _add(entries, used, at, b.angles[i], 0.5)
                used = _add(entries, used, at, b.angles[i + 1], 0.5)
                at += 1
        for r in range(size):
            for c in range(k):
                weight = b.sense * force[joints[c]]
                used = _add(entries, used, at, b.joints[joints[c]] + b.along, weight * basis[c, 1, r])
            for i in range(n):
                U0, U1 = fit.V[i, 0] @ mu, fit.V[i, 1] @ mu
                used = _add_point(entries, used, at, b, fit, i, U1 * fit.V[i, 0, r] + U0 * fit.V[i, 1, r], 0.0)
                used = _add_point(entries, used, at + 1, b, fit, i, K[r, i], K[r, n + i])
            beside[at + 1] = -1.0
            negative += 1
            at += 2
    return Columns(
        values, negative, diagonal[:at], beside[:at], entries[0][:used], entries[1][:used], entries[2][:used]
    )
