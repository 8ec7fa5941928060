"""What a figure shows of pins between bodies and of edges, from a station that is made up."""

import math

import numpy as np
import pytest

from comparisons import figures
from comparisons.bodies_drawn import draw_edges, places_at
from cprbm_scene import Certificate, Shape, StationAnswer, scene_from
from tests.cprbm_scene.editing import edited
from tests.cprbm_scene.scenes import LINKAGE

EDGE = {
    "kind": "beam-line",
    "beam": "spring",
    "body": "rocker",
    "points": [[0.15, 0.0], [0.15, 0.1]],
    "side": "right",
    "thick": False,
}
PLANE = {"kind": "beam-half-plane", "beam": "spring", "body": "ground", "point": [0.3, 0.0], "normal": [-2.0, 0.0]}
CURVE = {
    "kind": "beam-function",
    "beam": "spring",
    "body": "crank",
    "axis": "y",
    "coefficients": [-0.5, 0.0, 1.0],
    "range": [0.0, 0.1],
    "side": "above",
}


@pytest.fixture(scope="module")
def scene():
    return scene_from(edited(("contacts", {"edge": EDGE, "plane": PLANE, "curve": CURVE}), base=LINKAGE))


@pytest.fixture(scope="module")
def station():
    """The rocker has turned by a right angle, clockwise."""
    ends = {"spring": Shape(np.array([0.0, 1.0]), np.array([0.2, 0.25]), np.array([0.0, 0.0]))}
    return StationAnswer("load", 1.0, {}, ends, {}, Certificate(*[0.0] * 8, iterations=0))


def test_what_is_pinned_is_where_its_pin_is(scene, station):
    places = places_at(scene, station)
    assert places["B1"] == places["B"] == (0.25, 0.0)
    assert places["O1"] == (0.0, 0.0)
    assert places["D"] == (0.15, 0.0)
    assert "A" not in places


def test_edges_move_with_their_bodies(scene, station):
    with figures.canvas(3.0, 3.0) as figure:
        axes = figure.add_subplot()
        draw_edges(axes, scene, places_at(scene, station), "black")
        edge, plane, curve = axes.get_lines()
    assert edge.get_xydata() == pytest.approx(np.array([[0.15, 0.0], [0.25, 0.0]]), abs=1e-9)
    x, y = plane.get_xydata().T
    assert x == pytest.approx([0.3, 0.3])
    assert math.isclose(y[0], -y[1])
    assert edge.get_linestyle() == plane.get_linestyle() == "-"
    assert curve.get_linestyle() == "--"  # of the crank one place is known, and no rotation
    assert curve.get_xydata()[[0, -1]] == pytest.approx(np.array([[-0.5, 0.0], [-0.49, 0.1]]))
