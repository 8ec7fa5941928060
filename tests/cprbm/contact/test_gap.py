"""Derivatives of gaps against central differences, at random states, for all kinds of curves and places."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from cprbm.contact import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    TANGENT,
    TURN,
    gap_frame,
    gap_row,
    local_indices,
    on_edge,
    taken,
)
from tests.cprbm.contact.workshop import FINDING, all_places, mechanism, random_state, settled

STEP = 1e-6
FORCE = 40.0
"""Force of a point contact in units of EI/L²: half thicknesses seem smaller by about a percent."""


def vectors_over_unknowns(geometry, z, places, k):
    """Row, and its vectors over all unknowns (5, unknowns)."""
    vectors, index = np.empty((5, LOCAL)), np.empty(LOCAL, dtype=np.int64)
    row = gap_row(z, geometry.arrays, places, k, vectors)
    local_indices(geometry.arrays, places, k, index)
    spread = np.zeros((5, len(z)))
    for vector, whole in zip(vectors, spread, strict=True):
        np.add.at(whole, index, vector)
    return row, spread


def form(row, spread):
    """Hessian of λ over all unknowns."""
    q, e, m, f = spread[TANGENT], spread[TURN], spread[SHIFT], row.frame
    mixed = np.outer(q, e) + np.outer(e, q)
    return f.qq * np.outer(q, q) + f.qe * mixed + f.ee * np.outer(e, e) + row.shift * np.outer(m, m)


def touched(geometry, places):
    """Unknowns of a single place's nodes."""
    index = np.empty(LOCAL, dtype=np.int64)
    local_indices(geometry.arrays, places, 0, index)
    return np.unique(index)


def differences(function, z, unknowns):
    """Central differences of a function of the unknowns, by some of them."""
    out = []
    for i in unknowns:
        step = np.zeros(len(z))
        step[i] = STEP
        out.append((function(z + step) - function(z - step)) / (2.0 * STEP))
    return np.array(out)


def single(places, k, **changes):
    """One place, copied."""
    one = taken(places, np.array([k]))
    for name, value in changes.items():
        getattr(one, name)[:] = value
    return one


def cases():
    """Fixed places of every pair at random states: pair names, on pieces and at points."""
    m, geometry, rest = mechanism()
    rng = np.random.default_rng(5)
    found = []
    for seed in range(3):
        z = random_state(m, geometry, rest, seed)
        places = all_places(geometry, z, rest)
        bend = on_edge(geometry.arrays, places)
        corner = bend & geometry.arrays.is_point[places.curve]
        for k in range(len(places.pair)):
            inner = single(places, k, moves=False)
            if places.xi[k] == 0.0 and not bend[k]:
                inner.xi[:] = rng.uniform(0.05, 0.95)
            found.append(
                ("corner" if corner[k] else "bend" if bend[k] else geometry.pairs[places.pair[k]].name, z, inner)
            )
    return geometry, found


@pytest.fixture(scope="module")
def sampled():
    return cases()


@pytest.mark.parametrize("name", ["beams", "circle", "line", "plane", "graph", "ellipse", "ring", "corner"])
def test_fixed_places_have_exact_derivatives(sampled, name):
    geometry, found = sampled
    mine = [(z, places) for pair, z, places in found if pair == name]
    assert len(mine) > 15
    for z, places in mine[::3]:
        settled(geometry, z, places)
        at_point = bool(places.at_point[0])
        row, spread = vectors_over_unknowns(geometry, z, places, 0)
        unknowns = touched(geometry, places)

        def gap(z, places=places, at_point=at_point):
            near = single(places, 0)
            value = settled(geometry, z, near)[0][0]
            assert bool(near.at_point[0]) == at_point
            return value

        def gradient(z, places=places):
            near = single(places, 0)
            settled(geometry, z, near)
            return vectors_over_unknowns(geometry, z, near, 0)[1][GRADIENT]

        assert gap(z) == pytest.approx(row.value, abs=1e-13)
        np.testing.assert_allclose(differences(gap, z, unknowns), spread[GRADIENT][unknowns], atol=3e-9)
        hessian = form(row, spread)
        scale = np.abs(hessian).max()
        np.testing.assert_allclose(differences(gradient, z, unknowns), hessian[unknowns], atol=1e-7 * max(scale, 1.0))


@pytest.mark.parametrize("name", ["beams", "circle", "line", "graph", "ellipse", "corner"])
def test_points_with_lost_compliance_are_variational(sampled, name):
    """F λ has the derivatives F·gradient by the nodes and the row's value by F, places and feet moving along."""
    geometry, found = sampled
    tested = 0
    for z, start in [(z, places) for pair, z, places in found if pair == name]:
        places = single(start, 0, moves=True, force=FORCE)
        _, curvature = settled(geometry, z, places, FINDING)
        row, spread = vectors_over_unknowns(geometry, z, places, 0)
        moving = 0.02 < places.xi[0] < 0.98 and curvature[0] > 0.2 and abs(row.frame.slope) < 1e-12
        if not moving and (name != "corner" or places.at_point[0]):
            continue
        unknowns = touched(geometry, places)

        def energy(z, force=FORCE, places=places):
            near = single(places, 0, force=force)
            settled(geometry, z, near, FINDING)
            frame = gap_frame(z, geometry.arrays, near, 0)
            return force * (frame.gap + 0.5 * force * frame.lost)

        def value(z, force=FORCE, places=places):
            near = single(places, 0, force=force)
            settled(geometry, z, near, FINDING)
            return vectors_over_unknowns(geometry, z, near, 0)[0].value

        def gradient(z, places=places):
            near = single(places, 0)
            settled(geometry, z, near, FINDING)
            return vectors_over_unknowns(geometry, z, near, 0)[1][GRADIENT]

        shift = 1e-3
        by_force = (energy(z, FORCE + shift) - energy(z, FORCE - shift)) / (2.0 * shift)
        assert by_force == pytest.approx(row.value, abs=1e-10)
        np.testing.assert_allclose(differences(energy, z, unknowns), FORCE * spread[GRADIENT][unknowns], atol=1e-6)
        np.testing.assert_allclose(differences(value, z, unknowns), spread[COUPLING][unknowns], atol=1e-7)
        change = (value(z, FORCE + shift) - value(z, FORCE - shift)) / (2.0 * shift)
        assert change == pytest.approx(row.by_force, rel=1e-5)
        hessian = form(row, spread)
        found_hessian = differences(gradient, z, unknowns)
        np.testing.assert_allclose(found_hessian, hessian[unknowns], atol=3e-6 * np.abs(hessian).max())
        tested += 1
        if tested == 6:
            break
    assert tested >= 2


def test_a_place_that_is_not_at_its_minimum_has_the_linear_gap_of_the_minimum(sampled):
    """The row's value is what a Newton step of the place along leaves to first order."""
    geometry, found = sampled
    z, start = next((z, places) for pair, z, places in found if pair == "circle")
    places = single(start, 0, moves=True, force=FORCE)
    settled(geometry, z, places, FINDING)
    exact = vectors_over_unknowns(geometry, z, places, 0)[0].value
    errors = []
    for off in (1e-2, 5e-3):
        near = single(places, 0, xi=places.xi[0] + off)
        settled(geometry, z, near)
        errors.append(abs(vectors_over_unknowns(geometry, z, near, 0)[0].value - exact))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_rigid_motions_leave_gaps_unchanged():
    """The scene turned by 37 degrees, in the same deformed state turned along."""
    angle = np.radians(37.0)
    gaps = []
    for turn in (0.0, angle):
        m, geometry, rest = mechanism(angle=turn)
        rng = np.random.default_rng(3)
        z = rest.copy()
        for beam in m.chains:
            for node in m.beam_nodes(beam):
                offset = complex(*(2e-3 * rng.normal(size=2))) * np.exp(1j * turn)
                z[node] += offset.real
                z[node + 1] += offset.imag
        places = all_places(geometry, z, rest)
        found, _ = settled(geometry, z, places)
        names = np.array([pair.name for pair in geometry.pairs])[places.pair]
        gaps.append(found[np.isin(names, ["beams", "circle", "line", "plane"])])
    np.testing.assert_allclose(gaps[0], gaps[1], atol=1e-12)


def least_point(seed, between):
    """Gap, row's value and its derivative by F at the least gap of two beams; None at an end of a beam."""
    m, geometry, rest = mechanism(between=between)
    z = random_state(m, geometry, rest, seed)
    places = all_places(geometry, z, rest)
    gaps, _ = settled(geometry, z, places)
    mine = (places.pair == 0) & (places.curve == geometry.sites.columns[0, 0]) & (places.xi < 1.0)
    best = np.flatnonzero(mine)[np.argmin(gaps[mine])]
    point = single(places, best, moves=True, force=FORCE)
    gap = settled(geometry, z, point, FINDING)[0][0]
    row, _ = vectors_over_unknowns(geometry, z, point, 0)
    return (gap, row.value, row.by_force) if abs(row.frame.slope) < 1e-12 and not point.at_point[0] else None


def test_exchanged_beams_have_the_same_least_gap():
    """The minimum of λ is the same from either beam: thickness and lost compliance count alike at place and foot."""
    compared = 0
    for seed in range(5):
        both = [least_point(seed, between) for between in (("upper", "lower"), ("lower", "upper"))]
        if None not in both:
            np.testing.assert_allclose(both[0], both[1], rtol=1e-9, atol=1e-11)
            compared += 1
    assert compared >= 2


def test_interpreted_kernels_give_the_same_numbers():
    """NUMBA_DISABLE_JIT=1 runs the same code without compilation."""
    code = (
        "from tests.cprbm.contact.workshop import *\n"
        "m, g, rest = mechanism(4)\n"
        "z = random_state(m, g, rest, 1)\n"
        "print(*settled(g, z, all_places(g, z, rest))[0])\n"
    )
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    m, geometry, rest = mechanism(4)
    z = random_state(m, geometry, rest, 1)
    compiled = settled(geometry, z, all_places(geometry, z, rest))[0]
    np.testing.assert_allclose(compiled, np.array(run.stdout.split(), dtype=float), atol=1e-13)
