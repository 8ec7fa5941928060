"""Candidates of pairs, sides, moving places, angle stops of beams pinned on their edge."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cprbm.contact import (
    fixed_places,
    is_movable,
    joined,
    move_places,
    new_counters,
    on_edge,
    sides_at_rest,
    taken,
)
from cprbm_scene import read, scene_from
from tests.cprbm.contact.workshop import FINDING, all_places, at, geometry_of, mechanism, random_state, settled

CASES = Path(__file__).parents[3] / "comparisons" / "cases"


def built_in(name, links=12):
    return geometry_of(read(CASES / f"{name}.toml"), links)[:2]


def test_joints_hold_ends_and_the_first_joint_beside_a_clamp_shares_its_force():
    """Wrapped: clamped on the circle's body; the tip is welded to another body and is a place."""
    m, geometry = built_in("wrapped")
    places = all_places(geometry, np.array(m.rest), np.array(m.rest))
    nodes = places.piece + places.xi.astype(int)
    assert nodes.tolist() == list(range(1, 14))
    assert places.shares.tolist() == [1] + 12 * [0]


def test_places_may_move_but_in_the_end_link_at_a_weld():
    m, geometry = built_in("wrapped")
    places = all_places(geometry, np.array(m.rest), np.array(m.rest))
    inner = taken(places, np.array([0, 0, 11]))
    inner.piece[:], inner.xi[:] = [0, 1, 12], 0.5
    assert [is_movable(geometry.arrays, geometry.sites, inner, k) for k in range(3)] == [False, True, True]
    ends = taken(places, places.xi == 1.0)
    assert len(ends.xi)
    assert not any(is_movable(geometry.arrays, geometry.sites, ends, k) for k in range(len(ends.xi)))


def test_ends_of_the_second_beam_are_places_too():
    _, geometry, rest = mechanism()
    places = all_places(geometry, rest, rest)
    lower = next(k for k, curve in enumerate(geometry.curves) if curve.name == "lower")
    mine = (places.pair == 0) & (places.curve == lower)
    # ground holds the start, and the end of the upper beam beside the start
    assert places.xi[mine].tolist() == [1.0]


def test_sides_follow_the_scene_and_the_drawing():
    _, geometry, rest = mechanism()
    sides = sides_at_rest(geometry, rest, new_counters())
    by_name = dict(zip((pair.name for pair in geometry.pairs), sides.tolist(), strict=True))
    # the upper beam is left of the lower beam, the lower right of the upper; both run along x
    assert by_name["beams"] == [1.0, -1.0]
    assert by_name["line"] == [-1.0, -1.0]
    assert by_name["graph"] == by_name["plane"] == by_name["ring"] == [1.0, 1.0]
    assert by_name["ellipse"] == [-1.0, -1.0]


def test_a_beam_touches_itself_after_half_a_turn_and_each_gap_counts_once():
    m, geometry = built_in("rolled", 40)
    z = np.array(m.rest)
    assert not len(all_places(geometry, z, z).pair)
    # roll the beam into a spiral of 1.5 turns with half a millimetre between the layers
    nodes = m.beam_nodes(next(iter(m.chains)))
    chain = next(iter(m.chains.values()))
    angle = 3.0 * np.pi * chain.arcs / chain.length
    radius = chain.length / (3.0 * np.pi) * (1.0 + 0.05 * angle)
    spiral = radius * np.exp(1j * angle)
    z[nodes], z[nodes + 1] = spiral.real, spiral.imag
    z[m.beam_angles(chain.name)] = np.unwrap(np.angle(np.diff(spiral)))
    places = all_places(geometry, z, np.array(m.rest))
    gaps, _ = settled(geometry, z, places)
    assert len(places.pair) > 10
    assert np.all((places.foot >= places.piece) | (places.xi == 1.0))
    curve = geometry.curves[0]
    dense = at(curve, z, np.linspace(0.0, chain.length, 20001))
    turns = np.linspace(0.0, 3.0 * np.pi, 20001)
    for k in np.flatnonzero(np.isfinite(gaps))[::4]:
        s = curve.arcs[places.piece[k]] + places.xi[k] * np.diff(curve.arcs)[places.piece[k]]
        x = at(curve, z, np.array([s]))[0]
        beyond = np.abs(turns - 3.0 * np.pi * s / chain.length) > 3.0
        least = np.abs(dense[beyond] - x).min() - 2.0 * curve.half_thickness[0]
        if not places.at_point[k]:
            assert gaps[k] == pytest.approx(least, abs=1e-6)


def test_moving_places_follow_their_linear_change():
    """A place moved by the linear change differs from the settled place by the square of the change."""
    m, geometry, rest = mechanism()
    z = random_state(m, geometry, rest, 0)
    places = all_places(geometry, z, rest)
    circle = [pair.name for pair in geometry.pairs].index("circle")
    gaps, _ = settled(geometry, z, places)
    mine = np.flatnonzero((places.pair == circle) & ~on_edge(geometry.arrays, places))
    best = mine[np.argmin(gaps[mine])]
    point = taken(places, np.array([best]))
    point.moves[:], point.force[:] = True, 30.0
    settled(geometry, z, point, FINDING)
    rng = np.random.default_rng(1)
    direction = rng.normal(size=z.shape)
    errors = []
    for size in (1e-4, 5e-5):
        moved, found = taken(point, np.array([0])), taken(point, np.array([0]))
        move_places(z, geometry.arrays, moved, size * direction, np.array([100.0 * size]), 1.0, 2.0)
        found.force[:] += 100.0 * size
        settled(geometry, z + size * direction, found, FINDING)
        errors.append(abs(moved.piece[0] + moved.xi[0] - found.piece[0] - found.xi[0]))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


def test_gaps_to_round_shapes_are_distances():
    """Outside of an ellipse, and inside a ring: the ring's radius less the distance from the centre."""
    m, geometry, rest = mechanism()
    places = all_places(geometry, rest, rest)
    gaps, _ = settled(geometry, rest, places)
    names = np.array([pair.name for pair in geometry.pairs])[places.pair]
    turn = np.linspace(0.0, 2.0 * np.pi, 100_001)
    ellipse = 0.014 * np.cos(turn) + 0.007j * np.sin(turn)
    around = complex(*m.units.place((0.02, 0.028))) + ellipse * np.exp(0.2j) / m.units.length
    centre, radius = complex(*m.units.place((0.05, 0.01))), 0.08 / m.units.length
    for k in np.flatnonzero(
        np.isin(names, ["ellipse", "ring"]) & (places.xi == 0.0) & ~on_edge(geometry.arrays, places)
    ):
        curve = geometry.curves[places.curve[k]]
        node = places.piece[k] - geometry.arrays.first[places.curve[k]]
        x = at(curve, rest, curve.arcs[[node]])[0]
        apart = np.abs(around - x).min() if names[k] == "ellipse" else radius - abs(x - centre)
        assert gaps[k] == pytest.approx(apart - curve.half_thickness[node], abs=1e-8)


def test_far_pairs_have_no_places():
    _, geometry, rest = mechanism()
    sides, counters = sides_at_rest(geometry, rest, new_counters()), new_counters()
    none = fixed_places(geometry, rest, sides, np.zeros(len(geometry.pairs), dtype=bool), counters)
    assert not len(none.pair)
    assert not counters.any()
    all_of_them = all_places(geometry, rest, rest)
    assert len(joined(none, all_of_them).pair) == len(all_of_them.pair)


def test_a_beam_pinned_on_its_edge_has_an_angle_stop():
    """Five-bar: the rows hold as drawn, and open as the beam turns away from the edge."""
    m, _ = built_in("five-bar")
    rows = [row for row in m.rows if row.name.endswith(".pin")]
    assert rows
    rest = np.array(m.rest)
    for row in rows:
        assert row.limit
        assert not row.driven
        assert -1e-9 <= row.form.value(rest) < np.pi
        (index, factor), *_ = row.form.linear
        turned = rest.copy()
        turned[index] += 0.1 * np.sign(factor)
        assert row.form.value(turned) - row.form.value(rest) == pytest.approx(0.1)


def test_an_edge_that_runs_on_behind_the_pin_limits_both_ways():
    """A beam pinned on a half-plane may turn by less than half a turn: both openings add up to π."""
    scene = scene_from(
        {
            "name": "lever",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 2.1e9, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": [0.05, 0.03]}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.05, 0.03]},
                    "thickness": 0.001,
                    "width": 0.009,
                    "material": "m",
                    "start": {"joint": "pin", "point": "A"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {"F": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {
                "floor": {
                    "kind": "beam-half-plane",
                    "beam": "beam",
                    "body": "ground",
                    "thick": False,
                    "point": [0.0, 0.0],
                    "normal": [0.0, 1.0],
                }
            },
            "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}],
        }
    )
    m, _, _ = geometry_of(scene, 6)
    openings = [row.form.value(np.array(m.rest)) for row in m.rows if row.name == "floor.pin"]
    assert openings == pytest.approx([np.arctan2(0.03, 0.05), np.pi - np.arctan2(0.03, 0.05)])
