"""A beam free of stress, by its arc length: places, tangent angles, bending stiffness and what elements yield; SI."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comparisons.geometry import length
from cprbm_scene import Beam, Scene
from cprbm_scene.answer import Array, Ints
from cprbm_scene.geometry import points_on, tangents_on

Complex = NDArray[np.complex128]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


@dataclass(frozen=True)
class Rest:
    """One beam of a scene, its Young's modulus ``E``, Pa, and Poisson's ratio ``nu``."""

    name: str
    beam: Beam
    E: float
    nu: float

    @cached_property
    def length(self) -> float:
        """Of the neutral line, m."""
        return length(self.beam.curve)

    def places(self, s: Array) -> Complex:
        """x + i·y at arc lengths ``s`` (k,), m."""
        x, y = points_on(self.beam.curve, np.clip(s / self.length, 0.0, 1.0)).T
        return np.asarray(x + 1j * y)

    def angles(self, s: Array) -> Array:
        """Tangent angles at ascending arc lengths ``s`` (k,), counted on from the first, rad."""
        x, y = tangents_on(self.beam.curve, np.clip(s / self.length, 0.0, 1.0)).T
        return np.unwrap(np.arctan2(y, x))

    def rigidity(self, s: Array) -> Array:
        """E·I at arc lengths ``s`` (k,), N·m²."""
        u = np.clip(s / self.length, 0.0, 1.0)
        return np.asarray(self.E * self.beam.width_at(u) * self.beam.thickness_at(u) ** 3 / 12.0)

    def thickness(self, s: Array) -> Array:
        """At arc lengths ``s``, m, in the same shape."""
        return self.beam.thickness_at(np.clip(s / self.length, 0.0, 1.0))

    def over(self, borders: Array) -> tuple[Ints, Array, Array]:
        """Of what lies between ``borders`` (n+1,): number (m,), arc lengths and weights (m, 16) to integrate by.

        Between two borders, and knots of the section, no size more than grows by half.
        """
        ends = np.union1d(borders, self.beam.knots * self.length)
        ends = ends[(ends >= borders[0]) & (ends <= borders[-1])]
        while True:
            EI = self.rigidity(ends)
            steep = (EI[1:] > 3.0 * EI[:-1]) | (EI[:-1] > 3.0 * EI[1:])
            if not steep.any():
                break
            ends = np.union1d(ends, 0.5 * (ends[1:] + ends[:-1])[steep])
        middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
        number = np.clip(np.searchsorted(borders, middle) - 1, 0, len(borders) - 2)
        return number, middle[:, None] + half[:, None] * _NODES, half[:, None] * _WEIGHTS

    def summed(self, borders: Array, integrand: Array) -> Array:
        """What an ``integrand`` (m, 16) at the places of :meth:`over` comes to between the borders, (n,)."""
        number, _, weights = self.over(borders)
        return np.asarray(np.bincount(number, (integrand * weights).sum(axis=1), len(borders) - 1), dtype=float)


def coordinates(places: Complex) -> Array:
    """Complex places of any shape as coordinates, (…, 2)."""
    return np.stack((places.real, places.imag), axis=-1)


def rests_of(scene: Scene) -> dict[str, Rest]:
    """All beams of a scene."""
    found = {}
    for name, beam in scene.beams.items():
        material = scene.materials[beam.material]
        found[name] = Rest(name, beam, material.youngs_modulus, material.poisson_ratio)
    return found
