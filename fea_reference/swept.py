"""Points that a beam sweeps over: tips too sharp for its samples, centres of small circles.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
c       the point, in either of two states
x, n    the closest place of the neutral line, and the line's normal there, to the left
d       n·(x − c)
======  =====================================================================================

Both states have a closest place, the second found from the first. If the beam swept over the point, d changes sign.
This test is exact for any small obstacle. A beam that went around the point with its end has no closest place in a
short step; the point must not have crossed the end's face. A beam with a closer part elsewhere moved farther than a
step.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Flags
from fea_reference.hermite import NeutralLine
from fea_reference.neighbours import nearest
from fea_reference.projection import closest
from fea_reference.state import Complex

_WAY = 1.5  # times the motion of either place: largest change of d for a sweep
_PLACES = 4  # per element: samples for the initial guess of the closest place


@dataclass(frozen=True, slots=True)
class ClosestPlaces:
    """Closest places of k points: ζ (k,), ``found`` (k,), d (k,) and n (k,) as complex numbers."""

    zeta: Array
    found: Flags
    d: Array
    n: Complex

    def normal_along(self, out: Complex) -> Complex:
        """±n in the direction of ``out`` (k,): the normal of a beam on a tip lies between those of the tip's sides."""
        return np.asarray(self.n * np.where((self.n.conj() * out).real < 0.0, -1.0, 1.0))

    def distance_along(self, out: Complex) -> Array:
        """±d (k,) with the same sign."""
        return np.asarray(self.d * np.where((self.n.conj() * out).real < 0.0, -1.0, 1.0))


def closest_places(line: NeutralLine, points: Complex, guess: Array | None = None) -> ClosestPlaces:
    """Closest places of a line to points x + i y (k,), from ``guess`` (k,) or from the nearest sample."""
    if guess is None:
        even = np.arange(_PLACES * line.n + 1) / _PLACES
        there = line.around(even)
        guess = even[nearest(points, line.nodes[there.element] + there.way)[1]]
    zeta, found, there = closest(line, points, guess)
    n = 1j * there.ahead / np.abs(there.ahead)
    return ClosestPlaces(zeta, found, (n.conj() * (line.nodes[there.element] + there.way - points)).real, n)


def swept_over(
    before: tuple[NeutralLine, Complex], after: tuple[NeutralLine, Complex]
) -> tuple[ClosestPlaces, ClosestPlaces, Flags]:
    """Closest places of points (k,) in two states, and True (k,) for points that may have been swept over."""
    (old, c_0), (new, c_1) = before, after
    first = closest_places(old, c_0)
    last = closest_places(new, c_1, first.zeta)
    paths = [np.abs(_at(new, places.zeta) - c_1 - _at(old, places.zeta) + c_0) for places in (first, last)]
    near = np.abs(last.d - first.d) <= _WAY * np.maximum(*paths)
    return first, last, first.found & last.found & near


def cut_by_end(before: tuple[NeutralLine, Complex], after: tuple[NeutralLine, Complex], half: float) -> Flags:
    """True for points (k,) that pass through the flat end of a beam of ``half`` thickness, between two states.

    The points come from a side of the beam, on a path that is straight in the frame of the end.
    """
    old, new = (
        (points - line.nodes[[0, -1], None]) / (line.aheads[[0, -1], None] * [[-1.0], [1.0]])
        for line, points in (before, after)
    )
    passes = (np.abs(old.imag) >= half) & (old.real < 0.0) & (new.real > 0.0)
    share = old.real / np.where(passes, old.real - new.real, 1.0)
    return np.asarray((passes & (np.abs(old.imag + share * (new.imag - old.imag)) < half)).any(axis=0))


def _at(line: NeutralLine, zeta: Array) -> Complex:
    there = line.around(zeta)
    return np.asarray(line.nodes[there.element] + there.way)
