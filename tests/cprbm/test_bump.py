"""A beam pressed onto a graph with a narrow bump, against the closed form for points."""

import numpy as np
import pytest

from tests.cprbm.test_tiny_bodies import beam_onto, solved
from tests.fea_reference.on_an_edge import T
from tests.references.pressed import Pressed


def bump(place, top, half_width, height, side=1.0):
    """y = top − side·height·((x − place)/half_width)²: what a beam sees of it is its top."""
    u = np.polynomial.Polynomial([-place / half_width, 1.0 / half_width])
    return {
        "kind": "beam-function",
        "axis": "x",
        "coefficients": tuple((top - side * height * u**2).coef.tolist()),
        "range": (place - half_width, place + half_width),
        "side": "above" if side > 0.0 else "below",
    }


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("links", [20, 40, 80])
@pytest.mark.parametrize("shape", [(5e-4, 0.02), (5e-3, 0.1), (0.03, 0.06)])
def test_a_beam_is_pressed_onto_narrow_bumps(shape, links, thick):
    # radii of 6e-6 to 0.0075 under elements of 0.0125 to 0.05, all gone over by the first step if nothing held
    load, places, gaps = Pressed(force=-0.04), np.array([0.411, 0.75]), np.array([0.0004, 0.0035])
    half = 0.5 * T if thick else 0.0
    bumps = {f"c{i}": bump(x, -gap - half, *shape) for i, (x, gap) in enumerate(zip(places, gaps, strict=True))}
    values = solved(beam_onto(bumps, load, thick=thick), links)
    forces, tip = load.onto(places, gaps, np.ones(2))
    assert [values[f"{name}.force"][0] for name in bumps] == pytest.approx(forces, rel=0.02, abs=1e-3)
    assert values["tip.displacement"][1] == pytest.approx(tip, rel=0.02)


@pytest.mark.parametrize("links", [20, 41])
def test_bumps_on_both_sides_hold_a_clamped_beam(links):
    load = Pressed("clamped", force=-2.0, at=0.45)
    places, gaps, sides = np.array([0.3, 0.652]), np.array([0.0006, 0.0011]), np.ones(2)
    bumps = {f"c{i}": bump(x, -gap, 0.004, 0.05) for i, (x, gap) in enumerate(zip(places, gaps, strict=True))}
    bumps["above"] = bump(0.55, 0.003, 0.004, 0.05, side=-1.0)
    values = solved(beam_onto(bumps, load, thick=False), links)
    forces, _ = load.onto(places, gaps, sides)
    assert [values[f"{name}.force"][0] for name in ("c0", "c1", "above")] == pytest.approx([*forces, 0.0], rel=0.03)
