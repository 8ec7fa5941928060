"""A beam of links: its joints, its smooth line and its springs' moments, from the links' angles.

==========  ==============================================================================
e_j, s_j    arc lengths of the elements' borders; of the springs, in the middle of each element
L_i, θ_i    length and angle of link i, the chord of the stress-free line between two joints; θ_i⁰ stress-free
δ_j, Θ_j    what spring j has turned by; turning of element j, Θ_j⁰ + δ_j, from border to border
M_j         δ_j/f_j with f_j = ∫ ds/(E·I) over element j
R           radius of the arc over h/Θ that goes on from the tangent at a border
==========  ==============================================================================

The smooth line is that of the answer's own discretisation: a link carries its part of the stress-free line, and to
that is added by what the arcs of Θ and Θ⁰ from the border differ, with

    R = y cot y · sin x/x + y (1 − cos x)/x,    x = Θ⁰/2,    y = Θ/2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from comparisons.audit.rest import Complex, Rest
from cprbm_scene.answer import Array, Inside, Shape

SMALL = 1e-4  # rad: below this two terms of a series are exact
PER_HALF = 8  # places of the fine line in half of an element


@dataclass(frozen=True)
class Links:
    """A beam in one state."""

    rest: Rest
    inside: Inside
    shape: Shape

    @cached_property
    def joints_at(self) -> Array:
        """0, s_j, and the length, (n+2,)."""
        e = self.inside.borders
        return np.concatenate(([0.0], 0.5 * (e[1:] + e[:-1]), [self.rest.length]))

    @cached_property
    def _chords(self) -> Complex:
        return np.diff(self.rest.places(self.joints_at))

    @cached_property
    def start(self) -> complex:
        """The first joint, which the shape begins at."""
        return complex(self.shape.x[0], self.shape.y[0])

    @cached_property
    def joints(self) -> Complex:
        """x + i·y of the joints (n+2,)."""
        steps = np.abs(self._chords) * np.exp(1j * self.inside.angles)
        return np.asarray(self.start + np.concatenate(([0.0], np.cumsum(steps))))

    @cached_property
    def turned(self) -> Array:
        """δ_j (n,)."""
        return np.diff(self.inside.angles) - np.diff(np.unwrap(np.angle(self._chords)))

    @cached_property
    def flexibility(self) -> Array:
        """f_j (n,)."""
        e = self.inside.borders
        _, s, _ = self.rest.over(e)
        return self.rest.summed(e, 1.0 / self.rest.rigidity(s))

    @property
    def cuts(self) -> tuple[Array, Complex, Array]:
        """Where the moment is known, (n,): arc lengths, places, and M by the shape."""
        return self.joints_at[1:-1], self.joints[1:-1], self.turned / self.flexibility

    @property
    def strain_energy(self) -> float:
        """J."""
        return float(0.5 * np.sum(self.turned**2 / self.flexibility))

    @property
    def rounding(self) -> float:
        """What round-off leaves of a moment, N·m."""
        return float(4.0 * np.finfo(float).eps * np.max(1.0 + np.abs(self.inside.angles)) / self.flexibility.min())

    @property
    def blurred(self) -> Array:
        """What round-off of places leaves of the moments of ``cuts`` beside that, N·m (n,): directions of short chords.

        An end of a chord is known to four units in the last place, and each turning takes two chords.
        """
        far, chords = np.abs(self.rest.places(self.joints_at)), np.abs(self._chords)
        off = 4.0 * np.finfo(float).eps * (far[1:] + far[:-1]) / chords
        return np.asarray((off[1:] + off[:-1]) / self.flexibility)

    @property
    def ends(self) -> tuple[tuple[complex, float], tuple[complex, float]]:
        """Place and turning from rest of the start and of the end."""
        turned = self.inside.angles - np.angle(self._chords)
        return (complex(self.joints[0]), float(turned[0])), (complex(self.joints[-1]), float(turned[-1]))

    def line(self, s: Array) -> tuple[Complex, Array]:
        """Places and tangent angles of the smooth line at arc lengths ``s`` (k,)."""
        e, joints = self.inside.borders, self.joints_at
        link = np.clip(np.searchsorted(joints, s, side="right") - 1, 0, len(self._chords) - 1)
        n = len(e) - 1
        element = np.clip(np.where(s < e[link], link - 1, link), 0, n - 1)
        h = np.diff(e)[element]
        off = s - e[link]
        borders = self.rest.angles(e)
        chord = np.angle(self._chords)[link]
        rest_turning = np.diff(borders)[element]
        turning = rest_turning + self.turned[element]
        lean = np.exp(1j * (borders[link] - chord))
        piece = (self.rest.places(s) - self.rest.places(joints[link])) * np.exp(-1j * chord)
        added = lean * (_arc(off, turning / h, _radius(rest_turning, turning)) - _arc(off, rest_turning / h, 1.0))
        ahead = np.exp(1j * self.inside.angles[link])
        # the tangent turns evenly between borders, and what is curved at rest is so besides
        order = np.argsort(s)
        bent = np.empty(len(s))
        bent[order] = self.rest.angles(s[order])
        psi = self.inside.angles[link] - chord + bent + self.turned[element] / h * off
        return np.asarray(self.joints[link] + ahead * (piece + added)), psi

    @cached_property
    def fine(self) -> Array:
        """Arc lengths of a fine line, joints and borders among them."""
        knots = np.unique(np.concatenate((self.joints_at, self.inside.borders)))
        parts = [np.linspace(a, b, PER_HALF, endpoint=False) for a, b in pairwise(knots)]
        return np.concatenate([*parts, knots[-1:]])

    def misplaced(self, acting: Array) -> float:
        """How far the places of the shape are from the line that the angles make, m."""
        places, _ = self.line(self.shape.s)
        return float(np.max(np.abs(places - (self.shape.x + 1j * self.shape.y))))


def _radius(rest: Array, turning: Array) -> Array:
    x, y = 0.5 * rest, 0.5 * turning
    # y cot y, sin x/x and (1 − cos x)/x
    cot = np.where(np.abs(y) < SMALL, 1.0 - y * y / 3.0, y / np.tan(np.where(np.abs(y) < SMALL, 1.0, y)))
    versine = np.where(np.abs(x) < SMALL, 0.5 * x, (1.0 - np.cos(x)) / np.where(np.abs(x) < SMALL, 1.0, x))
    return np.asarray(cot * np.sinc(x / np.pi) + y * versine)


def _arc(off: Array, rate: Array, radius: Array | float) -> Complex:
    """Along and across from the border of an arc that turns by ``rate`` per length, off·R·sinc and so on."""
    half = 0.5 * rate * off
    return np.asarray(radius * off * np.sinc(half / np.pi) * np.exp(1j * half))
