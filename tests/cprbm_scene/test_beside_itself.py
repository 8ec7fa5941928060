"""Beams that overlap themselves: rings by the chord of their ends; polynomials cannot."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from cprbm_scene import Polynomial
from cprbm_scene.geometry import arc_length, largest_curvature, points_on
from tests.cprbm_scene.editing import edited, mistakes, two_lines

T = 0.002
KEY = "beams.lower.curve"


def _with(curve, *edits, thickness=T):
    """The cantilevers with the lower one's curve replaced, its end free and the block at the upper one's."""
    return edited(
        ("beams/lower/curve", curve),
        ("beams/lower/thickness", thickness),
        ("beams/lower/end", {"joint": "free"}),
        ("bodies/ground/points/O", curve["start"]),
        ("bodies/block/points/Q", [0.1, 0.3]),
        ("beams/upper/end", {"joint": "weld", "point": "Q"}),
        ("contacts", {}),
        *edits,
        base=two_lines(0.0, second=((0.0, 0.3), (0.1, 0.3))),
    )


def _ring(opening, direction="counterclockwise", radius=0.03):
    """A circle whose ends are a chord ``opening`` apart."""
    half = np.arcsin(0.5 * opening / radius)
    sign = 1.0 if direction == "counterclockwise" else -1.0
    start, end = ([radius * np.cos(a), radius * np.sin(a)] for a in (sign * half, -sign * half))
    return {"kind": "arc", "center": [0.0, 0.0], "start": start, "end": end, "direction": direction}


@pytest.mark.parametrize("direction", ["counterclockwise", "clockwise"])
def test_a_ring_is_open_by_its_thickness_or_refused(direction):
    assert mistakes(base=_with(_ring(1.0001 * T, direction))) == {}
    found = mistakes(base=_with(_ring(0.9 * T, direction)))
    assert list(found) == [KEY]
    assert "overlaps itself" in found[KEY]
    assert "0.0018 m from itself, and is 0.002 m thick" in found[KEY]


def test_a_short_arc_is_no_ring():
    """Its ends are near each other since it is short, not since it comes round."""
    ends = {"start": [0.03, 0.0], "end": [0.0, 0.03]}
    arc = {"kind": "arc", "center": [0.0, 0.0], **ends, "direction": "counterclockwise"}
    assert mistakes(base=_with(arc, thickness=0.2 * 0.03 * np.pi / 2 * 0.99)) == {}


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.lists(st.floats(-40.0, 40.0), min_size=3, max_size=7), st.floats(0.01, 1.0))
def test_no_polynomial_overlaps_itself(coefficients, share):
    """The thickest beam of any polynomial: places nearer than its thickness are neighbours along it."""
    curve = Polynomial(kind="polynomial", axis="x", coefficients=(0.0, *coefficients), range=(-1.0, 1.0))
    L = arc_length(curve)
    thickness = share * min(0.2 * L, 0.999 / max(largest_curvature(curve), 1e-9))
    u = np.linspace(0.0, 1.0, 1500)
    p = points_on(curve, u)
    near = cKDTree(p).query_pairs(thickness, output_type="ndarray")
    assert np.all(L * np.abs(np.diff(u[near], axis=1)) <= 1.1 * thickness)
