"""Equilibria with contacts: closed forms, the exact reference, and the linear system against differences."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from cprbm.contact import new_counters, open_contacts, settle, taken
from cprbm.equilibrium.contact_points import touched_equilibrium
from cprbm.equilibrium.contact_set import NotConvergedError
from cprbm.equilibrium.factors import factorise
from cprbm.equilibrium.solving import at_state
from cprbm.equilibrium.system import rest_state, system_of
from cprbm_scene import read
from tests.cprbm.contact.workshop import FINDING, geometry_of

CASES = Path(__file__).parents[3] / "comparisons" / "cases"
ITERATIONS = 40
HINGE_FORCE = 8.83723785
"""N at 0.67 N·m, of ``cprbm solve hinge --solver exact``: collocation of the beams' differential equations."""


def stepped(name: str, links: int, stations=None):
    """Solutions at the stations of a built-in case's first stage, and the mechanism."""
    m, geometry, _ = geometry_of(read(CASES / f"{name}.toml"), links)
    system, stage = system_of(m, geometry), m.scene.stages[0]
    state = rest_state(system)
    contacts = open_contacts(geometry, state.z)
    row, solutions = m.row(stage.steps), []
    for station in stage.stations if stations is None else stations:
        target = state.target.copy()
        target[row] = m.rows[row].unit * station
        solved = touched_equilibrium(system, replace(state, target=target, contacts=contacts), ITERATIONS)
        state, contacts = solved.state, solved.state.contacts
        solutions.append(solved)
    return m, geometry, system, solutions


def row_force(m, system, solved, name: str) -> float:
    """Force of a row on the mechanism, N."""
    return -float(solved.state.multipliers(system)[m.row(name)]) * m.units.force


@pytest.mark.parametrize(("links", "error"), [(20, 1e-4), (40, 2e-5)])
def test_the_hinges_contact_force_meets_the_exact_reference(links, error):
    m, _, system, solutions = stepped("hinge", links)
    last = solutions[-1]
    assert last.state.contacts.closed.sum() == last.state.contacts.places.moves.sum() == 1
    assert at_state(system, last.state).lost == 0
    force = float(last.state.contacts.places.force[last.state.contacts.closed][0]) * m.units.force
    assert force == pytest.approx(HINGE_FORCE, rel=error)


def lift_off(load: float) -> float:
    """Angle at which the wrapped cantilever leaves the circle, from the elastica: see the scene for the numbers.

    In the zone the moment is EI/R; beyond it EI κ²/2 = load (sin ψ_tip − sin ψ).
    """
    rigidity = 2.07e11 * 0.0097 * 0.00103**3 / 12.0
    radius, length = 0.0711 + 0.5 * 0.00103, 0.1104 - 0.0131

    def missing(angle):
        top = np.sin(angle) + rigidity / (2.0 * radius**2 * load)
        tip = np.arcsin(top)

        def rate(x):
            fall = 2.0 * np.cos(tip - 0.5 * x * x) * np.sin(0.5 * x * x)
            return 2.0 * x / np.sqrt(2.0 * load / rigidity * fall)

        return radius * angle + quad(rate, 0.0, np.sqrt(tip - angle), epsabs=1e-12)[0] - length

    highest = np.arcsin(1.0 - rigidity / (2.0 * radius**2 * load))
    return float(brentq(missing, 1e-9, highest - 1e-9))


def test_a_clamp_beside_a_wrapped_zone_takes_the_axial_force_alone():
    m, _, system, solutions = stepped("wrapped", 40)
    for load, solved in list(zip(m.scene.stages[0].stations, solutions, strict=True))[2:]:
        axial = row_force(m, system, solved, "beam@start.x")
        assert axial == pytest.approx(-load * np.sin(lift_off(load)), rel=2e-4)
        assert abs(row_force(m, system, solved, "beam@start.y")) < 1e-3 * load


def residual(system, geometry, state, places, closed):
    """Gradient by the unknowns and by the forces, places and feet moved to λ's stationary point."""
    gaps = np.empty(len(closed))
    settle(state.z, geometry.arrays, places, gaps, gaps.copy(), new_counters(), FINDING)
    factors, gradient = factorise(
        system, replace(state, contacts=replace(state.contacts, places=places, closed=closed))
    )
    return np.concatenate([gradient, -factors.bordered.columns.values])


@pytest.mark.parametrize(
    ("name", "station", "strength"), [("gripper", 9.0, 1.0), ("gripper", 9.0, -60.0), ("wrapped", 97.0, 1.0)]
)
def test_solutions_and_lost_directions_are_those_of_the_dense_matrix(name, station, strength):
    """The matrix by central differences of the gradient, with ``strength`` times the equilibrium's contact forces."""
    m, geometry, system, solutions = stepped(name, 9, np.linspace(0.0, station, 6)[1:])
    state, closed = solutions[-1].state, solutions[-1].state.contacts.closed
    places = taken(solutions[-1].state.contacts.places, np.arange(len(closed)))
    places.force[:] *= strength
    own, size = np.flatnonzero(closed & (places.shares == 0)), len(state.z)
    unknowns = np.concatenate([np.arange(system.rows.first), system.rows.first + np.flatnonzero(state.driven)])
    kept = np.concatenate([unknowns, size + np.arange(len(own))])

    def at(offset):
        moved = taken(places, np.arange(len(closed)))
        moved.force[own] += offset[size:]
        moved.force[:] = moved.force[np.arange(len(closed)) + moved.shares]
        return residual(system, geometry, replace(state, z=state.z + offset[:size]), moved, closed)[kept]

    units, step = np.eye(size + len(own))[kept], 1e-6
    matrix = np.array([(at(step * unit) - at(-step * unit)) / (2.0 * step) for unit in units])
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-6 * np.abs(matrix).max())
    residual(system, geometry, state, places, closed)
    factors, _ = factorise(system, replace(state, contacts=replace(state.contacts, places=places, closed=closed)))
    load = np.zeros(size + len(own))
    load[kept] = np.random.default_rng(2).normal(size=len(kept))
    found = np.concatenate(factors.solve_both(load[:size], load[size:]))[kept]
    expected = np.linalg.solve(matrix, load[kept])
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())
    links = sum(chain.links for chain in m.chains.values())
    negative = int(np.sum(np.linalg.eigvalsh(0.5 * (matrix + matrix.T)) < 0.0))
    assert factors.lost == negative - 2 * links - int(state.driven.sum()) - len(own)
    assert (factors.lost > 0) == (strength != 1.0)


def test_a_strip_does_not_pass_through_itself():
    """Rolled: small steps meet the contact of the strip's layers; a step past the contact is refused."""
    begin = [2.0, 4.0, 6.0]
    _, _, _, small = stepped("rolled", 20, [*begin, *np.linspace(6.1, 6.8, 8)])
    assert small[-1].state.contacts.closed.sum() == 1
    assert small[-1].state.contacts.places.force[small[-1].state.contacts.closed] > 0.0
    with pytest.raises(NotConvergedError, match="passed through itself"):
        stepped("rolled", 20, [*begin, 6.8])
