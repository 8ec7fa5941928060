"""Two cantilevers from either side whose free ends press each other's sides at once, at an angle of half a radian.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
c       the middle: a half turn about it takes either beam to the other
s_Q, n  where the other's end presses a beam, from the root, and the normal there
F       the force of either end
M       bending moment; θ tangent angle, κ⁰ curvature of the drawn line
======  =====================================================================================

Either beam is pressed by F n at s_Q, by the other's end, and by what a half turn makes of the force on the other there,
which is F n again, at its own end.  Hence the elastica

    θ' = κ⁰ + M/EI,     M' = −t × n k F,     k = 2 before s_Q and 1 behind it,     M(L) = 0,

with x(L) = 2 c − x(s_Q) + T n.  This is integrated here by SciPy, and solved for M(0), F, s_Q and the angle of n.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from

SPAN, REACH, RISE, BEND = 0.15, 0.1, 0.6, 6.0  # the upper is y = RISE x − BEND x² from 0 to REACH
START, LIFT = 0.0128, 0.006
THICKNESS, WIDTH, E = 0.001, 0.01, 2.0e11
EI = E * WIDTH * THICKNESS**3 / 12.0


def ends_of_both(first="upper", second="lower"):
    """The lower is the upper turned about (SPAN, START)/2, and its root goes up."""
    upper = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, RISE, -BEND], "range": [0.0, REACH]}
    turned = [START - RISE * SPAN + BEND * SPAN**2, RISE - 2.0 * BEND * SPAN, BEND]
    lower = {**upper, "coefficients": turned, "range": [SPAN, SPAN - REACH]}
    beam = {"thickness": THICKNESS, "width": WIDTH, "material": "steel", "end": {"joint": "free"}}
    return scene_from(
        {
            "name": "ends-of-both",
            "materials": {"steel": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "slide": {"motion": "slides", "along": [0.0, 1.0], "points": {"S": [SPAN, START]}},
            },
            "beams": {
                "upper": {**beam, "curve": upper, "start": {"joint": "weld", "point": "R"}},
                "lower": {**beam, "curve": lower, "start": {"joint": "weld", "point": "S"}},
            },
            "drives": {"lift": {"kind": "displacement", "point": "S", "direction": [0.0, 1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": [first, second]}},
            "stages": [{"name": "lifting", "steps": "lift", "stations": [LIFT]}],
            "probes": [
                {"of": "touch", "quantity": "force"},
                {"of": "touch", "quantity": "centre"},
                {"of": "S", "quantity": "reaction"},
            ],
        }
    )


@pytest.fixture(scope="module")
def elastica():
    """F, s_Q, the length L, and the angle between a beam's end and the other's side."""
    slope_at = RISE - 2.0 * BEND * REACH

    def length_to(slope):
        return (slope * np.hypot(1.0, slope) + np.arcsinh(slope)) / 2.0

    length = (length_to(RISE) - length_to(slope_at)) / (2.0 * BEND)
    middle = 0.5 * np.array([SPAN, START + LIFT])

    def shot(unknowns):
        moment, force, place, angle = unknowns[0], unknowns[1], unknowns[2] * length, unknowns[3]
        n = np.array([-np.sin(angle), np.cos(angle)])

        def rates(_s, state, times):
            theta, M, drawn = state[2], state[3], state[4]  # drawn: tan of the drawn line's angle
            curvature = -2.0 * BEND / (1.0 + drawn**2) ** 1.5
            turning = np.cos(theta) * n[1] - np.sin(theta) * n[0]
            return [
                np.cos(theta),
                np.sin(theta),
                curvature + M / EI,
                -times * force * turning,
                -2.0 * BEND / np.hypot(1.0, drawn),
            ]

        start = [0.0, 0.0, np.arctan(RISE), moment, RISE]
        exactly = {"rtol": 1e-11, "atol": 1e-14, "method": "DOP853"}
        there = solve_ivp(rates, (0.0, place), start, args=(2.0,), **exactly).y[:, -1]
        end = solve_ivp(rates, (place, length), there, args=(1.0,), **exactly).y[:, -1]
        off = end[:2] - (2.0 * middle - there[:2] + THICKNESS * n)
        return [*(off / REACH), there[2] - angle, end[3] * REACH / EI], end[2] - there[2]

    found = root(lambda unknowns: shot(unknowns)[0], [0.1, 1.0, 0.55, 0.0], tol=1e-13)
    assert np.abs(shot(found.x)[0]).max() < 1e-10
    return found.x[1], found.x[2] * length, length, shot(found.x)[1]


def test_the_ends_press_at_an_angle(elastica):
    assert abs(elastica[3]) > 0.4


@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
@pytest.mark.parametrize("elements", [20, 40])
def test_finite_elements_see_the_ends_of_both(elastica, elements, order):
    """With a penalty that leaves next to nothing of the overlap."""
    settings = fea_reference.Settings(elements=elements, kinematics="bending", penetration=1e-7)
    compared(fea_reference.answer(ends_of_both(*order), settings), elastica, 1e-6)


def test_the_chain_sees_the_ends_of_both(elastica):
    """Its error goes with the square of the links."""
    for links, allowed in ((80, 2e-4), (160, 5e-5)):
        compared(cprbm.answer(ends_of_both(), cprbm.Settings(links=links)), elastica, allowed)


def compared(got, elastica, allowed):
    """Forces of both ends together, and the place half-way between them on either beam."""
    force, place, length, _ = elastica
    assert got.ending is Ending.COMPLETED, got.sentence
    values = {name.split(".")[1]: value for name, value in got.stations[-1].values.items()}
    assert values["force"][0] == pytest.approx(2.0 * force, rel=allowed)
    assert values["centre"][0] == pytest.approx(0.5 * (place + length), rel=allowed)
