"""A tapered beam that touches a circle or a beam by its edge, in both solvers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import cprbm
import fea_reference
from cprbm_scene import Scene, SceneError, scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH, cantilever_data, force

SLOPE = -0.6 * THICKNESS / LENGTH  # of a thickness that falls to two fifths of what it is at the clamp


def scene_of(load: float, center: tuple[float, float], radius: float, **sizes) -> Scene:
    """A cantilever pressed down at its tip, with a circle below it."""
    data = cantilever_data(force(0.0, -1.0), [load])
    data["beams"]["beam"] |= {"thickness": {"at": [0.0, 1.0], "values": [THICKNESS, 0.4 * THICKNESS]}} | sizes
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": list(center), "radius": radius}
    data["contacts"] = {"circle": circle}
    data["probes"] += [{"of": "circle", "quantity": quantity} for quantity in ("force", "centre", "ends")]
    return scene_from(data)


def by_cprbm(scene: Scene, n: int = 160):
    answer = cprbm.answer(scene, cprbm.Settings(links=n))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


def by_fea(scene: Scene, n: int = 160):
    answer = fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending", penetration=1e-5))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


def resting(share: float, radius: float) -> tuple[tuple[float, float], float]:
    """Centre of a circle that the edge of the straight beam just touches, and at which arc length.

    The edge goes up along the beam by the angle whose sine is SLOPE/2: the normal leans back by it.
    """
    at = share * LENGTH
    rho = radius + 0.5 * (THICKNESS + SLOPE * at)
    return (at - 0.5 * SLOPE * rho, -rho * np.sqrt(1.0 - 0.25 * SLOPE**2)), at


@pytest.mark.parametrize("solver", [by_cprbm, by_fea])
def test_a_pin_below_the_beam(solver):
    # reference: two flexibilities by quadrature of (a − s)(b − s)/EI(s); the pin yields nothing, so it carries
    # F f(a, L)/f(a, a). It touches where the normal of the edge, and not of the neutral line, goes through it
    center, a = resting(0.43, 0.0041)
    load = 1e-4 * RIGIDITY / LENGTH**2

    def flexibility(b: float) -> float:
        return quad(lambda s: (a - s) * (b - s) / (RIGIDITY * (1.0 - 0.6 * s / LENGTH) ** 3), 0.0, a, epsrel=1e-12)[0]

    values = solver(scene_of(load, center, 0.0041))
    assert values["circle.force"][0] == pytest.approx(load * flexibility(LENGTH) / flexibility(a), rel=1e-3)
    assert values["circle.centre"][0] == pytest.approx(a, abs=3e-5 * LENGTH)
    # without the lean of the edge it were at the centre's own place
    assert abs(center[0] - a) > 2e-4 * LENGTH
    # the pin presses along the edge's normal, so that the clamp is pulled along the beam
    lean = values["circle.force"][0] * -0.5 * SLOPE
    assert values["R.reaction"][0] == pytest.approx(lean, rel=0.01)


@pytest.mark.parametrize("load", [1e-3, 0.5])
@pytest.mark.parametrize("solver", [by_cprbm, by_fea])
def test_a_clamped_end_that_just_touches_is_open(solver, load):
    # reference: a beam that does not reach the circle is a cantilever. What the clamp's own gap is rounded to, and the
    # slope of the edge against the circle, is no contact
    radius = 1.2 * LENGTH
    center, _ = resting(0.0, radius)
    values = solver(scene_of(load * RIGIDITY / LENGTH**2, center, radius), 40)
    assert values["circle.force"][0] == 0.0
    assert values["circle.ends"].size == values["circle.centre"].size == 0


@pytest.mark.parametrize("solver", [by_cprbm, by_fea])
def test_a_corner_of_the_edge_stands_on_the_circle(solver):
    # reference: the flexibilities as above of a beam that is thickest in its middle, which touches there by its corner
    knot = 0.5137
    sizes = {"at": [0.0, knot, 1.0], "values": [0.5 * THICKNESS, THICKNESS, 0.5 * THICKNESS]}
    center = (knot * LENGTH, -(0.0041 + 0.5 * THICKNESS))
    load = 1e-4 * RIGIDITY / LENGTH**2
    a = knot * LENGTH

    def flexibility(b: float) -> float:
        def rate(s: float) -> float:
            t = np.interp(s / LENGTH, sizes["at"], sizes["values"])
            return (a - s) * (b - s) * 12.0 / (MODULUS * WIDTH * t**3)

        return quad(rate, 0.0, a, epsrel=1e-12)[0]

    values = solver(scene_of(load, center, 0.0041, thickness=sizes))
    assert values["circle.force"][0] == pytest.approx(load * flexibility(LENGTH) / flexibility(a), rel=1e-3)
    assert values["circle.centre"][0] == pytest.approx(a, abs=1e-6 * LENGTH)


@pytest.mark.parametrize("n", [20, 41])
@pytest.mark.parametrize("between", [["beam", "lower"], ["lower", "beam"]])
def test_a_beam_lies_on_a_corner_of_another_beam(between, n):
    # reference: flexibilities as above of both beams: F = P f(a, L)/(f(a, a) + f'(a, a))
    knot, load = 0.5137, 1e-4 * RIGIDITY / LENGTH**2
    a = knot * LENGTH
    sizes = {"at": [0.0, knot, 1.0], "values": [0.5 * THICKNESS, THICKNESS, 0.5 * THICKNESS]}

    def rate(s: float) -> float:
        t = np.interp(s / LENGTH, sizes["at"], sizes["values"])
        return (a - s) ** 2 * 12.0 / (MODULUS * WIDTH * t**3)

    data = cantilever_data(force(0.0, -1.0), [load])
    data["bodies"]["wall"]["points"]["Q"] = [0.0, -THICKNESS]
    data["beams"]["lower"] = data["beams"]["beam"] | {
        "curve": {"kind": "line", "start": [0.0, -THICKNESS], "end": [LENGTH, -THICKNESS]},
        "thickness": sizes,
        "start": {"joint": "weld", "point": "Q"},
        "end": {"joint": "free"},
    }
    data["contacts"] = {"c": {"kind": "beam-beam", "between": between}}
    data["probes"] += [{"of": "c", "quantity": "force"}]
    own, other = a**3 / (3.0 * RIGIDITY), quad(rate, 0.0, a, epsrel=1e-12)[0]
    expected = load * a**2 * (3.0 * LENGTH - a) / (6.0 * RIGIDITY) / (own + other)
    assert by_cprbm(scene_from(data), n)["c.force"][0] == pytest.approx(expected, rel=1e-4)


def test_a_circle_that_overlaps_the_beam_where_it_is_thick_is_named():
    center, _ = resting(0.3, 0.0041)
    touching = scene_of(1.0, center, 0.0041)
    assert touching.beams["beam"].tapered
    with pytest.raises(SceneError, match="overlaps the circle"):
        scene_of(1.0, (center[0], center[1] + 1e-5 * THICKNESS), 0.0041)
