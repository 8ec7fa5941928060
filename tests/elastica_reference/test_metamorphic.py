"""Images of a scene with a known change of the answer: the exact solution beside the solution of the image."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest

from tests.elastica_reference import scenes
from tests.elastica_reference.scenes import TURN, answer, completed
from tests.references.hinge import PAPER, closing_moment
from tests.references.two_cantilevers import TwoCantilevers
from tests.references.wrapped import Wrapped

PAIR = TwoCantilevers(0.02, 1.8, 1.0, 2.0)
BEAM = Wrapped(0.0973, 0.0711, 0.00103, 0.0097, 2.07e11, 1.0)
VECTORS = ("displacement", "reaction")
TURNING = ("rotation", "reaction_moment", "bending_stress")


def gripper():
    data = scenes.case("gripper")
    data["stages"][0]["stations"] = data["stages"][0]["stations"][4:5]
    return data


SCENES = {
    "hinge": lambda: scenes.hinge(PAPER, [0.3, 0.6]),
    "wrapped": lambda: scenes.wrapped(BEAM, [17.0, 67.0]),
    "tip": lambda: scenes.tip_on_beam(PAIR, [1.0, 2.0]),
    "gripper": gripper,
}


@cache
def solved(name):
    """The answer of a scene as the list has it."""
    return completed(SCENES[name]())


def same(one, other, change=lambda quantity, value: value, but=()):
    """All probes of all stations agree to 1e-9 of their largest value, after ``change``."""
    assert len(one.stations) == len(other.stations)
    for probe in one.stations[0].values:
        if probe in but:
            continue
        size = max((float(np.max(np.abs(s.values[probe]), initial=0.0)) for s in one.stations), default=0.0)
        for first, second in zip(one.stations, other.stations, strict=True):
            expected = change(probe.split(".")[1], first.values[probe])
            np.testing.assert_allclose(second.values[probe], expected, rtol=0.0, atol=1e-9 * size, err_msg=probe)


@pytest.mark.parametrize("name", ["hinge", "wrapped"])
def test_a_rigid_motion(name):
    data = SCENES[name]()

    def move(place):
        x, y = TURN(place)
        return [x + 0.031, y - 0.017]

    turned = scenes.mapped(data, move, TURN, mirror=False)
    same(solved(name), completed(turned), lambda q, v: TURN(v) if q in VECTORS else v)


@pytest.mark.parametrize("name", SCENES)
def test_a_mirror_image(name):
    data = SCENES[name]()

    def flip(v):
        return [v[0], -v[1]]

    image = scenes.mapped(data, flip, flip, mirror=True)
    for beam in image["beams"].values():
        if beam["curve"]["kind"] == "polynomial":  # x = f(y) of −y
            curve = beam["curve"]
            assert curve["axis"] == "y"
            curve["coefficients"] = [c * (-1.0) ** k for k, c in enumerate(curve["coefficients"])]
            curve["range"] = [-v for v in curve["range"]]
    if "moment" in [load["kind"] for load in image.get("loads", {}).values()]:
        image["stages"][0]["stations"] = [-value for value in image["stages"][0]["stations"]]

    def change(quantity, value):
        if quantity in VECTORS:
            return flip(value)
        if quantity in TURNING or (quantity == "closing_load" and name == "hinge"):
            return -np.asarray(value)
        return value

    same(solved(name), completed(image), change)


@pytest.mark.parametrize("name", ["hinge", "wrapped", "tip"])
def test_a_beam_that_begins_where_it_ended(name):
    data = SCENES[name]()
    for beam in data["beams"]:
        other = scenes.reversed_beam(data, beam)
        first = {
            contact
            for contact, r in data.get("contacts", {}).items()
            if beam in (r.get("between", [None])[0], r.get("beam"))
        }
        but = {f"{contact}.{quantity}" for contact in first for quantity in ("centre", "ends")} | {
            f"{beam}.bending_stress"
        }
        one, two = solved(name), completed(other)
        same(one, two, but=but)
        length = one.stations[0].shapes[beam].s[-1]
        for a, b in zip(one.stations, two.stations, strict=True):
            for probe in but & set(a.values):
                back = -b.values[probe][::-1] if probe.endswith("stress") else (length - b.values[probe])[::-1]
                size = np.max(np.abs(a.values[probe]), initial=0.0)
                np.testing.assert_allclose(back, a.values[probe], rtol=0.0, atol=1e-9 * size, err_msg=probe)


def test_a_contact_named_the_other_way_round():
    data = SCENES["tip"]()
    contact = next(iter(data["contacts"]))
    data["contacts"][contact].pop("paper", None)
    other = json.loads(json.dumps(data))
    other["contacts"][contact]["between"].reverse()
    same(completed(data), completed(other), but={f"{contact}.centre", f"{contact}.ends"})


@pytest.mark.parametrize("name", ["wrapped", "tip"])
def test_more_stations_on_the_way(name):
    data, last = SCENES[name](), SCENES[name]()["stages"][0]["stations"][-1]
    few, many = (
        {**data, "stages": [data["stages"][0] | {"stations": [last * x for x in way]}]}
        for way in ([1.0], np.linspace(0.25, 1.0, 4).tolist())
    )
    one, other = completed(few).stations[-1], completed(many).stations[-1]
    for probe, value in one.values.items():
        np.testing.assert_allclose(
            other.values[probe], value, rtol=0.0, atol=1e-9 * np.max(np.abs(value)), err_msg=probe
        )


def test_unloading_comes_back_the_same_way():
    data = SCENES["hinge"]()
    up = data["stages"][0]
    up["stations"] = [up["stations"][0], 0.5 * sum(up["stations"][:2]), up["stations"][1]]
    data["stages"].append({"name": "back", "steps": up["steps"], "stations": [*up["stations"][1::-1], 0.0]})
    found = completed(data).stations
    for there, back in ((found[1], found[3]), (found[0], found[4])):
        for probe, value in there.values.items():
            size = np.max(np.abs(found[2].values[probe]), initial=0.0)
            np.testing.assert_allclose(back.values[probe], value, rtol=0.0, atol=1e-9 * size, err_msg=probe)
    for probe, value in found[5].values.items():
        size = np.max(np.abs(found[2].values[probe]), initial=0.0)
        assert np.max(np.abs(value), initial=0.0) <= 1e-9 * size, probe


def test_a_circle_that_moves_is_a_beam_that_does():
    # a circle on a driven slide pressed into a beam's tip, and the beam's ground moved against a fixed circle
    punch, moved = scenes.punched(), scenes.punched()
    moved["bodies"]["wall"] |= {"motion": "slides", "along": [0.0, 1.0]}
    moved["bodies"]["punch"] = {"motion": "fixed", "points": punch["bodies"]["punch"]["points"]}
    moved["drives"]["down"] |= {"point": "R", "direction": [0.0, 1.0]}
    one, other = completed(punch), completed(moved)
    assert one.stations[-1].values["circle.force"][0] > 0.0
    same(one, other)


def test_answers_are_made_of_the_stations_asked_for():
    found = answer(scenes.hinge(PAPER, [0.9 * closing_moment(PAPER), 0.5]))
    assert [station.value for station in found.stations] == [0.9 * closing_moment(PAPER), 0.5]
