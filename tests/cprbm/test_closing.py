"""When contacts first close: what touches from rest, and what a beam would sweep over if nothing held it."""

import numpy as np
import pytest

import cprbm
import elastica_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force

UNIT = RIGIDITY / LENGTH**2  # a force that bends the beam by about as much as it is long


def beside_circle(gap, stations, *, place=0.62, radius=0.17):
    """A cantilever above a circle, pressed down at its tip; ``gap``, ``place`` and ``radius`` over the length."""
    data = cantilever_data(force(0.0, -1.0), stations)
    below = 0.5 * THICKNESS + (gap + radius) * LENGTH
    data["contacts"] = {
        "circle": {
            "kind": "beam-circle",
            "beam": "beam",
            "body": "wall",
            "center": [place * LENGTH, -below],
            "radius": radius * LENGTH,
        }
    }
    data["probes"] = [{"of": "circle", "quantity": quantity} for quantity in ("force", "closing_load")]
    return scene_from(data)


def closing_loads(scene, links=20):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return [station.values["circle.closing_load"].tolist() for station in answer.stations]


@pytest.mark.parametrize("links", [20, 160])
def test_what_touches_from_rest_closes_at_nothing(links):
    # reference: statics, any force presses the beam on what it touches
    assert closing_loads(beside_circle(0.0, [0.5 * UNIT, 9.0 * UNIT]), links) == [[0.0], [0.0]]


def test_what_touches_from_rest_and_parts_closes_where_it_comes_back():
    # reference: under no load the beam is straight, and touches
    (apart, back) = closing_loads(beside_circle(0.0, [-1.3 * UNIT, 2.1 * UNIT]))
    assert apart == []
    assert back == pytest.approx([0.0], abs=1e-9 * UNIT)


def test_what_touches_and_parts_for_good_never_closes():
    assert closing_loads(beside_circle(0.0, [-0.7 * UNIT, -2.0 * UNIT])) == [[], []]


def test_a_small_gap_closes_where_a_cantilever_bridges_it():
    """w(s) = P s² (3L − s) / 6EI is the gap, with s = place: its least distance from a small circle is there."""
    gap, place, links = 1e-7, 0.62, 20
    expected = 6.0 * gap * UNIT / (place**2 * (3.0 - place))
    (found,) = closing_loads(beside_circle(gap, [30.0 * expected], radius=0.002), links)
    assert found == pytest.approx([expected], rel=1.0 / links**2)


def test_a_circle_that_the_beam_would_sweep_over_closes_at_the_same_load_however_far_the_next_station_is():
    # reference: the beam's differential equation
    stations = [0.9 * UNIT, 3.0 * UNIT, 9.0 * UNIT, 23.0 * UNIT]
    reference = elastica_reference.answer(beside_circle(0.33, stations)).stations[-1].values["circle.closing_load"][0]
    for links in (20, 40):
        by_steps, at_once = (closing_loads(beside_circle(0.33, asked), links) for asked in (stations, stations[-1:]))
        assert by_steps[0] == []
        assert by_steps[-1] == pytest.approx(at_once[-1], rel=1e-8)
        # of fourth order; the first edition had 2/N²
        assert by_steps[-1] == pytest.approx([reference], rel=10.0 / links**4)


def test_what_is_closed_at_a_station_has_a_closing_load_that_is_not_beyond():
    stations = (UNIT * np.linspace(0.3, 11.0, 9)).tolist()
    answer = cprbm.answer(beside_circle(0.21, stations), cprbm.Settings(links=120))
    assert answer.completed, answer.sentence
    closed = [station.values["circle.force"][0] > 0.0 for station in answer.stations]
    assert not closed[0]
    assert closed[-1]
    for station, pressed in zip(answer.stations, closed, strict=True):
        found = station.values["circle.closing_load"]
        assert found.size == pressed
        assert not pressed or 0.0 < found[0] <= station.value
    assert len(answer.events) == 1


def under_a_leaf(*, gap=1.8, nose=(80.0, 4.0), along=(0.0, 1.0), stations=(1.8, 2.5), backwards=False):
    """A leaf of 60 mm and a round nose (place along the leaf, radius) on a slider below, driven; lengths in mm."""
    ends = [([0.0, 0.0], {"joint": "weld", "point": "A"}), ([0.06, 0.0], {"joint": "free"})]
    (start, first), (end, last) = ends[::-1] if backwards else ends
    place, radius = 1e-3 * nose[0], 1e-3 * nose[1]
    below = -5e-4 - 1e-3 * gap - radius
    return scene_from(
        {
            "name": "leaf",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                "slider": {"motion": "slides", "along": list(along), "points": {"Q": [0.08, -0.05]}},
            },
            "beams": {
                "leaf": {
                    "curve": {"kind": "line", "start": start, "end": end},
                    "thickness": 1e-3,
                    "width": 8e-3,
                    "material": "steel",
                    "start": first,
                    "end": last,
                }
            },
            "contacts": {
                "nose": {
                    "kind": "beam-circle",
                    "beam": "leaf",
                    "body": "slider",
                    "center": [place, below],
                    "radius": radius,
                }
            },
            "drives": {"d": {"kind": "displacement", "point": "Q", "direction": list(along)}},
            "stages": [{"name": "on", "steps": "d", "stations": [1e-3 * value for value in stations]}],
            "probes": [
                {"of": "nose", "quantity": "closing_load"},
                {"of": "nose", "quantity": "force"},
                {"of": "Q", "quantity": "reaction"},
            ],
        }
    )


@pytest.mark.parametrize("stations", [(1.8, 2.5), (1.0, 1.8, 4.0), (3.0,)])
def test_a_driven_nose_closes_where_the_gap_ends(stations):
    # reference: geometry, the leaf is at rest until the nose has gone through the gap; at a station, or between two
    answer = cprbm.answer(under_a_leaf(nose=(40.0, 4.0), stations=stations), cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    assert answer.stations[-1].values["nose.closing_load"] == pytest.approx([1.8e-3], rel=1e-12)


@pytest.mark.parametrize("links", [20, 40])
def test_a_contact_leaves_the_tip_of_a_leaf_drawn_either_way(links):
    """The nose comes under the round tip and moves inwards; the direction of the leaf's curve is no matter."""
    reactions = []
    for backwards in (False, True):
        scene = under_a_leaf(
            gap=-1.7, nose=(66.0, 4.0), along=(-1.0, 0.0), stations=(5.0, 6.0, 8.0), backwards=backwards
        )
        answer = cprbm.answer(scene, cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        reactions.append([station.values["Q.reaction"] for station in answer.stations])
    assert np.array(reactions[0]) == pytest.approx(np.array(reactions[1]), rel=1e-9, abs=1e-9)


def three_noses(stations, thickness=0.5):
    """A leaf of 100 mm under three noses of a slider, at 80, 60 and 40 mm, with gaps of 1, 2 and 3 mm."""
    radius = 5.0
    noses = {
        name: {
            "kind": "beam-circle",
            "beam": "leaf",
            "body": "slider",
            "center": [place, gap + radius + 0.5 * thickness],
            "radius": radius,
        }
        for name, place, gap in (("outer", 80.0, 1.0), ("middle", 60.0, 2.0), ("inner", 40.0, 3.0))
    }
    return scene_from(
        {
            "name": "three noses",
            "units": {"length": "mm"},
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                "slider": {"motion": "slides", "points": {"J": [60.0, 30.0]}, "along": [0.0, 1.0]},
            },
            "beams": {
                "leaf": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [100.0, 0.0]},
                    "thickness": thickness,
                    "width": 8.0,
                    "material": "steel",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "free"},
                }
            },
            "contacts": noses,
            "drives": {"d": {"kind": "displacement", "point": "J", "direction": [0.0, -1.0]}},
            "stages": [{"name": "on", "steps": "d", "stations": stations}],
            "probes": [{"of": "J", "quantity": "reaction"}],
        }
    )


@pytest.mark.parametrize(("stations", "links"), [([6.0], 20), ([1.0, 2.0, 3.0, 6.0], 40), ([2.5, 5.0, 6.0], 20)])
def test_no_contact_closes_or_opens_unseen_in_a_step(stations, links):
    """Reference: a cantilever under a force at a: w(s)/w(a) = s² (3a − s)/2a³ before a, a straight line behind.

    The force goes from nose to nose: the inner noses close where w is the way of the slider less the gap, and then
    lift the leaf from the outer noses.  At d = 6 mm the slopes are 0.06, so that the theory is right to 0.3 %.
    """
    before_outer, before_middle = 0.6**2 * 1.8 / (2.0 * 0.8**3), 0.4**2 * 1.4 / (2.0 * 0.6**3)
    expected = [
        ("outer", "closes", 1.0),
        ("middle", "closes", (2.0 - before_outer) / (1.0 - before_outer)),
        ("outer", "opens", (2.0 * 1.5 - 1.0) / (1.5 - 1.0)),
        ("inner", "closes", (3.0 - 2.0 * before_middle) / (1.0 - before_middle)),
        ("middle", "opens", (3.0 * 1.75 - 2.0) / (1.75 - 1.0)),
    ]
    answer = cprbm.answer(three_noses(stations), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    assert [(event.contact, event.kind) for event in answer.events] == [(name, kind) for name, kind, _ in expected]
    values = [1e3 * event.value for event in answer.events]
    assert values == pytest.approx([value for *_, value in expected], rel=3e-3)
