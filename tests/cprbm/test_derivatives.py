"""First and second derivatives against central differences, at states away from any symmetry."""

from functools import partial

import numpy as np
import pytest

from cprbm import Settings, smooth
from cprbm.closure import closure_forces, closure_rows, closure_second, closure_values
from cprbm.energy import spring_moments, strain_energy, strain_gradient, strain_hessian
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium, measure
from cprbm.kinematics import State, positions, pulled_back, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.newton import newton_step, system
from cprbm.point import contact_gradient, contact_rows, point_at
from tests.cprbm.rolled import coil, hooked, nearly_closed, neck, strip
from tests.cprbm.scenes import hinge, hinge_data

STEP = 1e-6


def bows():
    """The hinge with a parabola and a curve of fourth degree in place of its half circles."""
    ends, reach = (0.001, 0.051), np.polynomial.Polynomial([-0.026 / 0.025, 1.0 / 0.025])
    beams = hinge_data()["beams"]
    for name, f in (("beam1", 0.00125 + 0.025 * reach**2), ("beam2", -0.00125 - 0.0175 * reach**2 - 0.0075 * reach**4)):
        coefficients = [float(coefficient) for coefficient in f.coef]
        beams[name]["curve"] = {"kind": "polynomial", "axis": "x", "coefficients": coefficients, "range": list(ends)}
    return hinge(beams=beams)


def bent_hinge(scene):
    """A mechanism close to contact, and a state."""
    mechanism = mechanism_of(scene(), Settings(links={"beam1": 23, "beam2": 29}))
    problem = mechanism.problem
    start = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    return mechanism, equilibrium(problem, {"M": 0.43}, start, 1e-11, 30).point.state


def taper(*values):
    """A thickness that varies, stated at equal steps."""
    return {"at": np.linspace(0.0, 1.0, len(values)).tolist(), "values": list(values)}


@pytest.fixture(
    params=[
        partial(bent_hinge, hinge),
        partial(bent_hinge, bows),
        partial(strip, neck, 0.01),
        partial(strip, neck, 0.01, held="T"),
        partial(strip, coil, 0.005),
        partial(strip, coil, 0.005, held="T"),
        partial(strip, hooked, 0.002),
        partial(strip, neck, taper(0.011, 0.007)),
        partial(strip, coil, taper(0.0025, 0.005), held="T"),
        partial(strip, hooked, taper(0.002, 0.001)),
        partial(strip, coil, taper(0.0025, 0.005, 0.0025)),
        partial(strip, nearly_closed, 0.09),
    ]
)
def bent(request):
    """A mechanism close to contact, bent at random, with multipliers."""
    mechanism, start = request.param()
    problem = mechanism.problem
    model = problem.model
    random = np.random.default_rng(20260)
    theta = start.theta + 0.003 * random.standard_normal(model.n_links)
    state = State(theta, start.bodies + 0.01 * random.standard_normal((1, 3)))
    moved = point_at(problem, {"M": 0.43}, state, random.standard_normal(problem.closure.rows), np.zeros(0), NO_ROWS)
    lam = 0.5 + random.random(moved.rows.size)
    return problem, point_at(problem, {"M": 0.43}, state, moved.mu, lam, moved.rows)


def lagrangian_gradient(problem, point, q):
    n = problem.model.n_links
    state = State(q[:n], q[n:].reshape(-1, 3))
    there = point_at(problem, {"M": 0.43}, state, point.mu, point.lam, point.rows)
    assert there.rows.size == point.rows.size
    return there.gradient + there.A_E.T @ point.mu + contact_gradient(problem.model, there), there


def test_rows_are_derivatives_of_closures_and_gaps(bent):
    problem, point = bent
    q = np.concatenate((point.state.theta, point.state.bodies.ravel()))
    assert point.rows.size >= 1
    random = np.random.default_rng(7)
    for _ in range(5):
        d = random.standard_normal(len(q))
        _, plus = lagrangian_gradient(problem, point, q + STEP * d)
        _, minus = lagrangian_gradient(problem, point, q - STEP * d)
        assert pytest.approx(point.A_E @ d, rel=1e-7, abs=1e-8) == (plus.Z - minus.Z) / (2 * STEP)
        assert (plus.rows.values - minus.rows.values) / (2 * STEP) == pytest.approx(
            contact_rows(problem.model, point) @ d, rel=1e-6, abs=1e-7
        )


def test_rows_of_a_large_model_are_those_of_a_small_one(monkeypatch):
    """Forces on joints are summed along the beams where a table of what hangs on what would be large."""
    mechanism, state = bent_hinge(hinge)
    small = mechanism.problem
    monkeypatch.setattr("cprbm.model.LARGE", 20)
    large = mechanism_of(hinge(), Settings(links={"beam1": 23, "beam2": 29})).problem
    none = np.zeros(small.closure.rows)
    one, other = (point_at(problem, {}, state, none, np.zeros(0), NO_ROWS) for problem in (small, large))
    assert small.model.hanging is not None
    assert large.model.hanging is None
    assert one.rows.size
    lam = 1.0 + np.arange(one.rows.size)
    assert other.rows.sums(lam, large.model) == pytest.approx(one.rows.sums(lam, small.model), rel=1e-12, abs=1e-9)
    assert contact_rows(large.model, other) == pytest.approx(contact_rows(small.model, one), abs=1e-13)


def test_the_newton_system_is_the_derivative_of_the_gradient(bent):
    problem, point = bent
    n = problem.model.n_links
    q = np.concatenate((point.state.theta, point.state.bodies.ravel()))
    found = system(problem, point, 0.0, 0.0)
    random = np.random.default_rng(11)
    for _ in range(5):
        d = random.standard_normal(len(q))
        d[problem.closure.fixed] = 0.0
        plus, _ = lagrangian_gradient(problem, point, q + STEP * d)
        minus, _ = lagrangian_gradient(problem, point, q - STEP * d)
        product = (plus - minus) / (2 * STEP)
        product[problem.closure.fixed] = 0.0
        # K [d; s; 0] = [Hd; 0; A_E d] with s the low-rank unknowns that their own rows ask for; angles of links at
        # free starts stand in the border, behind the bodies
        anchors = found.anchors
        known = np.concatenate((d[n:], d[anchors]))
        inner = d[:n].copy()
        inner[anchors] = 0.0
        r, first = found.n_base - problem.closure.rows - len(known), len(known)
        low = slice(first, first + r)
        border, corner = found.factors.border, found.factors.corner
        s = np.linalg.solve(corner[low, low], -border[:, low].T @ inner - corner[low, :first] @ known)
        upper = found.factors.tridiagonal.times(inner[:, None])[:, 0] + border[:, :first] @ known + border[:, low] @ s
        lower = border[:, :first].T @ inner + corner[:first, :first] @ known + corner[:first, low] @ s
        upper[anchors] = lower[3:]
        assert np.concatenate((upper, lower[:3])) == pytest.approx(
            product, rel=1e-5, abs=1e-5 * np.max(np.abs(product))
        )


def test_energy_and_its_gradient():
    model = mechanism_of(hinge(), Settings(links=9)).problem.model
    state = rest_state(model)
    random = np.random.default_rng(3)
    theta = state.theta + 0.2 * random.standard_normal(model.n_links)
    d = random.standard_normal(model.n_links)
    at = State(theta, state.bodies)
    plus, minus = State(theta + STEP * d, state.bodies), State(theta - STEP * d, state.bodies)
    slope = (strain_energy(model, plus) - strain_energy(model, minus)) / (2 * STEP)
    assert slope == pytest.approx(strain_gradient(spring_moments(model, at)) @ d, rel=1e-8)
    diagonal, off = strain_hessian(model)
    full = np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1)
    assert strain_gradient(spring_moments(model, at)) == pytest.approx(
        full @ (theta - model.rest), abs=1e-12 * diagonal.max()
    )


def test_the_undeformed_state_is_free_of_force():
    problem = mechanism_of(hinge(), Settings(links=17)).problem
    state = rest_state(problem.model)
    at = positions(problem.model, state)
    assert np.max(np.abs(strain_gradient(spring_moments(problem.model, state)))) == 0.0
    assert np.max(np.abs(closure_values(problem.model, problem.closure, state, at, {}))) < 1e-15


def test_turning_a_mechanism_that_nothing_holds_costs_nothing():
    model = mechanism_of(hinge(), Settings(links=17)).problem.model
    state = rest_state(model)
    turned = State(state.theta + 1.234, state.bodies)
    assert strain_energy(model, turned) < 1e-28
    assert np.max(np.abs(strain_gradient(spring_moments(model, turned)))) < 1e-12


@pytest.mark.parametrize("scene", [hinge, bows])
def test_smooth_lines_are_true_at_rest_and_have_consistent_derivatives(scene):
    model = mechanism_of(scene(), Settings(links=11)).problem.model
    chain = model.chains[1]
    state = rest_state(model)
    s = np.linspace(0.0, chain.s[-1], 57)
    line = smooth.smooth_line(chain, model.unit_length, state, positions(model, state)).at(s)
    x, y = chain.line.position(s * model.unit_length)
    assert line.x * model.unit_length == pytest.approx(x, abs=1e-16 + 1e-14 * abs(x).max())
    assert line.y * model.unit_length == pytest.approx(y, abs=1e-16 + 1e-14 * abs(y).max())
    random = np.random.default_rng(5)
    state = State(state.theta + 0.1 * random.standard_normal(model.n_links), state.bodies)
    at = positions(model, state)
    s = np.array([0.013, 0.21, 0.5217, 0.77, 0.993]) * chain.s[-1]
    here = smooth.smooth_line(chain, model.unit_length, state, at).at(s)
    ahead = smooth.smooth_line(chain, model.unit_length, state, at).at(s + STEP)
    behind = smooth.smooth_line(chain, model.unit_length, state, at).at(s - STEP)
    velocity = np.stack((ahead.x - behind.x, ahead.y - behind.y)) / (2 * STEP)
    assert velocity == pytest.approx(here.speed * np.stack((np.cos(here.psi), np.sin(here.psi))), abs=1e-8)
    assert (ahead.psi - behind.psi) / (2 * STEP) == pytest.approx(here.bend, rel=1e-6)


def on_both_sides_of_joints(scene, beam, links, aside):
    """Points of a bent beam's smooth line just before and just behind its inner joints."""
    model = mechanism_of(scene, Settings(links=links)).problem.model
    chain = model.chains[beam]
    state = State(model.rest + 0.8 * np.cos(np.linspace(0.0, 3.0, model.n_links)), np.zeros((1, 3)))
    line = smooth.smooth_line(chain, model.unit_length, state, positions(model, state))
    return line.at(chain.s[1:-1] - aside), line.at(chain.s[1:-1] + aside)


def test_smooth_lines_have_one_tangent_at_every_joint():
    left, right = on_both_sides_of_joints(hinge(), 0, 20, 1e-12)
    assert np.max(np.abs(left.psi - right.psi)) < 1e-10


def test_where_the_rest_curvature_varies_the_kinks_at_the_joints_are_of_fifth_order():
    """And no gap is left: both pieces end at the joint itself."""

    def at_joints(links):
        left, right = on_both_sides_of_joints(bows(), 1, links, 1e-13)
        assert left.x == pytest.approx(right.x, abs=1e-12)
        assert left.y == pytest.approx(right.y, abs=1e-12)
        return np.max(np.abs(left.psi - right.psi))

    coarse, fine = at_joints(20), at_joints(40)
    assert coarse < 1e-4
    assert np.log2(coarse / fine) == pytest.approx(5.0, abs=0.5)


def test_pulled_back_forces_and_their_second_derivatives():
    model = mechanism_of(hinge(), Settings(links=7)).problem.model
    random = np.random.default_rng(13)
    theta = model.rest + 0.3 * random.standard_normal(model.n_links)
    fx, fy = random.standard_normal((2, model.n_joints))
    d = random.standard_normal(model.n_links)

    def work(t):
        at = positions(model, State(t, np.zeros((1, 3))))
        return fx @ at.x + fy @ at.y

    state = State(theta, np.zeros((1, 3)))
    slope, _, second, _ = pulled_back(model, state, positions(model, state), fx, fy)
    assert (work(theta + STEP * d) - work(theta - STEP * d)) / (2 * STEP) == pytest.approx(slope @ d, rel=1e-7)
    curvature = (work(theta + 1e-4 * d) - 2 * work(theta) + work(theta - 1e-4 * d)) / 1e-8
    assert curvature == pytest.approx(second @ (d * d), rel=1e-5)


def test_closure_second_derivatives_over_a_bodys_rotation():
    problem = mechanism_of(hinge(), Settings(links=5)).problem
    model, closure = problem.model, problem.closure
    mu = np.random.default_rng(17).standard_normal(closure.rows)

    def value(phi):
        state = State(model.rest, np.array([[0.1, -0.2, phi]]))
        return closure_values(model, closure, state, positions(model, state), {}) @ mu

    state = State(model.rest, np.array([[0.1, -0.2, 0.4]]))
    second = (value(0.4 + 1e-4) - 2 * value(0.4) + value(0.4 - 1e-4)) / 1e-8
    assert closure_second(model, closure, state, mu)[0] == pytest.approx(second, rel=1e-5)
    fx, _ = closure_forces(model, closure, mu)
    assert np.count_nonzero(fx) == 2
    assert closure_rows(model, closure, state, positions(model, state)).shape == (
        closure.rows,
        model.n_links + 3,
    )


def test_newton_is_quadratic_at_the_hinge():
    mechanism = mechanism_of(hinge(), Settings(links=40))
    problem = mechanism.problem
    point = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    point = point_at(problem, {"M": 0.67}, point.state, point.mu, point.lam, point.rows)
    residuals = []
    for _ in range(6):
        change, mu, lam = newton_step(problem, point)
        point = point_at(problem, {"M": 0.67}, point.state.moved(change, problem.model.n_links), mu, lam, point.rows)
        residuals.append(measure(problem, point).residual)
    assert residuals[-1] < 1e-13
    assert residuals[3] < 10.0 * residuals[2] ** 1.7
