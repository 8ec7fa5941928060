"""The shooting for a varying section beside closed forms: logarithms, elliptic integrals, a circle, two arcs."""

import numpy as np
import pytest

from tests.references.elastica import cantilever_under_tip_force, roll_up
from tests.references.guided import guided_beam
from tests.references.small import rectangle_second_moment
from tests.references.tapered import bent, guided, small_deflection

L, E, T, W = 0.173, 3.1e9, 0.0023, 0.0091
EI = E * rectangle_second_moment(T, W)
EVEN = ((0.0, 1.0), (W, W))


@pytest.mark.parametrize("taper", [0.2, 0.5, 0.8, -0.7])
def test_a_small_force_gives_the_logarithms(taper):
    P = 1e-5 * EI / L**2
    got = bent(L, E, ((0.0, 1.0), (T, T * (1.0 - taper))), EVEN, (0.0, P), 0.0, np.array([0.0, 0.5]))
    w, theta = small_deflection(P, L, EI, taper)
    assert [got.y, got.angle] == pytest.approx([w, theta], rel=1e-9)
    assert got.moment == pytest.approx([P * L, 0.5 * P * L], rel=1e-9)
    # Clapeyron: the strain energy is half of the work
    assert got.energy == pytest.approx(-0.5 * P * w, rel=1e-8)


@pytest.mark.parametrize("alpha", [0.3, 3.0, 10.0])
def test_an_even_beam_gives_the_elliptic_integrals(alpha):
    exact = cantilever_under_tip_force(alpha)
    # a knot more changes nothing
    got = bent(L, E, ((0.0, 0.3, 1.0), (T, T, T)), EVEN, (0.0, alpha * EI / L**2), 0.0, np.zeros(1))
    assert [got.x / L, got.y / L, got.angle] == pytest.approx([exact.x, exact.y, exact.rotation], abs=2e-11)
    assert got.moment[0] == pytest.approx(alpha * EI / L * exact.x, rel=1e-10)


def test_an_end_moment_gives_a_circle():
    exact = roll_up(2.0)
    got = bent(L, E, ((0.0, 1.0), (T, T)), EVEN, (0.0, 0.0), 2.0 * EI / L, np.array([0.0, 0.7]))
    assert [got.x / L, got.y / L, got.angle] == pytest.approx([exact.x, exact.y, exact.rotation], abs=1e-11)
    assert got.stress == pytest.approx(np.full(2, E * T / L), rel=1e-11)


def test_an_end_moment_turns_a_tapered_beam_by_the_mean_of_its_compliance():
    # ∫ ds/t³ of t = t₀ (1 − a s/L) is L/(2 a t₀³) (1/b² − 1), b = 1 − a; and σ = 6 M/(w t²)
    a, M = 0.6, 0.4 * EI / L
    got = bent(L, E, ((0.0, 1.0), (T, T * (1.0 - a))), EVEN, (0.0, 0.0), M, np.array([0.0, 1.0]))
    assert got.angle == pytest.approx(M * L / (2.0 * a * EI) * (1.0 / (1.0 - a) ** 2 - 1.0), rel=1e-11)
    assert got.stress == pytest.approx(6.0 * M / (W * np.array([T, 0.4 * T]) ** 2), rel=1e-11)


def test_the_width_counts_once():
    # twice the width and half the modulus are the same beam, with half the stress
    thickness = ((0.0, 0.4, 1.0), (T, 0.6 * T, 0.8 * T))
    width = ((0.0, 0.7, 1.0), (W, 0.5 * W, 0.9 * W))
    wide = (width[0], tuple(2.0 * w for w in width[1]))
    force, moment, at = (-0.3 * EI / L**2, 0.8 * EI / L**2), 0.2 * EI / L, np.linspace(0.0, 1.0, 5)
    one, other = bent(L, E, thickness, width, force, moment, at), bent(L, 0.5 * E, thickness, wide, force, moment, at)
    assert (one.x, one.y, one.angle) == pytest.approx((other.x, other.y, other.angle), rel=1e-12)
    assert one.stress == pytest.approx(2.0 * other.stress, rel=1e-10)


@pytest.mark.parametrize("alpha", [0.3, 3.0, 12.0])
def test_an_even_beam_kept_from_turning_is_two_cantilevers(alpha):
    # reference: tests.references.guided
    exact, P = guided_beam(alpha), alpha * EI / L**2
    got, moment = guided(L, E, ((0.0, 0.3, 1.0), (T, T, T)), EVEN, (0.0, P), np.array([0.0, 1.0]))
    assert [1.0 - got.x / L, got.y / L] == pytest.approx([exact.shortening, exact.offset], abs=2e-11)
    assert [got.moment[0], -got.moment[1], -moment] == pytest.approx([exact.moment * EI / L] * 3, rel=1e-10)
