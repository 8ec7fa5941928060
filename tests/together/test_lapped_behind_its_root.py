"""A strip that comes to lie across the clamped end that it began with, from behind it: each solver for itself.

What lies there has no closest point on the strip but its end, about which the strip is a circle.
"""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import cprbm
import fea_reference
from cprbm_scene import Ending
from tests.fea_reference.hooked import hook

EVEN, TAPERED = (0.0011, 0.0011), (0.0009, 0.0012)


def whole(answer):
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations[-1]


def apart(scene, station, *, backwards):
    """The least distance of the clamped end from the other half of the strip, over half of the thickness of either."""
    shape, strip = station.shapes["strip"], scene.beams["strip"]
    root = 1.0 if backwards else 0.0
    u = np.linspace(0.0, 0.5, 40_001) if backwards else np.linspace(0.5, 1.0, 40_001)
    x, y = (CubicSpline(shape.s, one)(u * shape.s[-1]) - one[-1 if backwards else 0] for one in (shape.x, shape.y))
    distance = np.hypot(x, y)
    nearest = u[np.argmin(distance)]
    return float(distance.min()) / (0.5 * float(strip.thickness_at(np.array([root, nearest])).sum()))


@pytest.mark.parametrize(
    ("lean", "thickness", "backwards"), [(-47.0, EVEN, False), (27.0, TAPERED, False), (27.0, TAPERED, True)]
)
def test_it_lies_half_the_thicknesses_from_the_end(lean, thickness, backwards):
    scene = hook(np.radians(lean), thickness, [0.0091], backwards=backwards)
    found = whole(fea_reference.answer(scene, fea_reference.Settings(elements=29, kinematics="bending")))
    # geometry: the penetration asked is 1e-4 of the thickness
    assert apart(scene, found, backwards=backwards) == pytest.approx(1.0, abs=3e-4)
    # the other solver, whose error goes with N^-2
    expected = whole(cprbm.answer(scene, cprbm.Settings(links=59)))
    assert expected.values["itself.force"] > 0.1
    assert found.values["itself.force"] == pytest.approx(expected.values["itself.force"], rel=5e-3)
    far = np.hypot(*(found.values["T.displacement"] - expected.values["T.displacement"]))
    assert far < 3e-3 * np.hypot(*expected.values["T.displacement"])
    assert found.values["scene.potential_energy"] == pytest.approx(expected.values["scene.potential_energy"], rel=1e-3)
