"""Rows of contact in random states: solution and inertia against dense matrices, and how far open places stay open."""

from dataclasses import replace

import numpy as np
import pytest

from cprbm.contact import gap_frame, is_movable, new_counters, on_edge, settle, settle_near, taken
from cprbm.equilibrium.factors import factorise
from cprbm.equilibrium.system import system_of
from tests.cprbm.contact.workshop import FINDING, all_places, mechanism, settled
from tests.cprbm.second.systems import disturbed

SEEDS = range(12)

FOCUS = 2.0
"""Largest change of a foot by a turn of its curve, in pieces of the curve."""

CLOSED = 4
"""Places closed at once: more rows than the two beams have freedoms repeat others."""


def random_contact(seed):
    """System, geometry, a state near rest, places with random forces, and which are closed."""
    m, geometry, rest = mechanism(7)
    system, random = system_of(m, geometry), np.random.default_rng(seed)
    state = disturbed(system, seed, 3e-3)
    # large forces of links turn some of the states into saddles
    state.z[system.links.first[:, None] + [2, 3]] *= 1.0 + 400.0 * (seed % 3)
    places = all_places(geometry, state.z[: len(rest)], rest)
    gaps, curvatures = settled(geometry, state.z, places)
    bend = on_edge(geometry.arrays, places)
    corner = bend & geometry.arrays.is_point[places.curve]
    free = [is_movable(geometry.arrays, geometry.sites, places, k) for k in range(len(gaps))]
    places.moves[:] = corner | ((curvatures > 0.5) & free & (random.random(len(gaps)) < 0.3))
    # a place with the force of its neighbour does not move
    places.moves[places.shares != 0] = False
    _, curvatures = settled(geometry, state.z, places, FINDING)
    inside = (places.xi > 0.05) & (places.xi < 0.95)
    inside &= (curvatures > 0.5) & [is_movable(geometry.arrays, geometry.sites, places, k) for k in range(len(gaps))]
    possible = np.isfinite(gaps) & (~places.moves | corner | inside) & (corner | ~bend)
    # a foot near the centre of its curve's curvature magnifies the round-off of the differences
    frames = [gap_frame(state.z, geometry.arrays, places, k) for k in range(len(gaps))]
    possible &= np.array([abs(frame.ee) for frame in frames]) * geometry.arrays.span[places.foot] ** 2 < FOCUS
    leaders, closed = np.arange(len(gaps)) + places.shares, np.zeros(len(gaps), dtype=bool)
    closed[random.permutation(np.flatnonzero(possible))[:CLOSED]] = True
    closed[:] = closed[leaders] & possible[leaders]
    places.force[:] = (random.normal(size=len(gaps)) * closed)[leaders]
    return system, geometry, state, places, closed


def residual(system, geometry, state, places, closed):
    """Gradient by the unknowns and by the forces; feet and moving places follow the state."""
    gaps = np.empty(len(closed))
    settle(state.z, geometry.arrays, places, gaps, gaps.copy(), new_counters(), FINDING)
    factors, gradient = factorise(
        system, replace(state, contacts=replace(state.contacts, places=places, closed=closed))
    )
    return np.concatenate([gradient, -factors.bordered.columns.values])


@pytest.mark.parametrize("seed", SEEDS)
def test_solution_and_inertia_with_contacts_are_those_of_the_dense_matrix(seed):
    # reference: the matrix by central differences of the gradient, its eigenvalues and its product with the solution
    system, geometry, state, places, closed = random_contact(seed)
    own, size = np.flatnonzero(closed & (places.shares == 0)), system.size
    kept = np.concatenate([np.arange(system.rows.first), system.rows.first + np.flatnonzero(state.driven)])
    kept = np.concatenate([kept, size + np.arange(len(own))])

    def at(offset):
        moved = taken(places, np.arange(len(closed)))
        moved.force[own] += offset[size:]
        moved.force[:] = moved.force[np.arange(len(closed)) + moved.shares]
        return residual(system, geometry, replace(state, z=state.z + offset[:size]), moved, closed)[kept]

    step = 1e-6
    units = step * np.eye(size + len(own))[kept]
    matrix = np.array([(at(unit) - at(-unit)) / (2.0 * step) for unit in units])
    matrix = 0.5 * (matrix + matrix.T)
    residual(system, geometry, state, places, closed)
    contacts = replace(state.contacts, places=places, closed=closed)
    factors, _ = factorise(system, replace(state, contacts=contacts))
    load = np.zeros(size + len(own))
    load[kept] = np.random.default_rng(seed).normal(size=len(kept))
    found = np.concatenate(factors.solve_both(load[:size], load[size:]))[kept]
    # round-off of the differences, 1e-16 of a force over the step, stands in all entries
    allowed = 1e-6 * (1.0 + np.abs(matrix) @ np.abs(found)) + 1e-9 * np.abs(matrix).max() * np.abs(found).max()
    assert (np.abs(matrix @ found - load[kept]) < allowed).all()
    equalities = 2 * len(system.metric) + int(state.driven.sum()) + len(own)
    assert factors.lost == int((np.linalg.eigvalsh(matrix) < 0.0).sum()) - equalities


def test_the_random_states_hold_all_kinds_of_rows():
    # the test above is worth something if all kinds occur
    kinds, lost = set(), set()
    for seed in SEEDS:
        system, geometry, state, places, closed = random_contact(seed)
        kinds |= {
            (bool(a), bool(b), bool(c))
            for a, b, c in zip(places.at_point[closed], places.moves[closed], places.shares[closed] != 0, strict=True)
        }
        kinds |= {geometry.pairs[k].name for k in places.pair[closed]}
        contacts = replace(state.contacts, places=places, closed=closed)
        lost.add(factorise(system, replace(state, contacts=contacts))[0].lost)
    assert {(at_point, moves, False) for at_point in (False, True) for moves in (False, True)} < kinds
    assert (False, False, True) in kinds
    assert {"beams", "circle", "line", "plane", "graph", "ellipse", "ring"} < kinds
    assert len(lost) > 2


@pytest.mark.parametrize("seed", SEEDS)
def test_places_stay_open_while_nodes_move_less_than_their_room(seed):
    system, geometry, state, places, closed = random_contact(seed)
    places.moves[:], closed[:] = False, False
    room, gaps, random = np.zeros(len(closed)), np.empty(len(closed)), np.random.default_rng(seed)
    counters = new_counters()
    settle_near(state.z, geometry.arrays, places, closed, gaps, gaps.copy(), room, counters, 0)
    # the first links' way shows how far a place may come: as far as the median of the rooms
    way = float(np.median(room[room > 0.0]))
    z = state.z.copy()
    nodes = np.concatenate([system.nodes.ravel(), np.arange(system.border.first, system.rows.first)])
    z[nodes] += way * random.choice([-1.0, 1.0], size=len(nodes))
    moved, _ = settled(geometry, z, places)
    far = room > way
    assert far.sum() > 5
    assert (moved[far] > 0.0).all()
