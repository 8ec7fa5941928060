"""Corotational beam element with an independent axial force.

=======  =====================================================================================
symbol   meaning (lengths over the longest beam, forces over EI/length²)
=======  =====================================================================================
l, α     length and angle of the chord between an element's nodes
ϑ        end rotations against the chord, (2,); ϑ⁰ of the undeformed curve's tangents
Δ        ϑ − ϑ⁰
L, l⁰    arc length of the undeformed element, and its chord
θ(s)     rotation of the section against the chord: a parabola through both ends
γ        shear angle, one per element: w' = θ + γ, and w is zero at both ends, so γ = −∫θ ds / L
N        axial force, an independent unknown
c_N      axial compliance, the mean of 1/(EA), zero for an inextensible beam
EI, GA   bending stiffness; effective shear stiffness k_s G A, k_s = 5/6; both may vary along the element
F        flexibility of the end rotations, :mod:`fea_reference.section`; K = F⁻¹
c        slip, γ by −Δ: the shear force is −(1, 1)·K Δ / L, so that c = (1, 1)·K ∫ ds/(GA) / L²
=======  =====================================================================================

The element's contribution to the Hellinger–Reissner functional is

    Π_e = ½ Δᵀ K Δ + N [ (l − l⁰) + ½ ∫ (w'² − w⁰'² − (1 − 2 GA c_N) γ²) ds ] − ½ c_N L N²
          + L [ (⅓ − ½ GA c_N) GA γ⁴ − ½ (1 − GA c_N) c_N N² γ² ],

with the membrane strain averaged over the element (a shallow arch on its chord). A curved element therefore neither
locks nor shortens by its own curvature. The parabola's middle value makes the energy of bending and shear stationary,
with the element's mean compliances. Without shear w is the Hermite cubic, whatever EI does, and (½/L) ∫ w'² ds =
(2ϑ₁² − ϑ₁ϑ₂ + 2ϑ₂²)/30.

The term in γ² makes Reissner's beam (ZAMP 23, 1972) the limit of fine elements, with strains along and across the
section. Let the line have the stretch λ and lean from the section's normal by γ. Then the strains are λ cos γ − 1 and
λ sin γ, and to second order

    ½ EA (λ cos γ − 1)² + ½ GA (λ sin γ)² ≈ ½ EA (λ − 1 − ½ γ²)² + ½ GA γ² + GA (λ − 1) γ²,

where λ − 1 is N c_N up to a term in γ². Without the term, N acts along the line (Engesser's beam), and displacements
differ by N/GA of the share of shear. Without the terms of fourth order in γ and N they differ by ⅔ γ² of this share,
which no mesh shows. With λ eliminated by N all orders are N + ½ EA − ½ (N + EA cos γ)²/(EA cos² γ + GA sin² γ).

Corotational kinematics: Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, ch. 7.
"""

from dataclasses import dataclass

import numpy as np
from skfem import BilinearForm, CellBasis, ElementLineP2, MeshLine

from cprbm_scene.answer import Array
from fea_reference.hermite import Index
from fea_reference.state import State


@dataclass(frozen=True, slots=True)
class Elements:
    """Undeformed data of n elements; the element is the last index of every array.

    ``length`` L, ``chord`` l⁰, ``compliance`` c_N (n,); ``slip`` c, ``rotation`` ϑ⁰, ``slope`` ∫ w⁰' ∂w'/∂Δ ds (2,
    n); ``bending`` K, ``shortening`` ∫ (∂w'/∂Δ ∂w'/∂Δ − (1 − 2 GA c_N) ∂γ/∂Δ ∂γ/∂Δ) ds (2, 2, n). The rows of
    ``fourth`` (2, n) are the factors of γ⁴ and −½ N² γ², zero in elements with a moment between nodes.
    """

    length: Array
    chord: Array
    compliance: Array
    slip: Array
    rotation: Array
    slope: Array
    bending: Array
    shortening: Array
    fourth: Array


@dataclass(frozen=True, slots=True)
class ElementForces:
    """Derivatives of Π_e by (x₁, y₁, θ₁, x₂, y₂, θ₂, N); the element is the last index.

    ``gradient`` (7, n), ``hessian`` (7, 7, n), ``energy`` the strain energy (n,), ``rotation`` ϑ (2, n).
    """

    gradient: Array
    hessian: Array
    energy: Array
    rotation: Array


def reference(
    mesh: MeshLine,
    points: Array,
    tangents: Array,
    flexibility: Array,
    axial: Array,
    shear: Array,
) -> Elements:
    """Undeformed data of the elements, integrated over the beams.

    Args:
        mesh: lines with the arc length as their only coordinate.
        points: nodes (m, 2); tangents: tangent angles at the nodes (m,).
        flexibility: F without shear (2, 2, n); axial: ∫ ds/(EA); shear: ∫ ds/(GA), of every element (n,).
    """
    basis = CellBasis(mesh, ElementLineP2(), intorder=4)
    D = _local(BilinearForm(lambda u, v, _: u.grad[0] * v.grad[0]), basis)
    G = _local(BilinearForm(lambda u, v, _: u * v), basis)
    m = G.sum(axis=1)  # ∫ of each function; the functions sum to one
    L = m.sum(axis=0)

    chord = points[mesh.t[1]] - points[mesh.t[0]]
    alpha = np.arctan2(chord[:, 1], chord[:, 0])
    rotation = _wrapped(tangents[mesh.t] - alpha)

    # for a constant moment Δ = (−1, 1) is a rotation by ∫ ds/(EI)
    turning = flexibility[0, 0] - flexibility[0, 1] - flexibility[1, 0] + flexibility[1, 1]
    stiff, rigid = (_section_rotation(D, m, compliance / turning) for compliance in (shear, 0.0 * shear))
    K = _inverse(flexibility + shear / L**2)
    stretch = np.divide(axial, shear, out=np.zeros_like(L), where=shear > 0.0)  # GA c_N
    slope = np.einsum("kn,akn,abn,bjn->jn", rotation, rigid, G, stiff)  # ∫ w⁰' ds = 0
    shortening = np.einsum("ain,abn,bjn->ijn", stiff, G - 2.0 * (1.0 - stretch) * m[:, None] * m / L, stiff)
    quartic = np.divide(L**2 * (1.0 / 3.0 - 0.5 * stretch), shear, out=np.zeros_like(L), where=shear > 0.0)
    fourth, slip = np.array([quartic, (1.0 - stretch) * axial]), shear / L**2 * K.sum(axis=0)
    return Elements(L, np.hypot(*chord.T), axial / L, slip, rotation, slope, K, shortening, fourth)


def _local(form: BilinearForm, basis: CellBasis) -> Array:
    """Local matrices (3, 3, n) of a symmetric form."""
    return np.moveaxis(np.asarray(form.coo_data(basis).tolocal(), dtype=float), 0, -1)


def _inverse(F: Array) -> Array:
    """Inverses of symmetric matrices (2, 2, n)."""
    return np.asarray(np.array([[F[1, 1], -F[0, 1]], [-F[1, 0], F[0, 0]]]) / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]))


def _section_rotation(D: Array, m: Array, ratio: Array) -> Array:
    """θ at both ends and in the middle by the end rotations, (3, 2, n); ``ratio`` is EI/GA (n,).

    The middle value makes the energy ½ EI θᵀ D θ + ½ (GA/L) (mᵀθ)² stationary: the derivative by the middle value,
    divided by GA/L.
    """
    flexibility = ratio * m.sum(axis=0)
    middle = -(flexibility * D[2, :2] + m[2] * m[:2]) / (flexibility * D[2, 2] + m[2] ** 2)
    return np.concatenate([np.broadcast_to(np.eye(2)[:, :, None], (2, 2, middle.shape[-1])), middle[None]], axis=0)


def forces(elements: Elements, dofs: Index, state: State) -> ElementForces:
    """Forces and stiffness of elements with unknowns ``dofs`` (7, n), in the order (x₁, y₁, θ₁, x₂, y₂, θ₂, N)."""
    dx, dy = state.difference(dofs[3:5], dofs[:2])
    l = np.hypot(dx, dy)  # noqa: E741 - the chord's length
    theta = _wrapped(state[dofs[[2, 5]]] - np.arctan2(dy, dx)) + state.rest[dofs[[2, 5]]]
    delta = theta - elements.rotation
    N, slip, (quartic, mixed) = state[dofs[6]], elements.slip, elements.fourth
    gamma = -(slip * delta).sum(axis=0)

    bent = np.einsum("ijn,jn->in", elements.bending, delta)
    shortened = np.einsum("ijn,jn->in", elements.shortening, delta)
    strain_by_rotation = elements.slope + shortened + 2.0 * mixed * N * gamma * slip
    moment = bent + N * strain_by_rotation - (4.0 * quartic * gamma**3 + mixed * N**2 * gamma) * slip
    elongation = l - elements.chord + ((elements.slope + 0.5 * shortened) * delta).sum(axis=0) - mixed * N * gamma**2
    energy = 0.5 * (
        (delta * bent).sum(axis=0) + elements.compliance * elements.length * N**2 + mixed * (N * gamma) ** 2
    )

    r, z, turn = _chord(dx, dy, l)
    total = moment.sum(axis=0)

    gradient = N * r + np.einsum("in,ian->an", moment, turn)
    gradient[6] += elongation - elements.compliance * elements.length * N
    rz = r[:, None] * z[None, :]
    stiffness = (
        elements.bending + N * elements.shortening + (12.0 * quartic * gamma**2 - mixed * N**2) * slip[:, None] * slip
    )
    turned = np.einsum("ijn,jbn->ibn", stiffness, turn)
    H = np.einsum("ian,ibn->abn", turn, turned)
    H += N / l * (z[:, None] * z[None, :]) + total / l**2 * (rz + rz.transpose(1, 0, 2))
    coupling = r + np.einsum("in,ian->an", strain_by_rotation, turn)
    H[6] += coupling
    H[:, 6] += coupling
    H[6, 6] -= elements.compliance * elements.length + mixed * gamma**2
    return ElementForces(gradient, H, energy + quartic * gamma**4, theta)


@dataclass(frozen=True, slots=True)
class Shear:
    """Derivatives of γ of n elements, ``by`` (6, n) and ``by_twice`` (6, 6, n) the nodes' (x, y, θ)."""

    by: Array
    by_twice: Array


def shear(elements: Elements, part: slice | Index, dofs: Index, state: State) -> Shear:
    """Derivatives of γ for the elements ``part``, with unknowns ``dofs`` (7, n)."""
    dx, dy = state.difference(dofs[3:5], dofs[:2])
    l, slip = np.hypot(dx, dy), elements.slip[:, part]  # noqa: E741 - the chord's length
    r, z, turn = _chord(dx, dy, l)
    rz = r[:6, None] * z[None, :6]
    by_twice = -slip.sum(axis=0) / l**2 * (rz + rz.transpose(1, 0, 2))
    return Shear(-np.einsum("in,ian->an", slip, turn[:, :6]), by_twice)


def shear_angle(elements: Elements, part: slice, dofs: Index, state: State) -> Array:
    """γ (n,) of the elements ``part``, with unknowns ``dofs`` (7, n)."""
    dx, dy = state.difference(dofs[3:5], dofs[:2])
    theta = _wrapped(state[dofs[[2, 5]]] - np.arctan2(dy, dx)) + state.rest[dofs[[2, 5]]]
    return np.asarray(-(elements.slip[:, part] * (theta - elements.rotation[:, part])).sum(axis=0))


def layer(elements: Elements, e: int) -> float:
    """√(EI/GA) of an element over its length; a constant section has a slip of ½ Φ/(1 + Φ), Φ = 12 EI/(GA L²)."""
    slip = float(elements.slip[:, e].mean())
    return float(np.sqrt(slip / (6.0 * (1.0 - 2.0 * slip))))


def _chord(dx: Array, dy: Array, l: Array) -> tuple[Array, Array, Array]:  # noqa: E741 - the chord's length
    """Derivatives of the chord, l by the unknowns r (7, n), α z/l (7, n), and ϑ (2, 7, n)."""
    cos, sin, zero = dx / l, dy / l, np.zeros_like(l)
    r = np.array([-cos, -sin, zero, cos, sin, zero, zero])
    z = np.array([sin, -cos, zero, -sin, cos, zero, zero])
    turn = np.zeros((2, *r.shape))
    turn[:] = -z / l
    turn[0, 2] += 1.0
    turn[1, 5] += 1.0
    return r, z, turn


def _wrapped(angle: Array) -> Array:
    """The angle in [−π, π], without round-off if already there."""
    return np.asarray(angle - 2 * np.pi * np.round(angle / (2 * np.pi)))
