"""Self-contact: pairs of places of a single beam, and their sides.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, x_m  points of the neutral line at ζ and ζ_m
f       (x − x_m)·x_m': positive where the distance from x decreases along ζ_m
d       n·(x − x_m), n the normal to the left at ζ_m
======  =====================================================================================

Partners: a minimum of the distance from x along the line is a zero of f from positive to negative. The place itself
is such a minimum. Any other minimum is separated from it by a maximum, where the chord is again normal to the line. A
chord is the mean of the tangents in between, so that these turn by more than a right angle. Neighbours on the line
and contact partners are thus different minima, without any threshold of length or angle. Between touching sides the
tangents turn by about π, or 2π in a coil.

Every pair of places is considered once, from the later or from the earlier place; see :class:`Roles`. A place may
have several partners; consecutive partners along the beam form a sequence. An end of a thick beam is a circle and a
partner, at any angle, of all places with a distance minimum there: f negative at the start, or positive at the other
end.

Sides: once lines without thickness overlap, their position does not show the side. The side is that of the last
accepted state for nearby pairs of places, else the present position. Nearby means less than halfway to the next coil.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from cprbm_scene.answer import Array, Ints
from fea_reference.facing import Tapers, borders
from fea_reference.hermite import NeutralLine, as_plane
from fea_reference.neighbours import nearest
from fea_reference.zones import SAMPLES_PER_ELEMENT, Gap, Survey, gap, gap_round_off, one_side, survey

_ALIKE = 0.5  # share of the distance of two places along the beam: largest deviation from a pair of known side
_FOLLOWS = 2.0  # elements: largest difference between partners of consecutive places
_ITERATIONS = 60
_TABLE = 80_000  # points times nodes: limit above which a tree search is faster than a table
_NOTHING = 1e-9  # times the square of an element's length


@dataclass(frozen=True, slots=True)
class Roles:
    """Choice of the place that carries the contact integral, and known sides.

    The integral runs along the ``later`` place of a pair, if the beam's end may lie over its own side, else along the
    earlier. The partner is then never nearer to this end than to the other end, which limits the partner (``ended``)
    if thick.

    ``across`` (k, 2) are pairs of places ζ and ζ_m of the last accepted state, and ``side`` (k,) are their sides.
    """

    later: bool
    ended: bool
    across: Array = field(compare=False)
    side: Array = field(compare=False)

    def sides(self, zeta: Array, zeta_m: Array, d: Array) -> Array:
        """Sides (k,) of places ``zeta`` (k,) against ``zeta_m`` (k,), from known pairs or the sign of ``d`` (k,)."""
        present = np.where(d < 0.0, -1.0, 1.0)
        if not self.side.size or not zeta.size:
            return present
        far, which = nearest(zeta + 1j * zeta_m, self.across[:, 0] + 1j * self.across[:, 1])
        return np.asarray(np.where(far <= _ALIKE * np.abs(zeta - zeta_m), self.side[which], present))

    def renewed(self, line: NeutralLine) -> Roles:
        """The roles with pairs and sides of the present ``line``, one per node and partner."""
        nodes = np.arange(line.n + 1)
        i, j = (index.ravel() for index in np.meshgrid(nodes, nodes[:-1], indexing="ij"))
        zeta, zeta_m, _ = _partners(line, nodes.astype(float), i, j, 0.0, self)
        there = gap(line, line, one_side(1.0), 0.0, None, zeta, zeta_m)
        # beyond an end a place has no side and may come around to either
        zeta, zeta_m, d = zeta[there.found], zeta_m[there.found], there.g[there.found]
        return Roles(self.later, self.ended, np.stack([zeta, zeta_m], axis=1), self.sides(zeta, zeta_m, d))


def without_known_sides(*, later: bool, ended: bool) -> Roles:
    """Roles without known sides."""
    return Roles(later, ended, np.empty((0, 2)), np.empty(0))


def survey_self(line: NeutralLine, roles: Roles, T: float, tapers: Tapers | None) -> Survey:
    """Self-contact gap survey, wherever the gap is below a few elements."""

    def at(where: Array, guess: Array) -> Gap:
        return gap(line, line, roles.sides, T, tapers, where, guess, ended=roles.ended)

    reach = 2.0 * abs(T) + 3.0 * line.longest
    knots = () if tapers is None else tapers.first.knots
    zeta = np.union1d(_samples(line, tapers, reach), np.array(knots))
    i, j = _elements_near(line, line.at(zeta)[0], reach)
    # largest sine of a lean, without the change of the line's speed
    slope = 0.0 if tapers is None else float(np.abs(tapers.first.slope(np.array(knots))).max())
    places, partners, i = _partners(line, zeta, i, j, 2.0 * slope / float(line.lengths.min()), roles)
    there = at(places, partners)
    usable = there.found & (np.abs(there.g + T) < reach)
    places, there, i = places[usable], there.chosen(usable), i[usable]
    if not places.size:
        return Survey(at, places, there, np.empty(0, dtype=bool), (), reach - T)
    order, follows = _sequences(i, there.zeta_m)
    return survey(at, places[order], there.chosen(order), follows, knots, floor=gap_round_off(line, line, T))


def _elements_near(line: NeutralLine, x: Array, reach: float) -> tuple[Ints, Ints]:
    """Pairs of point numbers of ``x`` (2, k) and elements with a node within ``reach``, in order."""
    if x.shape[1] * (line.n + 1) > _TABLE:
        near = KDTree(x.T).sparse_distance_matrix(KDTree(line.points.T), reach, output_type="ndarray")
        pairs = np.concatenate([near["i"] * (line.n + 1) + near["j"], near["i"] * (line.n + 1) + near["j"] - 1])
        i, j = np.divmod(np.unique(pairs), line.n + 1)
        return i[j < line.n], j[j < line.n]
    away_x, away_y = (np.subtract.outer(own, nodes) for own, nodes in zip(x, line.points, strict=True))
    near = away_x * away_x + away_y * away_y <= reach**2
    i, j = np.nonzero(near[:, :-1] | near[:, 1:])
    return i, j


def _partners(
    line: NeutralLine, zeta: Array, i: Ints, j: Ints, steepest: float, roles: Roles
) -> tuple[Array, Array, Ints]:
    """Partners of places ``zeta`` (k,) among candidate pairs of place ``i`` (m,) and element ``j`` (m,).

    ``steepest`` is the sine of the largest lean at an end.

    Returns:
        Places ζ, approximate partners ζ_m, and the numbers of the places.
    """
    before = j + 1.0 < zeta[i] if roles.later else j > zeta[i]
    i, j = i[before], j[before]
    x = line.at(zeta)[0]

    def f(node: Ints) -> Array:
        return np.asarray(((x[:, i] - line.points[:, node]) * line.tangents[:, node]).sum(axis=0))

    here, there = f(j), f(j + 1)
    # opposite to an end f is zero up to round-off and lean
    for at_end, f_end, node in ((j == 0, here, 0), (j == line.n - 1, there, line.n)):
        tolerance = _NOTHING * line.longest**2 + steepest * np.hypot(*(x[:, i[at_end]] - line.points[:, [node]]))
        f_end[at_end] = np.where(np.abs(f_end[at_end]) <= tolerance, 0.0, f_end[at_end])
    least = (here >= 0.0) & (there <= 0.0) & (here > there)
    share = here / np.where(least, here - there, 1.0)
    if roles.ended:
        for at_end, f_end, place in ((j == 0, -here, 0.0), (j == line.n - 1, there, 1.0)):
            beyond = at_end & (f_end > 0.0)
            least, share = least | beyond, np.where(beyond, place, share)
    return zeta[i[least]], (j + share)[least], i[least]


def _samples(line: NeutralLine, tapers: Tapers | None, reach: float) -> Array:
    """Equal steps within every element, and the places opposite to the line's ends, on either side."""
    even = np.arange(SAMPLES_PER_ELEMENT * line.n + 1) / SAMPLES_PER_ELEMENT
    x = line.at(even)[0]
    places = [even]
    sides = (1.0,) if tapers is None else (1.0, -1.0)
    rays = [borders(line, None if tapers is None else tapers.second, side) for side in sides]
    for border, end in product(rays, (0, line.n)):
        at = border.zeta == end
        point, tangent = as_plane(border.points[at]), as_plane(border.w[at])
        ahead = ((x - point) * tangent).sum(axis=0)
        near = np.hypot(*(x - point)) < reach
        left = np.flatnonzero(near[:-1] & near[1:] & (ahead[:-1] * ahead[1:] < 0.0))
        low, high, rising = even[left], even[left + 1], np.sign(ahead[left + 1])
        zeta = low + ahead[left] / (ahead[left] - ahead[left + 1]) * (high - low)
        for _ in range(_ITERATIONS if left.size else 0):
            y, y1, _y2 = line.at(zeta)
            value, slope = ((y - point) * tangent).sum(axis=0), (y1 * tangent).sum(axis=0)
            low, high = np.where(value * rising < 0.0, zeta, low), np.where(value * rising < 0.0, high, zeta)
            moved = zeta - value / np.where(slope == 0.0, 1.0, slope)
            moved = np.where((moved >= low) & (moved <= high), moved, 0.5 * (low + high))
            step, zeta = np.abs(moved - zeta).max(), moved
            if step < 1e-12 * line.n:
                break
        places.append(zeta)
    return np.unique(np.concatenate(places))


def _sequences(i: Ints, zeta_m: Array) -> tuple[Ints, NDArray[np.bool_]]:
    """Order (k,) that groups consecutive places with consecutive partners into sequences.

    Returns:
        The order, and (k−1,) True if an entry and the next are consecutive in a sequence.
    """
    number = np.argsort(i, kind="stable")
    first, stop = np.searchsorted(i[number], i + 1, side="left"), np.searchsorted(i[number], i + 1, side="right")
    count = stop - first
    left = np.repeat(np.arange(i.size), count)
    right = number[np.repeat(first - np.concatenate([[0], np.cumsum(count)[:-1]]), count) + np.arange(left.size)]
    follows = np.abs(zeta_m[left] - zeta_m[right]) <= _FOLLOWS
    left, right = left[follows], right[follows]
    links = coo_array((np.ones(left.size), (left, right)), shape=(i.size, i.size))
    _, sequence = connected_components(links, directed=False)
    order = np.lexsort((i, sequence))
    beside = (sequence[order][1:] == sequence[order][:-1]) & (np.diff(i[order]) == 1)
    return order, beside
