"""Rows of the paper's contacts: gaps and gradients by complex step, solution and inertia by dense matrices."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from cprbm.chain import add_rows, mechanism_of
from cprbm.contact import contact_geometry, fixed_places
from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.factors import factorise
from cprbm.equilibrium.system import system_of
from cprbm.paper.contacts import paper_geometry
from tests.cprbm.contact.workshop import settled
from tests.cprbm.second.systems import disturbed

SCENES = {"hinge": 24, "gripper": 17, "five-bar": 16}
SEEDS = range(3)


def random_contact(case, seed, degree=4):
    """System, geometry, a state near rest, places with random forces, and marks of the closed places."""
    scene = cases.opened(case)
    m = mechanism_of(scene, dict.fromkeys(scene.beams, SCENES[case]), scene.theory, corrected=False)
    add_rows(m)
    geometry = paper_geometry(m, contact_geometry(m), degree)
    system, random = system_of(m, geometry), np.random.default_rng(seed)
    state = disturbed(system, seed, 1e-3)
    contacts = state.contacts
    near = np.ones(len(geometry.pairs), dtype=bool)
    places = fixed_places(geometry, state.z, contacts.sides, near, contacts.counters)
    settled(geometry, state.z, places)
    closed = random.random(len(places.pair)) < 0.25
    for pair in range(len(geometry.pairs)):
        # the first joint of the gripper's circle hangs on a clamped link
        first, second = np.flatnonzero(places.pair == pair)[:2]
        closed[first], closed[second] = False, True
    places.force[:] = 3.0 * random.random(len(closed)) * closed
    return system, geometry, state, replace(contacts, places=places, closed=closed)


def textbook_gaps(z, b):
    """Gaps of eqs. (9) to (11) in powers of the coordinate, for complex numbers too."""
    tau = 0.5 * (z[b.angles[:-1]] + z[b.angles[1:]])
    x, y = z[b.points] - b.offset * np.sin(tau), z[b.points + 1] + b.offset * np.cos(tau)
    A, B = (x, y) if b.along == 0 else (y, x)
    a, o = z[b.joints + b.along], z[b.joints + 1 - b.along]
    middle, width = np.mean(A.real), np.ptp(A.real)
    V, at = (np.vander((each - middle) / width, b.degree + 1) for each in (A, a))
    return b.sense * (o - at @ np.linalg.solve(V.T @ V, V.T @ B))


@pytest.mark.parametrize("degree", [2, 4])
@pytest.mark.parametrize("case", SCENES)
def test_gaps_and_gradients_are_those_of_the_textbook(case, degree):
    _, geometry, state, contacts = random_contact(case, 1, degree)
    places, z = contacts.places, state.z
    for pair, boundary in geometry.law.boundaries.items():
        mine, gaps = places.pair == pair, contacts.gaps(geometry, z)
        assert gaps[mine] == pytest.approx(textbook_gaps(z, boundary), abs=1e-12)
        closed = contacts.closed & mine
        found = contact_terms(geometry, z, places, closed)[1]
        step = 1e-30
        by_step = np.zeros(len(z))
        for i in np.flatnonzero(found):
            moved = z.astype(complex)
            moved[i] += 1j * step
            by_step[i] = -places.force[mine] @ textbook_gaps(moved, boundary).imag / step
        assert found == pytest.approx(by_step, abs=1e-9 * np.abs(by_step).max())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("case", SCENES)
def test_solution_and_inertia_are_those_of_the_dense_matrix(case, seed):
    # reference: the matrix by central differences of the gradient, its eigenvalues and its product with the solution
    system, geometry, state, contacts = random_contact(case, seed)
    places, closed, size = contacts.places, contacts.closed, system.size
    own = np.flatnonzero(closed)
    kept = np.concatenate([np.arange(system.rows.first), system.rows.first + np.flatnonzero(state.driven)])
    kept = np.concatenate([kept, size + np.arange(len(own))])

    def at(offset):
        moved = contacts.places._replace(force=places.force.copy())
        moved.force[own] += offset[size:]
        here = replace(state, z=state.z + offset[:size], contacts=replace(contacts, places=moved))
        settled(geometry, here.z, moved)
        factors, gradient = factorise(system, here)
        return np.concatenate([gradient, -factors.bordered.columns.values])[kept]

    step = 1e-6
    units = step * np.eye(size + len(own))[kept]
    matrix = np.array([(at(unit) - at(-unit)) / (2.0 * step) for unit in units])
    matrix = 0.5 * (matrix + matrix.T)
    factors, _ = factorise(system, replace(state, contacts=contacts))
    load = np.zeros(size + len(own))
    load[kept] = np.random.default_rng(seed).normal(size=len(kept))
    found = np.concatenate(factors.solve_both(load[:size], load[size:]))[kept]
    allowed = 1e-6 * (1.0 + np.abs(matrix) @ np.abs(found)) + 1e-9 * np.abs(matrix).max() * np.abs(found).max()
    assert (np.abs(matrix @ found - load[kept]) < allowed).all()
    equalities = 2 * len(system.metric) + int(state.driven.sum()) + len(own)
    assert factors.lost == int((np.linalg.eigvalsh(matrix) < 0.0).sum()) - equalities
