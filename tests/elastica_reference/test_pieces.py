"""Pieces of beams, neutral lines and the equations' derivative, each beside a method of another kind."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from cprbm_scene import Arc, Line, Polynomial, Spline, scene_from
from elastica_reference import Settings
from elastica_reference.curves import neutral_line
from elastica_reference.march import _advance  # the march itself, stopped at a station
from elastica_reference.model import model_of
from elastica_reference.newton import linearised
from elastica_reference.spectral import Law, UnsolvableError, piece, rule
from elastica_reference.way import Stepping
from tests.elastica_reference import scenes
from tests.references.hinge import PAPER
from tests.references.integrated import end_of

number = st.floats(-1.0, 1.0)


def law_of(a, b, c):
    """A curvature and a compliance that vary smoothly, with their derivatives."""
    return Law(
        lambda s: 2.0 * a + b * np.sin(3.0 * s),
        lambda s: 3.0 * b * np.cos(3.0 * s),
        lambda s: 1.5 + c * np.cos(2.0 * s),
        lambda s: -2.0 * c * np.sin(2.0 * s),
    )


def integrated(law, q):
    """The same end by an explicit Runge-Kutta method of order eight."""

    def slope(s, e):
        kappa, c = law.curvature(np.array(s)), law.compliance(np.array(s))
        F = q[4:6] - q[8:] * (s - q[6])
        return [np.cos(e[2]), np.sin(e[2]), kappa + c * e[3], F[0] * np.sin(e[2]) - F[1] * np.cos(e[2])]

    return end_of(slope, q[6:8], q[:4], rtol=1e-13, atol=1e-14)


def solved(law, q, nodes=24):
    return piece(
        law, q, q[2] + (law.curvature(q[6:7]) + law.compliance(q[6:7]) * q[3]) * (q[7] - q[6]) * rule(nodes).points
    )


@seed(5)
@settings(max_examples=12, deadline=None)
@given(st.tuples(*[number] * 3), st.tuples(*[number] * 8), st.floats(0.0, 0.4), st.floats(0.5, 1.0))
def test_a_piece_ends_where_integration_does(shape, state, begin, end):
    law, q = law_of(*shape), np.array([*state[:4], *(3.0 * np.array(state[4:6])), begin, end, *state[6:]])
    assert solved(law, q).end == pytest.approx(integrated(law, q), abs=1e-11)


@seed(7)
@settings(max_examples=12, deadline=None)
@given(st.tuples(*[number] * 3), st.tuples(*[number] * 8), st.floats(0.0, 0.4), st.floats(0.5, 1.0))
def test_the_slopes_of_a_piece_are_those_of_its_end(shape, state, begin, end):
    # reference: central differences of the end with respect to all ten, the two arc lengths among them
    law, q = law_of(*shape), np.array([*state[:4], *(3.0 * np.array(state[4:6])), begin, end, *state[6:]])
    step = 1e-5
    differences = [(solved(law, q + d).end - solved(law, q - d).end) / (2.0 * step) for d in step * np.eye(10)]
    assert solved(law, q).slopes == pytest.approx(np.stack(differences, axis=1), abs=2e-8)


def test_a_piece_is_right_to_twice_its_points():
    # reference: superconvergence of Gauss's collocation (Hairer, Nørsett and Wanner, II.7), order 2p
    law, q = law_of(0.3, 0.8, 0.4), np.array([0.1, -0.2, 0.4, 0.7, 1.2, -2.0, 0.1, 0.0, 0.0, 0.0])
    for p, lengths in ((2, (0.1, 0.05)), (3, (0.2, 0.1))):
        errors = []
        for length in lengths:
            q[7] = q[6] + length
            errors.append(np.max(np.abs(solved(law, q, p).end - solved(law, q, 24).end)))
        # the local error, one order more
        assert np.log2(errors[-2] / errors[-1]) == pytest.approx(2 * p + 1, abs=0.2)


def test_what_cannot_be_integrated_says_so():
    with pytest.raises(UnsolvableError):
        solved(law_of(0.0, 0.0, 0.0), np.array([0.0, 0.0, 0.0, np.nan, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
    with pytest.raises(UnsolvableError):
        solved(law_of(0.0, 0.0, 0.0), np.array([0.0, 0.0, 0.0, 1.0, 1e9, 3e8, 0.0, 1.0, 0.0, 0.0]))


CURVES = {
    "line": Line(kind="line", start=(0.01, 0.02), end=(-0.05, 0.06)),
    "arc": Arc(kind="arc", center=(0.0, 0.0), start=(0.03, 0.04), end=(-0.05, 0.0), direction="counterclockwise"),
    "clockwise": Arc(kind="arc", center=(0.0, 0.0), start=(0.03, 0.04), end=(-0.05, 0.0), direction="clockwise"),
    **{
        f"{axis}{way}": Polynomial(
            kind="polynomial", axis=axis, coefficients=(0.01, 0.3, 5.0, -80.0, 900.0), range=span
        )
        for axis in "xy"
        for way, span in (("+", (-0.01, 0.06)), ("-", (0.06, -0.01)))
    },
    "spline": Spline(
        kind="spline", points=((0.0, 0.0), (0.02, 0.011), (0.05, 0.01), (0.06, -0.01)), end_direction=(-1.0, -3.0)
    ),
}


@pytest.mark.parametrize("name", CURVES)
def test_a_neutral_line_is_one(name):
    # reference: differences of places and angles along it, and the curve's own ends
    curve, unit = CURVES[name], 0.05
    of = neutral_line(curve, unit)
    s, h = np.linspace(0.1, 0.9, 7) * of.length, 1e-4
    assert of.place(np.array([0.0, of.length])).T * unit == pytest.approx(np.array([curve.start, curve.end]), abs=1e-15)

    def derivative(f):
        return (8.0 * (f(s + h) - f(s - h)) - f(s + 2 * h) + f(s - 2 * h)) / (12.0 * h)

    tangent = np.stack([np.cos(of.angle(s)), np.sin(of.angle(s))])
    assert derivative(of.place) == pytest.approx(tangent, abs=1e-10)
    assert derivative(of.angle) == pytest.approx(of.curvature(s), abs=1e-9)
    assert derivative(of.curvature) == pytest.approx(of.curvature_slope(s), abs=1e-7)
    assert derivative(of.curvature_slope) == pytest.approx(of.curvature_second(s), abs=1e-6)


@pytest.mark.parametrize("name", [name for name in CURVES if name[0] in "xy"])
def test_arc_length_is_the_integral_of_the_speed(name):
    curve = CURVES[name]
    f = np.polynomial.Polynomial(curve.coefficients)
    length = abs(quad(lambda v: np.hypot(1.0, f.deriv()(v)), *curve.range, epsabs=0.0, epsrel=1e-13)[0])
    assert neutral_line(curve, 1.0).length == pytest.approx(length, rel=1e-13)


def states():
    """States with a place of contact, a wrap, a slide, an arc and a polynomial in them, off their equilibria."""
    for data, station in ((scenes.case("gripper"), 4), (scenes.hinge(PAPER, [0.5]), 0), (scenes.case("wrapped"), 2)):
        scene = scene_from(data)
        way = Stepping(model_of(scene), Settings(nodes=16))
        stage = scene.stages[0]
        way.begin(stage)
        for value in stage.stations[: station + 1]:
            _advance(way, value / way.unit, 0.0)
        assert way.state.equations.structure.touches
        yield way.state


def test_the_derivative_of_the_equations():
    # reference: central differences of the rows
    random = np.random.default_rng(11)
    for state in states():
        z = state.z + 1e-3 * random.standard_normal(len(state.z))
        equations = state.equations
        _, _, J = linearised(equations, z, state.lam, state)

        def angles(beam, s, state=state):
            return state.along(beam, s)[2]

        step = 1e-6

        def rows(z, equations=equations, lam=state.lam, angles=angles):
            return np.concatenate(equations(z[:, None], np.array([lam]), angles).rows)

        differences = [(rows(z + d) - rows(z - d)) / (2.0 * step) for d in step * np.eye(len(z))]
        assert pytest.approx(np.stack(differences, axis=1), abs=1e-6 * np.max(np.abs(J))) == J
