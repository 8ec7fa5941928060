"""Fixed places at the nearest feet, compiled, and the state of known places.

A place is the same in two groups if pair, curve, piece and parameter are equal; a corner or a bend has a single place.
Both groups have the order of all possible places, so that the search for the same place goes on behind the last.
"""

from typing import NamedTuple

import numpy as np

from cprbm.chain import compiled, compiled_inner
from cprbm.contact.closest import depth_beyond, thickness_between
from cprbm.contact.curve import CurveArrays
from cprbm.contact.gap import Places
from cprbm.contact.settling import choose_sides, find_bends, find_feet, near_pairs, settle_place
from cprbm_scene.answer import Array, Flags, Ints

FREE = -1
"""Number in place of a body's for a free end of a beam."""

BESIDE = 1
"""Pieces from a beam's end within which a foot counts as lying on the end's body."""

REACH = 0.1
"""Distance of two boxes, over the longest beam, for places of a pair: farther boxes cannot meet in a step."""

PARALLEL = 1e-9
"""Sine of an angle between a guide and an edge, and share of a bend in an edge, that counts as round-off."""

ROUNDS = 5
"""Rounds from chord to chord for the place of a bend."""


class Sites(NamedTuple):
    """All fixed places of a mechanism, and the bodies of the curves.

    Attributes:
        possible: places, feet not found.
        columns: numbers of the two curves of every pair (pairs, 2).
        body: numbers (curves, 2) of the bodies at start and end.
        slide: directions (curves, 2, 2) in which the bodies slide; zero at rest, NaN for every other motion.
        rigid: curves of bodies (curves,).
        welded: welds (curves, 2) of beams.
        sharing: ends (curves, 2) with a shared force: the first joint has the force of the second.
    """

    possible: Places
    columns: Ints
    body: Ints
    slide: Array
    rigid: Flags
    welded: Flags
    sharing: Flags


@compiled
def picked(places: Places, which: Ints) -> Places:  # pragma: no cover
    """Copies of the places of these numbers."""
    return Places(
        places.pair[which],
        places.curve[which],
        places.piece[which],
        places.xi[which],
        places.other[which],
        places.foot[which],
        places.eta[which],
        places.at_point[which],
        places.side[which],
        places.moves[which],
        places.shares[which],
        places.force[which],
    )


@compiled
def joined(places: Places, others: Places) -> Places:  # pragma: no cover
    """Both groups of places, in this order."""
    return Places(
        np.concatenate((places.pair, others.pair)),
        np.concatenate((places.curve, others.curve)),
        np.concatenate((places.piece, others.piece)),
        np.concatenate((places.xi, others.xi)),
        np.concatenate((places.other, others.other)),
        np.concatenate((places.foot, others.foot)),
        np.concatenate((places.eta, others.eta)),
        np.concatenate((places.at_point, others.at_point)),
        np.concatenate((places.side, others.side)),
        np.concatenate((places.moves, others.moves)),
        np.concatenate((places.shares, others.shares)),
        np.concatenate((places.force, others.force)),
    )


@compiled_inner
def is_straight(curves: CurveArrays, piece: int) -> bool:  # pragma: no cover
    """True for a straight piece of a body's edge."""
    bends = abs(curves.real[piece, 1, 2]) + abs(curves.real[piece, 1, 3])
    bends += abs(curves.imaginary[piece, 1, 2]) + abs(curves.imaginary[piece, 1, 3])
    speed = np.hypot(curves.real[piece, 1, 1], curves.imaginary[piece, 1, 1])
    return bool(curves.angle[piece] < 0 and bends < PARALLEL * speed)


@compiled_inner
def is_on_end_body(curves: CurveArrays, sites: Sites, places: Places, k: int, end: int) -> bool:  # pragma: no cover
    """True if a foot lies on, or beside a joint with, the body of the start (0) or end (1) of the place's curve.

    A body that slides along a straight edge keeps the gap of a welded end, as if the edge were on the body.
    """
    curve, other, foot = places.curve[k], places.other[k], places.foot[k]
    own, rigid = sites.body[curve, end], sites.rigid[other]
    x, y = curves.real[foot, 1, 1], curves.imaginary[foot, 1, 1]
    edge, beam = sites.slide[other, 0], sites.slide[curve, end]
    across = abs(x * edge[1] - y * edge[0]) + abs(x * beam[1] - y * beam[0])
    guided = sites.welded[curve, end] and is_straight(curves, foot) and across < PARALLEL * np.hypot(x, y)
    at_start = own == sites.body[other, 0] and (rigid or foot <= curves.first[other] + BESIDE)
    at_end = own == sites.body[other, 1] and (rigid or foot >= curves.last[other] - BESIDE)
    return bool(guided or (own != FREE and (at_start or at_end)))


@compiled_inner
def is_movable(curves: CurveArrays, sites: Sites, places: Places, k: int) -> bool:  # pragma: no cover
    """True if a place may move along the place's curve."""
    curve, piece, xi = places.curve[k], places.piece[k], places.xi[k]
    at_first, at_last = piece == curves.first[curve], piece == curves.last[curve]
    return not (
        (at_first and (xi == 0.0 or is_on_end_body(curves, sites, places, k, 0)))
        or (at_last and (xi == 1.0 or is_on_end_body(curves, sites, places, k, 1)))
    )


@compiled
def places_at_feet(
    z: Array,
    curves: CurveArrays,
    sites: Sites,
    sides: Array,
    near: Flags,
    pressed: Flags,
    counters: Ints,
) -> Places:  # pragma: no cover
    """The places of the pairs marked ``near``, as :func:`cprbm.contact.candidates.fixed_places` says.

    On the curves marked ``pressed`` (curves,) ends at a weld on the curve's body are places too.
    """
    mine = np.flatnonzero(near[sites.possible.pair])
    places, distance = picked(sites.possible, mine), np.empty(mine.size)
    find_feet(z, curves, places, distance, counters)
    kept = np.isfinite(distance)
    for k in range(mine.size):
        pair, curve, other, piece, foot = (
            places.pair[k],
            places.curve[k],
            places.other[k],
            places.piece[k],
            places.foot[k],
        )
        before, corner = piece - curves.first[curve] + int(places.xi[k]), curves.angle[piece] < 0
        behind = curves.last[curve] - curves.first[curve] + 1 - before
        places.side[k] = 0.0 if corner else sides[pair, int(curve != sites.columns[pair, 0])]
        kept[k] &= curve != other or foot >= piece or behind == 0
        for end, links, last in ((0, before, curves.first[other]), (1, behind, curves.last[other])):
            if (corner or links <= 1) and is_on_end_body(curves, sites, places, k, end):
                # a corner is no place in an end link held by the corner's body
                at_weld = links == 0 and not (sites.welded[curve, end] and pressed[other])
                kept[k] &= foot != last if corner else not at_weld
                if links == 1 and sites.sharing[curve, end]:
                    places.shares[k] = 1 - 2 * end
    return picked(places, np.flatnonzero(kept))


@compiled
def matched(curves: CurveArrays, places: Places, others: Places) -> Ints:  # pragma: no cover
    """Numbers of the same joints, ends and corners among ``others``, −1 without."""
    found, at, count = np.full(places.piece.size, -1), 0, others.piece.size
    for k in range(places.piece.size):
        if places.moves[k] and curves.angle[places.piece[k]] >= 0:
            continue
        for step in range(count):
            j = at + step - (count if at + step >= count else 0)
            if (
                places.pair[k] == others.pair[j]
                and places.curve[k] == others.curve[j]
                and places.moves[k] == others.moves[j]
                and (places.moves[k] or (places.piece[k] == others.piece[j] and places.xi[k] == others.xi[j]))
            ):
                found[k], at = j, j + 1
                break
    return found


@compiled_inner
def _turn_side(z: Array, curves: CurveArrays, places: Places, k: int, counters: Ints) -> None:  # pragma: no cover
    """Turn the side of a place beyond another beam: the place has come round an end, not through the beam.

    Beams with an overlap below ``BEYOND`` of their half thicknesses, or lines of a piece, are in contact.  A place
    before an end, or where beams cross steeply, has no side until the place is seen beside the beam.  The foot stays.
    """
    foot, eta, at_point = places.foot[k], places.eta[k], places.at_point[k]
    gap, _ = settle_place(z, curves, places, k, counters, 0)
    thickness = thickness_between(curves, places.piece[k], places.xi[k], places.foot[k], places.eta[k])
    if places.at_point[k] or not np.isfinite(gap):
        places.side[k] = 0.0
    elif gap + thickness < -depth_beyond(curves, places.piece[k], thickness):
        places.side[k] *= -1.0
    places.foot[k], places.eta[k], places.at_point[k] = foot, eta, at_point


@compiled
def contact_places(
    z: Array,
    curves: CurveArrays,
    sites: Sites,
    sides: Array,
    corner_sides: Array,
    old: Places,
    closed: Flags,
    keep_sides: Flags,
    counters: Ints,
) -> tuple[Places, Flags]:  # pragma: no cover
    """Fixed places at the nearest feet with the moving places of ``old``, and marks of the closed among both.

    Known places keep force, state and side.  A new place of a beam in self-contact has the present side, and a place
    beyond another beam has come round the end and changes the side.

    Args:
        z, curves: the state.
        sites: of the geometry.
        sides, corner_sides: of the contacts.
        old, closed: the known places.
        keep_sides: known places that do not change the side.
        counters: count the searches.
    """
    nothing = np.zeros(curves.first.size, np.bool_)
    near = near_pairs(z, curves, sites.columns, REACH, counters)
    for k in range(closed.size):
        near[old.pair[k]] |= closed[k]
    fixed = places_at_feet(z, curves, sites, sides, near, nothing, counters)
    find_bends(z, curves, fixed, ROUNDS)
    choose_sides(z, curves, fixed)
    count = fixed.piece.size
    moving = np.flatnonzero(old.moves & (curves.angle[old.piece] >= 0))
    known, marks = matched(curves, fixed, old), np.zeros(count + moving.size, np.bool_)
    for k in range(count):
        curve, j = fixed.curve[k], known[k]
        between = not sites.rigid[curve] and not sites.rigid[fixed.other[k]] and curve != fixed.other[k]
        if j >= 0 and closed[j]:
            marks[k], fixed.force[k], fixed.side[k] = True, old.force[j], old.side[j]
            fixed.piece[k], fixed.xi[k], fixed.foot[k], fixed.eta[k] = old.piece[j], old.xi[j], old.foot[j], old.eta[j]
        elif between:
            if j >= 0 and (keep_sides[j] or old.side[j] != 0.0):
                fixed.side[k] = old.side[j]
            if j < 0 or not keep_sides[j]:
                _turn_side(z, curves, fixed, k, counters)
        if curves.angle[fixed.piece[k]] < 0:
            fixed.side[k] = corner_sides[curve]
    marks[count:] = closed[moving]
    return joined(fixed, picked(old, moving)), marks
