"""A beam's section along its arc length: thickness, bending stiffness, and what elements of it yield.

=========  ==============================================================================
s          arc length from the beam's start
t, w       thickness and width, straight lines between places
E·I        bending stiffness, I = w t³/12
f_i        ∫ ds/(E·I) over element i: how much it turns per unit of an even moment
=========  ==============================================================================

Integrals are sums over the lengths between elements' borders and the section's places,
by Gauss's rule.  1/(w t³) has its poles where the straight lines of t and w are zero: between places at which
neither more than doubles they lie beyond three halves of such a length from its middle, and the rule's error is
below (3 + √8)^(−2·12), less than round-off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.once import once
from cprbm_scene import Beam
from cprbm_scene.answer import Array

SAME = 1e-9  # of the thickness over the length: slopes that differ by less are one
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True, eq=False)
class Section:
    """Of one beam, lengths in units of length ℓ.

    Attributes:
        places: arc lengths (k,) between which t and w go straight and neither more than doubles.
        thickness, width: there (k,).
        modulus: E, in units of S and of length.
    """

    places: Array
    thickness: Array
    width: Array
    modulus: float

    def thickness_at(self, s: Array) -> Array:
        """t at arc lengths ``s`` (n,)."""
        if self.level:
            return np.full(s.shape, self.thickness[0])
        return np.asarray(np.interp(s, self.places, self.thickness))

    def thinning_at(self, s: Array) -> Array:
        """dt/ds at arc lengths ``s`` (n,); at a kink what follows."""
        if self.level:
            return np.zeros(s.shape)
        piece = np.clip(np.searchsorted(self.places, s, side="right") - 1, 0, len(self.places) - 2)
        return np.asarray((np.diff(self.thickness) / np.diff(self.places))[piece])

    @once
    def level(self) -> bool:
        """Whether the beam is as thick everywhere."""
        return float(self.thickness.min()) == float(self.thickness.max())

    @once
    def ridges(self) -> Array:
        """Arc lengths (k,) at which the edges have a corner that stands out."""
        steeper, least = self._steeper
        return np.asarray(self.places[1:-1][steeper < -least])

    @once
    def corners(self) -> Array:
        """Arc lengths (k,) at which the edges have a corner, whether that stands out or not."""
        steeper, least = self._steeper
        return np.asarray(self.places[1:-1][np.abs(steeper) > least])

    @once
    def _steeper(self) -> tuple[Array, float]:
        """By how much dt/ds steps at the inner places, and what is no step."""
        slopes = np.diff(self.thickness) / np.diff(self.places)
        return np.diff(slopes), SAME * float(self.thickness.max() / self.places[-1])

    def rigidity_at(self, s: Array) -> Array:
        """E·I at arc lengths ``s`` (n,), units of S and of length."""
        width = np.interp(s, self.places, self.width)
        return np.asarray(self.modulus * width * self.thickness_at(s) ** 3 / 12.0)

    @once
    def even(self) -> bool:
        """Whether the beam is as thick and as wide everywhere."""
        return self.level and float(self.width.min()) == float(self.width.max())

    def flexibility(self, borders: Array) -> Array:
        """f_i of the elements between ``borders`` (N+1,), ascending: (N,)."""
        if self.even:
            return (borders[1:] - borders[:-1]) / self.rigidity_at(borders[:1])
        ends = np.unique(np.concatenate((borders, self.places)))
        ends = ends[(ends >= borders[0]) & (ends <= borders[-1])]
        half = 0.5 * np.diff(ends)
        s = 0.5 * (ends[1:] + ends[:-1])[:, None] + half[:, None] * NODES
        parts = half * ((1.0 / self.rigidity_at(s.ravel())).reshape(s.shape) @ WEIGHTS)
        return np.asarray(np.add.reduceat(parts, np.searchsorted(ends, borders[:-1])))


def section_of(beam: Beam, youngs_modulus: float, length: float, unit_length: float, unit_moment: float) -> Section:
    """The section of a ``beam`` of a ``length`` in metres; its modulus in Pa."""
    fractions = u = beam.knots
    sizes = beam.thickness_at(u), beam.width_at(u)
    if any(ends.max() > 2.0 * ends.min() for ends in sizes):
        fractions = np.unique(np.concatenate([u, *(_between(u, ends) for ends in sizes)]))
        sizes = beam.thickness_at(fractions), beam.width_at(fractions)
    return Section(
        places=fractions * (length / unit_length),
        thickness=sizes[0] / unit_length,
        width=sizes[1] / unit_length,
        modulus=youngs_modulus * unit_length**3 / unit_moment,
    )


def _between(u: Array, sizes: Array) -> Array:
    """Fractions between the knots ``u`` (k,), between which ``sizes`` (k,) there do not more than double."""
    found = [np.zeros(0)]
    for k, doublings in enumerate(np.ceil(np.abs(np.log2(sizes[1:] / sizes[:-1]))).astype(int).tolist()):
        if doublings > 1:
            begin, stop = sizes[k : k + 2]
            between = np.geomspace(begin, stop, doublings + 1)[1:-1]
            found.append(u[k] + (u[k + 1] - u[k]) * (between - begin) / (stop - begin))
    return np.concatenate(found)


def largest_rigidity(beam: Beam, youngs_modulus: float) -> float:
    """The largest E·I of a beam at its places, N·m²."""
    u = beam.knots
    return youngs_modulus * float((beam.width_at(u) * beam.thickness_at(u) ** 3).max()) / 12.0
