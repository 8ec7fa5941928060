"""The turned beam beside the linear beam, beside energy's curvatures, and what is left as a stop lets go."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from tests.references.snap import Snap
from tests.references.stability import Loaded, curvatures

FIXED = [(0, (0.0, 0.0, 1.0)), (1, (1.0, 0.0, 0.0)), (1, (0.0, 1.0, 0.0))]
ANGLE = (1, (0.0, 0.0, 1.0))
SNAP = Snap(0.9)


def found(state, *also):
    start = np.array([0.0, 0.0, state.clamp, state.clamp_moment])
    return curvatures([Loaded(start, state.force, 1.0)], [*FIXED, *also])


def linear(far_end):
    """Largest μ of a linear beam: w = A (cos τx − 1) + B (sin τx − τx) + φ x, with w = 0 and w'' or w' = 0 at x = 1."""
    x, weight = np.polynomial.legendre.leggauss(40)
    x, weight = 0.5 * (x + 1.0), 0.5 * weight

    def turned(tau):
        sin, cos = np.sin(tau), np.cos(tau)
        if far_end == "pinned":
            A, phi = -sin / cos, tau - sin / cos
        else:  # −A τ sin τ + B τ (cos τ − 1) + φ = 0 less A (cos τ − 1) + B (sin τ − τ) + φ = 0, with B = 1
            A = (tau * cos - sin) / (cos - 1.0 + tau * sin)
            phi = A * tau * sin - tau * (cos - 1.0)
        slope = -A * tau * np.sin(tau * x) + tau * (np.cos(tau * x) - 1.0) + phi
        return abs(phi) * np.sqrt(2.0 / (weight @ slope**2))

    span = (5.3, 6.28) if far_end == "pinned" else (7.0, 8.2)
    return -minimize_scalar(lambda tau: -turned(tau), bounds=span, method="bounded", options={"xatol": 1e-10}).fun


def test_published_turn():
    # reference: Gomez, Moulton and Vella (2017), 1.7818 for a far end that is clamped
    assert linear("clamped") == pytest.approx(1.7818, abs=5e-5)


@pytest.mark.parametrize("far_end", ["pinned", "clamped"])
def test_small_turns(far_end):
    # reference: the linear beam, from which the elastica departs as 1 − d
    errors = [Snap(1.0 - e, far_end).fold.clamp / np.sqrt(e) - linear(far_end) for e in (2e-2, 1e-2)]
    assert abs(errors[1]) < 5e-3
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.05)


def test_a_curvature_vanishes():
    # reference: Ritz's method; all others are still positive
    fold = SNAP.fold
    assert found(fold)[0] == pytest.approx(0.0, abs=1e-6)
    assert found(fold)[1] > 0.1
    assert found(SNAP.at(0.99 * fold.clamp))[0] > 0.01
    assert found(SNAP.at(0.0))[0] > 0.1


def test_beyond_the_fold_the_beam_stands_above():
    # reference: Ritz's method, and less energy than at the fold
    above = SNAP.above(SNAP.fold.clamp)
    assert found(above)[0] > 0.1
    assert above.energy < 0.5 * SNAP.fold.energy
    assert SNAP.end(above.unknowns)[0][[0, 1, 3]] == pytest.approx(np.zeros(3), abs=1e-11)


def test_a_stop_that_lets_go_leaves_a_negative_curvature():
    # reference: Ritz's method, with the stop's angle held and free
    free = SNAP.let_go(0.66)
    assert free.far_moment == pytest.approx(0.0, abs=1e-11)
    assert free.clamp < SNAP.fold.clamp
    assert found(free, ANGLE)[0] > 0.02
    assert found(free)[0] < -0.1
    held = SNAP.stopped(SNAP.fold.clamp, 0.66, free)
    assert held.far_moment > 0.3
    assert found(held, ANGLE)[0] > 0.02


def test_energy_is_the_work_of_the_turn():
    # reference: dU = −M₀ dφ, the moment of the ground on the clamp being −M₀, by an extrapolated difference
    def slope(h):
        return (SNAP.at(0.3 + h).energy - SNAP.at(0.3 - h).energy) / (2.0 * h)

    assert (4.0 * slope(0.01) - slope(0.02)) / 3.0 == pytest.approx(-SNAP.at(0.3).clamp_moment, rel=1e-6)


def test_the_moment_that_assembles_it_below():
    # reference: the end under a moment of EI/L is brought to its place, kept under it; then the moment goes
    assert SNAP.assembled(1.0).unknowns == pytest.approx(SNAP.at(0.0).unknowns, abs=1e-9)
