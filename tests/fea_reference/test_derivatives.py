"""Residual and tangent against differences, and what rigid motion must not do."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cprbm_scene import read
from fea_reference import Settings
from fea_reference.contact import pairs, touch
from fea_reference.element import chords, forces
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble
from fea_reference.touch import Penalty
from tests.fea_reference.cantilever import cantilever, force
from tests.fea_reference.differences import check


@pytest.fixture(scope="module")
def hinge():
    return read(Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml")


def bent(model, seed=1, size=0.02):
    """A state near the undeformed one with every unknown disturbed."""
    z = model.start.values + size * np.random.default_rng(seed).standard_normal(model.size) / 20
    z[model.element_dofs[6]] = np.random.default_rng(seed + 1).standard_normal(model.element_dofs.shape[1])
    z[model.multipliers] = np.random.default_rng(seed + 2).standard_normal(model.multipliers.size)
    return z


@pytest.mark.parametrize("kinematics", ["bending", "stretch", "shear"])
def test_the_elements_derivatives(hinge, kinematics):
    """The gradient is that of the mixed functional, put together from its parts; the hessian is its own."""
    model = build(hinge, Settings(elements=10, kinematics=kinematics))
    u = bent(model)[model.element_dofs]
    own = np.arange(u.size).reshape(u.shape)

    def at_values(u):
        z = State.of(u.ravel())
        return forces(model.elements, chords(model.elements, own, z), z.values[own[6]])

    at = at_values(u)
    h = 1e-6
    for i in range(7):
        step = np.zeros_like(u)
        step[i] = h
        ahead, behind = at_values(u + step), at_values(u - step)
        slope = (ahead.gradient - behind.gradient) / (2 * h)
        assert at.hessian()[i] == pytest.approx(slope, abs=1e-6 * np.abs(at.hessian()).max())
        # Π = strain energy + N ∂Π/∂N, because ∂Π/∂N is the membrane gap and c L N² is counted once too often
        # in it
        value = [side.energy + v[6] * side.gradient[6] for side, v in ((ahead, u + step), (behind, u - step))]
        assert at.gradient[i] == pytest.approx((value[0] - value[1]) / (2 * h), abs=1e-6 * np.abs(at.gradient).max())


def test_rigid_motion_gives_no_force(hinge):
    for kinematics in ("bending", "stretch", "shear"):
        model = build(hinge, Settings(elements=10, kinematics=kinematics))
        for angle in (0.3, 2.0, 3.1, 6.0, -9.0):
            u = model.start[model.node_dofs]
            cos, sin = np.cos(angle), np.sin(angle)
            moved = model.start.values.copy()
            moved[model.node_dofs] = cos * u[0] - sin * u[1] + 0.7, sin * u[0] + cos * u[1] - 0.4, u[2] + angle
            assert np.abs(model.bend(State.of(moved)).gradient).max() < 1e-10


def deep(hinge, shift):
    """The hinge's model with beam 2 pushed upwards into beam 1, and its one pair."""
    model = build(hinge, Settings(elements={"beam1": 13, "beam2": 10}))
    z = bent(model, size=0.002)
    beam = model.beams[1]
    z[model.node_dofs[1, beam.nodes]] += shift / model.units.length
    return model, z, pairs(hinge, model)[0]


@pytest.mark.parametrize(("shift", "thicker"), [(0.00052, 1.0), (0.0008, 1.0), (0.0015, 1.0), (0.0008, 4.3)])
def test_the_contacts_derivatives(hinge, shift, thicker):
    """Gradient and tangent of ½ ε ∫ ⟨−g⟩² ds, moving ends of the zone and all.

    Beams that touch at a much larger distance overlap deeply: then the gap's own curvature counts.
    """
    model, z, pair = deep(hinge, shift)
    pair = replace(pair, distance=thicker * pair.distance)

    def gathered(z):
        one = touch(model, pair, Penalty(1.0), 12, State.of(z))
        beam = model.line(model.beams[0], State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        # ½ ε g² ds = ½ |force| |g|, and ε is one: |force| = |g| ds
        g = np.hypot(*(one.x - one.x_m)) - pair.distance
        return 0.5 * float(np.hypot(*one.force) @ -g), gradient, hessian, beam

    value, _, hessian, _ = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    check(model, gathered, z, times=4, rel=1e-5, tangent=1e-4)


def test_the_contact_does_not_see_its_quadrature(hinge):
    """Doubling the rule: the integral runs over the zone itself, so the forces stay."""
    for shift in (0.00052, 0.0008, 0.0015):
        model, z, pair = deep(hinge, shift)
        once, twice = (touch(model, pair, Penalty(1.0), q, State.of(z)).force.sum(axis=1) for q in (6, 12))
        assert np.hypot(*twice) > 0.0
        assert once == pytest.approx(twice, rel=1e-9)


def test_the_contact_is_balanced(hinge):
    """Its generalised forces add up to no force and no moment."""
    model, z, pair = deep(hinge, 0.0008)
    one = touch(model, pair, Penalty(1.0), 6, State.of(z))
    # all but the axial forces: of the elements that touch, and of those beside
    nodes = np.add.outer([0, 3, 7, 10, *range(14, len(one.dofs), 3)], range(3))
    pull = one.gradient[nodes]
    total = pull[:, :2].sum(axis=0)
    scale = np.abs(one.gradient).sum()
    assert np.abs(total).max() < 1e-12 * scale
    at = z[one.dofs[nodes]]
    moment = (at[:, 0] * pull[:, 1] - at[:, 1] * pull[:, 0] + pull[:, 2]).sum()
    assert abs(moment) < 1e-12 * scale


def test_the_whole_tangent():
    scene = cantilever(force(1, 2), (1.0,))
    model = build(scene, Settings(elements=3))
    z, values = bent(model), np.array([0.7])

    def at(z):
        return assemble(model, {}, 6, values, State.of(z), model.initial_constraints)

    tangent = at(z).tangent.matrix.toarray()
    for i in range(model.size):
        step = np.zeros(model.size)
        step[i] = 1e-6
        slope = (at(z + step).residual - at(z - step).residual) / 2e-6
        assert tangent[:, i] == pytest.approx(slope, abs=1e-6 * np.abs(tangent).max())
