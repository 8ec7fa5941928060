"""The shooting reference beside closed forms that it does not know."""

import numpy as np
import pytest

from tests.references.curved import bent
from tests.references.elastica import cantilever_under_tip_force, roll_up


def test_a_level_graph_is_the_elastica():
    # reference: elliptic integrals, tests.references.elastica
    exact = cantilever_under_tip_force(3.0)
    found = bent(lambda x: 0.0, "x", (0.0, 1.0), 2.0, force=(0.0, 6.0))
    assert found.displacement == pytest.approx([exact.x - 1.0, exact.y], abs=1e-10)
    assert found.rotation == pytest.approx(exact.rotation, abs=1e-10)
    assert found.clamp_moment == pytest.approx(6.0 * exact.x, rel=1e-10)


def test_a_sloping_graph_rolls_up():
    # reference: a circle; the line x = −¾ y from (0, 0) to (¾, −1), of length 5/4, is turned by its direction
    kappa, slope = 2.3, -0.75
    exact, direction = roll_up(kappa), np.array([0.6, -0.8])
    along, across = exact.x - 1.0, exact.y
    expected = 1.25 * (along * direction + across * np.array([0.8, 0.6]))
    found = bent(lambda y: slope, "y", (0.0, -1.0), 1.7, moment=1.7 * kappa / 1.25)
    assert found.displacement == pytest.approx(expected, abs=1e-11)
    assert found.rotation == pytest.approx(kappa, rel=1e-12)


def test_a_flat_bow_at_a_small_load_is_castiglianos():
    # reference: y = b x²/2 with δ_y = P/EI ∫ (1 − x)² ds and δ_x = −P/EI ∫ (1 − x)(y₁ − y) ds, P to the tip along y
    b, P = 0.9, 1e-7
    x, weights = np.polynomial.legendre.leggauss(40)
    x, weights = 0.5 * (1.0 + x), 0.5 * weights
    ds = np.hypot(1.0, b * x) * weights
    expected = P * np.array([-np.sum((1.0 - x) * 0.5 * b * (1.0 - x * x) * ds), np.sum((1.0 - x) ** 2 * ds)])
    found = bent(lambda x: b * x, "x", (0.0, 1.0), 1.0, force=(0.0, P))
    assert found.displacement == pytest.approx(expected, rel=1e-6)
