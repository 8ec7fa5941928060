"""Contact rows and Newton's system beside central differences of gaps and of the Lagrangian's gradient."""

import numpy as np
import pytest

from cprbm.kinematics import State
from cprbm.newton import system
from cprbm.point import contact_gradient, contact_rows, point_at

STEP = 1e-6


def check(problem, values, point, random):
    """Along three random motions from a ``point`` at which the rows press."""
    model, closure, state, mu = problem.model, problem.closure, point.state, point.mu
    n, B = model.n_links, 3 * len(model.free_bodies)
    q = np.concatenate((state.theta, state.bodies.ravel()))

    def at(z):
        there = point_at(problem, values, State(z[:n], z[n:].reshape(-1, 3)), mu, point.lam, point.rows)
        assert there.rows.keys == point.rows.keys
        return there.gradient + there.A_E.T @ mu + contact_gradient(model, there), there

    found = system(problem, point, 0.0, 0.0)
    for _ in range(3):
        d = random.standard_normal(len(q))
        d[closure.fixed] = 0.0
        (plus, ahead), (minus, behind) = at(q + STEP * d), at(q - STEP * d)
        gaps = (ahead.rows.values - behind.rows.values) / (2 * STEP)
        assert gaps == pytest.approx(contact_rows(model, point) @ d, rel=1e-6, abs=1e-7)
        product = (plus - minus) / (2 * STEP)
        product[closure.fixed] = 0.0
        low = slice(B, found.n_base - closure.rows)
        border, corner = found.factors.border, found.factors.corner
        s = -np.linalg.solve(corner[low, low], border[:, low].T @ d[:n] + corner[low, :B] @ d[n:])
        upper = found.factors.tridiagonal.times(d[:n, None])[:, 0] + border[:, :B] @ d[n:] + border[:, low] @ s
        lower = border[:, :B].T @ d[:n] + corner[:B, :B] @ d[n:] + corner[:B, low] @ s
        assert np.concatenate((upper, lower)) == pytest.approx(product, rel=1e-5, abs=1e-5 * np.max(np.abs(product)))
