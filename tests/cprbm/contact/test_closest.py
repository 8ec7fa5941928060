"""Closest points against brute force: bends, ends, convex corners, closed edges, taper; boxes and counters."""

from __future__ import annotations

import numpy as np
import pytest

from cprbm.contact import (
    BOX_TESTS,
    GAPS,
    SEARCHES,
    contact_geometry,
    near_pairs,
    new_counters,
    settle,
)
from cprbm.contact.closest import closest_chord, closest_point
from tests.cprbm.contact.workshop import all_places, at, mechanism, random_state, settled

SAMPLES = 200_001


def sampled(curve, z):
    """Dense points of a curve with their half thickness."""
    s = np.linspace(0.0, curve.arcs[-1], SAMPLES)
    return at(curve, z, s), np.interp(s, curve.arcs, curve.half_thickness)


@pytest.mark.parametrize("name", ["upper", "lower", "contact line", "contact graph", "contact plane"])
def test_closest_points_of_random_places(name):
    m, geometry, rest = mechanism()
    number = next(k for k, curve in enumerate(geometry.curves) if curve.name == name)
    curve = geometry.curves[number]
    z = random_state(m, geometry, rest, 4, 1e-3)
    points, thickness = sampled(curve, z)
    rng = np.random.default_rng(8)
    tested = at_points = 0
    for _ in range(60):
        near = points[rng.integers(len(points))]
        x = near + 0.08 * complex(*rng.normal(size=2))
        reach = np.abs(points - x) - thickness
        piece, eta, _ = closest_chord(z, geometry.arrays, number, x.real, x.imag)
        piece, eta, at_point = closest_point(z, geometry.arrays, number, x.real, x.imag, piece, eta, 0.0, 0.0)
        local = piece - geometry.arrays.first[number]
        s = curve.arcs[local] + eta * np.diff(curve.arcs)[local]
        found = abs(at(curve, z, np.array([s]))[0] - x) - np.interp(s, curve.arcs, curve.half_thickness)
        assert found <= reach.min() + 1e-7
        at_points += at_point
        tested += 1
    assert tested == 60
    assert (at_points > 0) == (name != "contact plane")


def test_a_beams_disc_touches_head_on():
    """Places at ends: the gap of two ends is their distance less both half thicknesses."""
    m, geometry, rest = mechanism()
    z = rest.copy()
    nodes, lower = m.beam_nodes("upper"), m.beam_nodes("lower")
    # the upper beam continues the lower one, apart by 0.05
    begin = z[lower[-1]] + 0.05
    z[nodes], z[nodes + 1] = begin + geometry.curves[0].arcs[::-1], z[lower[-1] + 1]
    places = all_places(geometry, z, rest)
    gaps, _ = settled(geometry, z, places)
    upper = next(k for k, curve in enumerate(geometry.curves) if curve.name == "upper")
    tip = np.flatnonzero((places.pair == 0) & (places.curve == upper) & (places.xi == 1.0))[0]
    assert places.at_point[tip]
    # half thicknesses 0.65 mm and 1.05 mm over the unit of 0.1 m
    assert gaps[tip] == pytest.approx(0.05 - 0.0065 - 0.0105, abs=1e-12)


def test_convex_corners_hold_the_foot():
    """Beside a corner of a triangle, within the angle of its two normals, the closest point is the corner."""
    _, geometry, rest = mechanism()
    number = next(k for k, curve in enumerate(geometry.curves) if curve.name == "contact line")
    curve = geometry.curves[number]
    corner = at(curve, rest, curve.arcs[1:2])[0]
    directions = np.diff(at(curve, rest, curve.arcs))[:2]
    outward = directions[0] / abs(directions[0]) - directions[1] / abs(directions[1])
    for share in (0.01, 0.03):
        x = corner + share * outward
        begin = geometry.arrays.first[number]
        piece, eta, at_point = closest_point(rest, geometry.arrays, number, x.real, x.imag, begin, 0.4, 0.0, 0.0)
        assert at_point
        assert (piece - begin, eta) == (1, 0.0)


def test_boxes_hold_their_curves_and_pass_far_pairs_over():
    m, geometry, rest = mechanism()
    z = random_state(m, geometry, rest, 6)
    counters = new_counters()
    count = len(geometry.pairs)
    points = [at(curve, z, np.linspace(0.0, curve.arcs[-1], 301)) for curve in geometry.curves]
    for distance in (0.0, 0.1, 1.0):
        near = near_pairs(z, geometry.arrays, geometry.sites.columns, distance, counters)
        for pair, is_near in zip(geometry.pairs, near, strict=True):
            first, second = (points[k] for k in (pair.first, pair.second))
            apart = np.abs(first[:, None] - second[None, :]).min()
            assert is_near or apart > distance
    far = near_pairs(z, geometry.arrays, geometry.sites.columns, -10.0, counters)
    assert not far.any()
    assert counters[BOX_TESTS] == 4 * count
    assert counters[SEARCHES] == counters[GAPS] == 0


def test_gaps_are_counted():
    _, geometry, rest = mechanism()
    places = all_places(geometry, rest, rest)
    counters = new_counters()
    gaps = np.empty(len(places.pair))
    settle(rest, geometry.arrays, places, gaps, gaps.copy(), counters, 0)
    assert counters[GAPS] == len(places.pair)


def test_a_scene_without_contacts_has_no_curves_and_no_places():
    m, _, _ = mechanism()
    alone = m.scene.model_copy(update={"contacts": {}})
    m.scene = alone
    geometry = contact_geometry(m)
    assert len(geometry.arrays.stencil) == len(geometry.sites.possible.pair) == 0
