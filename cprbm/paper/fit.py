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

from math import cos, hypot, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain import compiled
from cprbm.contact import Columns
from cprbm.equilibrium import squares_of
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
    for i in range(n):
        write_basis(points[0, i], middle, width, V[i])
    values = np.ascontiguousarray(V[:, 0])
    inverse = np.ascontiguousarray(np.linalg.inv(values.T @ values))
    return Fit(points, offsets, turns, V, inverse, inverse @ (values.T @ points[1]), middle, width)


@compiled
def write_fitted_gaps(z: Array, b: Boundary, gaps: Array) -> None:  # pragma: no cover
    """Write the gaps (m,) of the constrained joints."""
    fit, basis = fitted(z, b), np.empty((3, b.degree + 1))
    for j in range(b.joints.size):
        a, o = z[b.joints[j] + b.along], z[b.joints[j] + 1 - b.along]
        write_basis(a, fit.middle, fit.width, basis)
        gaps[j] = b.sense * (o - basis[0] @ fit.q)


@compiled
def derivatives_of_fit(b: Boundary, fit: Fit) -> Array:  # pragma: no cover
    """K (degree + 1, 2 n)."""
    n = b.points.size
    load = np.zeros((b.degree + 1, 2 * n))
    for i in range(n):
        P = fit.V[i] @ fit.q
        load[:, i] = -fit.V[i, 1] * (P[0] - fit.points[1, i]) - fit.V[i, 0] * P[1]
        load[:, n + i] = fit.V[i, 0]
    return fit.inverse @ load


class Local(NamedTuple):
    """Columns by local coordinates: a (k), o (k), A (n), B (n), τ (n).

    ``vectors`` (columns, 2 k + 3 n), ``diagonal``, ``beside`` (columns,); ``numbers`` of columns and negative squares.
    """

    vectors: Array
    diagonal: Array
    beside: Array
    numbers: Ints


@compiled
def _new_square(out: Local, square: float) -> Array:  # pragma: no cover
    """Vector of a new column for square·v²."""
    at = out.numbers[0]
    out.diagonal[at] = -1.0 / square
    out.numbers[0] += 1
    out.numbers[1] += square > 0.0
    vector: Array = out.vectors[at]
    return vector


@compiled
def _add_curvature(b: Boundary, fit: Fit, out: Local, K: Array, w: Array, basis: Array) -> None:  # pragma: no cover
    """Append the columns of the second derivative; ``basis`` (k, 3, degree + 1) are the polynomials at the a_j."""
    n, k, mu, slope = b.points.size, w.size, np.zeros(b.degree + 1), np.zeros(K.shape[1])
    for c in range(k):
        slope += w[c] * (basis[c, 0] @ K)
        mu -= w[c] * (fit.inverse @ basis[c, 0])
        square = w[c] * (basis[c, 2] @ fit.q)
        if square != 0.0:
            _new_square(out, square)[c] = 1.0
    U = np.empty((n, 3))
    for i in range(n):
        P, U[i] = fit.V[i] @ fit.q, fit.V[i] @ mu
        bent = U[i, 2] * (P[0] - fit.points[1, i]) + 2.0 * U[i, 1] * P[1] + U[i, 0] * P[2]
        for value, A, B in squares_of(bent, -U[i, 1], 0.0):
            if abs(value) > REAL * hypot(bent, U[i, 1]):
                vector = _new_square(out, value)
                vector[2 * k + i], vector[2 * k + n + i] = A, B
        turn = -slope[i] * fit.offsets[0, i] - slope[n + i] * fit.offsets[1, i]
        if turn != 0.0:
            _new_square(out, turn)[2 * k + 2 * n + i] = 1.0
    for r in range(b.degree + 1):
        at = out.numbers[0]
        out.vectors[at, :k] = w * basis[:, 1, r]
        out.vectors[at, 2 * k : 2 * k + n] = U[:, 1] * fit.V[:, 0, r] + U[:, 0] * fit.V[:, 1, r]
        out.vectors[at + 1, 2 * k : 2 * k + 2 * n] = K[r]
        out.beside[at + 1] = -1.0
        out.numbers[:] += np.array([2, 1])


@compiled
def _entries(b: Boundary, fit: Fit, joints: Ints, vectors: Array) -> tuple[Ints, Ints, Array]:  # pragma: no cover
    """Entries of vectors over the local coordinates: column, unknown, value."""
    k, n, count, used = joints.size, b.points.size, len(vectors), 0
    index, local = np.empty(2 * k + 3 * n + 1, np.int64), np.empty(2 * k + 3 * n + 1)
    index[:k], index[k : 2 * k] = b.joints[joints] + b.along, b.joints[joints] + 1 - b.along
    index[2 * k : 2 * k + n], index[2 * k + n : 2 * k + 2 * n] = b.points + b.along, b.points + 1 - b.along
    index[2 * k + 2 * n :] = b.angles
    most = count * index.size
    columns, unknowns, values = np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most)
    for c in range(count):
        local[: 2 * k + 2 * n], local[2 * k + 2 * n :] = vectors[c, : 2 * k + 2 * n], 0.0
        A, B, tau = vectors[c, 2 * k :].reshape((3, n))
        turn = 0.5 * (A * fit.turns[0] + B * fit.turns[1] + tau)
        local[2 * k + 2 * n : -1] += turn
        local[2 * k + 2 * n + 1 :] += turn
        for j in np.flatnonzero(local):
            columns[used], unknowns[used], values[used] = c, index[j], local[j]
            used += 1
    return columns[:used], unknowns[:used], values[:used]


@compiled
def fitted_columns(z: Array, b: Boundary, force: Array, closed: Flags, gradient: Array) -> Columns:  # pragma: no cover
    """Columns of the constrained joints marked ``closed`` (m,); adds the gradient of −Σ F g to ``gradient``."""
    n, size, joints, fit = b.points.size, b.degree + 1, np.flatnonzero(closed), fitted(z, b)
    k, K, w = joints.size, derivatives_of_fit(b, fit), b.sense * force[joints]
    most = 2 * k + 3 * n + 2 * size
    out = Local(np.zeros((most, 2 * k + 3 * n)), np.zeros(most), np.zeros(most), np.array([k, 0]))
    values, basis = np.empty(k), np.empty((k, 3, size))
    for c in range(k):
        a, o = z[b.joints[joints[c]] + b.along], z[b.joints[joints[c]] + 1 - b.along]
        write_basis(a, fit.middle, fit.width, basis[c])
        values[c] = b.sense * (o - basis[c, 0] @ fit.q)
        out.vectors[c, c], out.vectors[c, k + c] = b.sense * (basis[c, 1] @ fit.q), -b.sense
        out.vectors[c, 2 * k : 2 * k + 2 * n] = b.sense * (basis[c, 0] @ K)
    if np.any(w != 0.0):
        _add_curvature(b, fit, out, K, w, basis)
    count, negative = out.numbers
    column, index, value = _entries(b, fit, joints, out.vectors[:count])
    for t in range(column.size):
        if column[t] < k:
            gradient[index[t]] += force[joints[column[t]]] * value[t]
    return Columns(values, negative, out.diagonal[:count], out.beside[:count], column, index, value)
