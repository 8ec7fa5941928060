"""Beams of a contact at the start: overlap up to 1e-3 t counts as touching, a larger one is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Arc, Line
from tests.cprbm_scene.editing import HINGE, edited, line_distance, mistakes, two_lines

T = 0.002


def _hinge_with_gap(gap):
    """The hinge with its centres at ±(R + (t + gap)/2): edges ``gap`` apart."""
    y = 0.025 + 0.5 * (T + gap)
    edits = []
    for beam, sign, (start, end) in (("beam1", 1, "AB"), ("beam2", -1, "CD")):
        edits += [
            (f"beams/{beam}/curve/center", [0.026, sign * y]),
            (f"beams/{beam}/curve/start", [0.001, sign * y]),
            (f"beams/{beam}/curve/end", [0.051, sign * y]),
            (f"bodies/AC/points/{start}", [0.001, sign * y]),
            (f"bodies/BD/points/{end}", [0.051, sign * y]),
        ]
    return edited(*edits, base=HINGE)


@pytest.mark.parametrize("gap", [5e-4, 1e-9, 0.0, -0.5e-6 * T, -0.99e-3 * T])
def test_arcs_that_touch_or_are_apart_pass(gap):
    assert mistakes(base=_hinge_with_gap(gap)) == {}


@pytest.mark.parametrize("share", [1.01e-3, 0.5])
def test_arcs_that_overlap_are_refused_with_the_depth(share):
    (sentence,) = mistakes(base=_hinge_with_gap(-share * T)).values()
    assert f"overlap at the start by {share * T:.3g} m, {share:.3g} of their mean thickness" in sentence


def test_arcs_that_cross_are_refused():
    """Closer than the neutral lines' own crossing: their distance is nothing, the depth all of t."""
    (sentence,) = mistakes(base=_hinge_with_gap(-1.5 * T)).values()
    assert ", 1 of their mean thickness" in sentence


@pytest.mark.parametrize("gap", [T, -T, 1.1 * T, T * (1 - 0.99e-3)])
def test_parallel_lines_that_touch_along_their_length_pass(gap):
    assert mistakes(base=two_lines(gap)) == {}


@pytest.mark.parametrize("gap", [0.9 * T, T * (1 - 1.01e-3)])
def test_parallel_lines_that_overlap_are_refused(gap):
    assert "overlap at the start" in mistakes(base=two_lines(gap))["contacts.touch"]


def _from_one_block(share, *, slope=0.05, joint="weld", body="block"):
    """A level beam, and above it a beam of varying thickness that ends beside it and rises away."""
    y = T - share * T
    base = two_lines(0.0, second=((0.0, y + 0.1 * slope), (0.1, y)))
    base["bodies"][body]["points"]["S"] = [0.1, y]
    base["beams"]["upper"]["thickness"] = {"at": [0.0, 1.0], "values": [T * (1 + 1e-9), T]}
    return edited(("beams/upper/end", {"joint": joint, "point": "S"}), base=base)


@pytest.mark.parametrize("share", [0.0, 6.35e-4, 9e-4])
def test_beams_of_varying_thickness_may_overlap_beside_one_block(share):
    """6.35e-4 is what the gripper's coordinates make with the digits that are printed."""
    assert mistakes(base=_from_one_block(share)) == {}


@pytest.mark.parametrize(
    ("share", "change"),
    [(2e-3, {}), (6.35e-4, {"joint": "pin"}), (6.35e-4, {"body": "ground"}), (6.35e-4, {"slope": 0.0})],
    ids=["too much", "a pin", "two bodies", "all along"],
)
def test_every_other_overlap_of_a_varying_thickness_is_refused(share, change):
    found = mistakes(base=_from_one_block(share, **change))
    assert f"{share:.3g} of their mean thickness" in found["contacts.touch"]


def test_lines_without_thickness_may_touch_and_not_cross():
    tee = ((0.05, 0.0), (0.05, 0.08))
    cross = ((0.05, -0.03), (0.05, 0.08))
    assert mistakes(base=two_lines(0.0, thick=False, second=tee)) == {}
    found = mistakes(base=two_lines(0.0, thick=False, second=cross))
    assert "cross at the start, at (0.05, 0) m" in found["contacts.touch"]


def test_beams_that_share_an_end_may_overlap_beside_it_only():
    fork, fold = ((0.0, 0.0), (0.08, 0.04)), ((0.0, 0.0), (0.08, 0.001))
    assert mistakes(base=two_lines(0.0, second=fork)) == {}
    assert "overlap" in mistakes(base=two_lines(0.0, second=fold))["contacts.touch"]


angles = st.floats(0.0, 6.28)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(offset=st.floats(2.1, 4.0), towards=angles, radius=st.floats(0.2, 1.0))
def test_the_distance_of_two_circles_is_that_of_their_centres_less_the_radii(offset, towards, radius):
    """Nearly full circles whose openings point away from each other."""
    centre = (offset * np.cos(towards), offset * np.sin(towards))

    def ring(middle, R, opening):
        ends = [(middle[0] + R * np.cos(opening + d), middle[1] + R * np.sin(opening + d)) for d in (0.1, -0.1)]
        return Arc(kind="arc", center=middle, start=ends[0], end=ends[1], direction="counterclockwise")

    apart = line_distance(ring((0.0, 0.0), 1.0, towards + np.pi), ring(centre, radius, towards))
    assert apart == pytest.approx(offset - 1.0 - radius, abs=1e-8)


def test_a_crossing_is_found_where_another_place_is_nearly_as_near():
    """A chord cuts the arc twice, close to grazing: the distance is zero, not the samples' spacing."""
    arc = Arc(kind="arc", center=(0.0, 0.0), start=(1.0, 0.0), end=(-1.0, 0.0), direction="counterclockwise")
    chord = Line(kind="line", start=(-0.7, 0.9999), end=(0.9, 0.9999))
    assert line_distance(arc, chord) == pytest.approx(0.0, abs=1e-8)
