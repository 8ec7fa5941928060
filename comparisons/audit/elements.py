"""A beam of finite elements: what its nodes' places, sections' angles and axial forces say of forces inside.

=========  =====================================================================================
l, α       length and angle of the chord between an element's nodes; l⁰ at rest
ϑ, Δ       the sections' angles against the chord (2,), and less those at rest ϑ⁰
F          what end moments turn the ends by, ∫ b bᵀ/(E·I) ds + (1, 1)ᵀ(1, 1) ∫ f ds/(GA)/L², b = (ξ − 1, ξ)
m          moments on the ends, F⁻¹ Δ + N ∂(½ ∫ w′² ds)/∂ϑ
w′         slope of the line against the chord, θ + γ less its mean, θ a parabola through ϑ
N, Q       axial force; shear force −(m₁ + m₂)/l
=========  =====================================================================================

The middle of the parabola is what makes bending and shear least: −¼ of the sum of the ends where nothing shears.
These are the equations of the answer's own discretisation, so that they hold to round-off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from comparisons.audit.rest import Complex, Rest
from cprbm_scene.answer import Array, Inside, Shape

PER_ELEMENT = 16
SHEAR_FACTOR = 5.0 / 6.0  # of a rectangle
LAYERS = np.array([1.0, 2.0, 4.0, 8.0, 16.0])  # between which f is smooth, and behind which it is one


@dataclass(frozen=True)
class ElementsOfBeam:
    """A beam in one state; ``kinematics`` says whether it stretches and shears."""

    rest: Rest
    inside: Inside
    shape: Shape
    kinematics: str

    @cached_property
    def nodes(self) -> Complex:
        """x + i·y (n+1,)."""
        return np.asarray(self.shape.x + 1j * self.shape.y)

    @cached_property
    def _sizes(self) -> Array:
        return np.diff(self.inside.borders)

    @cached_property
    def _at_rest(self) -> tuple[Complex, Array]:
        """Chords (n,) and angles ϑ⁰ (2, n)."""
        e = self.inside.borders
        chords, tangents = np.diff(self.rest.places(e)), self.rest.angles(e)
        return chords, _wrapped(np.stack((tangents[:-1], tangents[1:])) - np.angle(chords))

    @cached_property
    def _flexible(self) -> tuple[Array, Array, Array]:
        """F (2, 2, n), ∫ ds/(EA) and ∫ f ds/(GA) (n,)."""
        e, L, rest = self.inside.borders, self._sizes, self.rest
        number, s, _ = rest.over(e)
        xi = (s - e[number, None]) / L[number, None]
        EI, b = rest.rigidity(s), (xi - 1.0, xi)
        bending = np.array([[rest.summed(e, p * q / EI) for q in b] for p in b])
        EA = EI * 12.0 / rest.thickness(s) ** 2
        axial = rest.summed(e, 1.0 / EA)
        shear = self._leant() * 2.0 * (1.0 + rest.nu) / SHEAR_FACTOR
        axial = axial if self.kinematics in ("stretch", "shear") else 0.0 * axial
        return bending, axial, shear if self.kinematics == "shear" else 0.0 * shear

    def _leant(self) -> Array:
        """∫ f ds/(EA), (n,): of the shear beside an end only tanh²(s/(√2 a)) leans."""
        e, rest = self.inside.borders, self.rest
        start, end = (layer * LAYERS for layer in self.inside.upright)
        finer = np.unique(np.concatenate((e, e[0] + start, e[-1] - end)))
        finer = finer[(finer >= e[0]) & (finer <= e[-1])]
        s = rest.over(finer)[1]
        f = np.ones_like(s)
        for layer, away in zip(self.inside.upright, (s - e[0], e[-1] - s), strict=True):
            if layer > 0.0:
                f = f * np.tanh(away / (np.sqrt(2.0) * layer)) ** 2
        each = rest.summed(finer, f * rest.thickness(s) ** 2 / (12.0 * rest.rigidity(s)))
        number = np.searchsorted(e, 0.5 * (finer[1:] + finer[:-1]), side="right") - 1
        return np.asarray(np.bincount(number, each, len(e) - 1), dtype=float)

    @cached_property
    def _slopes(self) -> tuple[Array, Array]:
        """∫ w⁰′ ∂w′/∂ϑ ds (2, n) and ∫ ∂w′/∂ϑ ∂w′/∂ϑ ds (2, 2, n)."""
        bending, _, shear = self._flexible
        L = self._sizes
        turning = bending[0, 0] - 2.0 * bending[0, 1] + bending[1, 1]
        rest = self._at_rest[1]
        stiff, rigid = (_parabola(one / turning, L) for one in (shear, 0.0 * shear))
        x, w = np.polynomial.legendre.leggauss(4)
        xi, w = 0.5 * (1.0 + x), 0.5 * w
        shapes = np.stack((1.0 - 3.0 * xi + 2.0 * xi**2, 2.0 * xi**2 - xi, 4.0 * xi * (1.0 - xi)))
        shapes = shapes - (shapes @ w)[:, None]
        W = (shapes * w) @ shapes.T
        slope = np.einsum("kn,akn,ab,bjn->jn", rest, rigid, W, stiff) * L
        return slope, np.einsum("ain,ab,bjn->ijn", stiff, W, stiff) * L

    @cached_property
    def _chords(self) -> Complex:
        return np.diff(self.nodes)

    @cached_property
    def _turned(self) -> Array:
        """Δ (2, n)."""
        angles = self.inside.angles
        theta = _wrapped(np.stack((angles[:-1], angles[1:])) - np.angle(self._chords))
        return _wrapped(theta - self._at_rest[1])

    @cached_property
    def _moments(self) -> Array:
        """m (2, n)."""
        (F, _, shear), (slope, shortening) = self._flexible, self._slopes
        delta, L = self._turned, self._sizes
        F = F + shear / L**2
        determinant = F[0, 0] * F[1, 1] - F[0, 1] ** 2
        bent = np.stack((F[1, 1] * delta[0] - F[0, 1] * delta[1], F[0, 0] * delta[1] - F[0, 1] * delta[0]))
        return np.asarray(bent / determinant + self.inside.pulls * (slope + np.einsum("ijn,jn->in", shortening, delta)))

    @cached_property
    def forces(self) -> Complex:
        """Force that holds each element at its first node, x + i·y, (n,)."""
        m, chord = self._moments, self._chords
        size, ahead = np.abs(chord), chord / np.abs(chord)
        # the ends' moments turn the chord unless the nodes hold it across
        return np.asarray((-self.inside.pulls + 1j * (m[0] + m[1]) / size) * ahead)

    @property
    def cuts(self) -> tuple[Array, Complex, Array]:
        """First nodes of the elements: arc lengths, places, and the moment inside, (n,)."""
        return self.inside.borders[:-1], self.nodes[:-1], -self._moments[0]

    @property
    def strain_energy(self) -> float:
        """J."""
        (_, axial, _), N = self._flexible, self.inside.pulls
        (slope, shortening), delta = self._slopes, self._turned
        bent = self._moments - N * (slope + np.einsum("ijn,jn->in", shortening, delta))
        return float(0.5 * np.sum(delta * bent) + 0.5 * np.sum(axial * N**2))

    @property
    def stretching(self) -> Array:
        """By how much elements' lengths are wrong under their axial forces, m (n,)."""
        (_, axial, _), (slope, shortening) = self._flexible, self._slopes
        delta = self._turned
        longer = np.abs(self._chords) - np.abs(self._at_rest[0])
        longer += ((slope + 0.5 * np.einsum("ijn,jn->in", shortening, delta)) * delta).sum(axis=0)
        return np.asarray(longer - axial * self.inside.pulls)

    @property
    def rounding(self) -> float:
        """What round-off of the places leaves of a moment, N·m."""
        h, far = self._sizes, float(np.max(np.abs(self.nodes))) + self.rest.length
        EI = self.rest.rigidity(self.inside.borders[:-1])
        return float(np.max(40.0 * np.finfo(float).eps * EI / h * (far / h + np.max(np.abs(self.inside.angles)))))

    @property
    def ends(self) -> tuple[tuple[complex, float], tuple[complex, float]]:
        """Place and turning of the section from rest of the start and of the end."""
        turned = self.inside.angles - self.rest.angles(self.inside.borders)
        return (complex(self.nodes[0]), float(turned[0])), (complex(self.nodes[-1]), float(turned[-1]))

    def line(self, s: Array) -> tuple[Complex, Array]:
        """Places and tangent angles at arc lengths ``s`` (k,): cubics by nodes and, of what shears, tangents there."""
        e, L = self.inside.borders, self._sizes
        n = len(L)
        number = np.clip(np.searchsorted(e, s, side="right") - 1, 0, n - 1)
        xi = (s - e[number]) / L[number]
        tangents = self.inside.angles + self._leaning
        turned = np.diff(tangents)
        speed = (L * (1.0 + turned**2 / 48.0) + self._flexible[1] * self.inside.pulls)[number]
        t1, t2 = speed * np.exp(1j * tangents[number]), speed * np.exp(1j * tangents[number + 1])
        step = self._chords[number]
        b, a = 3.0 * step - 2.0 * t1 - t2, t1 + t2 - 2.0 * step
        ahead = t1 + xi * (2.0 * b + 3.0 * xi * a)
        return np.asarray(self.nodes[number] + xi * (t1 + xi * (b + xi * a))), np.asarray(np.angle(ahead))

    @cached_property
    def _leaning(self) -> Array:
        """Of the line's tangents against the sections at the nodes, the mean of the elements beside, (n+1,)."""
        _, _, shear = self._flexible
        gamma = -(self._moments.sum(axis=0)) * shear / self._sizes**2
        return np.concatenate((gamma[:1], 0.5 * (gamma[1:] + gamma[:-1]), gamma[-1:]))

    @cached_property
    def fine(self) -> Array:
        """Arc lengths of a fine line, nodes among them."""
        e = self.inside.borders
        parts = e[:-1, None] + self._sizes[:, None] * (np.arange(PER_ELEMENT) / PER_ELEMENT)
        return np.append(parts.ravel(), e[-1])

    def misplaced(self, acting: Array) -> float:
        """By how much lengths are wrong, m; of elements that shear only where nothing is ``acting`` on them, (k,) m.

        A force between nodes bows what shears by more than its ends tell.
        """
        off = self.stretching
        if self.kinematics == "shear":
            e = self.inside.borders
            off[np.unique(np.clip(np.searchsorted(e, acting, side="right") - 1, 0, len(e) - 2))] = 0.0
        return float(np.max(np.abs(off)))


def _parabola(ratio: Array, L: Array) -> Array:
    """θ at both ends and in the middle by the ends' angles, (3, 2, n).

    With θ = a N₁ + b N₂ + c N₃ the middle c makes ½ E·I ∫ θ′² ds + ½ (GA/L) (∫ θ ds)² stationary; ``ratio`` is that of
    E·I to GA.
    """
    # ∫ θ′² ds L: of the ends' functions with the middle's −8/3, of the middle's 16/3; means 1/6, 1/6, 2/3
    middle = -(-8.0 / 3.0 * ratio / L**2 + 1.0 / 9.0) / (16.0 / 3.0 * ratio / L**2 + 4.0 / 9.0)
    ends = np.broadcast_to(np.eye(2)[:, :, None], (2, 2, len(L)))
    return np.concatenate((ends, np.broadcast_to(middle, (1, 2, len(L)))), axis=0)


def _wrapped(angle: Array) -> Array:
    return np.asarray(angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi)))
