"""Where rows of a contact of two beams stand: minima at kinks, ends, clamps of both beams."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import cprbm
from cprbm import closest, wells
from cprbm.feet import distance_along
from cprbm.first_contact import Rows
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from

H = np.sqrt(0.4985**2 - 0.065**2)  # of the bowl's ends below its centre


def beams(first, second, thickness=1e-3, **contact):
    """Two beams of given curves, their starts welded to the ground, their ends free, the first loaded by nothing."""
    welds = {"A": "P", "B": "Q"}
    return scene_from(
        {
            "name": "two",
            "materials": {"m": {"youngs_modulus": 2.0e9, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"P": first["start"], "Q": second["start"]}},
                "block": {"motion": "free", "points": {"T": first["end"]}},
            },
            "beams": {
                name: {
                    "curve": curve,
                    "thickness": thickness,
                    "width": 0.01,
                    "material": "m",
                    "start": {"joint": "weld", "point": welds[name]},
                    "end": {"joint": "weld", "point": "T"} if name == "A" else {"joint": "free"},
                }
                for name, curve in (("A", first), ("B", second))
            },
            "contacts": {"c": {"kind": "beam-beam", "between": ["A", "B"], **contact}},
            "loads": {"P1": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "stages": [{"name": "load", "steps": "P1", "stations": [1e-3]}],
            "probes": [{"of": "c", "quantity": "force"}],
        }
    )


def line(start, end):
    return {"kind": "line", "start": list(start), "end": list(end)}


def pair_at_rest(scene, links):
    mechanism = mechanism_of(scene, cprbm.Settings(links=links))
    model = mechanism.problem.model
    state = rest_state(model)
    return mechanism.pairs["c"], state, positions(model, state)


@pytest.mark.parametrize("seed", range(4))
def test_every_minimum_is_found_where_the_curvature_jumps_too(monkeypatch, seed):
    # reference: Brent's method on D between the samples; beams bent at random have a kink of D' at every border
    monkeypatch.setattr(wells, "_parted", lambda parting, samples, least: np.ones(len(samples), dtype=bool))
    scene = beams(line((0.0, 0.0012), (0.1, 0.0012)), line((0.0, 0.0), (0.13, 0.0)))
    mechanism = mechanism_of(scene, cprbm.Settings(links={"A": 31, "B": 43}))
    pair, model = mechanism.pairs["c"], mechanism.problem.model
    random = np.random.default_rng(seed)
    rest = rest_state(model)
    state = State(rest.theta + 0.01 * random.standard_normal(model.n_links), rest.bodies)
    lines = pair.lines(state, positions(model, state))
    D, sigma = closest.sampled_distances(pair, lines)
    places, feet = closest.minima(pair, lines, D, sigma)
    s = pair.a.halves
    found = 0
    for k in range(1, len(s) - 1):
        if not (D[k] < min(D[k - 1], D[k + 1]) and D[k] < pair.offset + closest.REACH):
            continue
        best = minimize_scalar(
            lambda x: float(distance_along(pair, lines, np.array([x]))[0][0]),
            bounds=(s[k - 1], s[k + 1]),
            method="bounded",
            options={"xatol": 1e-10},
        )
        if min(best.x - s[k - 1], s[k + 1] - best.x) < 1e-6:
            continue
        near = np.flatnonzero(np.abs(places - best.x) < 1e-4 * pair.a.h)
        assert near.size == 1
        assert distance_along(pair, lines, places[near])[0][0] <= best.fun + 1e-14
        assert distance_along(pair, lines, places[near])[1] == pytest.approx(feet[near], abs=1e-12)
        found += 1
    assert found >= 3


@pytest.mark.parametrize("order", [["A", "B"], ["B", "A"]])
@pytest.mark.parametrize("links", [7, 12])
def test_a_line_that_has_turned_about_its_end_through_another_lies_across_it(order, links):
    # A stands on B with its start, aslant, both without thickness, and is turned about it until it lies below:
    # nothing crosses but there, where they touch; reference: a straight line's end
    scene = beams(line((0.03, 0.0), (0.08, 0.02)), line((0.0, 0.0), (0.1, 0.0)), between=order, thick=False)
    pair, state, at = pair_at_rest(scene, links)
    assert pair.least_gap(state, at) == pytest.approx(0.0, abs=1e-15)
    turning = pair.a if order[0] == "A" else pair.b
    model = mechanism_of(scene, cprbm.Settings(links=links)).problem.model
    theta = state.theta.copy()
    theta[turning.links] -= 2.0 * np.arctan2(0.02, 0.05)
    turned = State(theta, state.bodies)
    at = positions(model, turned)
    assert not pair.gone_round(turned, at)
    assert pair.least_gap(turned, at) == pytest.approx(-0.2, rel=0.1)  # bent beside the weld
    assert np.max(Rows(pair.groups(turned, at)).values) == pytest.approx(0.2, rel=0.1)


@pytest.mark.parametrize("links", [5, 8])
def test_an_end_of_the_second_beam_that_digs_into_the_first_is_seen(links):
    # B comes up from below, normal to A, and A sags on its end; reference: Brent's method on the distance of the
    # end from A's line, which lies between A's samples
    scene = beams(line((0.0, 0.0), (0.1, 0.0)), line((0.037, -0.05), (0.037, -0.0011)))
    pair, state, at = pair_at_rest(scene, links)
    assert pair.least_gap(state, at) >= 0.0
    model = mechanism_of(scene, cprbm.Settings(links=links)).problem.model
    theta = state.theta.copy()
    theta[pair.a.links] += np.linspace(-0.03, 0.06, links + 1)
    sagging = State(theta, state.bodies)
    at = positions(model, sagging)
    lines = pair.lines(sagging, at)
    end = lines[1].at(pair.b.s[[-1]])

    def away(s):
        place = lines[0].at(np.array([s]))
        return float(np.hypot(place.x - end.x, place.y - end.y)[0])

    nearest_place = minimize_scalar(away, bounds=(0.2, 0.6), method="bounded", options={"xatol": 1e-12})
    overlap = pair.offset - nearest_place.fun
    assert overlap > 1e-3
    assert -pair.least_gap(sagging, at) == pytest.approx(overlap, rel=1e-9)
    rows = Rows(pair.groups(sagging, at))
    assert np.max(rows.values) == pytest.approx(overlap, rel=1e-9)
    assert rows.arc[np.argmax(rows.values)] == pytest.approx(nearest_place.x, abs=1e-6)


@pytest.mark.parametrize("links", [9, 14])
def test_beyond_an_end_of_the_second_beam_there_is_no_place(links):
    # A comes down over B and is lowest past B's end, over its continuation: what is nearest to B faces that end alone
    bowl = {
        "kind": "arc",
        "direction": "counterclockwise",
        "center": [0.065, 0.5],
        "start": [0.0, 0.5 - H],
        "end": [0.13, 0.5 - H],
    }
    pair, state, at = pair_at_rest(beams(bowl, line((0.0, 0.0), (0.0613, 0.0))), links)
    lines = pair.lines(state, at)
    D, sigma = closest.sampled_distances(pair, lines)
    assert wells.lowest(D, pair.offset + closest.REACH).size
    assert closest.minima(pair, lines, D, sigma)[0].size == 0
    # B as long as A has it
    pair, state, at = pair_at_rest(beams(bowl, line((0.0, 0.0), (0.1, 0.0))), links)
    lines = pair.lines(state, at)
    assert closest.minima(pair, lines, *closest.sampled_distances(pair, lines))[1] * pair.unit_length == pytest.approx(
        [0.065], abs=1e-9
    )


@pytest.mark.parametrize("longer", [1.0, 1.3])
def test_what_is_welded_to_one_body_side_by_side_has_no_row_there(longer):
    # a gap between welds that cannot open or close is no unknown: without the row the load is carried
    scene = beams(line((0.0, 0.001), (0.1, 0.001)), line((0.0, 0.0), (0.1 * longer, 0.0)))
    pair, state, at = pair_at_rest(scene, 12)
    assert pair.clamps == ((True, False), (True, False))
    rows = Rows(pair.groups(state, at))
    assert np.min(rows.arc) > 0.0
    assert len(set(rows.keys)) == rows.size
    answer = cprbm.answer(scene, cprbm.Settings(links=12))
    assert answer.completed, answer.sentence
    # reference: both lie on each other all along, so B takes its share of the tip's force or less
    assert 0.0 < answer.stations[-1].values["c.force"][0] < 1.5e-3


def test_clamps_that_leave_a_gap_are_not_taken_for_one():
    scene = beams(line((0.0, 0.0011), (0.1, 0.0011)), line((0.0, 0.0), (0.1, 0.0)))
    pair, _, _ = pair_at_rest(scene, 12)
    assert pair.clamps == ((False, False), (False, False))


def test_rows_keep_their_keys_while_the_state_moves_a_little():
    scene = beams(line((0.0, 0.001), (0.1, 0.001)), line((0.0, 0.0), (0.13, 0.0)))
    mechanism = mechanism_of(scene, cprbm.Settings(links={"A": 17, "B": 40}))
    pair, model = mechanism.pairs["c"], mechanism.problem.model
    rest = rest_state(model)
    random = np.random.default_rng(8)
    before = None
    for _ in range(4):
        state = State(rest.theta + 1e-9 * random.standard_normal(model.n_links), rest.bodies)
        keys = Rows(pair.groups(state, positions(model, state))).keys
        assert before is None or keys == before
        before = keys


def test_a_minimum_that_is_not_parted_keeps_its_place_while_it_is_pressed_and_its_neighbours_are_apart():
    """By hand: pressed there the gap is nought but for round-off; deeper than the joints beside are apart, they press.

    Where the beams part all round there is nothing else to press.
    """
    one = wells.Wells(np.array([5, 9, 13, 17]), np.array([False, False, False, True]), np.full(4, 0.0013))
    assert one.held(np.array([-1e-16, -0.0009, -0.0021, -0.0021])).tolist() == [True, True, False, True]
