"""What a scene may tell the formulation ``paper`` about a beam's elements."""

import pytest

from tests.cprbm_scene.editing import edited, mistakes, two_lines

TWO = two_lines(0.1)
ARC = {"kind": "arc", "center": [0.05, 0.0], "start": [0.0, 0.0], "end": [0.1, 0.0], "direction": "clockwise"}
BOWL = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, -0.4, 4.0], "range": [0.0, 0.1]}


def with_curve(curve, axis):
    return edited(("beams/lower/curve", curve), ("beams/lower/paper", {"uniform": axis}), ("contacts", {}), base=TWO)


@pytest.mark.parametrize("curve", [TWO["beams"]["lower"]["curve"], ARC, BOWL], ids=["line", "half circle", "bowl"])
def test_elements_are_uniform_only_along_an_axis_along_which_the_beam_runs_one_way(curve):
    assert mistakes(base=with_curve(curve, "x")) == {}
    found = mistakes(base=with_curve(curve, "y"))
    assert list(found) == ["beams.lower.paper.uniform"]
    assert "'y', along which the curve turns back" in found["beams.lower.paper.uniform"]


def test_an_axis_that_is_none():
    found = mistakes(base=with_curve(ARC, "s"))
    assert list(found) == ["beams.lower.paper.uniform"]
    assert "'x'" in found["beams.lower.paper.uniform"]
