"""The column on a circle beside linear theory, the column without it, and energy's curvatures."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.columns import bent
from tests.references.let_go import Held
from tests.references.small import euler_load_cantilever
from tests.references.stability import Loaded, curvatures

LOAD = 3.21
CLAMP = (0, (0.0, 0.0, 1.0))
HELD = Held(LOAD, (0.62, 0.15), 0.13)


def pieces(state):
    force = np.array([-LOAD, state.side_force])
    n = np.array([np.sin(state.angle), -np.cos(state.angle)])
    return [
        Loaded(np.array([0.0, 0.0, 0.0, state.moment]), force + state.pressing * n, state.touch),
        Loaded(state.touching, force, 1.0 - state.touch),
    ], (1, (float(n[0]), float(n[1]), 0.0))


def test_small_gaps():
    # reference: S. P. Timoshenko and J. M. Gere, a linear column that touches at its place below the center; by the
    # slope of the column there, the place of contact departs as the gap, and so does Q* over it
    k, x = np.sqrt(LOAD), 0.62
    rise = (np.sin(k * x) - k * x + np.tan(k) * (1.0 - np.cos(k * x))) / k / LOAD
    errors = [Held(LOAD, (x, 0.13 + gap), 0.13).let_go().side_force / gap * rise - 1.0 for gap in (2e-3, 1e-3)]
    assert abs(errors[1]) < 5e-3
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.1)


def test_circle_presses_until_it_lets_go():
    free = HELD.let_go()
    assert euler_load_cantilever(1.0, 1.0) < LOAD
    assert free.side_force < 0.0
    pressing = [HELD.under(free.side_force + more).pressing for more in (0.0, 0.02, 0.1)]
    assert pressing[0] == pytest.approx(0.0, abs=1e-10)
    assert 0.0 < pressing[1] < pressing[2]
    place = free.touching[:2] - HELD.center
    assert np.hypot(*place) == pytest.approx(HELD.radius, rel=1e-12)


def test_what_is_left_has_a_negative_curvature():
    # reference: Ritz's method; where the circle presses no longer its own curvature plays no part
    beam, contact = pieces(HELD.let_go())
    assert curvatures(beam, [CLAMP, contact])[0] > 0.4
    left = curvatures(beam, [CLAMP])
    assert left[0] < -0.1
    assert left[1] > 0.4


def test_where_it_falls_to():
    # reference: Ritz's method, and less energy
    free = HELD.let_go()
    fallen = HELD.fallen(free.side_force)
    assert fallen.tip[1] < -0.5
    assert curvatures(pieces(fallen)[0], [CLAMP])[0] > 0.1
    assert HELD.energy(fallen) < HELD.energy(free) - 0.1


def test_fallen_without_a_side_force_it_is_eulers():
    # reference: elliptic integrals
    fallen, exact = HELD.fallen(0.0), bent("cantilever", LOAD)
    assert [1.0 - fallen.tip[0], -fallen.tip[1], -fallen.tip[2]] == pytest.approx(
        [exact.shortening, exact.deflection, exact.angle], rel=1e-11
    )
