"""Which way something rigid may press where it has a corner: a beam without thickness stands on the corner itself.

======  ================================================================================================
symbol  meaning
======  ================================================================================================
P       a corner that juts out, or an end, from which what is rigid goes straight back
b, f    unit normals of what comes before P and of what follows, the free side on the left
F, t    force on the beam, and the beam's tangent where it is
======  ================================================================================================

At a corner the distance of a line is nought whichever way it leaves, and a nearest place says nothing of the force.  Of
what is rigid it may point between b and f.  Of the beam all such forces together are normal to it, unless its end is
there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.audit.rest import Complex
from cprbm_scene.answer import Flags, Ints

WITHIN = 1e-6  # of a force: what it may point by beyond b and f
JUTTING = 1e-9  # sine of the angle by which a corner juts out at least


@dataclass(frozen=True)
class Corners:
    """``places`` P, normals ``before`` b and ``behind`` f, (k,) each."""

    places: Complex
    before: Complex
    behind: Complex

    def moved(self, first: complex, moved: complex, turn: complex) -> Corners:
        """Carried along by a body whose point ``first`` has ``moved``, and that has turned."""
        return Corners(first + moved + turn * (self.places - first), turn * self.before, turn * self.behind)

    def standing(self, places: Complex, reach: float) -> tuple[Ints, Flags]:
        """The number of the corner that is nearest to each of some places, and whether it is within a reach, (m,)."""
        if not self.places.size:
            return np.zeros(len(places), dtype=np.intp), np.zeros(len(places), dtype=bool)
        away = np.abs(places[:, None] - self.places)
        return away.argmin(axis=1), np.asarray(away.min(axis=1) <= reach)

    def allow(self, forces: Complex, numbers: Ints) -> Flags:
        """Whether forces (m,) point between b and f of the corners that are numbered (m,)."""
        size = np.maximum(np.abs(forces), np.finfo(float).tiny)
        b, f = (np.conj(each[numbers]) for each in (self.before, self.behind))
        return np.asarray(((b * forces).imag <= WITHIN * size) & ((f * forces).imag >= -WITHIN * size))


def corners_of(points: Complex) -> Corners:
    """Of a line through points (k,), whose free side is to its left, those that jut out, and its ends."""
    along = np.diff(points) / np.abs(np.diff(points))
    if points[0] == points[-1]:
        places, before, behind = points[:-1], 1j * np.roll(along, 1), 1j * along
    else:
        places = points
        before, behind = np.append(-along[0], 1j * along), np.append(1j * along, along[-1])
    out = (np.conj(before) * behind).imag < -JUTTING
    return Corners(places[out], before[out], behind[out])


def ends_of(places: Complex, along: Complex) -> Corners:
    """Of a line from one to the other of two places (2,), whose unit tangents there are ``along`` (2,)."""
    return Corners(places, np.array([-along[0], 1j * along[1]]), np.array([1j * along[0], along[1]]))


def leaning(tangents: Complex, forces: Complex) -> float:
    """Sine by which forces (m,) together lean from the normal of a line, (m,) tangents where they act."""
    whole = complex(forces.sum())
    tangent = complex((tangents * np.abs(forces)).sum())
    return float(abs((np.conj(tangent) * whole).real)) / max(abs(whole) * abs(tangent), float(np.finfo(float).tiny))
