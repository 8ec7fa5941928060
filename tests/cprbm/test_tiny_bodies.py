"""A cantilever pressed onto rigid bodies far smaller than an element, against the closed form for points."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Scene
from tests.fea_reference.on_an_edge import WIDTH, T
from tests.references.pressed import Pressed


def beam_onto(contacts, load, *, thick):
    """A beam of unit length and EI from the origin along x, with ``contacts`` by their names, under a load."""
    tip = {"kind": "force", "point": "tip", "direction": (0.0, 1.0)}
    along = {"kind": "beam_force", "beam": "beam", "at": load.at, "direction": (0.0, 1.0)}
    block = {"motion": "free"} if load.tip == "free" else {"motion": "slides", "along": (1.0, 0.0)}
    loads = {
        "P": (load.force, tip if load.tip == "free" else along),
        "M": (load.moment, {"kind": "moment", "body": "block"}),
    }
    acting = {name: (value, of) for name, (value, of) in loads.items() if value}
    probes = [("tip", "displacement"), *((name, "force") for name in contacts)]
    return Scene.model_validate(
        {
            "name": "tiny",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 12.0 / (WIDTH * T**3), "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
                "block": {**block, "points": {"tip": (1.0, 0.0)}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
                    "thickness": T,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": {"joint": "pin" if load.tip == "pinned" else "weld", "point": "tip"},
                }
            },
            "loads": {name: of for name, (_, of) in acting.items()},
            "contacts": {
                name: {"beam": "beam", "body": "ground", "thick": thick, **of} for name, of in contacts.items()
            },
            "stages": tuple({"name": f"s{n}", "steps": n, "stations": (value,)} for n, (value, _) in acting.items()),
            "probes": tuple({"of": of, "quantity": quantity} for of, quantity in probes),
        }
    )


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("links", [20, 40, 80])
@pytest.mark.parametrize("radius", [1e-4, 1e-3, 1e-2])
def test_a_circle_smaller_than_an_element_presses_as_a_point_does(radius, links, thick):
    # one in the middle of an element, one at a joint; the slope is 0.02 at most, its square what is left out
    load, places, gaps = Pressed(force=-0.04), np.array([0.411, 0.75]), np.array([0.0004, 0.0035])
    half = 0.5 * T if thick else 0.0
    circles = {
        f"c{i}": {"kind": "beam-circle", "center": (float(x), -float(gap) - radius - half), "radius": radius}
        for i, (x, gap) in enumerate(zip(places, gaps, strict=True))
    }
    values = solved(beam_onto(circles, load, thick=thick), links)
    forces, tip = load.onto(places, gaps, np.ones(2))
    assert [values[f"{name}.force"][0] for name in circles] == pytest.approx(forces, rel=0.02, abs=1e-3)
    assert values["tip.displacement"][1] == pytest.approx(tip, rel=0.02)


# of the apex's legs how far aside and how far down their feet are: upright, leaning, closed with a base near
KNIVES = [
    (-0.001, 0.0005, 0.3, False),
    (-0.0001, 0.07, 0.07, False),
    (-0.04, -0.02, 0.2, True),
    (-1e-4, 1e-4, 0.01, True),
]


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("links", [20, 40, 80])
@pytest.mark.parametrize("knife", KNIVES)
def test_a_knife_narrower_than_an_element_presses_as_a_point_does(knife, links, thick):
    # a long step leads from rest beyond both; the beam is pressed on them, and passes through neither
    load, places, gaps = Pressed(force=-0.04), np.array([0.411, 0.75]), np.array([0.0004, 0.0035])
    half, (left, right, deep, closed) = 0.5 * T if thick else 0.0, knife
    knives = {}
    for i, (x, gap) in enumerate(zip(places.tolist(), gaps.tolist(), strict=True)):
        top = -gap - half
        points = ((x + left, top - deep), (x, top), (x + right, top - deep))
        points = (*points, points[0]) if closed else points
        knives[f"c{i}"] = {"kind": "beam-line", "points": points, "side": "left"}
    values = solved(beam_onto(knives, load, thick=thick), links)
    forces, tip = load.onto(places, gaps, np.ones(2))
    assert [values[f"{name}.force"][0] for name in knives] == pytest.approx(forces, rel=0.02, abs=1e-3)
    assert values["tip.displacement"][1] == pytest.approx(tip, rel=0.02)


@pytest.mark.parametrize("tip", ["pinned", "clamped"])
@pytest.mark.parametrize("links", [20, 41])
def test_a_knife_presses_a_beam_that_is_held_at_both_ends(tip, links):
    load, place, gap = Pressed(tip, force=-1.0, at=0.5), np.array([0.7753]), np.array([0.0013])
    points = ((0.7327, -0.3076), (0.7753, -0.0013), (0.7776, -0.3076))
    values = solved(
        beam_onto({"knife": {"kind": "beam-line", "points": points, "side": "left"}}, load, thick=False), links
    )
    assert values["knife.force"][0] == pytest.approx(load.onto(place, gap, np.ones(1))[0][0], rel=0.02)


@pytest.mark.parametrize("beyond", [-0.002, 0.0015, 0.003])
@pytest.mark.parametrize("links", [20, 41])
def test_the_round_end_of_a_beam_presses_a_corner_beyond_it(beyond, links):
    # a knife below the tip's end, by whose round end the tip is on it: the push leans by the sine 2·beyond/t, and the
    # tip sinks by what that leaves of half of the thickness; beside the tip it is as below the beam
    load, gap, aside = Pressed(force=-0.04), 0.003, max(beyond, 0.0)
    upright = np.sqrt((0.5 * T) ** 2 - aside**2)
    x, top = 1.0 + beyond, -gap - upright
    points = ((x - 0.002, top - 0.3), (x, top), (x + 0.001, top - 0.3))
    values = solved(
        beam_onto({"knife": {"kind": "beam-line", "points": points, "side": "left"}}, load, thick=True), links
    )
    (force,), tip = load.onto(np.array([min(x, 1.0)]), np.array([gap]), np.ones(1))
    assert values["knife.force"][0] == pytest.approx(force * 0.5 * T / upright, rel=0.03)
    assert values["tip.displacement"][1] == pytest.approx(tip, rel=0.03)
