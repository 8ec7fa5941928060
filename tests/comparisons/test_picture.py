"""The drawing list and the figures made of it: places of points and edges, curves, windows, names."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.present import figures
from comparisons.present.curves import curve_figures
from comparisons.present.picture import view_of
from comparisons.present.strips import left_of
from cprbm_scene import Certificate, Shape, Stage, StationAnswer, scene_from
from cprbm_scene.frozendict import frozendict
from tests.cprbm_scene.editing import edited
from tests.cprbm_scene.scenes import LINKAGE
from tests.verdict.jumping import Jumping


def curves_of(compared):
    return curve_figures(compared.scene, compared.runs.reference, compared.runs.cprbm[0])


RIGID = {"beam": "spring", "thick": False}
EDGE = {**RIGID, "kind": "beam-line", "body": "rocker", "points": [[0.15, 0.0], [0.15, 0.1]], "side": "right"}
PLANE = {"kind": "beam-half-plane", "beam": "spring", "body": "ground", "point": [0.3, 0.0], "normal": [-2.0, 0.0]}
CURVE = {
    "kind": "beam-function", "beam": "spring", "body": "crank", "axis": "y", "coefficients": [-0.5, 0.0, 1.0],
    "range": [0.0, 0.1], "side": "above",
}  # fmt: skip


@pytest.fixture(scope="module")
def linkage():
    return scene_from(edited(("contacts", {"edge": EDGE, "plane": PLANE, "curve": CURVE}), base=LINKAGE))


@pytest.fixture(scope="module")
def station(linkage):
    """The rocker has turned by a right angle, clockwise, about its first point."""
    s = np.linspace(0.0, 1.0, 5)
    ends = {"spring": Shape(s, 0.2 + 0.05 * s, 0.0 * s)}
    turned = frozendict({"rocker": np.array([0.01, 0.0, -0.5 * math.pi])})
    return StationAnswer("load", 1.0, {}, ends, {}, Certificate(*[0.0] * 8, iterations=0), bodies=turned)


def test_points_and_edges_move_with_their_bodies(linkage, station):
    view = view_of(linkage, station)
    first = np.array(next(iter(linkage.bodies["rocker"].points.values())))
    for name, place in linkage.bodies["rocker"].points.items():
        x, y = np.array(place) - first
        assert view.points[name] == pytest.approx((first[0] + 0.01 + y, first[1] - x))
    edge = next(each for each in view.of("edge") if each.name == "edge")
    for place, drawn in zip(edge.points, EDGE["points"], strict=True):
        x, y = np.array(drawn) - first
        assert place == pytest.approx((first[0] + 0.01 + y, first[1] - x))
    plane = next(each for each in view.of("edge") if each.name == "plane")
    assert plane.points[:, 0] == pytest.approx([0.3, 0.3])


def test_ends_of_beams_say_where_points_of_bodies_without_a_motion_are(linkage, station):
    view = view_of(linkage, replace(station, bodies={}))
    end = linkage.beams["spring"].end.point
    assert view.points[end] == pytest.approx([0.25, 0.0])


def test_normals_point_to_the_left():
    assert left_of(np.array([[2.0, 0.0], [0.0, 3.0]])) == pytest.approx(np.array([[0.0, 1.0], [-1.0, 0.0]]))


def case(every):
    whole = cases.opened("prestressed")
    stages = tuple(
        stage.model_copy(update={"stations": stage.stations[::every], "shown": stage.stations[:1]})
        for stage in whole.stages
    )
    return whole.model_copy(update={"stages": stages, "claims": ()})


@pytest.fixture(scope="module")
def comparison():
    scene = case(10)
    return compare(scene, paired(scene, Choices(), Solvers(Jumping("cprbm"), Jumping("fea"))))


def test_a_drive_that_goes_back_and_forth_has_its_curve(comparison):
    (path,) = curves_of(comparison)
    assert path.name == "path-alpha"
    assert path.caption.startswith("Reaction moment")
    assert "potential energy against alpha" in path.caption
    assert "Dashed: jumps" in path.caption
    assert path.svg == next(curves_of(comparison)).svg


def test_shown_stations_stand_beside_the_last(comparison):
    found = figures.comparison_figures(comparison)
    assert [figure.name for figure in found] == ["shapes", "stations", "path-alpha", "reaction-alpha", "stress"]
    assert "apart from its pin" in found[0].caption


def test_the_rays_of_a_stop_turn_with_its_body(comparison):
    """At 90° the line from B to C points up, and 45° to either side of it is where the rays go."""
    scene = comparison.scene
    last = next(at for at in comparison.runs.reference.stations if at.value > 1.57)
    names = {name for name, body in scene.bodies.items() if "B" in body.points}
    turned = replace(last, bodies=frozendict(dict.fromkeys(names, np.array([0.0, 0.0, last.value]))))
    rays = [np.diff(part.points, axis=0)[0] for part in view_of(scene, turned).of("stop")]
    bases = [math.degrees(math.atan2(y, x)) for x, y in rays]
    at_rest = [np.diff(part.points, axis=0)[0] for part in view_of(scene, replace(last, bodies={})).of("stop")]
    before = [math.degrees(math.atan2(y, x)) for x, y in at_rest]
    differences = {round((a - b) % 360.0, 6) for a, b in zip(bases, before, strict=True)}
    assert differences <= {0.0, round(math.degrees(last.value), 6)}
    assert len(rays) == 4


def test_a_load_that_goes_back_has_the_curve_of_its_body(hinge, right):
    back = Stage(name="back", steps="M", stations=(0.3, 0.1))
    scene = hinge.model_copy(update={"stages": (*hinge.stages, back)})
    (path,) = curves_of(compare(scene, paired(scene, Choices(), right)))
    assert path.caption.startswith("Rotation")


def test_a_single_station_is_no_curve(hinge, right):
    """A point has no curve, on axes that must have a length."""

    def of(*stations):
        stage = hinge.stages[0].model_copy(update={"stations": stations, "shown": stations[-1:]})
        scene = hinge.model_copy(update={"stages": (stage,), "claims": ()})
        return compare(scene, paired(scene, Choices(), right))

    assert list(curves_of(of(0.3))) == []
    assert [each.name for each in curves_of(of(0.3, 0.6))] == ["path-M"]


def test_a_mechanism_that_draws_itself_together_is_shown_as_large_as_it_is(hinge, right):
    """A window of the beams alone where the mechanism at rest is more than twice as large."""
    answer = right.cprbm(hinge, Choices())
    view = view_of(hinge, answer.stations[-1])
    low, high = figures.extent(hinge, [view])
    assert np.max(high - low) > 0.05
    small = {name: replace(strip, line=0.02 * strip.line) for name, strip in view.strips.items()}
    low, high = figures.extent(hinge, [view._replace(strips=small)])
    assert np.max(high - low) < 0.003
