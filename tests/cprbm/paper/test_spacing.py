"""Elements that are uniform along an axis, beside exact arc lengths."""

from math import asinh, hypot

import numpy as np
import pytest

from cprbm.chain import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import cantilever_data, force

N = 7
BENT = 14.64  # 1/m: x = 0.05 + BENT·y²
PARABOLA = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, 0.0, BENT], "range": [0.0, 0.05]}
RADIUS = 0.025
QUARTER = {
    "kind": "arc",
    "center": [0.0, RADIUS],
    "start": [0.0, 0.0],
    "end": [RADIUS, RADIUS],
    "direction": "counterclockwise",
}
SLOPE = {"kind": "line", "start": [0.0, 0.0], "end": [0.03, -0.04]}


def chain_of(curve, axis, *, corrected=False):
    data = cantilever_data(force(0.0, 1.0), [1.0])
    data["beams"]["beam"] |= {"curve": curve, "paper": {"uniform": axis}}
    data["bodies"]["wall"]["points"]["R"] = curve.get("start", [0.05, 0.0])
    data["bodies"]["tip"]["points"]["T"] = curve.get("end", [0.05 + BENT * 0.05**2, 0.05])
    m = mechanism_of(scene_from(data), {"beam": N}, "bending", corrected=corrected)
    return m.chains["beam"], m.units


def up_to(y):
    """Arc length of the parabola from its vertex: (z √(1 + z²) + arsinh z)/4a with z = 2 a y."""
    z = 2.0 * BENT * y
    return (z * hypot(1.0, z) + asinh(z)) / (4.0 * BENT)


def exact(curve, axis, share):
    """Arc length up to a share of the whole along the axis, m."""
    if curve["kind"] == "polynomial":
        # along x: y = √(share) of the whole
        return up_to(0.05 * (share if axis == "y" else share**0.5))
    if curve["kind"] == "arc":
        return RADIUS * (np.arcsin(share) if axis == "x" else np.arccos(1.0 - share))
    return 0.05 * share


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("curve", [PARABOLA, QUARTER, SLOPE])
def test_borders_and_springs_are_even_along_the_axis(curve, axis):
    chain, units = chain_of(curve, axis)
    places = np.array([exact(curve, axis, i / (2 * N)) for i in range(2 * N + 1)]) / units.length
    # where the curve is level to the axis, a place is known to the root of round-off
    assert chain.borders == pytest.approx(places[::2], abs=1e-12)
    assert chain.arcs[1:-1] == pytest.approx(places[1::2], abs=1e-12)
    # eq. (3): k = EI/Le, over the unit of moment
    assert chain.stiffness == pytest.approx(chain.section.rigidity(np.zeros(1)) / np.diff(places[::2]), rel=1e-9)


def test_springs_lie_at_the_middle_of_the_axis_and_not_of_the_arc():
    chain, units = chain_of(PARABOLA, "y")
    y = chain.nodes[1:-1, 1] * units.length + units.origin[1]
    assert y == pytest.approx(0.05 * (np.arange(N) + 0.5) / N, abs=1e-15)
    middles = 0.5 * (chain.borders[1:] + chain.borders[:-1])
    assert np.max(np.abs(chain.arcs[1:-1] - middles)) > 1e-3 * chain.length / N


def test_the_corrected_chain_takes_no_notice():
    chain, _ = chain_of(PARABOLA, "y", corrected=True)
    assert np.diff(chain.borders) == pytest.approx(np.full(N, chain.length / N), rel=1e-12)
