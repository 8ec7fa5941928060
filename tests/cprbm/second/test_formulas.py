"""Formulas of chain and rows: the gradient against differences of the Lagrangian, elimination and inertia against
dense matrices, the neutral line against its definition."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from cprbm.chain import row_values
from cprbm.chain.spline import polygon_line, spline_line
from cprbm.equilibrium.factors import Springs, factorise
from tests.cprbm.second.systems import dense_hessian, disturbed, gradient, loop

VARIANTS = [("bending", True), ("stretch", True), ("shear", True), ("bending", False), ("shear", False)]


def lagrangian(system, state):
    """The Lagrangian of the module docstring of ``cprbm.chain.kernel``, term by term."""
    z, links, joints = state.z, system.links, system.joints
    p = z[links.first[:, None] + [0, 1]]
    behind = z[links.first[:, None] + [5, 6]]
    n, theta = z[links.first[:, None] + [2, 3]], z[links.first + 4]
    e = np.column_stack([np.cos(theta), np.sin(theta)])
    left = np.column_stack([-np.sin(theta), np.cos(theta)])
    N, Q = (n * e).sum(axis=1), (n * left).sum(axis=1)
    L, r = links.length, 1.0 - (links.shear - links.stretch) * N
    strained = links.stretch * N**2 + links.shear * Q**2 + links.lean * (Q * r) ** 2
    total = ((n * (behind - p)).sum(axis=1) - L * N - 0.5 * L * strained).sum()
    j, i = joints.before, joints.before + 1
    d = theta[i] - theta[j] - joints.rest
    D = d + 0.5 * joints.skew * (Q[j] + Q[i])
    grown = d * (d + 2.0 * joints.bend) / 12.0 * (joints.growth_before * (N * r)[j] + joints.growth_behind * (N * r)[i])
    total += (0.5 * joints.stiffness * D**2 - grown).sum()
    for link, sense, weight in ((j, 1.0, joints.half_before), (i, -1.0, joints.half_behind)):
        angle = theta[link] + 0.25 * sense * d
        hat = n[link, 1] * np.cos(angle) - n[link, 0] * np.sin(angle)
        total -= (0.5 * weight * hat**2).sum()
    return total + state.multipliers(system) @ row_values(z, system.rows)


@pytest.mark.parametrize(("theory", "corrected"), VARIANTS)
def test_the_gradient_is_that_of_the_lagrangian(theory, corrected):
    # reference: central differences of the Lagrangian as the docstring states it, error 1e-10 of its third derivative
    system, _ = loop(theory, 5, corrected=corrected)
    state = disturbed(system, 3, 0.2)
    found, step = gradient(system, state), 1e-5
    for i in range(system.rows.first):
        sides = [lagrangian(system, replace(state, z=state.z + s * step * np.eye(system.size)[i])) for s in (1.0, -1.0)]
        assert found[i] == pytest.approx((sides[0] - sides[1]) / (2.0 * step), abs=2e-8), i


@pytest.mark.parametrize(("theory", "corrected"), VARIANTS)
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_elimination_gives_solution_and_inertia_of_the_dense_matrix(theory, corrected, seed):
    # reference: the dense Hessian by differences of the gradient, with eigenvalues and solution
    system, _ = loop(theory, 6, corrected=corrected)
    state = disturbed(system, seed, 0.1 * seed)
    matrix = dense_hessian(system, state)
    factors, _ = factorise(system, state)
    load = np.random.default_rng(7).normal(size=system.size)
    load[system.rows.first :][~state.driven] = 0.0
    assert matrix @ factors.solve_both(load, np.zeros(0))[0] == pytest.approx(load, abs=1e-4)
    equalities = 2 * len(system.metric) + int(state.driven.sum())
    assert factors.lost == int((np.linalg.eigvalsh(matrix) < 0.0).sum()) - equalities


def test_random_states_of_the_inertia_test_lose_directions():
    # the test above is worth something if some states are no minima
    system, _ = loop("shear", 6)
    lost = {factorise(system, disturbed(system, seed, 0.1 * seed))[0].lost for seed in (1, 2, 3, 4)}
    assert len(lost) > 2


def test_springs_add_their_stiffness_to_the_angles():
    system, _ = loop("shear", 5)
    state = disturbed(system, 2, 0.1)
    anchor = state.z[system.angles] - 0.01
    _, without = factorise(system, state)
    _, with_springs = factorise(system, state, Springs(3.0, anchor))
    assert (with_springs - without)[system.angles] == pytest.approx(0.03 * system.metric)


def test_the_spline_meets_an_arc_to_fourth_order_between_the_joints():
    # reference: nodes of a chain whose elements have constant curvature lie on the tangents at their borders
    errors = []
    for count in (10, 20, 40):
        h = 1.0 / count
        arcs = np.concatenate([[0.0], (np.arange(count) + 0.5) * h, [1.0]])
        radius = np.concatenate([[1.0], np.full(count, 1.0 / np.cos(0.5 * h)), [1.0]])
        nodes = radius[:, None] * np.column_stack([np.cos(arcs), np.sin(arcs)])
        s = np.linspace(0.0, 1.0, 97)
        places = spline_line(arcs).weights(s) @ nodes
        errors.append(np.abs(np.hypot(*places.T) - 1.0)[5:-5].max())
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 3.5)
    assert errors[-1] < 1e-7


@pytest.mark.parametrize("line", [spline_line, polygon_line])
def test_weights_places_and_integrals_agree(line):
    # reference: Gauss's rule on every piece, and a rigid motion
    arcs = np.concatenate([[0.0], np.arange(6) / 6.0 + 1.0 / 12.0, [1.0]])
    nodes = np.random.default_rng(5).normal(size=(8, 2))
    curve, s = line(arcs), np.array([0.0, 0.03, 0.41, 0.77, 1.0])
    assert curve.weights(s).sum(axis=1) == pytest.approx(np.ones((5, 1)))
    points, weights = np.polynomial.legendre.leggauss(4)
    for end in s[1:]:
        borders = np.append(arcs[arcs < end], end)
        exact = np.zeros(2)
        for a, b in pairwise(borders):
            exact += 0.5 * (b - a) * weights @ (curve.weights(0.5 * (a + b) + 0.5 * (b - a) * points) @ nodes)
        assert (curve.integrals(borders) @ nodes).sum(axis=0) == pytest.approx(exact, abs=1e-12)
