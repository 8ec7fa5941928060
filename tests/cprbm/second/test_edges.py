"""Corners, bends and ends of rigid edges, and bodies that contacts hold, against references outside of the chain."""

from pathlib import Path

import numpy as np
import pytest

import cprbm
from cprbm_scene import Loss, read, scene_from
from tests.cprbm_scene.editing import edited
from tests.fea_reference.on_an_edge import T, cantilever_over
from tests.references.cornered import Cornered
from tests.scenes.rare_scenes import scene as rare_scene
from tests.together.features import CIRCLE, held_by

AT, FORCE = (0.5, -0.02), 3.0
DEAD_WEIGHT = """
name = "dead-weight"
theory = "bending"
units = { length = "mm", force = "N", angle = "deg", stress = "MPa" }
[materials.steel]
youngs_modulus = 200000.0
poisson_ratio = 0.3
[bodies.ground]
motion = "fixed"
points = { A = [0.0, 0.0] }
[bodies.tip]
motion = "free"
points = { T = [100.0, 0.0] }
[bodies.slider]
motion = "slides"
points = { N = [70.0, 10.0] }
along = [0.0, 1.0]
[beams.leaf]
curve = { kind = "line", start = [0.0, 0.0], end = [100.0, 0.0] }
thickness = 1.0
width = 10.0
material = "steel"
start = { joint = "weld", point = "A" }
end = { joint = "weld", point = "T" }
[contacts.nose]
kind = "beam-circle"
beam = "leaf"
body = "slider"
center = [70.0, 5.6]
radius = 5.0
[loads.W]
kind = "force"
point = "N"
direction = [0.0, -1.0]
[[stages]]
name = "W"
steps = "W"
stations = [1.0, 5.0, 10.0]
[[probes]]
of = "N"
quantity = "displacement"
[[probes]]
of = "nose"
quantity = "force"
"""
"""A slider with a round nose, loaded by a dead force, rests on a leaf spring."""


def solved(scene, links=40):
    found = cprbm.answer(scene, cprbm.Settings(links=links))
    assert found.completed, found.sentence
    return found.stations[-1].values


def over(contact, thick):
    return solved(cantilever_over({**contact, "thick": thick}, force=FORCE))


@pytest.mark.parametrize("thick", [False, True])
def test_a_circle_of_vanishing_radius_is_a_corner(thick):
    # reference: shooting of the elastica over a corner; the circle's top is the corner
    exact = Cornered(FORCE, AT, 0.5 * T if thick else 0.0)
    errors = []
    for radius in (1e-3, 1e-4, 1e-5):
        values = over({"kind": "beam-circle", "center": (AT[0], AT[1] - radius), "radius": radius}, thick)
        errors.append(abs(values["edge.force"][0] / exact.pressed - 1.0))
    # the place of contact is off the top by the sine of the slope times the radius
    assert errors[0] > 5.0 * errors[1] > 25.0 * errors[2]
    assert errors[2] < 1e-4


def polygon(pieces):
    angle = np.linspace(0.0, 2.0 * np.pi, pieces + 1)[::-1]
    points = np.column_stack([0.5 + 0.1 * np.cos(angle), -0.12 + 0.1 * np.sin(angle)])
    points[-1] = points[0]
    return {"kind": "beam-line", "points": tuple(map(tuple, points.tolist())), "side": "left"}


@pytest.mark.parametrize("thick", [False, True])
def test_a_polygon_through_points_of_a_circle_presses_by_a_corner_and_tends_to_the_circle(thick):
    # reference: shooting of the elastica over the corner on top; with pieces far below a link, the circle
    exact = Cornered(FORCE, AT, 0.5 * T if thick else 0.0)
    assert over(polygon(8), thick)["edge.force"][0] == pytest.approx(exact.pressed, rel=1e-6)
    circle = over({"kind": "beam-circle", "center": (0.5, -0.12), "radius": 0.1}, thick)
    assert over(polygon(256), thick)["edge.force"] == pytest.approx(circle["edge.force"], rel=1e-2)


def test_a_support_at_the_end_of_a_straight_edge_is_a_prop():
    # reference: beam theory, statically indeterminate: a prop at a takes F (2a + 3b)/(2a), the tip at b beyond sinks by
    # F b² (3a + 4b)/(12 EI); the beam lifts off the edge before the end
    a, b, force = 0.6, 0.4, 1e-4
    line = {"kind": "beam-line", "points": ((0.0, -0.5 * T), (a, -0.5 * T)), "side": "left"}
    values = solved(cantilever_over(line, force=force), 20)
    assert values["edge.ends"] == pytest.approx([a, a], abs=1e-5)
    assert values["edge.force"] == pytest.approx([force * (2.0 * a + 3.0 * b) / (2.0 * a)], rel=1e-5)
    assert values["tip.displacement"][1] == pytest.approx(-force * b**2 * (3.0 * a + 4.0 * b) / 12.0, rel=1e-5)


def test_a_corner_goes_round_the_end_of_a_beam():
    # the wedge's corner passes the round end of the beam, and the end slides on the face
    found = cprbm.answer(rare_scene("round-a-corner"), cprbm.Settings(links=20))
    assert found.completed
    assert not found.critical


def test_an_end_slips_off_a_corner_by_name():
    # reference: linear theory of a propped beam gives 0.02048 N within 2 %
    found = cprbm.answer(rare_scene("off-a-corner"), cprbm.Settings(links=20))
    (point,) = found.critical
    assert (point.loss, point.what) == (Loss.SLIP, "corner")
    assert point.value == pytest.approx(0.02048, rel=0.02)


def test_a_wedge_holds_by_its_short_face_and_not_from_behind():
    # reference: the first edition's limit at 40 and 80 links
    found = cprbm.answer(rare_scene("wedge-on-a-lever"), cprbm.Settings(links=40))
    assert found.completed
    assert found.stations[-1].values["wedge.force"] == pytest.approx([2404.54], rel=1e-4)


def test_a_dead_weight_rests_on_a_leaf(tmp_path):
    # reference: shooting of the leaf's elastica, within 0.5 % in forces
    path = tmp_path / "scene.toml"
    path.write_text(DEAD_WEIGHT, encoding="utf-8")
    found = cprbm.answer(read(path), cprbm.Settings(links=20))
    assert found.completed
    down = [station.values["N.displacement"][1] for station in found.stations]
    forces = [station.values["nose.force"][0] for station in found.stations]
    assert down == pytest.approx([-0.784e-3, -3.507e-3, -6.951e-3], abs=1e-6)
    assert forces == pytest.approx([1.0001, 5.0134, 10.109], rel=1e-4)


def test_a_load_away_from_all_contacts_leaves_a_body_neutral(tmp_path):
    path = Path(tmp_path) / "scene.toml"
    path.write_text(DEAD_WEIGHT.replace("direction = [0.0, -1.0]", "direction = [0.0, 1.0]"), encoding="utf-8")
    found = cprbm.answer(read(path), cprbm.Settings(links=10))
    assert not found.completed
    assert "body 'slider' is neutral" in found.sentence


def test_a_flat_ellipse_has_a_sharp_tip_that_no_place_leaves():
    """A place at the end of the tip's bend stays there; the values of 10 and 40 links agree within 1e-4."""
    base = held_by(CIRCLE)
    lower = 0.5 * base["beams"]["beam"]["thickness"] + 0.0005
    ellipse = {"kind": "beam-ellipse", "beam": "beam", "body": "wall", "semi_axes": [0.01, 0.002]}
    scene = scene_from(edited(("contacts/c", ellipse | {"center": [0.06, -0.002 - lower]}), base=base))
    few, many = (cprbm.answer(scene, cprbm.Settings(links=links)) for links in (10, 40))
    assert few.completed
    assert many.completed
    for probe in ("T.displacement", "c.force"):
        assert few.stations[-1].values[probe] == pytest.approx(many.stations[-1].values[probe], rel=1e-4)
