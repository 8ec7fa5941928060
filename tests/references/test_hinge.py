"""The hinge's boundary-value solution checked by itself: statics, energy, symmetries, a linear limit."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import quad_vec

from tests.references.hinge import (
    PAPER,
    Hinge,
    SinglePointContactError,
    checked,
    closest,
    closing_moment,
    solve,
)

LENGTH = PAPER.length


@pytest.fixture(scope="module")
def full():
    return solve(PAPER, 0.67)


def _wrench(force, at):
    return np.array([*force, at[0] * force[1] - at[1] * force[0]])


@pytest.mark.parametrize("moment", [0.1, 0.67, -0.67])
def test_reactions_balance_the_moment(moment):
    found = solve(PAPER, moment)
    total = _wrench(found.reaction_A, (0.001, 0.02625)) + _wrench(found.reaction_C, (0.001, -0.02625))
    total[2] += found.reaction_moment_A + found.reaction_moment_C + moment
    np.testing.assert_allclose(total, 0.0, atol=1e-12)


def test_each_beam_balances_between_its_start_and_a_cut_beyond_the_contact(full):
    """Statics of beam 1 from A to s: reaction, contact force and the bending moment m(s) = E I Δκ."""
    s1, _ = full.contact_arc_lengths
    s = np.array([s1, s1 + 0.01])
    (x1, y1), (x2, y2) = full.shape(1, s).T
    below = full.shape(2, np.array([full.contact_arc_lengths[1]]))[:, 0]
    e = np.array([x1, y1]) - below
    assert np.linalg.norm(e) == pytest.approx(PAPER.thickness, rel=1e-12)
    contact = full.contact_force * e / np.linalg.norm(e)
    moment_about_cut = (
        full.reaction_moment_A
        + _wrench(full.reaction_A, (0.001 - x2, 0.02625 - y2))[2]
        + _wrench(contact, (x1 - x2, y1 - y2))[2]
    )
    internal = PAPER.bending_stiffness * full.curvature_change(1, s)[1]
    assert internal == pytest.approx(-moment_about_cut, rel=1e-11)


@pytest.mark.parametrize("moment", [0.2, 0.67])
def test_energy_falls_with_the_moment_by_the_rotation(moment):
    """dPE/dM = −φ along equilibria."""
    h = 1e-3
    slope = (solve(PAPER, moment + h).potential_energy - solve(PAPER, moment - h).potential_energy) / (2 * h)
    assert slope == pytest.approx(-solve(PAPER, moment).rotation, rel=1e-6)


def test_energy_rises_with_the_distance_held_by_the_contact_force(full):
    """dPE/dt = P at a fixed bending stiffness: the force is the multiplier of the distance."""

    def energy(t):
        same_stiffness = PAPER.youngs_modulus * (PAPER.thickness / t) ** 3
        return solve(dataclasses.replace(PAPER, thickness=t, youngs_modulus=same_stiffness), 0.67).potential_energy

    h = 2e-6
    assert (energy(0.002 + h) - energy(0.002 - h)) / (2 * h) == pytest.approx(full.contact_force, rel=1e-6)


def test_the_strain_energy_is_the_integral_of_the_curvature_change(full):
    def density(s):
        return sum(full.curvature_change(beam, np.array([s]))[0] ** 2 for beam in (1, 2))

    s1, _ = full.contact_arc_lengths
    integral = quad_vec(density, 0.0, LENGTH, points=[s1], epsrel=1e-9)[0]
    strain = 0.5 * PAPER.bending_stiffness * integral
    assert full.potential_energy == pytest.approx(strain - 0.67 * full.rotation, rel=1e-9)


def test_the_other_sign_is_the_mirror_image_with_the_beams_exchanged(full):
    other = solve(PAPER, -0.67)
    mirror = np.array([1.0, -1.0])
    np.testing.assert_allclose(other.displacement_B, mirror * full.displacement_D, atol=1e-12)
    np.testing.assert_allclose(other.displacement_D, mirror * full.displacement_B, atol=1e-12)
    np.testing.assert_allclose(other.reaction_A, mirror * full.reaction_C, rtol=1e-10)
    assert other.rotation == pytest.approx(-full.rotation, rel=1e-11)
    assert other.contact_force == pytest.approx(full.contact_force, rel=1e-11)
    s = np.linspace(0, LENGTH, 7)
    stress = full.bending_stress(2, s)
    np.testing.assert_allclose(other.bending_stress(1, s), -stress, atol=1e-9 * np.abs(stress).max())


def test_only_the_turning_of_one_link_against_the_other_matters(full):
    """Seen from BD the hinge is its own mirror image: the beams touch at half their length."""
    assert full.contact_arc_lengths == pytest.approx((LENGTH / 2, LENGTH / 2), rel=1e-11)
    s = np.linspace(0, LENGTH, 9)
    for beam in (1, 2):
        stress = full.bending_stress(beam, s)
        np.testing.assert_allclose(stress, stress[::-1], atol=1e-9 * np.abs(stress).max())


def test_a_small_moment_follows_the_linear_theory_of_curved_beams():
    """Castigliano: flexibility of each arc about BD's middle, in parallel; φ/M in the limit M → 0."""
    R, yc, EI = PAPER.radius, PAPER.yc, PAPER.bending_stiffness

    def stiffness(sign):
        def density(angle):
            lever_x = R * (1.0 + np.cos(angle))
            lever_y = sign * (R * np.sin(angle) - yc)
            v = np.array([1.0, lever_y, -lever_x])
            return np.outer(v, v) * R / EI

        return np.linalg.inv(quad_vec(density, 0.0, np.pi)[0])

    linear = np.linalg.inv(stiffness(1.0) + stiffness(-1.0))[0, 0]
    assert solve(PAPER, 1e-5).rotation / 1e-5 == pytest.approx(linear, rel=1e-6)


def test_figures_of_a_discrete_minimum_of_the_energy(full):
    """A chain of links minimised by an interior-point method, N refined: B, φ, and the force's y component.

    The multiplier of a gap measured along y is the y component of the force; its resultant is larger by
    1/cos of the normal's tilt, which is φ/2 here.
    """
    assert full.displacement_B == pytest.approx([-0.0255877, 0.0101034], rel=2e-4)
    assert full.rotation == pytest.approx(0.784886, rel=1e-4)
    assert full.contact_force * np.cos(full.rotation / 2) == pytest.approx(8.166, rel=5e-4)


def test_first_touch_divides_open_from_closed():
    touch = closing_moment(PAPER)
    assert closing_moment(PAPER, -1.0) == pytest.approx(-touch, rel=1e-11)
    # at the closing moment itself the sign of the force is round-off
    below, at, above = (solve(PAPER, touch * factor) for factor in (0.999, 1.0 + 1e-12, 1.001))
    assert below.contact_force == 0.0
    assert below.contact_arc_lengths is None
    # the gap is even in M (mirror image), so it closes like 1 − (M/Mc)² to leading order
    assert below.smallest_gap == pytest.approx(0.0005 * (1 - 0.999**2), rel=0.02)
    assert at.smallest_gap == pytest.approx(0.0, abs=1e-12)
    assert above.contact_force > 0.0
    assert above.smallest_gap == pytest.approx(0.0, abs=1e-12)
    assert below.rotation < at.rotation < above.rotation


def test_at_rest_nothing_happens():
    rest = solve(PAPER, 0.0)
    assert rest.rotation == pytest.approx(0.0, abs=1e-13)
    assert rest.smallest_gap == pytest.approx(0.0005, rel=1e-9)


@pytest.mark.parametrize("moment", [0.1, 0.4, 0.67])
def test_the_equations_hold_to_round_off(moment):
    assert solve(PAPER, moment).residual < 1e-11


def test_another_hinge_scales_as_it_must():
    """Twice as large in every length: moments scale with E·l³, forces with E·l², rotation stays."""
    twice = Hinge(radius=0.05, xc=0.052, yc=0.0525, thickness=0.004, width=0.016, youngs_modulus=2.3e9)
    large, small = solve(twice, 8 * 0.5), solve(PAPER, 0.5)
    assert large.rotation == pytest.approx(small.rotation, rel=1e-10)
    assert large.contact_force == pytest.approx(4 * small.contact_force, rel=1e-10)


@pytest.mark.parametrize("moment", [50.0, -2.0, float("nan")])
def test_a_moment_beyond_the_range_is_refused(moment):
    with pytest.raises(ValueError, match="within"):
        solve(PAPER, moment)


@pytest.mark.parametrize(
    ("broken", "words"),
    [({"contact_force": -1.0}, "pull on each other"), ({"smallest_gap": -1e-6}, "overlap by")],
)
def test_what_is_no_single_point_of_contact_is_refused(full, broken, words):
    with pytest.raises(SinglePointContactError, match=words):
        checked(dataclasses.replace(full, **broken))


def test_beams_that_overlap_away_from_the_point_are_seen(full):
    """The gap of the unloaded shape, under a thickness larger than the distance of the beams."""
    fat = dataclasses.replace(PAPER, thickness=0.003)
    gap, arcs = closest(fat, np.zeros(6))
    assert gap * fat.radius == pytest.approx(-0.0005, rel=1e-9)
    assert arcs == pytest.approx([np.pi / 2, np.pi / 2], abs=1e-9)
