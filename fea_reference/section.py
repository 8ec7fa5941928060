"""Flexibility of beam elements with a varying rectangular section.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
s, ξ    arc length within an element of length L, ξ = s/L
t, w    thickness and width; A = w t, I = w t³/12
m       end moments (m₁, m₂) of an element for end rotations Δ
M, Q    bending moment and shear force: M = −(1 − ξ) m₁ + ξ m₂, Q = −(m₁ + m₂)/L
N       axial force
f       shear reduction, 1/(GA) → f/(GA): one except near some held ends (:mod:`fea_reference.upright`)
======  =====================================================================================

An element without load between its nodes has a linear moment for any section. By Castigliano's theorem Δ = F m with

    F = ∫ b bᵀ/(EI) ds + (1/L²) (1, 1)ᵀ(1, 1) ∫ f ds/(GA),     b = (−(1 − ξ), ξ),

and the elongation is N ∫ ds/(EA). The element is exact for small deflections on any mesh, also with kinks of
thickness or width inside (Przemieniecki, Theory of Matrix Structural Analysis, ch. 5, for a constant section). The
integrals run over pieces without kinks, in which neither size more than doubles.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Beam, Material

SHEAR_FACTOR = 5.0 / 6.0  # of a rectangle
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_GRADED = np.array([1.0, 2.0, 4.0, 8.0, 16.0])  # layers: f is one beyond, up to 1e-9


@dataclass(frozen=True, slots=True)
class Compliance:
    """Compliance of n equal elements of a beam: bending F without shear (2, 2, n), axial and shear (n,), SI.

    ``axial`` and ``shear`` are ∫ ds/(EA) and ∫ f ds/(GA), the latter with the shear factor.
    """

    bending: Array
    axial: Array
    shear: Array


def bending_stiffness(beam: Beam, material: Material, u: Array) -> Array:
    """EI (k,) at fractions ``u`` (k,) of the arc length, N·m²."""
    return np.asarray(material.youngs_modulus * beam.width_at(u) * beam.thickness_at(u) ** 3 / 12.0)


def bending_stiffness_second(beam: Beam, material: Material, u: Array) -> Array:
    """∂²EI/∂u² at fractions ``u`` (k,), N·m²; at a knot the value behind: E/12 (6 w t t'² + 6 w' t² t')."""
    knots = beam.knots
    piece = np.clip(np.searchsorted(knots, u, side="right") - 1, 0, len(knots) - 2)
    t1, w1 = ((np.diff(size(knots)) / np.diff(knots))[piece] for size in (beam.thickness_at, beam.width_at))
    t, w = beam.thickness_at(u), beam.width_at(u)
    return np.asarray(0.5 * material.youngs_modulus * t * t1 * (w * t1 + w1 * t))


def compliance(beam: Beam, material: Material, length: float, n: int, upright: tuple[float, float]) -> Compliance:
    """Compliance of ``n`` equal elements of a beam of ``length`` (m).

    ``upright`` are the widths (m) of shear boundary layers at start and end, zero without a layer.
    """
    grades = [_graded(layer / length) for layer in upright]
    edges = np.unique(np.concatenate([_pieces(beam, n), grades[0], 1.0 - grades[1]]))
    half = 0.5 * np.diff(edges)
    u = 0.5 * (edges[1:] + edges[:-1]) + half * _POINTS[:, None]
    element = np.minimum((0.5 * (edges[1:] + edges[:-1]) * n).astype(np.int64), n - 1)
    xi = u * n - element
    ds = half * length * _WEIGHTS[:, None]

    def summed(integrand: Array) -> Array:
        return np.asarray(np.bincount(element, weights=(integrand * ds).sum(axis=0), minlength=n), dtype=float)

    axial = 1.0 / (beam.width_at(u) * beam.thickness_at(u) * material.youngs_modulus)
    b = np.stack([xi - 1.0, xi])
    EI = bending_stiffness(beam, material, u)
    bending = np.array([[summed(b[i] * b[j] / EI) for j in range(2)] for i in range(2)])
    shear = axial * 2.0 * (1.0 + material.poisson_ratio) / SHEAR_FACTOR
    for layer, away in zip(upright, (u, 1.0 - u), strict=True):
        if layer:
            shear = shear * shear_reduction(away * length / layer)
    return Compliance(bending, summed(axial), summed(shear))


def shear_reduction(x: Array) -> Array:
    """f at ``x`` (k,) layers a from a held section: tanh²(x/√2)."""
    return np.asarray(np.tanh(x / np.sqrt(2.0)) ** 2)


def _graded(layer: float) -> Array:
    """Ends (k,) of integration pieces for f, for a unit beam with a ``layer`` at its end."""
    places = layer * _GRADED
    return np.asarray(places[(places > 0.0) & (places < 1.0)])


def _pieces(beam: Beam, n: int) -> Array:
    """Ends of pieces within elements and between knots, halved until no size more than doubles in a piece."""
    edges = np.union1d(np.arange(n + 1) / n, beam.knots)
    while True:
        sizes = np.stack([beam.thickness_at(edges), beam.width_at(edges)])
        ratio = sizes[:, 1:] / sizes[:, :-1]
        steep = np.any((ratio > 2.0) | (ratio < 0.5), axis=0)
        if not steep.any():
            return edges
        edges = np.union1d(edges, 0.5 * (edges[1:] + edges[:-1])[steep])
