"""Thickness and width that vary along a beam: how they are read, and what is wrong with wrong ones."""

import numpy as np
import pytest

from cprbm_scene import Profile, scene_from
from tests.cprbm_scene.editing import edited, mistakes, two_lines

NAN = float("nan")
BEAM = "beams/lower"
SIZE = {"at": [0.0, 0.25, 1.0], "values": [0.003, 0.001, 0.002]}


def line(*edits):
    return edited(*edits, base=two_lines(0.01, thick=False))


def test_a_size_goes_straight_between_its_places():
    beam = scene_from(line((f"{BEAM}/thickness", SIZE))).beams["lower"]
    assert isinstance(beam.thickness, Profile)
    at = np.array([[0.0, 0.125, 0.25], [0.5, 0.75, 1.0]])
    expected = np.array([[0.003, 0.002, 0.001], [0.004 / 3, 0.005 / 3, 0.002]])
    assert beam.thickness_at(at) == pytest.approx(expected, rel=1e-14)
    assert beam.width_at(at) == pytest.approx(np.full((2, 3), 0.01))
    assert (beam.thinnest, beam.thickest, beam.tapered) == (0.001, 0.003, True)
    assert beam.knots.tolist() == [0.0, 0.25, 1.0]


def test_kinks_of_both_sizes_are_knots():
    data = line((f"{BEAM}/thickness", SIZE), (f"{BEAM}/width", {"at": [0.0, 0.7, 1.0], "values": [0.01, 0.02, 0.01]}))
    assert scene_from(data).beams["lower"].knots.tolist() == [0.0, 0.25, 0.7, 1.0]


def test_a_profile_of_one_value_is_no_taper():
    size = {"at": [0.0, 1.0], "values": [0.002, 0.002]}
    data = edited((f"{BEAM}/thickness", size), base=two_lines(0.01))
    assert not scene_from(data).beams["lower"].tapered


def size(at=(0.0, 0.25, 1.0), values=(0.003, 0.001, 0.002), **more):
    return {"at": list(at), "values": list(values), **more}


@pytest.mark.parametrize("key", ["thickness", "width"])
@pytest.mark.parametrize(
    ("value", "where", "words"),
    [
        (size(at=[0.0, 0.25]), "values", "3 values at 2 places; as many values as places"),
        (size(at=[0.1, 0.25, 1.0]), "at", "from 0.1 to 1; fractions of the beam's length that begin with 0"),
        (size(at=[0.0, 0.25, 0.9]), "at", "from 0 to 0.9"),
        (size(at=[0.0, 1.0, 1.0]), "at[2]", "1 after 1; places that ascend"),
        (size(at=[0.0, 1.25, 1.0]), "at[2]", "1 after 1.25; places that ascend"),
        (size(at=[0.0, 1e-9, 1.0]), "at[1]", "1e-09 after 0"),
        (size(at=[0.0], values=[0.002]), "at", "at least 2"),
        (size(values=[0.003, -0.001, 0.002]), "values[1]", "greater than 0"),
        (size(values=[0.003, NAN, 0.002]), "values[1]", "finite"),
        (size(values=[0.003, "thin", 0.002]), "values[1]", "a number"),
        ({"at": [0.0, 1.0], "values": 0.002}, "values", "a list"),
        (size(values=[1e-30, 1e30, 0.002]), "values", "1e-30 m to 1e+30 m; values of which the largest"),
        (size(a=1), "a", "no key here"),
        ({"at": [0.0, 1.0]}, "values", "required"),
    ],
)
def test_a_wrong_profile_is_named(key, value, where, words):
    found = mistakes((f"{BEAM}/{key}", value), base=two_lines(0.01, thick=False))
    assert list(found) == [name for name in found if name.startswith(f"beams.lower.{key}.")]
    assert words in found[f"beams.lower.{key}.{where}"]


@pytest.mark.parametrize("value", ["thin", [0.001, 0.002], None])
def test_what_is_neither_number_nor_profile(value):
    found = mistakes((f"{BEAM}/thickness", value), base=two_lines(0.01, thick=False))
    assert "a number, or a table with the keys 'at' and 'values'" in found["beams.lower.thickness"]


@pytest.mark.parametrize("thickness", [0.021, 0.9e-6])
def test_the_thinnest_and_the_thickest_place_are_in_proportion(thickness):
    found = mistakes((f"{BEAM}/thickness", size(values=[0.003, thickness, 0.002])), base=two_lines(0.01, thick=False))
    assert f"{thickness:g} m, which is" in found["beams.lower.thickness"]


def test_only_the_thickness_where_a_line_bends_must_fit_its_bend():
    # y = 50 x² has the radius 0.01 m where it begins, and is nearly straight for the most of its length
    curve = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.0, 50.0], "range": [0.0, 0.1]}
    base = two_lines(0.01, thick=False)
    base["bodies"]["block"]["points"]["Q"] = [0.1, 0.5]
    base["beams"]["lower"]["curve"] = curve
    base["contacts"] = {}
    assert "radius of curvature" in mistakes((f"{BEAM}/thickness", 0.028), base=base)["beams.lower.thickness"]
    outer = {"at": [0.0, 0.2, 0.3, 1.0], "values": [0.004, 0.004, 0.028, 0.028]}
    assert mistakes((f"{BEAM}/thickness", outer), base=base) == {}
    inner = {"at": [0.0, 0.2, 0.3, 1.0], "values": [0.028, 0.028, 0.004, 0.004]}
    assert "radius of curvature" in mistakes((f"{BEAM}/thickness", inner), base=base)["beams.lower.thickness"]


@pytest.mark.parametrize(
    ("values", "apart"), [([0.001, 0.002], 0.002), ([0.001, 0.0013, 0.001], 0.00165), ([0.0012, 0.001, 0.0018], 0.0019)]
)
def test_edges_of_a_varying_thickness_touch_where_it_is_thickest(values, apart):
    """Two level lines, the upper one 2 mm thick."""
    at = [0.0, 0.37, 1.0] if len(values) == 3 else [0.0, 1.0]
    for gap, fits in ((apart, True), (apart + 1e-5, True), (apart - 1e-8, False), (0.4 * apart, False)):
        found = mistakes((f"{BEAM}/thickness", {"at": at, "values": values}), base=two_lines(gap))
        assert (found == {}) if fits else (f"overlap at the start by {apart - gap:.3g} m" in found["contacts.touch"])


def test_edges_of_a_varying_thickness_lean():
    """Lines that are not parallel, and whose edges touch all along: u is normal to these."""
    sine = 0.01
    u, along = np.array([-sine, np.sqrt(1.0 - sine**2)]), np.array([np.sqrt(1.0 - sine**2), sine])
    thickness = {"at": [0.0, 1.0], "values": [0.001, 0.001 + 2.0 * sine * 0.1]}
    for closer, fits in ((0.0, True), (1e-8, False)):
        middle = np.array([0.05, 0.0]) + (0.5e-3 + sine * 0.05 + 0.001 - closer) * u
        ends = tuple(tuple((middle + way * along).tolist()) for way in (-0.04, 0.04))
        found = mistakes((f"{BEAM}/thickness", thickness), base=two_lines(0.0, second=ends))
        assert (found == {}) == fits, found
