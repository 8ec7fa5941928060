"""The shot cantilever beside what is known of it in closed form."""

import numpy as np
import pytest

from tests.references.elastica import cantilever_under_tip_force
from tests.references.loaded import loaded


@pytest.mark.parametrize(("at", "force"), [(1.0, 7.0), (0.37, 9.0), (0.61, -25.0)])
def test_a_force_along_the_beam(at, force):
    # reference: Bisshopp and Drucker up to the force, and straight beyond it
    bent = cantilever_under_tip_force(force * at**2)
    found = loaded(forces=[(at, 0.0, force)])
    cos, sin = np.cos(bent.rotation), np.sin(bent.rotation)
    assert found.angle == pytest.approx(bent.rotation, abs=1e-12)
    assert found.tip == pytest.approx([bent.x * at + (1.0 - at) * cos, bent.y * at + (1.0 - at) * sin], abs=1e-12)
    assert found.clamp_moment == pytest.approx(-force * bent.x * at, abs=1e-11)
    assert found.clamp_force == pytest.approx([0.0, -force])
    assert found.moment(np.array([0.0, at])) == pytest.approx([-found.clamp_moment, 0.0], abs=1e-10)


def test_slight_weights():
    # reference: beams in a textbook; y = q/8, θ = q/6 at the tip, energy −q²/40, of a weight on the outer half 41 q/384
    q = 1e-4
    found = loaded(distributed=[(0.0, 1.0, 0.0, -q)])
    assert found.tip[1] == pytest.approx(-q / 8.0, rel=1e-7)
    assert found.angle == pytest.approx(-q / 6.0, rel=1e-7)
    assert found.energy == pytest.approx(-(q**2) / 40.0, rel=1e-5)
    s = np.linspace(0.0, 1.0, 7)
    assert found.moment(s) == pytest.approx(-0.5 * q * (1.0 - s) ** 2, abs=1e-11)
    half = loaded(distributed=[(0.5, 1.0, 0.0, -q)])
    assert half.tip[1] == pytest.approx(-41.0 * q / 384.0, rel=1e-7)


def test_a_weight_and_its_energy():
    # reference: the energy of a dead load's equilibria falls with the load by what its points have sunk
    q, step = 12.0, 0.01
    ahead, behind = (loaded(distributed=[(0.2, 0.9, 0.6 * each, each)]).energy for each in (q + step, q - step))
    found = loaded(distributed=[(0.2, 0.9, 0.6 * q, q)])
    fine = np.linspace(0.0, 1.0, 200_001)
    theta = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(fine) * (found.moment(fine)[1:] + found.moment(fine)[:-1]))])
    x = np.concatenate([[0.0], np.cumsum(np.diff(fine) * np.cos(0.5 * (theta[1:] + theta[:-1])))])
    y = np.concatenate([[0.0], np.cumsum(np.diff(fine) * np.sin(0.5 * (theta[1:] + theta[:-1])))])
    inside = (fine >= 0.2) & (fine <= 0.9)
    sunk = np.trapezoid((0.6 * (x - fine) + y)[inside], fine[inside])
    assert (ahead - behind) / (2.0 * step) == pytest.approx(-sunk, rel=1e-5)
