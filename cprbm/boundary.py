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
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from cprbm.contact import Blocks, Group
from cprbm.kinematics import Positions, State
from cprbm.model import Model
from cprbm.offset_points import offset_vectors
from cprbm.related import related_joints
from scene import BeamContact, Mistake, Scene, SceneError
from scene.answer import Array, Ints

FEWEST_POINTS = 3


@dataclass(frozen=True, slots=True)
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

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        m, n = len(self.joints), len(self.points)
        _, nx, ny = offset_vectors(state.theta[self.links], self.side * self.offset)
        bx, by = at.x[self.points] + nx, at.y[self.points] + ny
        if self.along_x:
            A, B, a, o = bx, by, at.x[self.joints], at.y[self.joints]
        else:
            A, B, a, o = by, bx, at.y[self.joints], at.x[self.joints]
        centre, width = 0.5 * (A.max() + A.min()), 0.5 * (A.max() - A.min())
        at_points = _basis(A, centre, width, self.degree)
        at_joints = _basis(a, centre, width, self.degree)
        V = at_points[0]
        inverse = np.linalg.inv(V.T @ V)
        q = inverse @ (V.T @ B)
        P, P1, P2 = (basis @ q for basis in at_points)
        g, g1, g2 = (basis @ q for basis in at_joints)
        rest = P - B

        # dq over A and B, and with it the slopes of c over (a, o, A, B)
        q_A = -inverse @ (at_points[1].T * rest + V.T * P1)
        q_B = inverse @ V.T
        slopes = self.sense * np.hstack((np.diag(g1), -np.eye(m), at_joints[0] @ q_A, at_joints[0] @ q_B))
        # (A, B) over (x, y, τ) of the boundary's joints; τ halves onto two links
        nA, nB = (nx, ny) if self.along_x else (ny, nx)
        tA, tB = (-ny, nx) if self.along_x else (nx, -ny)

        def over_locals(over: Array) -> Array:
            """Columns (a, o, A, B) to columns (x of joints and points, y of the same, θ of links)."""
            over_a, over_o, over_A, over_B = np.split(over, [m, 2 * m, 2 * m + n], axis=1)
            along, across = np.hstack((over_a, over_A)), np.hstack((over_o, over_B))
            over_tau = over_A * tA + over_B * tB
            angles = np.zeros((len(over), n + 1))
            angles[:, :-1] += 0.5 * over_tau
            angles[:, 1:] += 0.5 * over_tau
            xy = (along, across) if self.along_x else (across, along)
            return np.hstack((*xy, angles))

        def curvature(multipliers: Array) -> Array:
            weights = self.sense * multipliers
            mu = -inverse @ (at_joints[0].T @ weights)
            U, U1, U2 = (basis @ mu for basis in at_points)
            second = np.zeros((2 * m + 2 * n, 2 * m + 2 * n))
            ia, iA, iB = np.arange(m), 2 * m + np.arange(n), 2 * m + n + np.arange(n)
            second[ia, ia] = weights * g2
            second[iA, iA] = U2 * rest + 2.0 * U1 * P1 + U * P2
            second[iA, iB] = second[iB, iA] = -U1
            over_q = np.zeros((2 * m + 2 * n, self.degree + 1))
            over_q[ia] = weights[:, None] * at_joints[1]
            over_q[iA] = U1[:, None] * V + U[:, None] * at_points[1]
            q_z = np.zeros((self.degree + 1, 2 * m + 2 * n))
            q_z[:, iA], q_z[:, iB] = q_A, q_B
            cross = over_q @ q_z
            second += cross + cross.T
            local = over_locals(over_locals(second).T)
            # the offset points turn with τ: d²(A, B)/dτ² = −(nA, nB)
            slope = weights @ (self.sense * slopes[:, 2 * m :])
            turning = -0.25 * (slope[:n] * nA + slope[n:] * nB)
            k = 2 * (m + n)
            i = np.arange(n)
            local[k + i, k + i] += turning
            local[k + i + 1, k + i + 1] += turning
            local[k + i, k + i + 1] += turning
            local[k + i + 1, k + i] += turning
            return local

        joints = np.concatenate((self.joints, self.points))
        return (
            Group(
                contact=self.name,
                values=self.sense * (g - o),
                joints=np.tile(joints, (m, 1)),
                angles=np.tile(self.links, (m, 1)),
                slopes=over_locals(slopes),
                curvature=lambda lam: Blocks(joints[None], self.links[None], curvature(lam)[None]),
                keys=tuple(int(j) for j in self.joints),
                arc=self.arc if self.on_first else at_joints[0] @ q_B @ self.arc,
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
        return float(np.max(np.abs(chebyshev.Chebyshev.fit(A, B, self.degree)(A) - B)))

    def _points(self, state: State, at: Positions) -> tuple[Array, Array]:
        """A and B of the offset points, (n,) each."""
        _, nx, ny = offset_vectors(state.theta[self.links], self.side * self.offset)
        bx, by = at.x[self.points] + nx, at.y[self.points] + ny
        return (bx, by) if self.along_x else (by, bx)


def _basis(at: Array, centre: float, width: float, degree: int) -> tuple[Array, Array, Array]:
    """Chebyshev polynomials up to ``degree`` and their two derivatives at some places, (k, degree+1) each."""
    scaled = (at - centre) / width
    values = np.asarray(chebyshev.chebvander(scaled, degree), dtype=float)
    identity = np.eye(degree + 1)
    first = np.zeros(values.shape)
    second = np.zeros(values.shape)
    if degree >= 1:
        first = np.asarray(chebyshev.chebvander(scaled, degree - 1) @ chebyshev.chebder(identity, 1) / width)
    if degree >= 2:
        second = np.asarray(chebyshev.chebvander(scaled, degree - 2) @ chebyshev.chebder(identity, 2) / width**2)
    return values, first, second


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
    points = related_joints(scene, model, name, boundary, FEWEST_POINTS)
    joints = related_joints(scene, model, name, constrained, FEWEST_POINTS)
    line = boundary.line
    x_p, y_p = line.position(boundary.s[points] * model.unit_length)
    x_j, y_j = constrained.line.position(constrained.s[joints] * model.unit_length)
    angle = line.angle(boundary.s[points] * model.unit_length)
    nearest = np.unravel_index(
        np.argmin((x_j[:, None] - x_p) ** 2 + (y_j[:, None] - y_p) ** 2), (len(joints), len(points))
    )
    gap = (x_j[nearest[0]] - x_p[nearest[1]], y_j[nearest[0]] - y_p[nearest[1]])
    tangent = (np.cos(angle[nearest[1]]), np.sin(angle[nearest[1]]))
    along_x = hints.axis == "y"
    half = 0.5 * (boundary.thickness + constrained.thickness) if contact.thick else 0.0
    first = model.chain(contact.between[0])
    return FittedBoundary(
        name=name,
        degree=min(degree, len(points) - 1),
        along_x=along_x,
        sense=1.0 if gap[1 if along_x else 0] > 0.0 else -1.0,
        side=1.0 if tangent[0] * gap[1] - tangent[1] * gap[0] > 0.0 else -1.0,
        offset=half,
        joints=constrained.first_joint + joints,
        points=boundary.first_joint + points,
        links=boundary.first_link + np.arange(points[0] - 1, points[-1] + 1),
        arc=constrained.s[joints] if first is constrained else boundary.s[points],
        on_first=first is constrained,
    )
