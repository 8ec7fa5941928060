"""Which points a beam goes over on its way: tips that are too sharp for its samples, centres of small circles.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
c       the point, in either of two states
x, n    the place of the neutral line that is closest to it, and the line's normal there, to the left
d       n·(x − c)
======  =====================================================================================

Where a closest place is found in both states, the one beginning from the other, a beam that has gone over the point has
it on its other side: d has changed its sign.  That is exact however narrow what stands there is.  One that has gone
round an end has none on its way, if that was short enough; one of which another part is closer has gone farther.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array, Flags
from fea_reference.hermite import NeutralLine
from fea_reference.neighbours import nearest
from fea_reference.projection import closest
from fea_reference.state import Complex

_WAY = 1.5  # times the way of either place: what is passed has come no farther than that across
_PLACES = 4  # per element, from which the closest one is sought


@dataclass(frozen=True, slots=True)
class Beside:
    """Of k points: ζ (k,) of the closest place and whether it was ``found``, d (k,) and n (k,) as complex numbers."""

    zeta: Array
    found: Flags
    d: Array
    n: Complex

    def along(self, out: Complex) -> Complex:
        """Of n and −n that which goes with ``out`` (k,): a beam on a tip has its normal between those of the sides."""
        return np.asarray(self.n * np.where((self.n.conj() * out).real < 0.0, -1.0, 1.0))

    def seen_along(self, out: Complex) -> Array:
        """d (k,) by that."""
        return np.asarray(self.d * np.where((self.n.conj() * out).real < 0.0, -1.0, 1.0))


def beside(line: NeutralLine, points: Complex, guess: Array | None = None) -> Beside:
    """On which side of a line points x + i y (k,) are; sought from a ``guess`` (k,), else from what is nearest."""
    if guess is None:
        even = np.arange(_PLACES * line.n + 1) / _PLACES
        there = line.around(even)
        guess = even[nearest(points, line.nodes[there.element] + there.way)[1]]
    zeta, found, there = closest(line, points, guess)
    n = 1j * there.ahead / np.abs(there.ahead)
    return Beside(zeta, found, (n.conj() * (line.nodes[there.element] + there.way - points)).real, n)


def gone_over(before: tuple[NeutralLine, Complex], after: tuple[NeutralLine, Complex]) -> tuple[Beside, Beside, Flags]:
    """Where points (k,) are beside a line in two states, and which of them it may have gone over between, (k,)."""
    (old, c_0), (new, c_1) = before, after
    first = beside(old, c_0)
    last = beside(new, c_1, first.zeta)
    ways = [np.abs(_at(new, one.zeta) - c_1 - _at(old, one.zeta) + c_0) for one in (first, last)]
    near = np.abs(last.d - first.d) <= _WAY * np.maximum(*ways)
    return first, last, first.found & last.found & near


def _at(line: NeutralLine, zeta: Array) -> Complex:
    there = line.around(zeta)
    return np.asarray(line.nodes[there.element] + there.way)
