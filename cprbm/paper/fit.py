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
    (3, n, degree + 1) V, V′, V″; ``inverse`` G; q; ``middle`` and half ``width`` of the range.
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
def basis_of(x: Array, middle: float, width: float, degree: int) -> Array:  # pragma: no cover
    """Chebyshev polynomials and two derivatives (3, k, degree + 1) at some places (k,)."""
    t, V = (x - middle) / width, np.zeros((3, x.size, degree + 1))
    V[0, :, 0], V[0, :, 1], V[1, :, 1] = 1.0, t, 1.0 / width
    for r in range(2, degree + 1):
        V[0, :, r] = 2.0 * t * V[0, :, r - 1] - V[0, :, r - 2]
        V[1, :, r] = 2.0 * (V[0, :, r - 1] / width + t * V[1, :, r - 1]) - V[1, :, r - 2]
        V[2, :, r] = 2.0 * (2.0 * V[1, :, r - 1] / width + t * V[2, :, r - 1]) - V[2, :, r - 2]
    return V


@compiled
def fitted(z: Array, b: Boundary) -> Fit:  # pragma: no cover
    """The polynomial through the offset points."""
    n, x, y, tau = b.points.size, b.along, 1 - b.along, 0.5 * (z[b.angles[:-1]] + z[b.angles[1:]])
    points, offsets, turns = np.empty((2, n)), np.empty((2, n)), np.empty((2, n))
    offsets[x], offsets[y] = -b.offset * np.sin(tau), b.offset * np.cos(tau)
    points[x], points[y] = z[b.points] + offsets[x], z[b.points + 1] + offsets[y]
    turns[x], turns[y] = -offsets[y], offsets[x]
    low, high = points[0].min(), points[0].max()
    middle, width = 0.5 * (low + high), 0.5 * (high - low)
    V = basis_of(points[0], middle, width, b.degree)
    inverse = np.ascontiguousarray(np.linalg.inv(V[0].T @ V[0]))
    return Fit(points, offsets, turns, V, inverse, inverse @ (V[0].T @ points[1]), middle, width)


@compiled
def fitted_gaps(z: Array, b: Boundary) -> Array:  # pragma: no cover
    """Gaps (m,) of the constrained joints."""
    fit, a, o = fitted(z, b), z[b.joints + b.along], z[b.joints + 1 - b.along]
    return np.asarray(b.sense * (o - basis_of(a, fit.middle, fit.width, b.degree)[0] @ fit.q))


@compiled
def derivatives_of_fit(b: Boundary, fit: Fit) -> Array:  # pragma: no cover
    """K (degree + 1, 2 n)."""
    n, load = b.points.size, np.empty((b.degree + 1, 2 * b.points.size))
    load[:, :n] = -fit.V[1].T * (fit.V[0] @ fit.q - fit.points[1]) - fit.V[0].T * (fit.V[1] @ fit.q)
    load[:, n:] = fit.V[0].T
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
    """Append the columns of the second derivative; ``basis`` (3, k, degree + 1) are the polynomials at the a_j."""
    n, k, V = b.points.size, w.size, fit.V
    slope, mu, squares = w @ (basis[0] @ K), -(fit.inverse @ (w @ basis[0])), w * (basis[2] @ fit.q)
    P0, P1, P2 = V[0] @ fit.q, V[1] @ fit.q, V[2] @ fit.q
    U0, U1, U2 = V[0] @ mu, V[1] @ mu, V[2] @ mu
    bent = U2 * (P0 - fit.points[1]) + 2.0 * U1 * P1 + U0 * P2
    turn = -slope[:n] * fit.offsets[0] - slope[n:] * fit.offsets[1]
    for c in np.flatnonzero(squares):
        _new_square(out, squares[c])[c] = 1.0
    for i in range(n):
        for value, A, B in squares_of(bent[i], -U1[i], 0.0):
            if abs(value) > REAL * np.hypot(bent[i], U1[i]):
                vector = _new_square(out, value)
                vector[2 * k + i], vector[2 * k + n + i] = A, B
        if turn[i] != 0.0:
            _new_square(out, turn[i])[2 * k + 2 * n + i] = 1.0
    for r in range(b.degree + 1):
        at = out.numbers[0]
        out.vectors[at, :k] = w * basis[1, :, r]
        out.vectors[at, 2 * k : 2 * k + n] = U1 * V[0, :, r] + U0 * V[1, :, r]
        out.vectors[at + 1, 2 * k : 2 * k + 2 * n] = K[r]
        out.beside[at + 1] = -1.0
        out.numbers[:] += np.array([2, 1])


@compiled
def _entries(b: Boundary, fit: Fit, joints: Ints, vectors: Array) -> tuple[Ints, Ints, Array]:  # pragma: no cover
    """Entries of vectors over the local coordinates: column, unknown, value."""
    k, n = joints.size, b.points.size
    across, along = 1 - b.along, b.along
    held, points = b.joints[joints], b.points
    index = np.concatenate((held + along, held + across, points + along, points + across, b.angles))
    first = 2 * k + 2 * n
    turn = vectors[:, 2 * k : 2 * k + n] * fit.turns[0] + vectors[:, 2 * k + n : first] * fit.turns[1]
    turn = 0.5 * (turn + vectors[:, first:])
    local = np.zeros((len(vectors), index.size))
    local[:, :first] = vectors[:, :first]
    local[:, first:-1] += turn
    local[:, first + 1 :] += turn
    columns, at = np.nonzero(local)
    return columns, index[at], local.ravel()[columns * index.size + at]


@compiled
def fitted_columns(z: Array, b: Boundary, force: Array, closed: Flags, gradient: Array) -> Columns:  # pragma: no cover
    """Columns of the constrained joints marked ``closed`` (m,); adds the gradient of −Σ F g to ``gradient``."""
    n, joints, fit = b.points.size, np.flatnonzero(closed), fitted(z, b)
    k, K, w = joints.size, derivatives_of_fit(b, fit), b.sense * force[joints]
    most = 2 * k + 3 * n + 2 * (b.degree + 1)
    out = Local(np.zeros((most, 2 * k + 3 * n)), np.zeros(most), np.zeros(most), np.array([k, 0]))
    basis = basis_of(z[b.joints[joints] + b.along], fit.middle, fit.width, b.degree)
    values = b.sense * (z[b.joints[joints] + 1 - b.along] - basis[0] @ fit.q)
    out.vectors[:k, :k], out.vectors[:k, k : 2 * k] = np.diag(b.sense * (basis[1] @ fit.q)), -b.sense * np.eye(k)
    out.vectors[:k, 2 * k : 2 * k + 2 * n] = b.sense * (basis[0] @ K)
    if np.any(w != 0.0):
        _add_curvature(b, fit, out, K, w, basis)
    count, negative = out.numbers
    column, index, value = _entries(b, fit, joints, out.vectors[:count])
    for t in range(column.size):
        if column[t] < k:
            gradient[index[t]] += force[joints[column[t]]] * value[t]
    return Columns(values, negative, out.diagonal[:count], out.beside[:count], column, index, value)
