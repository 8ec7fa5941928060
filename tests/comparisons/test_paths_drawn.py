"""Figures of what is stepped back and forth: which there are, and what is in them."""

from collections import namedtuple

import numpy as np
import pytest

from comparisons import cases, figures, paths_drawn, reactions_drawn
from comparisons.bodies_drawn import draw_stops, places_at
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.framing import frame
from comparisons.pairing import Solvers, paired
from cprbm_scene import Stage
from tests.verdict.jumping import Jumping


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


def test_a_drive_that_goes_back_and_forth_has_its_path(comparison):
    (path,) = paths_drawn.of_comparison(comparison)
    assert path.name == "path-alpha"
    assert path.caption.startswith("Reaction moment and potential energy against alpha")
    assert path.svg == paths_drawn.of_comparison(comparison)[0].svg


def test_the_stations_to_show_are_drawn_beside_the_last(comparison):
    names = [picture.name for picture in figures.of_comparison(comparison)]
    assert names[:2] == ["shapes", "stations"]
    assert "apart from its pin" in figures.of_comparison(comparison)[0].caption
    assert [picture.name for picture in reactions_drawn.of_comparison(comparison)] == ["reaction-alpha"]


def test_what_is_stepped_once_and_never_jumps_has_no_path(hinge, right):
    assert paths_drawn.of_comparison(compare(hinge, paired(hinge, Choices(), right))) == ()


def test_a_load_that_goes_back_has_the_path_of_its_body(hinge, right):
    back = Stage(name="back", steps="M", stations=(0.3, 0.1))
    scene = hinge.model_copy(update={"stages": (*hinge.stages, back)})
    (path,) = paths_drawn.of_comparison(compare(scene, paired(scene, Choices(), right)))
    assert path.caption.startswith("Rotation of BD")


def test_a_pivot_and_the_ends_have_places(comparison):
    """The crank turns about A by what its drive says: B at 0 is where it is drawn."""
    scene = comparison.scene
    first = places_at(scene, comparison.runs.reference.stations[0])
    assert set(first) == {"A", "B", "C", "O1", "O2"}
    assert first["B"] == pytest.approx((-0.02, 0.05), abs=1e-12)
    last = places_at(scene, next(s for s in comparison.runs.reference.stations if s.value > 1.57))
    assert last["B"] == pytest.approx((-0.04, -0.01), abs=1e-6)


def test_the_rays_of_a_stop_turn_with_its_body(comparison):
    """At 90° the line from B to C points up, and 45° to either side of it is where the rays go."""
    scene = comparison.scene
    last = places_at(scene, next(s for s in comparison.runs.reference.stations if s.value > 1.57))
    with figures.canvas(3.0, 3.0) as figure:
        axes = figure.add_subplot()
        draw_stops(axes, scene, last)
        rays = [np.diff(line.get_xydata(), axis=0)[0] for line in axes.get_lines()]
    ways = [np.degrees(np.arctan2(y, x)) for x, y in rays]
    np.testing.assert_allclose(ways, [45.0, 135.0, -135.0, -45.0], atol=1e-6)


def test_a_stop_of_a_body_whose_rotation_is_not_known_is_not_drawn(comparison):
    with figures.canvas(3.0, 3.0) as figure:
        axes = figure.add_subplot()
        draw_stops(axes, comparison.scene, {"B": (0.0, 0.0)})
        assert axes.get_lines() == []


def test_one_station_alone_is_no_curve(hinge, right):
    """Of a point there is nothing to see, on axes that must have a length."""

    def of(*stations):
        stage = hinge.stages[0].model_copy(update={"stations": stations, "shown": stations[-1:]})
        scene = hinge.model_copy(update={"stages": (stage,), "claims": ()})
        return compare(scene, paired(scene, Choices(), right))

    assert paths_drawn.of_every_way(of(0.3)) == ()
    assert [each.name for each in paths_drawn.of_every_way(of(0.3, 0.6))] == ["path-M"]


def test_a_mechanism_that_draws_itself_together_is_shown_as_large_as_it_is():
    """A line of 240 mm rolled to 60 x 50 mm has a window of its own; one of 60 x 40 mm stands beside the whole line."""
    shape = namedtuple("Shape", "x y")
    for across, high, most in ((0.03, 0.025, 0.06), (0.13, 0.04, 0.3)):
        turn = np.linspace(0.0, 2.0 * np.pi, 30)
        loaded = namedtuple("Station", "shapes")({"strip": shape(across * np.cos(turn), high * np.sin(turn))})
        with figures.canvas(4.0, 4.0) as figure:
            axes = figure.add_subplot()
            axes.plot([0.0, 0.24], [0.0, 0.0])
            axes.plot(loaded.shapes["strip"].x, loaded.shapes["strip"].y)
            frame(axes, loaded)
            assert np.ptp(axes.get_xlim()) < 1.7 * most
            assert axes.get_xlim()[0] < -across
            assert (axes.get_xlim()[1] > 0.24) == (across > 0.1)
