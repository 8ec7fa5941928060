"""Corners of beams' ends: on another beam, and on what is rigid."""

import numpy as np
import pytest

import fea_reference
from cprbm_scene import LineContact, scene_from
from fea_reference import solid
from fea_reference.solid.edges import broken
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar

STRIP = {"width": WIDTH, "material": "m", "thickness": 0.0017}


def pressing(*, by_a_point):
    """A cantilever whose tip is driven down on another one that comes from the other side, by its own corner.

    The beams of the other solver have round ends.  There the corner is a circle on the tip's body, a fiftieth as thick.
    """
    half, radius = 0.5 * STRIP["thickness"], 0.01 * STRIP["thickness"]
    corner = {"kind": "beam-circle", "beam": "low", "body": "tip", "center": [0.11 - radius, -half + radius]}
    edges = {"kind": "beam-beam", "between": ["high", "low"]}
    return scene_from(
        {
            "name": "pressing",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.0}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"A": [0.0, 0.0], "B": [0.17, -0.013]}},
                "tip": {"motion": "free", "points": {"T": [0.11, 0.0]}},
                "far": {"motion": "free", "points": {"F": [0.06, -0.013]}},
            },
            "beams": {
                "high": {
                    **STRIP,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.11, 0.0]},
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "T"},
                },
                "low": {
                    **STRIP,
                    "curve": {"kind": "line", "start": [0.17, -0.013], "end": [0.06, -0.013]},
                    "start": {"joint": "weld", "point": "B"},
                    "end": {"joint": "weld", "point": "F"},
                },
            },
            "drives": {"press": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"c": {**corner, "radius": radius} if by_a_point else edges},
            "stages": [{"name": "press", "steps": "press", "stations": [0.041]}],
            "probes": [
                {"of": "T", "quantity": "reaction"},
                {"of": "T", "quantity": "displacement"},
                {"of": "B", "quantity": "reaction_moment"},
                {"of": "c", "quantity": "force"},
            ],
        }
    )


def test_the_corner_of_a_held_end_presses_as_a_point_of_its_body_does():
    found = solid.answer(pressing(by_a_point=False), solid.Settings(elements=14, across=1))
    there = fea_reference.answer(pressing(by_a_point=True), fea_reference.Settings(elements=24, kinematics="shear"))
    assert found.completed, found.sentence
    assert there.completed, there.sentence
    for name, value in there.stations[0].values.items():
        mine = found.stations[0].values[name]
        assert np.abs(mine - value).max() < 0.01 * np.abs(value).max(), name


LENGTH, THICKNESS, LEANS, BELOW = 0.1, 0.002, np.radians(62.0), 0.0012
FLOOR = -LENGTH * np.sin(LEANS) - BELOW


@pytest.mark.parametrize(
    "floor",
    [
        {"kind": "beam-half-plane", "point": [0.0, FLOOR], "normal": [0.0, 1.0]},
        {"kind": "beam-line", "points": [[-0.3, FLOOR], [0.3, FLOOR]], "side": "left"},
        {"kind": "beam-function", "axis": "x", "coefficients": [FLOOR, 0.0], "range": [-0.3, 0.3], "side": "above"},
    ],
    ids=["half-plane", "line", "function"],
)
def test_a_steep_end_stands_on_the_floor_by_its_corner(floor):
    # the place of the corner follows from the tip's displacement and rotation, and it is the floor's
    scene = bar(
        {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH * np.cos(LEANS), -LENGTH * np.sin(LEANS)]},
        THICKNESS,
        contacts={"floor": {**floor, "beam": "beam", "body": "ground"}},
        load={"kind": "force", "point": "tip", "direction": [0.3, -1.0]},
        stations=(0.57,),
        probes=(("tip", "displacement"), ("block", "rotation"), ("floor", "force"), ("root", "reaction")),
    )
    found = solid.answer(scene, solid.Settings(elements=9, across=1))
    assert found.completed, found.sentence
    values = found.stations[0].values
    assert values["floor.force"][0] > 0.1 * 0.57
    turned = -LEANS + values["block.rotation"][0]
    tip = -LENGTH * np.sin(LEANS) + values["tip.displacement"][1]
    corner = tip - 0.5 * THICKNESS * np.cos(turned)  # the right one of the end, as seen along the beam
    assert corner == pytest.approx(FLOOR, abs=1e-3 * THICKNESS)
    assert values["floor.force"][0] + values["root.reaction"][1] == pytest.approx(0.57 / np.hypot(0.3, 1.0), rel=1e-7)


def seen(points, places, side="left"):
    """The gaps of places to an edge."""
    contact = LineContact(kind="beam-line", beam="b", body="g", points=points, side=side)
    edge, corners = broken(contact, np.zeros(2), 1.0)
    return edge.measured(places)[0], len(corners)


def test_sides_that_meet_behind_an_edge_are_those_of_a_block():
    # a roof of two equal pieces at a right angle: what is rigid behind it is a square
    open_roof = ((0.0, 0.0), (1.3, 1.3), (2.6, 0.0))
    square = (*open_roof, (1.3, -1.3), (0.0, 0.0))
    places = np.random.default_rng(31).uniform(-4.0, 6.0, (400, 2))
    gaps, corners = seen(open_roof, places)
    assert gaps == pytest.approx(seen(square, places)[0])
    assert corners == 4


def test_a_side_ends_where_it_comes_to_the_edge_from_behind():
    # a hook, whose short end looks at the back of its long piece: on that piece's other side nothing is rigid
    hook = ((0.0, 0.0), (0.0, 3.0), (1.1, 3.0), (1.1, 2.2))
    gaps, _ = seen(hook, np.array([[-1.7, 2.3], [0.4, 2.6]]), side="left")
    assert gaps[0] == pytest.approx(1.7)
    assert -0.45 < gaps[1] < 0.0
