"""Beams that are straight between held ends: idle, asked to become shorter or longer, and pressed on from the side."""

import re

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, Loss, scene_from

LENGTH, THICKNESS, WIDTH, E = 0.1037, 0.00113, 0.0087, 2.07e11
STIFFNESS = E * WIDTH * THICKNESS**3 / 12.0


def beam(start, end, root, tip):
    return {
        "curve": {"kind": "line", "start": start, "end": end},
        "thickness": THICKNESS,
        "width": WIDTH,
        "material": "steel",
        "start": {"joint": "weld", "point": root},
        "end": {"joint": "pin", "point": tip},
    }


def beside_a_held_one(moment, away):
    """A cantilever that a moment bends, and ``away`` above it a straight beam between two points of the wall."""
    held = [0.0511, away], [0.1213, away + 0.0031]
    cantilever = beam([0.0, 0.0], [LENGTH, 0.0], "R", "T")
    cantilever["end"] = {"joint": "weld", "point": "T"}
    return scene_from(
        {
            "name": "beside",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "A": held[0], "B": held[1]}},
                "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {"bent": cantilever, "held": beam(*held, "A", "B")},
            "loads": {"m": {"kind": "moment", "body": "tip"}},
            "contacts": {"both": {"kind": "beam-beam", "between": ["bent", "held"]}},
            "stages": [{"name": "bend", "steps": "m", "stations": [0.43 * moment, moment]}],
            "probes": [{"of": "tip", "quantity": "rotation"}, {"of": "T", "quantity": "displacement"}],
        }
    )


def test_a_beam_that_cannot_move_and_that_nothing_touches_changes_nothing():
    # reference: a cantilever under a moment is an arc, θ = M L/EI
    moment = 0.73 * STIFFNESS / LENGTH
    answer = cprbm.answer(beside_a_held_one(moment, 0.0713), cprbm.Settings(links=17))
    assert answer.completed, answer.sentence
    last = answer.stations[-1].values
    turned = float(last["tip.rotation"][0])
    assert turned == pytest.approx(0.73, rel=1e-9)
    height = LENGTH * (1.0 - np.cos(turned)) / turned
    assert last["T.displacement"][1] == pytest.approx(height, rel=2e-3)  # π²/24 N² of it and less


def test_what_presses_on_it_ends_with_the_beam_that_is_in_the_way():
    # no finite pull of a beam that is as long as its ends are apart carries a force across it
    moment = 0.73 * STIFFNESS / LENGTH
    answer = cprbm.answer(beside_a_held_one(moment, 0.0213), cprbm.Settings(links=17))
    assert answer.ending is Ending.STEP_TOO_SMALL
    assert "beam 'held' is straight between its ends, and cannot become longer or shorter" in answer.sentence
    assert len(answer.stations) == 1


def column(push):
    """A clamped column whose other end is pushed along it, or turned a little about a point beside it."""
    return scene_from(
        {
            "name": "column",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "arm": {"motion": "turns", "about": "P", "points": {"P": [0.0713, -0.0517], "T": [LENGTH, 0.0]}},
            },
            "beams": {"column": beam([0.0, 0.0], [LENGTH, 0.0], "R", "T")},
            "drives": {"turn": {"kind": "rotation", "body": "arm"}},
            "stages": [{"name": "turn", "steps": "turn", "stations": [push]}],
            "probes": [{"of": "arm", "quantity": "rotation"}],
        }
    )


def test_a_perfect_column_that_is_pushed_stands_on_a_bifurcation():
    # reference: Euler's column shortens by P L/EA before it buckles, which is nothing in bending alone; turning the
    # arm counter-clockwise takes T towards the clamp, and from then on it bends to one side or to the other
    answer = cprbm.answer(column(0.0217), cprbm.Settings(links=17))
    assert answer.ending is Ending.BRANCH_ENDS
    (end,) = answer.critical
    assert (end.value, end.loss, end.energy) == (0.0, Loss.BIFURCATION, 0.0)


def test_a_beam_that_is_pulled_longer_says_so():
    answer = cprbm.answer(column(-0.0217), cprbm.Settings(links=17))
    assert answer.ending is Ending.STEP_TOO_SMALL
    assert "beam 'column' is straight between its ends, and cannot become longer" in answer.sentence


@pytest.mark.parametrize("rise", [0.03, 0.2])
def test_an_arc_that_is_drawn_straight_says_where_forces_have_no_limit(rise):
    # reference: an arc of radius R and angle θ is R θ long, and its ends are no farther apart when it is straight
    half = 2.0 * np.arctan(2.0 * rise)
    radius = 0.5 * LENGTH / np.sin(half)
    longer = 2.0 * half * radius - LENGTH
    scene = column(0.1).model_dump(mode="json", exclude={"file"})
    scene["bodies"] = {
        "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
        "car": {"motion": "slides", "along": [1.0, 0.0], "points": {"T": [LENGTH, 0.0]}},
    }
    middle = [0.5 * LENGTH, -radius * np.cos(half)]
    arc = {"kind": "arc", "center": middle, "start": [0.0, 0.0], "end": [LENGTH, 0.0], "direction": "clockwise"}
    scene["beams"]["column"] |= {"curve": arc, "start": {"joint": "pin", "point": "R"}}
    scene["drives"] = {"pull": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]}}
    scene["stages"] = [{"name": "pull", "steps": "pull", "stations": [0.5 * longer, 1.3 * longer]}]
    scene["probes"] = [{"of": "T", "quantity": "displacement"}]
    answer = cprbm.answer(scene_from(scene), cprbm.Settings(links=17))
    assert answer.ending is Ending.STEP_TOO_SMALL
    assert len(answer.stations) == 1
    said = re.search(r"forces grow without limit as pull comes to (\S+),", answer.sentence)
    assert said is not None, answer.sentence
    assert float(said[1]) == pytest.approx(longer, rel=1e-2)
