"""Zones of overlap of two beams: the gap along the first beam, and the intervals with a negative gap.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, x_m  point of the first beam's neutral line at ζ, its closest point on the second's at ζ_m
τ, n    unit tangent and normal of the second beam at ζ_m
d       n·(x − x_m)
T       distance of the neutral lines when the surfaces touch
g       gap, side·d − T
J, a    |x_m'| and n·x_m'', by ζ_m
======  =====================================================================================

A change of ζ moves the closest point by J (τ·x')/(J² − d a), and n turns with the closest point. Hence

    g' = side n·x',     g'' = side [ n·x'' − a (τ·x')²/(J² − d a) ].

With varying thickness T varies, n and τ lean with the second beam's surface (:mod:`fea_reference.facing`) and J is
τ·x_m'. Then g' has the additional term −T' of the first beam's half thickness.

A zone may be far narrower than an element. Samples of g and g' along the beam therefore bracket first the minima of
the gap, then the ends of zones; Newton's method, safeguarded by the brackets, locates both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.facing import Borders, Tapers, borders, facing
from fea_reference.hermite import NeutralLine, line_difference
from fea_reference.neighbours import near_each_other, nearest
from fea_reference.projection import closest

SAMPLES_PER_ELEMENT = 4
_ITERATIONS = 60
_END_ITERATIONS = 15
_INSIDE = 1e-6  # elements: distance between the inside of an element and a node
_ON_RAY = 1e-6  # elements
_ARRIVED = 1e-8  # elements: last step of a root search
# least value under the root of a parabola's zero, below which the parabola gives no small correction of the step
_BENT = 0.5
_SHORT = 1e-4  # elements: steps with a negligible third power
_TURNS = 1e-4  # elements: last step of a search for a minimum, where the gap changes with the square of the error
_WITHIN = 1e-9  # share of an interval: far narrower zones begin at a minimum of the gap
_EPS = float(np.finfo(float).eps)
_EVEN = 3.0  # times the mean slope: a cubic with smaller end slopes is monotonic


class Gap(NamedTuple):
    """g, g', g'' by ζ and ζ_m at places (k,); ``found`` (k,) is True where a closest point exists."""

    g: Array
    slope: Array
    curvature: Array
    zeta_m: Array
    found: NDArray[np.bool_]

    def chosen(self, selection: NDArray[np.bool_] | NDArray[np.int64]) -> Gap:
        """The gap at a selection of the places."""
        g, slope, curvature, zeta_m, found = self
        return Gap(g[selection], slope[selection], curvature[selection], zeta_m[selection], found[selection])


@dataclass(frozen=True, slots=True)
class Survey:
    """A gap at ordered places ``zeta`` (k,), its minima included, from which the zones below any level follow.

    For self-contact several such sequences follow each other; the last place of a sequence is no neighbour of the
    next.

    Attributes:
        at: gap at other places ζ (k,), with initial guesses ζ_m (k,) of the closest points.
        there: gap at ``zeta``.
        neighbours: (k−1,), True if the gap is defined between a place and the next.
        kinks: places, other than nodes, with a kink of the gap.
        least: minimum of the gap, or an upper bound without places.
    """

    at: Callable[[Array, Array], Gap]
    zeta: Array
    there: Gap
    neighbours: NDArray[np.bool_]
    kinks: tuple[float, ...]
    least: float

    def below(self, level: float) -> Zones:
        """Intervals on which the gap is below ``level``, divided at nodes and kinks only."""
        if self.least >= level:
            return no_zones(self.least)
        zeta, neighbours, there = self.zeta, self.neighbours, self.there
        g, zeta_m = there.g - level, there.zeta_m
        ends = (neighbours & (g[:-1] * g[1:] < 0.0)).nonzero()[0]
        if ends.size:
            share = _parabola(zeta, g, there.slope, there.curvature, ends)
            where, guess = _roots(self.at, zeta, g, zeta_m, ends, share, level=level)
            new = np.array([where, np.zeros_like(where), guess])
            (zeta, g, zeta_m), neighbours = _with_columns(np.array([zeta, g, zeta_m]), neighbours, ends, new)
        here, there_next = g[:-1], g[1:]
        inside = (neighbours & (np.maximum(here, there_next) <= 0.0) & (here + there_next < 0.0)).nonzero()[0]
        if not inside.size:
            return no_zones(self.least)
        # The gap is smooth within an element, so that adjacent parts form a single interval.
        place = zeta[inside]
        parted = place == np.floor(place)
        if self.kinks:
            parted |= np.isin(place, self.kinks)
        parted[1:] |= inside[1:] - inside[:-1] > 1
        begins = parted[1:].nonzero()[0] + 1
        bounds = np.concatenate([inside[:1], inside[begins], inside[begins - 1] + 1, inside[-1:] + 1]).reshape(2, -1).T
        return Zones(zeta[bounds], zeta_m[bounds], self.least)


@dataclass(frozen=True, slots=True)
class Zones:
    """Intervals (k, 2) of ζ with a negative gap; no interval has a node of either beam in its interior.

    ``zeta_m`` (k, 2) are the closest points of the interval ends. ``least`` is the minimum of the gap, or a bound of
    the minimum for distant beams.
    """

    intervals: Array
    zeta_m: Array
    least: float

    @property
    def begins(self) -> NDArray[np.bool_]:
        """True for intervals (k,) that start a zone: the interval before ends elsewhere."""
        return np.append(True, self.intervals[1:, 0] > self.intervals[:-1, 1])[: len(self.intervals)]

    @property
    def numbers(self) -> NDArray[np.int64]:
        """Number of the zone of every interval, (k,)."""
        return np.cumsum(self.begins) - 1

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.int64]) -> Zones:
        """A selection, or another order, of the intervals."""
        return Zones(self.intervals[which], self.zeta_m[which], self.least)


def gap(
    first: NeutralLine,
    second: NeutralLine,
    sides: Callable[[Array, Array, Array], Array | float],
    T: float,
    tapers: Tapers | None,
    zeta: Array,
    zeta_m: Array,
    *,
    ended: bool = False,
) -> Gap:
    """The gap at ``zeta`` (k,), with initial guesses ``zeta_m`` (k,) of the closest points.

    ``sides`` gives the sides (k,) from ζ, ζ_m and d. With ``ended``, points beyond an end of the second beam face
    this end.
    """
    there = first.around(zeta)
    points = first.nodes[there.element] + there.way
    edge = None if tapers is None else tapers.second
    faced = facing(second, edge, points, zeta_m, lambda at_m, d: sides(zeta, at_m, d), ended=ended)
    across, J, zeta_m = faced.across, faced.c, faced.zeta_m
    back = (1j * faced.w).conj()  # n conjugate: of a product with it, the real part is n·v and the imaginary part −τ·v
    d = (back * line_difference(first, there, second, across)).real
    a = (back * across.bent).real
    ahead = back * there.ahead
    bend = -a / (J * J - d * a if faced.fixed is None else np.where(faced.fixed, 1.0, J * J - d * a))
    if faced.fixed is not None:
        bend = np.where(faced.fixed, 1.0 / np.where(d == 0.0, 1.0, d), bend)
    curvature = (back * there.bent).real + bend * ahead.imag**2
    side = sides(zeta, zeta_m, d)
    g, slope = side * d - T, side * ahead.real
    if tapers is not None:
        g, slope = g + tapers.thinner(zeta, zeta_m), slope - tapers.first.slope(zeta)
    return Gap(g, slope, side * curvature, zeta_m, faced.found)


def one_side(side: float) -> Callable[[Array, Array, Array], float]:
    """Side function with a constant value."""
    return lambda _zeta, _zeta_m, _d: side


def side_of(first: NeutralLine, second: NeutralLine, unseen: float = 1.0) -> float:
    """Side of the second beam on which the first lies: +1 left of its direction, −1 right.

    ``unseen`` is returned if no place of the first beam has a closest point on the second.
    """
    rays, reach = borders(second, None, 1.0), _reach(first, second, 0.0)
    zeta = _samples(first, rays, np.arange(first.n), np.arange(first.n + 1), reach)
    x = first.around(zeta)
    near = nearest(first.nodes[x.element] + x.way, second.nodes)[1].astype(float)
    there = gap(first, second, one_side(1.0), 0.0, None, zeta, near)
    d = there.g[there.found]
    if d.size == 0:
        return unseen
    least = d[np.argmin(np.abs(d))]
    # Lines that touch at rest have a side elsewhere.
    return float(np.sign(least if abs(least) > 1e-9 else d.sum())) or 1.0


def has_end_over(first: NeutralLine, second: NeutralLine) -> bool:
    """True if an end of the first beam has its closest point inside the second beam."""
    return bool(np.isfinite(end_distance(first, second)))


def end_distance(first: NeutralLine, second: NeutralLine) -> float:
    """Distance of the nearer end of the first beam from the second; infinite without a closest point inside."""
    near = nearest(first.nodes[[0, -1]], second.nodes)[1].astype(float)
    zeta, found, there = closest(second, first.nodes[[0, -1]], near)
    over = found & (zeta > _INSIDE) & (zeta < second.n - _INSIDE)
    distance = np.abs(first.nodes[[0, -1]] - second.nodes[there.element] - there.way)
    return float(distance[over].min(initial=np.inf))


def survey_pair(
    first: NeutralLine,
    second: NeutralLine,
    side: float,
    T: float,
    tapers: Tapers | None = None,
    free: tuple[float, float] = (0.0, np.inf),
) -> Survey:
    """Gap survey of two beams at places ζ in ``free``, wherever the gap is below the second's longest element."""

    def at(where: Array, guess: Array) -> Gap:
        return gap(first, second, one_side(side), T, tapers, where, guess)

    reach, none_there = _reach(first, second, T), np.empty(0)
    within = search_distance(first, second, T)
    begin, end = int(free[0]), int(min(free[1], first.n - 1.0)) + 2
    nodes_first, nodes_second = near_each_other(
        first.nodes[begin:end], second.nodes, within + first.longest + second.longest
    )
    nodes_first = nodes_first + begin
    apart_by, _ = nearest(first.nodes[nodes_first], second.nodes[nodes_second])
    close = np.zeros(first.n + 1, dtype=bool)
    close[nodes_first[apart_by < within]] = True
    beside = np.flatnonzero(close[:-1] | close[1:])
    if not beside.size:
        empty = Gap(none_there, none_there, none_there, none_there, none_there.astype(bool))
        return Survey(at, none_there, empty, none_there.astype(bool), (), float(apart_by.min()) - T)
    rays = borders(second, None if tapers is None else tapers.second, side).among(nodes_second)
    zeta = _samples(first, rays, beside, nodes_first, reach)
    knots = () if tapers is None else tapers.first.knots
    if knots:
        zeta = np.union1d(zeta, [knot for knot in knots if min(int(knot), first.n - 1) in beside])
    zeta = zeta if free == (0.0, np.inf) else np.unique(np.clip(zeta, *free))
    x = first.around(zeta)
    distance, nearest_node = nearest(first.nodes[x.element] + x.way, second.nodes[nodes_second])
    near = np.flatnonzero(distance < reach)
    there = at(zeta[near], nodes_second[nearest_node[near]].astype(float))
    # a place that faces the far side of a strongly bent second beam does not overlap
    usable = there.found & (there.g > -T - reach)
    if not usable.any():
        return Survey(at, zeta[:0], there.chosen(near[:0]), np.empty(0, dtype=bool), (), float(distance.min()) - T)
    if not usable.all():
        near, there = near[usable], there.chosen(usable)
    return survey(at, zeta[near], there, np.diff(near) == 1, knots, floor=gap_round_off(first, second, T))


def overlap(
    first: NeutralLine, second: NeutralLine, T: float, where: Survey, level: float, rays: Sequence[Borders]
) -> Zones:
    """Zones with a surveyed gap below ``level``, a level smaller than the second beam's element.

    The gap has to be below the level by more than round-off, so that beams held side by side do not press. Intervals
    end where the first beam passes a ray of ``rays``.
    """
    inside = where.below(level - gap_round_off(first, second, T))
    split = inside.intervals, inside.zeta_m
    for borders_of_side in rays:
        split = _split_at(first, borders_of_side, *split)
    return Zones(*split, inside.least)


def gap_round_off(first: NeutralLine, second: NeutralLine, T: float) -> float:
    """Round-off of the gap of two beams."""
    return _EPS * (abs(T) + first.longest + second.longest)


def negative(
    at: Callable[[Array, Array], Gap],
    zeta: Array,
    there: Gap,
    neighbours: NDArray[np.bool_],
    kinks: tuple[float, ...] = (),
    joined: tuple[float, ...] = (),
    floor: float = 0.0,
) -> Zones:
    """Zones with a negative gap; arguments as for :func:`survey`."""
    return survey(at, zeta, there, neighbours, kinks, joined, floor).below(0.0)


def survey(
    at: Callable[[Array, Array], Gap],
    zeta: Array,
    there: Gap,
    neighbours: NDArray[np.bool_],
    kinks: tuple[float, ...] = (),
    joined: tuple[float, ...] = (),
    floor: float = 0.0,
) -> Survey:
    """Survey of a gap with its minima added to the places.

    Args:
        at: gap at places ζ (k,), with initial guesses ζ_m (k,).
        zeta: ordered places (k,), all relevant nodes included.
        there: gap at ``zeta``.
        neighbours: (k−1,), True if the gap is defined between a place and the next.
        kinks: places, other than nodes, with a kink of the gap.
        joined: places where a joint makes the gap zero; they are no minima.
        floor: round-off of the gap.
    """
    zeta, there, neighbours = _with_bends(at, zeta, there, neighbours)
    slope, zeta_m = there.slope, there.zeta_m
    # a maximum matters only between two places with negative gaps
    parts = (slope[:-1] < 0.0) | ((there.g[:-1] <= 0.0) & (there.g[1:] <= 0.0))
    turning = (neighbours & (slope[:-1] * slope[1:] < 0.0) & parts).nonzero()[0]
    if turning.size and kinks:
        turning = turning[~_at_kinks(at, zeta, slope, zeta_m, turning, kinks)]
    if turning.size:
        share = _turning(zeta, slope, there.curvature, turning)
        where, guess = _roots(at, zeta, slope, zeta_m, turning, share, floor)
        zeta, there, neighbours = _with_places(zeta, there, neighbours, turning, where, at(where, guess))
    least = float((there.g[~np.isin(zeta, joined)] if joined else there.g).min())
    return Survey(at, zeta, there, neighbours, kinks, least)


def _with_places(
    zeta: Array, there: Gap, neighbours: NDArray[np.bool_], left: NDArray[np.int64], where: Array, inserted: Gap
) -> tuple[Array, Gap, NDArray[np.bool_]]:
    """Places and gap with further places ``where``, inserted behind the places with index ``left``."""
    rows, neighbours = _with_columns(np.array([zeta, *there]), neighbours, left, np.array([where, *inserted]))
    zeta, g, slope, curvature, zeta_m, found = rows
    return zeta, Gap(g, slope, curvature, zeta_m, found != 0.0), neighbours


def _with_columns(
    rows: Array, neighbours: NDArray[np.bool_], left: NDArray[np.int64], new: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """``rows`` (r, k) with columns ``new`` (r, m) behind the columns ``left`` (m,), and ``neighbours`` (k+m−1,).

    All columns ``left`` had a neighbour.
    """
    order = np.concatenate([np.arange(rows.shape[1]), left + 0.5]).argsort()
    both = np.concatenate([neighbours, [False], neighbours[left]])
    return np.concatenate([rows, new], axis=1)[:, order], both[order[:-1]]


def _with_bends(
    at: Callable[[Array, Array], Gap], zeta: Array, there: Gap, neighbours: NDArray[np.bool_]
) -> tuple[Array, Gap, NDArray[np.bool_]]:
    """Places and gap with further places where the gap may have both a maximum and a minimum between two places.

    The slope has the same sign at both, but the cubic through g and g' of both has two turning points; the new place
    is the second. A zone missed there would appear at its full width, and its force with a jump.
    """
    width, slope = np.where(neighbours, zeta[1:] - zeta[:-1], 1.0), there.slope
    before, behind, rise = slope[:-1], slope[1:], (there.g[1:] - there.g[:-1]) / width
    # g' = before + 2 b ξ + 3 a ξ², over the width
    b, a = 3.0 * rise - 2.0 * before - behind, before + behind - 2.0 * rise
    turned = -b / np.where(a == 0.0, 1.0, 3.0 * a)
    inside = (a != 0.0) & (turned > _INSIDE) & (turned < 1.0 - _INSIDE)
    bends = (neighbours & (before * behind > 0.0) & (before * b < 0.0) & inside).nonzero()[0]
    if bends.size == 0:
        return zeta, there, neighbours
    share = turned[bends]
    where = zeta[bends] + share * width[bends]
    inserted = at(where, there.zeta_m[bends] + share * (there.zeta_m[bends + 1] - there.zeta_m[bends]))
    return _with_places(zeta, there, neighbours, bends, where, inserted)


def search_distance(first: NeutralLine, second: NeutralLine, T: float) -> float:
    """Distance of nodes beyond which the gap is not evaluated."""
    return _reach(first, second, T) + first.longest


def node_distance(first: NeutralLine, second: NeutralLine) -> float:
    """Least distance between nodes of two beams."""
    nodes_first, nodes_second = near_each_other(first.nodes, second.nodes, 0.0)
    return float(nearest(first.nodes[nodes_first], second.nodes[nodes_second])[0].min())


def _reach(first: NeutralLine, second: NeutralLine, T: float) -> float:
    """Distance from the second beam's nodes beyond which neither a place nor its neighbours can touch."""
    return float(2.0 * abs(T) + 2.0 * second.longest + first.longest)


def _samples(
    first: NeutralLine, rays: Borders, elements: NDArray[np.int64], nodes: NDArray[np.int64], reach: float
) -> Array:
    """Equal steps within ``elements``, and the places opposite to the second beam's nodes.

    The gap is undefined beyond an end, and a zone up to there may be narrower than a step; at inner nodes the
    curvature of the gap jumps. ``nodes`` are nodes of the first beam within reach.
    """
    even, _ = steps_within(elements, ())
    distance, nearest_node = nearest(rays.points, first.nodes[nodes])
    near = distance < reach
    if not near.any():
        return even
    zeta = nodes[nearest_node[near]].astype(float)
    facing_to, back = rays.points[near], rays.w[near].conj()
    for _ in range(_END_ITERATIONS):
        there = first.around(zeta)
        ahead = (there.ahead * back).real
        off = ((first.nodes[there.element] - facing_to + there.way) * back).real
        step = np.minimum(np.maximum(off / np.where(ahead == 0.0, 1.0, ahead), -1.0), 1.0)
        moved = np.minimum(np.maximum(zeta - step, 0.0), first.n)
        done = np.maximum.reduce(np.abs(moved - zeta)) < 1e-8
        zeta = moved
        if done:
            break
    return np.unique(np.concatenate([even, zeta]))


def steps_within(elements: NDArray[np.int64], knots: tuple[float, ...]) -> tuple[Array, NDArray[np.bool_]]:
    """Equal steps within ordered ``elements`` (k,), with the ``knots`` inside them.

    Returns:
        Places (m,), and (m−1,) True if a place and the next belong to the same run of elements.
    """
    zeta = (elements[:, None] + np.arange(SAMPLES_PER_ELEMENT) / SAMPLES_PER_ELEMENT).ravel()
    gaps = (elements[1:] - elements[:-1] > 1).nonzero()[0]
    inner = [knot for knot in knots if knot != int(knot) and int(knot) in elements]
    if not gaps.size and not inner:
        return np.concatenate([zeta, elements[-1:] + 1.0]), np.ones(zeta.size, dtype=bool)
    ends = np.concatenate([elements[gaps], elements[-1:]]) + 1.0
    zeta = np.union1d(zeta, np.concatenate([ends, inner]))
    return zeta, ~np.isin(zeta[:-1], ends) | np.isin(zeta[:-1], elements)


def no_zones(least: float) -> Zones:
    """Zones without any interval."""
    return Zones(np.empty((0, 2)), np.empty((0, 2)), least)


def _roots(
    at: Callable[[Array, Array], Gap],
    zeta: Array,
    values: Array,
    zeta_m: Array,
    left: NDArray[np.int64],
    share: Array,
    floor: float = 0.0,
    level: float | None = None,
) -> tuple[Array, Array]:
    """Places between ``left`` and the next with a gap of ``level`` or, without a level, a zero slope; and their ζ_m.

    ``values`` change sign there. Newton's method, safeguarded by bisection, starts at the ``share`` of the interval.
    If a value times the bracket is below ``floor``, the integral of the function does not change any more and any
    place is a root: slopes of beams that lie on a surface are pure round-off.

    For a level a step leads to the zero of the osculating parabola. The difference from the Newton step then bounds
    the error.
    """
    low, high = zeta[left], zeta[left + 1]
    x = low + share * (high - low)
    guess = zeta_m[left] + share * (zeta_m[left + 1] - zeta_m[left])
    rising = np.sign(values[left + 1])
    pace = (zeta_m[left + 1] - zeta_m[left]) / np.where(high > low, high - low, 1.0)
    places, closest_there = x.copy(), guess.copy()
    sought = np.arange(x.size)
    for _ in range(_ITERATIONS):
        g, slope, curvature, guess, _ = at(x, guess)
        f, df = (slope, curvature) if level is None else (g - level, slope)
        below = f * rising < 0.0
        np.copyto(low, x, where=below)
        np.copyto(high, x, where=~below)
        df = np.where(df == 0.0, np.nan, df)  # no Newton step where the function is flat
        newton_step = -f / df
        newton = x + newton_step
        if level is not None:
            correction = _to_parabola(newton_step, df, curvature)
            newton += correction
        # a step out of the bracket by round-off has converged; bisection would restart from afar
        good = (newton > low - _ARRIVED) & (newton < high + _ARRIVED)
        moved = np.where(good, np.minimum(np.maximum(newton, low), high), 0.5 * (low + high))
        step = moved - x
        step[np.abs(f) * (high - low) <= floor] = 0.0
        x, guess = x + step, guess + pace * step
        size = np.abs(step)
        if level is not None:
            size = np.where(good & (size < _SHORT) & (correction != 0.0), np.minimum(size, np.abs(correction)), size)
        # the error of the last step is of second or third order
        going = size >= (np.where(good, _TURNS, _ARRIVED) if level is None else _ARRIVED)
        places[sought], closest_there[sought] = x, guess
        if not (count := np.count_nonzero(going)):
            break
        if count < going.size:
            sought = sought[going]
            low, high, x, guess, rising, pace = (array[going] for array in (low, high, x, guess, rising, pace))
    return places, closest_there


def _to_parabola(newton_step: Array, slope: Array, bend: Array) -> Array:
    """Difference between the nearer zero of a parabola and the ``newton_step`` (k,); zero if it is not small."""
    under = 1.0 + 2.0 * newton_step * bend / slope
    return np.asarray(
        np.where(under > _BENT, newton_step * (2.0 / (1.0 + np.sqrt(np.maximum(under, _BENT))) - 1.0), 0.0)
    )


def _at_kinks(
    at: Callable[[Array, Array], Gap],
    zeta: Array,
    slope: Array,
    zeta_m: Array,
    left: NDArray[np.int64],
    kinks: tuple[float, ...],
) -> NDArray[np.bool_]:
    """True (k,) if the slope changes sign at a kink, which is a place already, and not between places.

    At a kink the slope is one-sided. A root search would find the kink again, by bisection.
    """
    right = left + 1
    at_kink = np.zeros(left.size, dtype=bool)
    wide = zeta[right] - zeta[left] > 2.0 * _ARRIVED
    for end, other, inwards in ((left, right, _ARRIVED), (right, left, -_ARRIVED)):
        beside = np.flatnonzero(wide & np.isin(zeta[end], kinks))
        if beside.size:
            there = at(zeta[end[beside]] + inwards, zeta_m[end[beside]])
            at_kink[beside] |= there.slope * slope[other[beside]] > 0.0
    return at_kink


def _turning(zeta: Array, slope: Array, curvature: Array, left: NDArray[np.int64]) -> Array:
    """Share of the interval behind ``left`` with g' = 0: by inverse cubic interpolation, or linear."""
    right = left + 1
    rise = slope[right] - slope[left]
    linear = -slope[left] / rise
    width = zeta[right] - zeta[left]
    by_width = rise / np.where(width == 0.0, np.inf, width)  # a kink counts as a double place
    first, last = (by_width / np.where(curvature[i] == 0.0, np.inf, curvature[i]) for i in (left, right))
    rest = 1.0 - linear
    cubic = linear * (linear * (3.0 - 2.0 * linear) + rest * (rest * first - linear * last))
    even = (np.minimum(first, last) > 0.0) & (np.maximum(first, last) < _EVEN)
    return np.asarray(np.where(even, cubic, linear))


def _parabola(zeta: Array, g: Array, slope: Array, curvature: Array, left: NDArray[np.int64]) -> Array:
    """Share of the interval behind ``left`` at the zero of the parabola at its negative end."""
    forward = g[left] < 0.0
    inner = np.where(forward, left, left + 1)
    direction = np.where(forward, 1.0, -1.0)
    width = zeta[left + 1] - zeta[left]
    a, b, c = 0.5 * curvature[inner] * width**2, direction * slope[inner] * width, g[inner]
    root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
    # stable form of (−b + root)/(2a)
    distance = np.minimum(np.maximum(-2.0 * c / np.maximum(b + root, 1e-300), _WITHIN), 1.0 - _WITHIN)
    return np.where(forward, distance, 1.0 - distance)


def _split_at(first: NeutralLine, rays: Borders, intervals: Array, closest: Array) -> tuple[Array, Array]:
    """Divide intervals where the first beam passes a ray: the curvature of the gap jumps there."""
    low, high = closest.min(axis=1) - _ON_RAY, closest.max(axis=1) + _ON_RAY
    owner, ray = np.nonzero((rays.zeta > low[:, None]) & (rays.zeta < high[:, None]))
    if not owner.size:
        return intervals, closest

    def off(zeta: Array) -> tuple[Array, Array]:
        there, back = first.around(zeta), rays.w[ray].conj()
        r = first.nodes[there.element] + there.way - rays.points[ray]
        return (r * back).real, (there.ahead * back).real

    before, behind = (off(intervals[owner, i])[0] for i in (0, 1))
    tolerance = _ARRIVED * np.diff(intervals[owner])[:, 0] * np.abs(off(intervals[owner].mean(axis=1))[1])
    passes = (before * behind < 0.0) & (np.minimum(np.abs(before), np.abs(behind)) > tolerance)
    owner, ray, before, behind = owner[passes], ray[passes], before[passes], behind[passes]
    zeta = intervals[owner, 0] + before / (before - behind) * np.diff(intervals[owner])[:, 0]
    for _ in range(_ITERATIONS if owner.size else 0):
        value, slope = off(zeta)
        moved = np.clip(zeta - value / slope, intervals[owner, 0], intervals[owner, 1])
        step, zeta = float(np.abs(moved - zeta).max()), moved
        if step < 1e-12:
            break
    places = np.concatenate([intervals[:, 0], intervals[:, 1], zeta])
    closest_all = np.concatenate([closest[:, 0], closest[:, 1], rays.zeta[ray]])
    every = np.arange(len(intervals))
    owners = np.concatenate([every, every, owner])
    order = np.lexsort((places, owners))
    places, closest_all, owners = places[order], closest_all[order], owners[order]
    same = np.flatnonzero(owners[:-1] == owners[1:])
    return (
        np.stack([places[same], places[same + 1]], axis=1),
        np.stack([closest_all[same], closest_all[same + 1]], axis=1),
    )
