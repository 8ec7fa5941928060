"""The paper's contact: related joints against a polynomial through offset points, eqs. (8)-(11).

==========  =====================================================================================
τ_i         ½(θ_{i−1} + θ_i), tangent at joint i of the boundary's beam, eq. (9)
b_i         p_i + ½(t₁+t₂)·n(τ_i), offset points towards the other beam, eq. (10); (A_i, B_i) along
            the axis of the fit and across it
V, q        Vandermonde matrix at A and the coefficients, least squares VᵀV q = VᵀB
P_q         the polynomial g_s; P_q', P_q'' its derivatives
a_j, o_j    a related joint of the other beam, along and across
c_j         ±(P_q(a_j) − o_j) ≤ 0, eq. (11)
μ           adjoint of the fit, VᵀV μ = −Σ λ_j φ(a_j), φ the basis
==========  =====================================================================================

The fit is done in Chebyshev polynomials over the present range of A: the curve is the same for any
basis, so that centre and width of the range are constants for the derivatives.

==========  =====================================================================================
L           Σ w_j (P_q(a_j) − o_j), w = ±λ
ρ           P_q(A_i) − B_i, what the fit misses its points by
U           μ·φ(A_i); U', U'' likewise
C, K        over (a, A, B): ∂²(L + μ·Vᵀ(V q − B))/∂z∂q, and ∂q/∂z
t           −∂L/∂A_i n_A − ∂L/∂B_i n_B, of n = (n_A, n_B) from p_i to b_i
==========  =====================================================================================

With dτ = ½(dθ_{i−1} + dθ_i) the second derivative of L is

    Σ w_j P_q''(a_j) da_j² + Σ (U''ρ + 2 U'P_q' + U P_q'') dA_i² − 2 U' dA_i dB_i + C K + Kᵀ Cᵀ + Σ t dτ_i².
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from scipy.linalg import lapack

from cprbm.first_contact import REAL, Factored, Group, Local
from cprbm.kinematics import Positions, State, behind
from cprbm.model import Model
from cprbm.offset_points import offset_vectors
from cprbm.once import once
from cprbm.related import related_joints
from cprbm_scene import BeamContact, Mistake, Scene, SceneError
from cprbm_scene.answer import Array, Ints
from cprbm_scene.clearance import overlap_at_rest

FEWEST_POINTS = 3
FEW = 100  # related joints, whose derivatives are products with a small matrix


@dataclass(frozen=True, eq=False)
class FittedBoundary:
    """One contact in the paper's form.

    Attributes:
        name: of the contact.
        degree: of the polynomial.
        along_x: whether g_s is a function of x (gap along y) or of y.
        sense: +1 where the constrained joints lie above the boundary along the gap's axis, −1 below.
        side: +1 where the offset points lie to the left of the boundary's beam, −1 to the right.
        offset: ½(t₁+t₂), zero for lines; units of length.
        joints: the constrained related joints (m,).
        points: the boundary's related joints (n,); links: the links around them (n+1,).
        arc: arc lengths on the contact's first beam: of the constrained joints (m,), or of the boundary's (n,).
        on_first: whether the constrained joints are the first beam's.
        behind: which links all these joints are behind, the constrained ones first, :func:`cprbm.kinematics.behind`;
            None where they are many.
    """

    name: str
    degree: int
    along_x: bool
    sense: float
    side: float
    offset: float
    joints: Ints
    points: Ints
    links: Ints
    arc: Array
    on_first: bool
    behind: Array | None

    @once
    def _local(self) -> tuple[Ints, Ints]:
        """Joints and angles of each row, (m, m + n) and (m, n + 1)."""
        joints = np.concatenate((self.joints, self.points))
        m = len(self.joints)
        return np.broadcast_to(joints, (m, len(joints))), np.broadcast_to(self.links, (m, len(self.links)))

    @once
    def _spans(self) -> tuple[slice, slice, slice]:
        """The related joints of both beams and the links, which are neighbours."""
        joints, points, links = (
            slice(int(each[0]), int(each[-1]) + 1) for each in (self.joints, self.points, self.links)
        )
        return joints, points, links

    @once
    def _keys(self) -> tuple[int, ...]:
        return tuple(self.joints.tolist())

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives.

        Raises:
            np.linalg.LinAlgError: the points do not determine the polynomial.
        """
        m, n = len(self.joints), len(self.points)
        joints, points, links = self._spans
        _, nx, ny = offset_vectors(state.theta[links], self.side * self.offset)
        bx, by = at.x[points] + nx, at.y[points] + ny
        if self.along_x:
            A, B, a, o = bx, by, at.x[joints], at.y[joints]
        else:
            A, B, a, o = by, bx, at.y[joints], at.x[joints]
        low, high = float(A.min()), float(A.max())
        centre, width = 0.5 * (high + low), 0.5 * (high - low)
        D = _derivative(self.degree) / width
        # the basis at points and joints, a row for each polynomial
        basis = _basis((np.concatenate((A, a)) - centre) / width, self.degree)
        V, at_joints = basis[:, :n], basis[:, n:]
        *_, inverse, failed = lapack.dgesv(V @ V.T, _identity(self.degree))
        if failed:
            raise np.linalg.LinAlgError("the points of a fitted boundary are too few or in one place")
        q_B = inverse @ V
        q = q_B @ B
        q1 = D @ q
        curve = np.array((q, q1, D @ q1)) @ basis
        (P, P1, P2), (g, g1, g2) = curve[:, :n], curve[:, n:]
        rest = P - B

        # dq over A and B, and with it the slopes of c over (a, o, A, B)
        V1 = D.T @ V
        q_AB = np.concatenate((-inverse @ (V1 * rest + V * P1), q_B), axis=1)
        over_AB = self.sense * (at_joints.T @ q_AB)
        # (A, B) over (x, y, τ) of the boundary's joints; τ halves onto two links
        normal = np.concatenate((nx, ny) if self.along_x else (ny, nx))
        half_tA, half_tB = (-0.5 * ny, 0.5 * nx) if self.along_x else (0.5 * nx, -0.5 * ny)

        def over_locals(k: int, over_AB: Array) -> tuple[Array, int, int]:
            """(A, B) to (x of ``k`` joints and the points, y of the same, θ of links), and where a and o begin."""
            over_A, over_B = over_AB[:, :n], over_AB[:, n:]
            found = np.zeros((len(over_AB), 2 * (k + n) + n + 1))
            along, across = (0, k + n) if self.along_x else (k + n, 0)
            found[:, along + k : along + k + n] = over_A
            found[:, across + k : across + k + n] = over_B
            half = over_A * half_tA
            half += over_B * half_tB
            found[:, -n - 1 : -1] = half
            found[:, -n:] += half
            return found, along, across

        slopes, along, across = over_locals(m, over_AB)
        diagonal, next_row = slopes.reshape(-1), slopes.shape[1] + 1
        diagonal[along : m * (next_row - 1) : next_row] = self.sense * g1
        diagonal[across : m * (next_row - 1) : next_row] = -self.sense

        def factors(multipliers: Array) -> Factored:
            pressing = multipliers.nonzero()[0]
            k = len(pressing)
            w, phi = self.sense * multipliers[pressing], at_joints[:, pressing]
            mu = -inverse @ (phi @ w)
            mu1 = D @ mu
            U, U1, U2 = np.array((mu, mu1, D @ mu1)) @ V
            # over (a, A, B)
            second, size = np.zeros((k + 2 * n, k + 2 * n)), k + 2 * n
            second[: k + n, k:] = np.concatenate((w * (D.T @ phi), U1 * V + U * V1), axis=1).T @ q_AB
            second += second.T
            flat = second.reshape(-1)
            flat[: k * size : size + 1] += w * g2[pressing]
            flat[k * (size + 1) : (k + n) * size : size + 1] += U2 * rest + 2.0 * U1 * P1 + U * P2
            flat[k * (size + 1) + n : (k + n) * size : size + 1] -= U1
            flat[(k + n) * (size + 1) - n :: size + 1] -= U1
            sigma, vectors, failed = lapack.dsyevd(second)
            if failed:
                raise np.linalg.LinAlgError("no eigenvalues of a boundary's second derivative")
            size_of = np.abs(sigma)
            real = (size_of > REAL * size_of.max()).nonzero()[0]
            over = vectors.T[real]
            columns, along, _ = over_locals(k, over[:, k:])
            columns[:, along : along + k] = over[:, :k]
            joints = np.concatenate((self.joints[pressing], self.points))
            links_behind = None if self.behind is None else np.concatenate((self.behind[pressing], self.behind[m:]))
            return Factored(
                Local(joints[None], self.links[None], columns, alike=True, behind=links_behind),
                sigma[real],
                # the offset points turn with τ: d²(A, B)/dτ² = −(nA, nB)
                turning=-((multipliers @ over_AB) * normal).reshape(2, n).sum(axis=0),
            )

        each, angles = self._local
        return (
            Group(
                contact=self.name,
                values=self.sense * (g - o),
                joints=each,
                angles=angles,
                slopes=slopes,
                curvature=lambda lam: factors(lam).blocks(),
                keys=self._keys,
                arc=self.arc if self.on_first else at_joints.T @ (q_B @ self.arc),
                shared=True,
                behind=self.behind,
                factors=factors,
            ),
        )

    def range_left(self, state: State, at: Positions) -> Array:
        """How far each constrained joint lies beyond the boundary's ends, (m,), units of length; ≤ 0 within."""
        A, _ = self._points(state, at)
        a = at.x[self.joints] if self.along_x else at.y[self.joints]
        return np.asarray(np.maximum(a - A.max(), A.min() - a))

    @property
    def approximates(self) -> bool:
        """Whether g_s has fewer coefficients than points to go through."""
        return self.degree + 1 < len(self.points)

    def misfit(self, state: State, at: Positions) -> float:
        """The most by which g_s misses the points that it is fitted to, along the gap's axis, units of length."""
        A, B = self._points(state, at)
        low, high = float(A.min()), float(A.max())
        V = _basis((A - 0.5 * (high + low)) / (0.5 * (high - low)), self.degree)
        q = np.linalg.solve(V @ V.T, V @ B)
        return float(np.abs(q @ V - B).max())

    def _points(self, state: State, at: Positions) -> tuple[Array, Array]:
        """A and B of the offset points, (n,) each."""
        _, nx, ny = offset_vectors(state.theta[self.links], self.side * self.offset)
        bx, by = at.x[self.points] + nx, at.y[self.points] + ny
        return (bx, by) if self.along_x else (by, bx)


@cache
def _identity(degree: int) -> Array:
    return np.eye(degree + 1)


@cache
def _derivative(degree: int) -> Array:
    """Coefficients of the polynomials' derivatives, column by column (degree+1, degree+1)."""
    found = np.zeros((degree + 1, degree + 1))
    found[:-1] = chebyshev.chebder(_identity(degree))
    return found


def _basis(at: Array, degree: int) -> Array:
    """Chebyshev polynomials up to ``degree`` ≥ 1 at some places (k,), (degree+1, k)."""
    values = np.empty((degree + 1, len(at)))
    values[0], values[1] = 1.0, at
    twice = at + at
    for i in range(2, degree + 1):
        np.multiply(twice, values[i - 1], out=values[i])
        values[i] -= values[i - 2]
    return values


def fitted_boundary(scene: Scene, model: Model, name: str, degree: int) -> FittedBoundary:
    """One of the scene's contacts in the paper's form.

    Raises:
        SceneError: the contact does not say what the paper's form must know, has too few related joints, or a
            thickness varies that it would need.
    """
    contact = scene.contacts[name]
    hints = contact.paper if isinstance(contact, BeamContact) else None
    if hints is None or not isinstance(contact, BeamContact):
        raise SceneError(
            [
                Mistake(
                    f"contacts.{name}.paper",
                    "nothing",
                    "the boundary's beam and the axis, which the formulation 'paper' must be told",
                    scene.file,
                )
            ]
        )
    for beam in contact.between:
        if contact.thick and scene.beams[beam].tapered:
            found = f"contact of two beams by the edges of {beam!r}, whose thickness varies"
            allowed = "thick = false, a beam of one thickness, or the formulation 'auto'"
            raise SceneError([Mistake(f"contacts.{name}.thick", found, allowed, scene.file)])
    other = next(beam for beam in contact.between if beam != hints.boundary)
    boundary, constrained = model.chain(hints.boundary), model.chain(other)
    points = related_joints(scene, name, boundary, FEWEST_POINTS)
    joints = related_joints(scene, name, constrained, FEWEST_POINTS)
    here, there = boundary.springs.only(points - 1), constrained.springs.only(joints - 1)
    dx = there.x[:, None] - here.x + (constrained.line.x0 - boundary.line.x0)
    dy = there.y[:, None] - here.y + (constrained.line.y0 - boundary.line.y0)
    nearest = divmod(int((dx * dx + dy * dy).argmin()), len(points))
    gap, tangent = (float(dx[nearest]), float(dy[nearest])), complex(here.tangent[nearest[1]])
    along_x = hints.axis == "y"
    half = 0.5 * (boundary.thickness + constrained.thickness) if contact.thick else 0.0
    first = model.chain(contact.between[0])
    numbers = np.concatenate((constrained.first_joint + joints, boundary.first_joint + points))
    return FittedBoundary(
        name=name,
        degree=min(degree, len(points) - 1),
        along_x=along_x,
        sense=1.0 if gap[1 if along_x else 0] > 0.0 else -1.0,
        side=1.0 if tangent.real * gap[1] - tangent.imag * gap[0] > 0.0 else -1.0,
        offset=half - overlap_at_rest(scene, contact) / model.unit_length,
        joints=constrained.first_joint + joints,
        points=boundary.first_joint + points,
        links=boundary.first_link + np.arange(points[0] - 1, points[-1] + 1),
        arc=constrained.s[joints] if first is constrained else boundary.s[points],
        on_first=first is constrained,
        behind=behind(model, numbers) if len(numbers) <= FEW else None,
    )
