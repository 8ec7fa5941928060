"""The drawing list and the figures: places of points and edges, forces, limits, curves and windows."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import cprbm
from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.formats import display_unit
from comparisons.geometry import longest
from comparisons.pairing import Solvers, paired
from comparisons.present import curves, figures
from comparisons.present.curves import curve_figures
from comparisons.present.picture import Arrow, Bounds, bounds_of, carried, outline_of, view_of
from comparisons.present.strips import left_of, with_stresses
from comparisons.present.view import force_block
from cprbm_scene import (
    Certificate,
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Shape,
    Stage,
    StationAnswer,
    scene_from,
)
from cprbm_scene.frozendict import frozendict
from tests.cprbm_scene.editing import LINKAGE, edited
from tests.verdict.jumping import Jumping

pytestmark = pytest.mark.usefixtures("printed")

RIGID = {"beam": "spring", "thick": False}
EDGE = {**RIGID, "kind": "beam-line", "body": "rocker", "points": [[0.15, 0.0], [0.15, 0.1]], "side": "right"}
PLANE = {"kind": "beam-half-plane", "beam": "spring", "body": "ground", "point": [0.3, 0.0], "normal": [-2.0, 0.0]}
CURVE = {
    "kind": "beam-function", "beam": "spring", "body": "crank", "axis": "y", "coefficients": [-0.5, 0.0, 1.0],
    "range": [0.0, 0.1], "side": "above",
}  # fmt: skip


def curves_of(compared):
    return curve_figures(compared.scene, compared.runs.answers["fea"], compared.runs.answers["cprbm"])


@pytest.fixture(scope="module")
def linkage():
    return scene_from(edited(("contacts", {"edge": EDGE, "plane": PLANE, "curve": CURVE}), base=LINKAGE))


@pytest.fixture(scope="module")
def station():
    """The rocker has turned by a right angle, clockwise, about its first point."""
    s = np.linspace(0.0, 1.0, 5)
    ends = {"spring": Shape(s, 0.2 + 0.05 * s, 0.0 * s)}
    turned = frozendict({"rocker": np.array([0.01, 0.0, -0.5 * math.pi])})
    return StationAnswer("load", 1.0, {}, ends, {}, Certificate(*[0.0] * 8, iterations=0), bodies=turned)


@pytest.fixture(scope="module")
def solved():
    """The hinge with stresses at all sections, and the views of all stations."""
    scene = with_stresses(cases.opened("hinge"))
    answer = cprbm.answer(scene, cprbm.Settings(links=19))
    return scene, answer, [view_of(scene, station) for station in answer.stations]


@pytest.fixture(scope="module")
def jumping():
    """The prestressed case at a tenth of its stations, by made-up solvers with jumps."""
    whole = cases.opened("prestressed")
    stages = tuple(
        stage.model_copy(update={"stations": stage.stations[::10], "shown": stage.stations[:1]})
        for stage in whole.stages
    )
    scene = whole.model_copy(update={"stages": stages, "claims": ()})
    return compare(paired(scene, Choices(), Solvers(Jumping("cprbm"), Jumping("fea"))))


def test_points_and_edges_move_with_their_bodies(linkage, station):
    view = view_of(linkage, station)
    first = np.array(next(iter(linkage.bodies["rocker"].points.values())))
    edge, plane = (next(part for part in view.of("edge") if part.name == name) for name in ("edge", "plane"))
    drawn = [*linkage.bodies["rocker"].points.values(), *EDGE["points"]]
    moved = [*(view.points[name] for name in linkage.bodies["rocker"].points), *edge.points]
    for place, found in zip(drawn, moved, strict=True):
        x, y = np.array(place) - first
        assert found == pytest.approx((first[0] + 0.01 + y, first[1] - x))
    assert plane.points[:, 0] == pytest.approx([0.3, 0.3])
    # without a stated motion the end of a beam says where the point of the body is
    without = view_of(linkage, replace(station, bodies={}))
    assert without.points[linkage.beams["spring"].end.point] == pytest.approx([0.25, 0.0])


def test_a_body_turns_about_its_first_point():
    scene = cases.opened("hinge")
    (x, y), *_ = scene.bodies["BD"].points.values()
    at = StationAnswer("load", 1.0, {}, {}, {}, None, bodies={"BD": np.array([0.02, -0.07, 0.5 * math.pi])})
    # a quarter turn takes (0.7, 0) beside the first point to (0, 0.7)
    assert carried(scene, at, "BD", np.array([[x + 0.7, y]]))[0] == pytest.approx([x + 0.02, y - 0.07 + 0.7])


FREE = {"beam": "b", "body": "g"}
BELOW = [
    LineContact(kind="beam-line", points=((0.0, 0.0), (0.7, 0.0), (1.3, 0.0)), side="left", **FREE),
    LineContact(kind="beam-line", points=((1.3, 0.0), (0.0, 0.0)), side="right", **FREE),
    HalfPlaneContact(kind="beam-half-plane", point=(0.3, 0.0), normal=(0.0, 0.9), **FREE),
    FunctionContact(kind="beam-function", axis="x", coefficients=(0.0, 0.0), range=(-0.3, 0.9), side="above", **FREE),
]


@pytest.mark.parametrize("contact", BELOW, ids=lambda contact: f"{contact.kind}")
def test_the_solid_side_lies_behind_the_edge(contact):
    outline, solid, closed = outline_of(contact, 3.0, 0.11)
    assert not closed
    assert outline[:, 1] == pytest.approx(0.0, abs=1e-15)
    assert solid[:, 1] == pytest.approx(-0.11, rel=1e-12)


def test_the_solid_side_of_a_function_of_y_of_a_corner_and_of_a_circle():
    along_y = FunctionContact(
        kind="beam-function", axis="y", coefficients=(0.3, 0.0), range=(0.0, 0.9), side="above", **FREE
    )
    outline, solid, _ = outline_of(along_y, 3.0, 0.11)
    assert outline[:, 0] == pytest.approx(0.3)
    assert solid[:, 0] == pytest.approx(0.19)  # the beam lies where x is larger
    corner = LineContact(kind="beam-line", points=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), side="left", **FREE)
    assert outline_of(corner, 3.0, 0.1)[1][1] == pytest.approx([1.1, -0.1])  # the same depth behind both pieces
    circle = CircleContact(kind="beam-circle", center=(0.5, 0.4), radius=0.13, **FREE)
    outline, solid, closed = outline_of(circle, 1.0, 0.1)
    assert closed
    assert np.hypot(*(outline - solid).T) == pytest.approx(0.13)
    assert left_of(np.array([[2.0, 0.0], [0.0, 3.0]])) == pytest.approx(np.array([[0.0, 1.0], [-1.0, 0.0]]))


def test_contact_forces_sum_to_the_probe_and_press_in_one_place(solved):
    scene, answer, views = solved
    pushes = views[-1].arrows_of("push")
    (stated,) = answer.stations[-1].values["contact.force"]
    assert [push.name for push in pushes] == ["contact", "contact"]  # on both beams
    assert [push.size for push in pushes] == pytest.approx([stated, stated], rel=1e-9)
    assert np.abs(force_block(views[-1]).values["contact_force"].sum(axis=0)).max() < 1e-9 * stated
    assert force_block(views[0]) is None  # the contact is open
    first, second = (push.middle for push in pushes)
    assert math.dist(first, second) < 0.01 * scene.beams["beam1"].thickness


def test_limits_span_the_shown_colours_and_arrows(solved):
    scene, answer, views = solved
    largest = max(np.abs(answer.stations[-1].values[f"{beam}.bending_stress"]).max() for beam in scene.beams)
    bounds = bounds_of(scene, views, "bending_stress")
    assert (bounds.least, bounds.most) == (-largest, largest)
    assert bounds_of(scene, views, "combined_stress").least == 0.0
    vectors = [bounds.arrow(push) for view in views for push in view.arrows_of("push")]
    assert max(np.hypot(*vector) for vector in vectors if vector is not None) == pytest.approx(0.13 * bounds.size)


def test_a_flat_picture_has_room_for_its_arrows():
    """A level strip of 100 by 2: the arrow from below has 13 % of the length."""
    push = Arrow("push", "pin", np.array([[50.0, -1.0]]), np.array([[0.0, 7.0]]))
    bounds = Bounds(np.array([0.0, -1.0]), np.array([100.0, 1.0]), 0.0, 1.0, {"push": 7.0})
    wide = bounds.around([push])
    assert (*wide.low, *wide.high) == pytest.approx((0.0, -14.0, 100.0, 1.0))
    np.testing.assert_array_equal(bounds.around([]).high, bounds.high)


def test_the_rays_of_a_stop_turn_with_its_body(jumping):
    """The body of the stop turns by the angle of the station, and two of the four rays with it."""
    scene = jumping.scene
    last = next(at for at in jumping.runs.answers["fea"].stations if at.value > 1.57)
    names = {name for name, body in scene.bodies.items() if "B" in body.points}
    turned = replace(last, bodies=frozendict(dict.fromkeys(names, np.array([0.0, 0.0, last.value]))))
    angles = []
    for at in (turned, replace(last, bodies={})):
        rays = [np.diff(part.points, axis=0)[0] for part in view_of(scene, at).of("stop")]
        angles.append([math.degrees(math.atan2(y, x)) for x, y in rays])
    differences = {round((after - before) % 360.0, 6) for after, before in zip(*angles, strict=True)}
    assert differences <= {0.0, round(math.degrees(last.value), 6)}
    assert len(angles[0]) == 4


def test_a_drive_that_goes_back_and_forth_has_all_its_figures(jumping):
    found = {figure.name: figure for figure in figures.comparison_figures(jumping)}
    assert list(found) == ["shapes", "stations", "path-alpha", "reaction-alpha", "stress"]
    assert "apart from its pin" in found["shapes"].caption
    path = found["path-alpha"]
    assert path.caption.startswith("Reaction moment")
    assert "potential energy against alpha" in path.caption
    assert "Dashed: jumps" in path.caption
    assert path.svg == next(curves_of(jumping)).svg


def test_a_curve_needs_two_stations_and_may_go_back(hinge, right):
    def of(*stages):
        scene = hinge.model_copy(update={"stages": stages, "claims": ()})
        return list(curves_of(compare(paired(scene, Choices(), right))))

    load = hinge.stages[0]
    assert of(load.model_copy(update={"stations": (0.3,), "shown": (0.3,)})) == []
    back = Stage(name="back", steps="M", stations=(0.1,))
    (path,) = of(load.model_copy(update={"stations": (0.3, 0.6), "shown": (0.6,)}), back)
    assert path.name == "path-M"
    assert path.caption.startswith("Rotation")


def test_a_contact_in_a_point_is_shown_on_a_part_of_its_beam(solved, monkeypatch):
    """The finite elements press over 1e-4 of a beam: the figure shows a twentieth, and no wide zone."""
    scene, answer, _ = solved
    monkeypatch.setattr(curves, "chart", lambda name, caption, abscissa, panels, **_: panels)
    where = SimpleNamespace(where=(answer.stations[-1].stage, answer.stations[-1].value))
    compared = SimpleNamespace(scene=scene, rows=[where], runs=SimpleNamespace(pair=(answer, answer)))
    (panels,) = curves.contact_figures(compared)
    factor, _ = display_unit(scene, "m", longest(scene))
    for panel in panels:
        shown = factor * np.ptp(np.concatenate([s for s, *_ in panel.lines]))
        assert 0.05 * longest(scene) <= shown * (1.0 + 1e-9) < 0.06 * longest(scene)


def test_a_window_shows_the_beams_alone_where_the_rest_is_twice_as_large(solved):
    scene, _, views = solved
    low, high = figures.extent(scene, views[-1:])
    assert np.max(high - low) > 0.05
    small = {name: strip._replace(line=0.02 * strip.line) for name, strip in views[-1].strips.items()}
    low, high = figures.extent(scene, [views[-1]._replace(strips=small)])
    assert np.max(high - low) < 0.003
