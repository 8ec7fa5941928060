"""The paper's fitted boundary: slopes and second derivatives over places and angles against differences."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from tests.cprbm.scenes import hinge

STEP = 2.3e-5
DIFFERENCE = {-3: -1 / 60, -2: 3 / 20, -1: -3 / 4, 1: 3 / 4, 2: -3 / 20, 3: 1 / 60}  # its error is of sixth order
WITHIN = 1e-9  # finer than single precision


@pytest.fixture(scope="module", params=["as it is", "mirrored at the diagonal"])
def boundary_and_numbers(request):
    """The boundary and its local numbers (x of joints, y of joints, θ of links), none of them at rest."""
    # more points than coefficients: where the fit goes through all of them, much of the second derivative cancels
    mechanism = mechanism_of(hinge(), cprbm.Settings(links=71, formulation="paper"))
    boundary, model = mechanism.boundaries["contact"], mechanism.problem.model
    state, random = rest_state(model), np.random.default_rng(19)
    at = positions(model, state)
    joints = np.concatenate((boundary.joints, boundary.points))
    x, y = at.x[joints], at.y[joints]
    x, y = (each + 0.003 * random.standard_normal(len(joints)) for each in (x, y))
    theta = state.theta[boundary.links] + 0.07 * random.standard_normal(len(boundary.links))
    if request.param != "as it is":
        # what was to the left is to the right
        boundary = replace(boundary, along_x=not boundary.along_x, side=-boundary.side)
        x, y, theta = y, x, 0.5 * np.pi - theta
    return boundary, np.concatenate((x, y, theta)), state, at


def group_at(boundary, z, state, at):
    k = len(boundary.joints) + len(boundary.points)
    joints = np.concatenate((boundary.joints, boundary.points))
    x, y, theta = at.x.copy(), at.y.copy(), state.theta.copy()
    x[joints], y[joints], theta[boundary.links] = z[:k], z[k : 2 * k], z[2 * k :]
    (group,) = boundary.groups(State(theta, state.bodies), replace(at, x=x, y=y))
    return group


def test_slopes_and_second_derivatives(boundary_and_numbers):
    boundary, z, *rest = boundary_and_numbers
    here, random = group_at(boundary, z, *rest), np.random.default_rng(29)
    lam = 0.3 + random.random(len(here.values))
    lam[1] = 0.0  # does not press
    (second,) = here.factors(lam).blocks().matrices
    pressing = np.flatnonzero(lam)
    m, n = len(boundary.joints), len(boundary.points)
    joints = np.concatenate((pressing, m + np.arange(n)))
    mine = np.concatenate((joints, m + n + joints, 2 * (m + n) + np.arange(len(boundary.links))))
    for _ in range(5):
        d = random.standard_normal(len(z))
        along = {k: group_at(boundary, z + k * STEP * d, *rest) for k in DIFFERENCE}
        change = sum(w * along[k].values for k, w in DIFFERENCE.items()) / STEP
        assert here.slopes @ d == pytest.approx(change, abs=WITHIN * np.max(np.abs(change)))
        bend = sum(w * (lam @ along[k].slopes) for k, w in DIFFERENCE.items()) / STEP
        product = np.zeros(len(z))
        product[mine] = second @ d[mine]
        assert product == pytest.approx(bend, abs=WITHIN * np.max(np.abs(bend)))
