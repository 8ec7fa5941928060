"""A cantilever pressed over a sharp tip in a single step: the tip is narrower than the distance of the beam's samples.

Reference: :func:`tests.fea_reference.test_faces.over_a_corner`, an integration of the beam's differential equations.
"""

import numpy as np
import pytest

from cprbm_scene import Ending
from fea_reference import Settings, answer
from tests.fea_reference.on_an_edge import cantilever_over
from tests.fea_reference.test_faces import over_a_corner


def knife(x, y, half, lean, long):
    """A wedge with the tip at (x, y): half the angle ``half``, length ``long``, lean ``lean`` from upright, rad."""
    feet = [(x + long * np.sin(a), y - long * np.cos(a)) for a in (lean - half, lean + half)]
    return {"kind": "beam-line", "points": (feet[0], (x, y), feet[1], feet[0]), "side": "left"}


@pytest.mark.parametrize(("x", "y", "load", "elements"), [(0.5, 0.02, 3.0, 6), (0.6, 0.1, 6.0, 20)])
def test_a_beam_does_not_go_over_a_tip_between_its_samples(x, y, load, elements):
    """Without the test of swept tips, the beam passes through in the first step with a certified force of zero."""
    _, push, tip = over_a_corner(load, x, y)
    scene = cantilever_over({**knife(x, -y, 0.2, 0.2, 0.02), "thick": False}, force=load)
    found = answer(scene, Settings(elements=elements, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    assert values["edge.force"][0] == pytest.approx(push, rel=1e-3)
    assert values["tip.displacement"] == pytest.approx(tip - [1.0, 0.0], abs=3e-4)


@pytest.mark.parametrize(
    ("half", "lean", "long", "elements"), [(0.03, 0.0, 0.02, 10), (0.1, -0.5, 0.1, 40), (0.01, 0.2, 0.02, 10)]
)
def test_a_beam_lies_on_a_tip_however_sharp(half, lean, long, elements):
    """Nearly upright sides overlap, and hold the beam by the cube of the sine of half the angle."""
    _, push, tip = over_a_corner(3.0, 0.5, 0.02)
    scene = cantilever_over({**knife(0.5, -0.02, half, lean, long), "thick": False}, force=3.0)
    found = answer(scene, Settings(elements=elements, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    assert values["edge.force"][0] == pytest.approx(push, rel=1e-3)
    assert values["tip.displacement"] == pytest.approx(tip - [1.0, 0.0], abs=3e-4)
