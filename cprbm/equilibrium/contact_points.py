"""Places of contact: joints along a length of contact, a moving place for a point of contact.

After every solve the rule looks at runs of neighbouring closed joints:

* one or two closed joints with a minimum of the gap nearby become a moving place;
* a moving place with a closed joint nearby, or with a gap of negative curvature, becomes joints again;
* joints beside a moving place with less than a small part of the force open.  A light joint that closes again and
  again is part of a length: the moving place becomes joints.

The equilibrium is solved again until the rule changes nothing.  Where moving places fail, or would move far at once,
joints are solved first and made points anew, once: joints for flat points, else for all points.  Where joints fail too,
the joints of the last solution stand for the point.
"""

from dataclasses import replace

import numpy as np

from cprbm.contact import (
    REACH,
    TOUCHING,
    Contacts,
    Geometry,
    Places,
    copied,
    corner_sides,
    is_left,
    is_movable,
    joined,
    left_corner,
    matched,
    near_pairs,
    on_edge,
    taken,
)
from cprbm.equilibrium.contact_set import (
    ContactClosesError,
    NotConvergedError,
    Touched,
    passed_through,
    solve_set,
    with_fixed_places,
)
from cprbm.equilibrium.factors import Springs
from cprbm.equilibrium.iteration import OVERLAP, arcs_of, beside_points
from cprbm.equilibrium.neighbours import ISOLATED, LIGHT, given_up, points_at, short_runs
from cprbm.equilibrium.system import State, System
from cprbm_scene.answer import Flags

ROUNDS = 12
"""Solves under the same targets."""

RETRIES = 6
"""First solves, half of all, after which light joints open, and a moving place that became joints may move again."""

STEEPEST = 0.1
"""Largest turn of two overlapping curves against each other over a link, rad, where joints stand for a point.

The joints on both sides of a small round edge hold like a valley, whatever the direction of the force.
"""


def touched_equilibrium(
    system: System,
    start: State,
    iterations: int,
    springs: Springs | None = None,
    awaited: frozenset[int] = frozenset(),
) -> Touched:
    """Equilibrium near a state under the state's targets, with settled places of contact.

    Raises:
        ContactClosesError: ``awaited`` pairs overlap in the equilibrium.
        NotConvergedError: no equilibrium was found, the places do not settle, or a beam passed through itself.
    """
    geometry, contacts = system.geometry, start.contacts
    if not geometry.pairs:
        return solve_set(system, start, iterations, springs)
    # beams of pairs that are kept open may overlap corners: the side of the begin stays
    corners = np.where(
        bool(contacts.kept_open) & (contacts.corner_sides != 0.0),
        contacts.corner_sides,
        corner_sides(geometry, start.z, contacts.corner_sides, contacts.counters),
    )
    contacts = with_fixed_places(
        geometry, start.z, replace(contacts, given_up=frozenset(), corner_sides=corners), turning=True
    )
    before, old, joints_tried, failed = start.z, contacts.places, False, frozenset[tuple[int, int]]()
    for number in range(ROUNDS):
        try:
            solved = solve_set(system, replace(start, contacts=contacts), iterations, springs, awaited)
        except NotConvergedError:
            moves = contacts.places.moves & ~on_edge(geometry.arrays, contacts.places)
            if moves.any():
                # joints do not stand for a point between curves that turn much against each other over a link
                flat = moves & (
                    contacts.settled(geometry, start.z)[2] * geometry.arrays.link[contacts.places.piece] <= STEEPEST
                )
                contacts = _without(geometry, contacts, flat if flat.any() else moves)
                failed |= contacts.given_up
                contacts, joints_tried = replace(contacts, given_up=failed if joints_tried else frozenset()), True
            elif failed and not start.contacts.places.moves.any():
                contacts = replace(start.contacts, given_up=failed)
            else:
                raise
            contacts = with_fixed_places(geometry, start.z, contacts)
            continue
        revised = _revised(geometry, solved, LIGHT if number < RETRIES else 0.0)
        if revised is None:
            if passed_through(geometry, before, old, solved.state):
                raise NotConvergedError("a beam passed through itself or over a point")
            revised = _come_near(geometry, solved)
            if revised is None:
                return solved
        if len(closing := revised.places.pair[revised.closed & revised.of_pairs(awaited)]):
            raise ContactClosesError(closing, closing)
        if number < RETRIES and not joints_tried:
            # the joints beside a place may open with the joints in its stead: the place is tried again
            revised = replace(revised, given_up=frozenset())
        start, contacts = solved.state, with_fixed_places(geometry, solved.state.z, revised)
    raise NotConvergedError("the places of contact do not settle")


def _revised(geometry: Geometry, solved: Touched, least: float) -> Contacts | None:
    """Contacts with other places, or None if the places are right.

    Joints beside a point with at most the ``least`` part of its force open.
    """
    if geometry.joints_alone:
        return None
    contacts, places = solved.state.contacts, solved.state.contacts.places
    gone, light = given_up(geometry.arrays, geometry.sites, places, contacts.closed, solved.curvatures, least)
    if gone.any():
        return _without(geometry, contacts, gone)
    if light.any():
        kept = places._replace(force=np.where(light, 0.0, places.force))
        return replace(contacts, places=kept, closed=contacts.closed & ~light)
    if geometry.has_corners:
        ends = _at_ends(geometry, solved)
        if ends is not None:
            return ends
        created, replaced = _leaving_corners(geometry, solved)
        if len(created.pair):
            return _with_points(contacts, created, replaced)
    return _points(geometry, solved)


def _with_points(contacts: Contacts, created: Places, replaced: Flags) -> Contacts:
    """Contacts with new points of contact in place of others."""
    closed = np.concatenate([contacts.closed[~replaced], np.ones(len(created.pair), dtype=bool)])
    return replace(contacts, places=joined(taken(contacts.places, ~replaced), created), closed=closed)


def _at_ends(geometry: Geometry, solved: Touched) -> Contacts | None:
    """Contacts with the ends of beams in the place of corners that have left the round ends; None without any."""
    contacts, places = solved.state.contacts, solved.state.contacts.places
    kept, closed = copied(places), contacts.closed.copy()
    arcs, moved = arcs_of(geometry.arrays, places), False
    for k in np.flatnonzero(contacts.closed & places.at_point & on_edge(geometry.arrays, places)).tolist():
        if is_left(geometry, solved.state.z, places, k):
            mine = ~places.moves & (places.pair == places.pair[k]) & (places.curve == places.other[k])
            at = np.flatnonzero(mine & (arcs == arcs[k]))
            closed[k], closed[at], kept.force[at], moved = False, True, places.force[k], moved or len(at) > 0
    return replace(contacts, places=kept, closed=closed) if moved else None


def _leaving_corners(geometry: Geometry, solved: Touched) -> tuple[Places, Flags]:
    """Moving places on faces for points of contact that leave corners; the replaced places at corners.

    A corner at the end of a length of contact stays.
    """
    contacts, places, z = solved.state.contacts, solved.state.contacts.places, solved.state.z
    replaced = np.zeros(len(contacts.closed), dtype=bool)
    created = taken(places, replaced)
    arcs = arcs_of(geometry.arrays, places)
    for k in np.flatnonzero(contacts.closed & ~places.at_point & on_edge(geometry.arrays, places)).tolist():
        if not is_left(geometry, z, places, k):
            continue
        trial = left_corner(geometry, z, places, k, contacts.sides, contacts.counters)
        mine = contacts.closed & (places.pair == places.pair[k]) & (np.arange(len(arcs)) != k)
        if trial is not None and np.all(
            np.abs(arcs[mine] - arcs_of(geometry.arrays, trial)) > ISOLATED * geometry.arrays.link[trial.piece]
        ):
            replaced[k], created = True, joined(created, trial)
    return created, replaced


def _come_near(geometry: Geometry, solved: Touched) -> Contacts | None:
    """Contacts with the feet of a new search where such a foot overlaps at the end; None without any.

    New are the feet of pairs without places at the start, and on a rigid curve of several pieces: a foot that moves
    along one face does not see another face come near.
    """
    z, contacts = solved.state.z, solved.state.contacts
    late = near_pairs(z, geometry.arrays, geometry.sites.columns, REACH, contacts.counters)
    late[list(contacts.kept_open)] = False
    faces = geometry.sites.rigid & (geometry.arrays.last > geometry.arrays.first)
    late[contacts.places.pair] &= faces[geometry.sites.columns[contacts.places.pair, 1]]
    if not late.any():
        return None
    new = with_fixed_places(geometry, z, contacts)
    known = matched(geometry.arrays, new.places, contacts.places)
    least = np.append(solved.gaps - TOUCHING, 0.0)[known]  # the last of a place that is new
    late = late[new.places.pair] & ((known >= 0) | ~new.closed)
    return new if np.any(late & (new.gaps(geometry, z) < np.minimum(least, -OVERLAP))) else None


def _without(geometry: Geometry, contacts: Contacts, gone: Flags) -> Contacts:
    """Contacts after moving places become joints again; the joints within a link share the force."""
    places, closed = copied(contacts.places), contacts.closed.copy()
    arcs, link, given_up = arcs_of(geometry.arrays, places), geometry.arrays.link[places.piece], set(contacts.given_up)
    for k in np.flatnonzero(gone).tolist():
        given_up |= {(int(places.pair[k]), int(places.piece[k]) + e) for e in range(-ISOLATED, ISOLATED + 1)}
        share = 1.0 - np.abs(arcs - arcs[k]) / link[k]
        mine = (places.pair == places.pair[k]) & (places.curve == places.curve[k]) & contacts.closed[k]
        beside = mine & ~places.moves & (share > 0.0)
        closed |= beside
        places.force[beside] += share[beside] * places.force[k]
    return replace(contacts, places=taken(places, ~gone), closed=closed[~gone], given_up=frozenset(given_up))


def _points(geometry: Geometry, solved: Touched) -> Contacts | None:
    """Contacts with moving places for lonely closed joints and for minima that overlap; None without any.

    Raises:
        NotConvergedError: joints stand for a given-up point, and the curves overlap steeply between the joints.
    """
    contacts, places, z = solved.state.contacts, solved.state.contacts.places, solved.state.z
    curves, closed = geometry.arrays, contacts.closed
    runs = short_runs(curves, geometry.sites, places, closed, solved.gaps)
    if not len(runs):
        return None
    forces = places.force[runs]
    forces[:, 1] *= runs[:, 1] > runs[:, 0]
    heavier = runs[np.arange(len(runs)), np.argmax(forces, axis=1)]
    points, gaps, curvatures = points_at(z, curves, places, heavier, forces.sum(axis=1), contacts.counters)
    arcs, found = arcs_of(curves, places), arcs_of(curves, points)
    overlap, link = -OVERLAP - beside_points(curves, places, closed)[1], curves.link[places.piece]
    replaced = np.zeros(len(closed), dtype=bool)
    created = taken(places, replaced)
    for i in np.flatnonzero(
        closed[heavier] | ((gaps < overlap[heavier]) & ~contacts.of_pairs(contacts.kept_open)[heavier])
    ).tolist():
        best = heavier[i]
        # the joints of a run are neighbours
        if any((int(places.pair[k]), int(places.piece[k])) in contacts.given_up for k in runs[i]):
            if closed[best] and gaps[i] < -OVERLAP and curvatures[i] * curves.link[points.piece[i]] > STEEPEST:
                raise NotConvergedError("a contact's curves overlap between two joints")
            continue
        if curvatures[i] <= 0.0 or not is_movable(curves, geometry.sites, points, i):
            continue
        run = np.flatnonzero(np.isin(np.arange(len(arcs)) + places.shares, runs[i]))
        others = closed & (places.pair == places.pair[best]) & (places.curve == places.curve[best])
        others[run] = False
        around = np.concatenate([arcs[others], arcs_of(curves, created)[created.pair == places.pair[best]]])
        lonely = not np.any(np.abs(around - found[i]) < ISOLATED * link[best])
        if lonely and np.any(np.abs(arcs[run] - found[i]) < link[best]):
            replaced[run] = closed[run]
            created = joined(created, taken(points, np.array([i])))
    return _with_points(contacts, created, replaced) if len(created.pair) else None
