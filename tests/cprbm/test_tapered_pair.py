"""Two beams whose thickness varies, touching by their edges."""

import numpy as np
import pytest

import cprbm
from cprbm.contact import NO_ROWS, Rows
from cprbm.equilibrium import contact_gradient, contact_rows, equilibrium, point_at, system
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from scene.statement import Profile
from tests.cprbm.test_lying import bowl

STEP = 1e-6
EVEN = (1.0,)
THINNER, THICKER = (1.0, 0.4), (0.6, 1.0)
RIDGED = (0.6, 0.6, 1.0, 0.7, 0.7)  # with a corner that stands out at half of the length


def tapered(scene, **parts):
    """The scene with thicknesses that vary, stated at equal steps in parts of the even one."""
    beams = dict(scene.beams)
    for name, values in parts.items():
        if len(values) > 1:
            at = tuple(np.linspace(0.0, 1.0, len(values)).tolist())
            profile = Profile(at=at, values=tuple(beams[name].thickness * value for value in values))
            beams[name] = beams[name].model_copy(update={"thickness": profile})
    return scene.model_copy(update={"beams": beams})


def loaded(scene, load, links):
    mechanism = mechanism_of(scene, cprbm.Settings(links=links))
    problem = mechanism.problem
    start = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    for part in (0.25, 0.5, 0.75, 1.0):
        found = equilibrium(problem, {"P": part * load}, start, 1e-11, 60)
        assert found.converged
        start = found.point
    return mechanism, start


@pytest.mark.parametrize("load", [12.0, 60.0], ids=["point", "length"])
@pytest.mark.parametrize(
    ("A", "B"),
    [(THINNER, EVEN), (EVEN, THICKER), (THINNER, THICKER), (RIDGED, THICKER), (THINNER, RIDGED)],
)
@pytest.mark.parametrize("links", [{"A": 23, "B": 31}, {"A": 31, "B": 23}], ids=["rows on A", "rows on B"])
def test_derivatives_of_gaps_and_of_the_lagrangian(load, A, B, links):
    mechanism, start = loaded(tapered(bowl(load), A=A, B=B), load, links)
    problem, values = mechanism.problem, {"P": load}
    model, closure = problem.model, problem.closure
    n, bodies = model.n_links, 3 * len(model.free_bodies)
    random = np.random.default_rng(99)
    state = State(start.state.theta + 1e-3 * random.standard_normal(n), start.state.bodies)
    mu = random.standard_normal(closure.rows)
    moved = point_at(problem, values, state, mu, np.zeros(0), NO_ROWS)
    assert moved.rows.size > 0
    point = point_at(problem, values, state, mu, 0.5 + random.random(moved.rows.size), moved.rows)
    print(point.rows.keys)
    q = np.concatenate((state.theta, state.bodies.ravel()))

    def at(z):
        there = point_at(problem, values, State(z[:n], z[n:].reshape(-1, 3)), mu, point.lam, point.rows)
        assert there.rows.keys == point.rows.keys
        return there.gradient + there.A_E.T @ mu + contact_gradient(model, there), there

    found = system(problem, point, np.zeros(point.rows.size), 0.0)
    for _ in range(3):
        d = random.standard_normal(len(q))
        d[closure.fixed] = 0.0
        (plus, ahead), (minus, behind) = at(q + STEP * d), at(q - STEP * d)
        gaps = (ahead.rows.values - behind.rows.values) / (2 * STEP)
        assert gaps == pytest.approx(contact_rows(model, point) @ d, rel=1e-6, abs=1e-7)
        product = (plus - minus) / (2 * STEP)
        product[closure.fixed] = 0.0
        low = slice(bodies, len(found.base) - closure.rows)
        border, corner = found.factors.border, found.factors.corner
        s = -np.linalg.solve(corner[low, low], border[:, low].T @ d[:n] + corner[low, :bodies] @ d[n:])
        upper = found.factors.tridiagonal.times(d[:n, None])[:, 0] + border[:, :bodies] @ d[n:] + border[:, low] @ s
        lower = border[:, :bodies].T @ d[:n] + corner[:bodies, :bodies] @ d[n:] + corner[:bodies, low] @ s
        assert np.concatenate((upper, lower)) == pytest.approx(product, rel=1e-5, abs=1e-5 * np.max(np.abs(product)))
