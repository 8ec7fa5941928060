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

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from skfem import BilinearForm, CellBasis, ElementLineP2, MeshLine

from cprbm_scene.answer import Array
from fea_reference.hermite import Index
from fea_reference.state import State

# the unknowns of an element move the chord (dx, dy), θ₁, θ₂ and N
_MOTIONS = np.array([0, 1, 2, 0, 1, 3, 4])
_SIGNS = np.array([-1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
_SIGNS_TWICE = (_SIGNS[:, None] * _SIGNS)[:, :, None]


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


@dataclass(frozen=True)
class Chords:
    """Chords of n elements in a state; the element is the last index.

    ``length`` l (n,), unit vectors ``ahead`` and ``across``, to the left, (2, n), end rotations ``rotation`` ϑ and
    ``bent`` Δ (2, n), ``slip`` c (2, n), ``shear`` γ (n,).
    """

    length: Array
    ahead: Array
    across: Array
    rotation: Array
    bent: Array
    slip: Array
    shear: Array

    @cached_property
    def shear_by(self) -> Array:
        """Derivatives (6, n) of γ by (x₁, y₁, θ₁, x₂, y₂, θ₂)."""
        leaning = (self.slip[0] + self.slip[1]) / self.length
        by = np.array([*(leaning * self.across), -self.slip[0], -self.slip[1]])
        return np.asarray(by[_MOTIONS[:6]] * _SIGNS[:6, None])

    @cached_property
    def shear_by_twice(self) -> Array:
        """Second derivatives (6, 6, n) of γ by the same unknowns."""
        (cos, sin), turned = self.ahead, (self.slip[0] + self.slip[1]) / self.length**2
        along, across = 2.0 * turned * cos * sin, turned * (sin * sin - cos * cos)
        twice = np.zeros((4, 4, turned.size))
        twice[:2, :2] = [[along, across], [across, -along]]
        return _by_nodes(twice, 6)


@dataclass(frozen=True, slots=True)
class ElementForces:
    """Derivatives of Π_e by (x₁, y₁, θ₁, x₂, y₂, θ₂, N); the element is the last index.

    ``gradient`` (7, n), ``energy`` the strain energy (n,), ``rotation`` ϑ (2, n), and ``hessian`` (7, 7, n), evaluated
    at the first call.
    """

    gradient: Array
    energy: Array
    rotation: Array
    hessian: Callable[[], Array]


def _by_nodes(twice: Array, count: int) -> Array:
    """Second derivatives (count, count, n) by the element's unknowns, from derivatives by its motions."""
    return np.asarray(twice[_MOTIONS[:count, None], _MOTIONS[:count]] * _SIGNS_TWICE[:count, :count])


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


def chords(elements: Elements, dofs: Index, state: State) -> Chords:
    """Chords of elements with unknowns ``dofs`` (7, n), in the order (x₁, y₁, θ₁, x₂, y₂, θ₂, N)."""
    dx, dy = state.difference(dofs[3:5], dofs[:2])
    l = np.hypot(dx, dy)  # noqa: E741 - the chord's length
    cos, sin = dx / l, dy / l
    turning = dofs[[2, 5]]
    rotation = _wrapped(state.values[turning] - np.arctan2(dy, dx)) + state.rest[turning]
    bent, slip = rotation - elements.rotation, elements.slip
    gamma = -(slip[0] * bent[0] + slip[1] * bent[1])
    return Chords(l, np.array([cos, sin]), np.array([-sin, cos]), rotation, bent, slip, gamma)


def forces(elements: Elements, chord: Chords, N: Array) -> ElementForces:
    """Forces and stiffness of elements with axial forces ``N`` (n,)."""
    l, (cos, sin), delta, gamma = chord.length, chord.ahead, chord.bent, chord.shear  # noqa: E741 - the chord's length
    slip, (quartic, mixed), stretched = elements.slip, elements.fourth, elements.compliance * elements.length
    bent, shortened = (K[:, 0] * delta[0] + K[:, 1] * delta[1] for K in (elements.bending, elements.shortening))
    strain_by_rotation = elements.slope + shortened + 2.0 * mixed * N * gamma * slip
    sheared = (4.0 * quartic * gamma**2 + mixed * N**2) * gamma
    moment = bent + N * strain_by_rotation - sheared * slip
    membrane, doubled = (elements.slope + 0.5 * shortened) * delta, delta * bent
    elongation = l - elements.chord + membrane[0] + membrane[1] - mixed * N * gamma**2
    energy = 0.5 * (doubled[0] + doubled[1] + stretched * N**2 + mixed * (N * gamma) ** 2) + quartic * gamma**4

    total = moment[0] + moment[1]
    V = total / l
    by_motions = np.array([N * cos + V * sin, N * sin - V * cos, *moment, elongation - stretched * N])

    @cache
    def hessian() -> Array:
        """By the chord d, with direction t and normal n: ∂ϑ = ∂θ − n·∂d/l, ∂l = t·∂d."""
        K = elements.bending + N * elements.shortening
        K = K + (12.0 * quartic * gamma**2 - mixed * N**2) * slip[:, None] * slip
        of_turn, (nx, ny) = K[0] + K[1], chord.across / l
        whole, lean = of_turn[0] + of_turn[1] + N * l, V / l
        xx, yy = whole * nx * nx - 2.0 * lean * cos * sin, whole * ny * ny + 2.0 * lean * cos * sin
        xy = whole * nx * ny + lean * (cos * cos - sin * sin)
        (x1, x2), (y1, y2), (s1, s2) = -of_turn * nx, -of_turn * ny, strain_by_rotation
        xN, yN = cos - (s1 + s2) * nx, sin - (s1 + s2) * ny
        by_N = -stretched - mixed * gamma**2
        rows = [xx, xy, x1, x2, xN], [xy, yy, y1, y2, yN], [x1, y1, *K[0], s1], [x2, y2, *K[1], s2]
        return _by_nodes(np.array([*rows, [xN, yN, s1, s2, by_N]]), 7)

    return ElementForces(by_motions[_MOTIONS] * _SIGNS[:, None], energy, chord.rotation, hessian)


def layer(elements: Elements, e: int) -> float:
    """√(EI/GA) of an element over its length; a constant section has a slip of ½ Φ/(1 + Φ), Φ = 12 EI/(GA L²)."""
    slip = float(elements.slip[:, e].mean())
    return float(np.sqrt(slip / (6.0 * (1.0 - 2.0 * slip))))


def _wrapped(angle: Array) -> Array:
    """The angle in [−π, π], without round-off if already there."""
    return np.asarray(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))
