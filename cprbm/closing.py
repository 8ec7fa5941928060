"""At which value of what is stepped a contact first closes.

==========  ==================================================================================
v           value of the stepped load or drive
c(v)        largest constraint value of the contact, :mod:`cprbm.first_contact`, in the equilibrium without the
            contact, the others in force: negative while the contact is open
v_c         its first zero
==========  ==================================================================================

Up to v_c a contact carries nothing, so that leaving it out changes nothing before.  Behind v_c the beam goes through
what it would have touched, and may come out on the other side: so the way is gone in steps short enough to see it
within.  What touches already where the way begins, and does not part, closes there.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from cprbm.first_contact import Rows
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import most_turned
from cprbm.mechanism import Mechanism, mechanism_of
from cprbm.point import Point, point_at
from cprbm.refining import all_zones, carried_over, fits, fitted
from cprbm.settings import Settings
from cprbm.steadied import Turn, steadied
from cprbm_scene import Scene

Stood = tuple[float, Point]  # a value of what is stepped, and the march's state there

SOON = 12  # iterations to a state near another
SEEN = 0.3  # rad: the most that a link turns by in a step in which nothing is missed
TOUCHING = 1e-12  # of the longest beam: a gap that is none
SHORTEST = 1e-6  # of the way: a step behind which there is no equilibrium without the contact
EXACTLY = 1e-10  # of the way
BEGUN = 1e-3  # of the way: what touches where it begins has parted by then, or never does
NEARLY = 0.05  # of a closing value: it lies no farther from that on even elements
NEARBY = (1e-3, 1e-2, 3e-2)  # of the way, on either side of where a less fitted mesh closes
FITS = 10  # of the mesh to where the other contacts are, at most


@dataclass(frozen=True, slots=True)
class Closings:
    """What the closings of one stage have in common.

    Attributes:
        scene, settings: what is solved and on which mesh.
        marched, asked: the mechanism on the march's mesh, and on even elements of the one that was asked.
        load: what is stepped; ``values`` are of all others.
    """

    scene: Scene
    settings: Settings
    marched: Mechanism
    asked: Mechanism
    load: str
    values: dict[str, float]

    def first(self, contact: str, opened: list[Stood], target: float) -> float | None:
        """v_c, or None where the contact stays open without its own help.

        Args:
            contact: its name.
            opened: where the march stood before with the contact open, in order; the first where the stage began.
            target: a value at which it presses.
        """
        for value, point in reversed(opened):
            if self.asked is not self.marched:
                point = carried_over(self.marched, point, self.asked, {**self.values, self.load: value})
            gap = self._gap(self.asked, contact, value, point)
            if gap.overlap(value) < 0.0 or value == opened[0][0]:
                break  # closed on this mesh, and not yet on the march's: it closed before
        bracket = gap.bracket(value, target)
        if bracket is None:
            return None
        low, high = bracket
        if low == high:
            return low
        closing = gap.root(low, high, target - value)
        # of the whole way of the stage: where it was cut is not asked
        return self._fitted(gap, closing, closing - opened[0][0])

    def _gap(self, mechanism: Mechanism, contact: str, value: float, point: Point) -> Gap:
        """Of a mechanism with the contact, whose state near ``value`` is about known."""
        without = replace(mechanism, problem=mechanism.without(contact))
        values = {**self.values, self.load: value}
        guess = point_at(without.problem, values, point.state, point.mu, np.zeros(0), Rows((), sides=point.rows.sides))
        return Gap(without, contact, self.values, self.load, self.settings, guess)

    def _fitted(self, gap: Gap, closing: float, way: float) -> float:
        """v_c on the mesh that is fitted to where the other contacts are then."""
        last: Turn | None = None
        for _ in range(FITS):
            mechanism, point = gap.mechanism, gap.nearest(closing)
            fit = fitted(mechanism, point, all_zones(mechanism, point), self.settings)
            if fits(mechanism, fit):
                break
            now = mechanism.fit, fit
            fit, last = steadied(now, last), now
            target = mechanism_of(self.scene, self.settings, fit, mechanism)
            start = carried_over(mechanism, point, target, gap.at(closing))
            gap = self._gap(target, gap.contact, closing, start)
            again = gap.root_near(closing, way)
            if again is None or not abs(again - closing) <= NEARLY * abs(closing):
                break  # on a mesh that fits a little less it is known already
            closing = again
        return closing


@dataclass(frozen=True, slots=True)
class Gap:
    """c(v); ``mechanism`` is without the contact, ``solved`` by v what is known, before there is any a ``guess``."""

    mechanism: Mechanism
    contact: str
    values: dict[str, float]
    load: str
    settings: Settings
    guess: Point
    solved: dict[float, Point] = field(default_factory=dict)

    def at(self, value: float) -> dict[str, float]:
        """The values of all loads and drives at v."""
        return {**self.values, self.load: value}

    def root(self, low: float, high: float, way: float) -> float:
        """v_c between two values at which the gap has two signs, to a very small part of a ``way``."""
        from scipy.optimize import brentq  # loaded when a closing load is asked

        return float(brentq(self.overlap, low, high, xtol=EXACTLY * abs(way), rtol=8.9e-16))

    def root_near(self, value: float, way: float) -> float | None:
        """v_c within a small part of a ``way`` from a value; None if the gap does not change its sign there."""
        for part in NEARBY:
            low, high = sorted((value - part * way, value + part * way))
            if self.overlap(low) * self.overlap(high) < 0.0:
                return self.root(low, high, way)
        return None

    def nearest(self, value: float) -> Point:
        """The state whose v is nearest."""
        if not self.solved:
            return self.guess
        return self.solved[min(self.solved, key=lambda other: abs(other - value))]

    def followed(self, value: float) -> Point | None:
        """The equilibrium at v, from the nearest that is known; None where there is none near that."""
        if value in self.solved:
            return self.solved[value]
        start = self.nearest(value)
        most = min(self.settings.iterations, SOON)
        found = equilibrium(self.mechanism.problem, self.at(value), start, self.settings.tolerance, most)
        turned = most_turned(start.state, found.point.state)
        if not found.converged or turned > SEEN:
            return None
        self.solved[value] = found.point
        return found.point

    def overlap(self, value: float) -> float:
        """c, units of length; where the way ends without the contact, as if that were violated."""
        point = self.followed(value)
        if point is None:
            return 1.0
        return self._constraint(point)

    def _constraint(self, point: Point) -> float:
        # far away there are no rows
        return max(self.mechanism.overlap(self.contact, point), -1.0)

    def bracket(self, begin: float, target: float) -> tuple[float, float] | None:
        """Two values close to each other, v_c between them or at both; None where there is none up to ``target``."""
        start = self.followed(begin)
        if start is None:
            return None
        low, done, step = begin, 0.0, 1.0
        if self._constraint(start) >= -TOUCHING:
            low, done = begin + BEGUN * (target - begin), BEGUN
            if self.overlap(low) > 0.0:
                return begin, begin
        while step > SHORTEST:
            part = min(1.0, done + step)
            high = target if part == 1.0 else begin + part * (target - begin)
            before, after = self.nearest(high), self.followed(high)
            if after is not None and self._constraint(after) > 0.0:
                return low, high
            if after is None or self.mechanism.passed(before, after):
                self.solved.pop(high, None)
                step *= 0.5
                continue
            if part == 1.0:
                return None
            low, done, step = high, part, 2.0 * step
        # without the contact there is nothing beyond: the beam leaps on it
        return low, low
