"""Several contacts on the way: what closes where, and whether the march arrives."""

from collections import namedtuple
from dataclasses import dataclass
from types import SimpleNamespace

import pytest

from comparisons import cases
from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer
from fea_reference.march import March


def with_stations(scene, *stations):
    return scene.model_copy(update={"stages": (scene.stages[0].model_copy(update={"stations": stations}),)})


def test_tips_that_slide_along_one_another_arrive_in_long_steps():
    """Three contacts, two of them of a free end that slides along a beam under a penalty whose force on what a step
    overlaps is thousands of times the contact's own.
    """
    found = answer(cases.opened("stack"), Settings(elements=20, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    assert sum(station.certificate.iterations for station in found.stations) < 600


def test_a_little_penetration_in_few_stations_arrives():
    """A 256th of the standard penetration: the penalties of both contacts are the stiffest that are ever asked for."""
    scene = with_stations(cases.opened("gripper"), 9.6, 16.0)
    found = answer(scene, Settings(elements=320, kinematics="bending", penetration=1e-4 / 256))
    assert found.ending is Ending.COMPLETED, found.sentence


def test_what_overlaps_by_more_than_was_asked_for_is_not_left_however_often_it_was_tried():
    # reference: the share of a contact's scale that Settings.penetration says, below it and beyond
    pair = namedtuple("Pair", "scale stiffest")(0.043, 310.0)
    march = SimpleNamespace(settings=Settings(penetration=2.3e-4), penalties={pair: SimpleNamespace(stiffness=470.0)})
    for share, done in ((0.9, True), (1.1, False)):
        one = SimpleNamespace(pair=pair, penetration=share * 2.3e-4 * 0.043)
        assert March._penalty_accepted(march, one, 1.7, 40, 2.3e-4 * 0.043) == done
        assert not March._penalty_accepted(march, one, 1.7, 0, 2.3e-4 * 0.043)


def test_of_three_gaps_the_first_to_close_is_found_though_another_seemed_to_be():
    # reference: where the three close, as they are written; on straight lines from 0 to 1 the first one does before the
    # second, which in truth has closed by then, and the third is open all the while
    def gaps(value):
        second = 1.0 - value / 0.37 if value < 0.37 else -0.1 * (value - 0.37) / 0.63
        return [1.0 - value / 0.53, second, 2.3 - value]

    @dataclass
    class System:
        z: float

    march = SimpleNamespace(
        solve=lambda load, value, start: System(value),
        system=System(0.0),
        gaps=lambda system: gaps(system.z),
        open=[namedtuple("Pair", "scale")(0.043)] * 3,
        model=SimpleNamespace(stops=()),
        _path=lambda *way: lambda value: value,
    )
    assert March._first_touch(march, 0, {0.0: System(0.0), 1.0: System(1.0)})[0] == pytest.approx(0.37, abs=1e-9)


def test_where_a_contact_closes_is_not_a_matter_of_the_stations():
    """Another contact that is still under its first, loose penalty must not let the next one close too late."""
    first, second = (
        answer(with_stations(cases.opened("stack"), *stations), Settings(elements=40)).stations[-1].values
        for stations in ((0.015,), (0.012, 0.014, 0.015))
    )
    # a penetration of 1e-4 of 0.95 mm, on a way of 14 mm, and as much again for the levers in between
    assert first["second.closing_load"] == pytest.approx(second["second.closing_load"], rel=2e-5)


def test_what_a_penalty_leaves_is_the_same_share_of_the_penetration_asked():
    """The same at every load and for every number of elements: else it would not go evenly with either.

    But where the contact has just closed, and presses with little: there it is felt, and goes evenly all the same.
    """

    def left(asked):
        found = answer(cases.opened("hinge"), Settings(20, kinematics="bending", penetration=asked))
        return [one.certificate.penetration / asked for one in found.stations if one.values["contact.force"]]

    asked = 1e-4 * (40 / 20) ** 4
    shares = left(asked)
    assert len(shares) > 5
    assert shares[2:] == pytest.approx(len(shares[2:]) * [shares[-1]], rel=0.04)
    assert 0.5 < shares[-1] <= 1.0
    assert shares[0] < shares[1] < shares[2]
    assert left(asked / 4.0) == pytest.approx(shares, rel=0.04)


def test_tips_that_slide_are_held_while_a_circle_s_penalty_rises():
    """Both tips overlap by less than what the circle's rising penalty moves them: they must not open."""
    scene = with_stations(cases.opened("stack"), 0.01, 0.015, 0.02, 0.025, 0.03, 0.035)
    found = answer(scene, Settings(elements=40, kinematics="bending", penetration=6e-9))
    assert found.ending is Ending.COMPLETED, found.sentence


def nudged_column(*stations):
    """A column between a clamp and a slide, thinner towards one end, which a little load across it lies on."""
    tip = [-0.031212, 0.0080202]
    return scene_from(
        {
            "name": "nudged",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 1.14e11, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "slides", "along": tip, "points": {"T": tip}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": tip},
                    "thickness": {"at": [0.0, 1.0], "values": [0.000202, 0.000183]},
                    "width": 0.00686,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {
                "nudge": {"kind": "distributed", "beam": "beam", "direction": [0.249, 0.969]},
                "press": {"kind": "force", "point": "T", "direction": [-tip[0], -tip[1]]},
            },
            "stages": [
                {"name": "aside", "steps": "nudge", "stations": [2.342]},
                {"name": "press", "steps": "press", "stations": list(stations)},
            ],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


def test_a_long_step_past_a_buckling_load_stays_on_the_branch_of_minima():
    """It buckles at 4π²EI/L² = 17.7 N; in one step from before that, Newton's method lands on a branch of saddles."""
    settings = Settings(elements=37, kinematics="bending")
    long = answer(nudged_column(13.12, 19.68, 21.86), settings)
    assert long.ending is Ending.COMPLETED, long.sentence
    short = answer(nudged_column(*(13.12 + 0.437 * step for step in range(20)), 21.86), settings)
    assert short.ending is Ending.COMPLETED, short.sentence
    for name, value in short.stations[-1].values.items():
        assert long.stations[-1].values[name] == pytest.approx(value, rel=1e-7), name


def test_what_is_left_at_a_station_is_no_part_of_the_loads():
    """Where elements are short, forces within them are a hundred times the loads, of which nothing may be missing."""
    found = answer(pressed_hook(), Settings(elements=120, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    for station in found.stations:
        assert station.certificate.force_balance <= 1e-10


def pressed_hook():
    """A thick strip that is clamped at one end and turned by a moment until it leans on a circle."""
    points = [[0.0, 0.0], [-0.017982, 0.026535], [-0.059447, 0.042669], [-0.090298, 0.065915], [-0.085977, 0.11308]]
    return scene_from(
        {
            "name": "hook",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": points[0]}}},
            "beams": {
                "beam": {
                    "curve": {"kind": "spline", "points": points, "start_direction": [-0.419, 0.938]},
                    "thickness": 0.0081,
                    "width": 0.0228,
                    "material": "steel",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "free"},
                }
            },
            "loads": {"turn": {"kind": "beam_moment", "beam": "beam", "at": 0.71}},
            "contacts": {
                "circle": {
                    "kind": "beam-circle",
                    "beam": "beam",
                    "body": "wall",
                    "center": [-0.116003, 0.049526],
                    "radius": 0.025,
                }
            },
            "stages": [{"name": "turn", "steps": "turn", "stations": [1103.0, 2206.0]}],
            "probes": [{"of": "circle", "quantity": "force"}],
        }
    )
