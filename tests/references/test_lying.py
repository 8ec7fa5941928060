"""The beam that lies on another, checked by itself: a minimum found by search, balance, energy, limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize

from tests.references.lying import Lying, Strip

PAIR = Lying(
    top=Strip(length=0.0973, thickness=1.03e-3, width=8.7e-3, youngs_modulus=2.03e11),
    bottom=Strip(length=0.0811, thickness=1.27e-3, width=8.7e-3, youngs_modulus=2.03e11),
    curvature=1.0 / 0.12,
    force=45.0,
)
CASES = [
    PAIR,
    replace(PAIR, force=90.0),
    replace(PAIR, pull=-1.2),
    replace(PAIR, pull=-0.7, force=70.0),
    replace(PAIR, bottom=replace(PAIR.bottom, thickness=0.6e-3), force=30.0),
    replace(PAIR, top=Strip(0.0973, 6e-3, 8.7e-3, 1e9), bottom=Strip(0.0953, 6e-3, 8.7e-3, 1e9), force=60.0),  # thick
]
every = pytest.mark.parametrize("pair", CASES, ids=range(len(CASES)))


def _pull(pair):
    return pair.force * np.array([np.cos(pair.pull), np.sin(pair.pull)])


def _cross(arm, force):
    return arm[0] * force[1] - arm[1] * force[0]


def _tip(pair):
    turn = pair.curvature * pair.top.length
    rest = np.array([np.sin(turn), 1.0 - np.cos(turn)]) / pair.curvature + [0.0, pair.distance]
    return rest + pair.displacement


@every
def test_a_search_among_shapes_finds_no_lower_energy(pair):
    # kinematics and strain energy only: angles as polynomials in the zone and beyond, over unit lengths
    nodes, weights = np.polynomial.legendre.leggauss(24)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    orders, L, T, k = np.arange(1, 8), pair.top.length, pair.distance, pair.curvature
    powers, slopes = nodes[:, None] ** orders, orders * nodes[:, None] ** (orders - 1)
    c = pair.lift_off[1]

    def energy(unknowns):
        zone, beyond = unknowns[:7], unknowns[7:]
        psi, kappa, end = powers @ zone, slopes @ zone / c, np.sum(zone)
        thinner = 1.0 - T * kappa
        bent = pair.bottom.stiffness * kappa**2 + pair.top.stiffness * thinner * (kappa / thinner - k) ** 2
        place = c * weights @ np.stack((np.cos(psi), np.sin(psi)), axis=1) + T * np.array([-np.sin(end), np.cos(end)])
        free, psi = L - c * weights @ thinner, end + powers @ beyond
        strain = (
            0.5 * c * weights @ bent + 0.5 * free * pair.top.stiffness * weights @ (slopes @ beyond / free - k) ** 2
        )
        tip = place + free * weights @ np.stack((np.cos(psi), np.sin(psi)), axis=1)
        return strain - _pull(pair) @ (tip - (_tip(pair) - pair.displacement))

    found = minimize(energy, np.zeros(14), method="BFGS", options={"gtol": 1e-7, "maxiter": 2000})
    assert pair.potential_energy == pytest.approx(found.fun, rel=1e-9)
    assert pair.lift_off_angle == pytest.approx(np.sum(found.x[:7]), rel=1e-4)
    # the zone ends at the right place if nothing asked for it and A's curvature is zero on both sides
    assert abs(orders @ found.x[:7]) < 1e-2 * k * c
    assert abs(found.x[7]) < 1e-2 * k * L


@every
def test_the_tip_moves_as_the_energy_falls_with_the_force(pair):
    # d(PE)/dF = −displacement along F, since PE is stationary in everything else
    step = 1e-4 * pair.force
    more, less = (replace(pair, force=pair.force + d).potential_energy for d in (step, -step))
    assert (less - more) / (2.0 * step) == pytest.approx(_pull(pair) @ pair.displacement / pair.force, rel=1e-7)


@every
def test_each_beam_is_in_balance_under_clamp_contact_and_pull(pair):
    # forces summed over the pressure itself, placed on either neutral line by the shape's own integration
    (top, bottom), (top_moment, bottom_moment) = pair.reaction, pair.reaction_moment
    assert top + pair.contact_force + _pull(pair) == pytest.approx(0.0, abs=1e-9 * pair.force)
    assert bottom - pair.contact_force == pytest.approx(0.0, abs=1e-9 * pair.force)
    sigma = np.linspace(0.0, pair.lift_off[1], 2001)
    psi, _, x, y, *_ = pair._zone.sol(sigma / pair.top.length)
    place = np.stack((x, y)) * pair.top.length
    normal = np.stack((-np.sin(psi), np.cos(psi)))
    moment = np.trapezoid(pair.pressure(sigma) * _cross(place, normal), sigma)
    moment += pair.lift_off_force * _cross(place[:, -1], normal[:, -1])
    scale = pair.force * pair.top.length
    assert bottom_moment - moment == pytest.approx(0.0, abs=1e-6 * scale)
    clamp = _cross((0.0, pair.distance), top)
    assert top_moment + clamp + moment + _cross(_tip(pair), _pull(pair)) == pytest.approx(0.0, abs=1e-6 * scale)


@every
def test_the_centre_is_the_mean_place_of_the_forces(pair):
    sigma = np.linspace(0.0, pair.lift_off[1], 2001)
    q, s = pair.pressure(sigma), pair.along_top(sigma)
    total = np.trapezoid(q, sigma) + pair.lift_off_force
    moment = np.trapezoid(q * s, sigma) + pair.lift_off_force * pair.lift_off[0]
    assert pair.contact_centre == pytest.approx(moment / total, rel=1e-6)


@every
def test_beyond_the_zone_the_beams_part(pair):
    _, kappa, x, y, _ = pair._free.sol(np.linspace(pair.lift_off[0] / pair.top.length, 1.0, 101))
    angle = pair.lift_off_angle
    place = pair._zone.y[2:4, -1]
    apart = (y - place[1]) * np.cos(angle) - (x - place[0]) * np.sin(angle)
    assert np.all(np.diff(apart) > 0.0)
    assert np.all(np.diff(kappa) > 0.0)


def test_on_a_bottom_that_does_not_bend():
    # ½ EI κ² = F sin ψ from lift-off, where ψ = κ = 0; no pressure, F itself at lift-off
    rigid = replace(PAIR, bottom=replace(PAIR.bottom, youngs_modulus=2e21))
    EI, F = rigid.top.stiffness, rigid.force
    tip = np.arcsin(EI * rigid.curvature**2 / (2.0 * F))
    # ψ = v² takes the root out of the integrand
    length = quad(lambda v: 2.0 * v / np.sqrt(2.0 * F / EI * np.sin(v * v)), 0.0, np.sqrt(tip))[0]
    assert rigid.lift_off[0] == pytest.approx(rigid.top.length - length, rel=1e-8)
    assert rigid.lift_off_force == pytest.approx(F, rel=1e-8)
    assert rigid.contact_force == pytest.approx([0.0, F], abs=1e-7 * F)
    assert rigid.rotation == pytest.approx(tip - rigid.curvature * rigid.top.length, rel=1e-8)


def test_beams_without_thickness_are_one_beam_of_both_stiffnesses():
    # ½ (EI_A + EI_B) κ² = F (sin ψ − sin ψ_c) in the zone, with EI_A alone beyond
    def slim(strip):
        return replace(strip, thickness=1e-5 * strip.thickness, youngs_modulus=1e15 * strip.youngs_modulus)

    thin = replace(PAIR, top=slim(PAIR.top), bottom=slim(PAIR.bottom))
    EI, both, F = thin.top.stiffness, thin.top.stiffness + thin.bottom.stiffness, thin.force

    def arc(angle, turn, stiffness):
        # ψ = angle + v²
        def integrand(v):
            rise = 2.0 * np.cos(angle + 0.5 * v * v) * np.sin(0.5 * v * v)
            return 2.0 * v / np.sqrt(2.0 * F / stiffness * rise)

        return quad(integrand, 0.0, np.sqrt(turn), epsabs=1e-13)[0]

    def excess(angle):
        tip = np.arcsin(np.sin(angle) + EI * thin.curvature**2 / (2.0 * F))
        return arc(angle, -angle, both) + arc(angle, tip - angle, EI) - thin.top.length

    angle = brentq(excess, -1.0, -1e-3, xtol=1e-14)
    assert thin.lift_off_angle == pytest.approx(angle, rel=1e-5)
    assert thin.lift_off[0] == pytest.approx(arc(angle, -angle, both), rel=1e-5)
    assert thin.lift_off_force == pytest.approx(F * np.cos(angle) * thin.bottom.stiffness / both, rel=1e-5)


def test_a_force_too_small_to_lay_the_beam_down_is_refused():
    with pytest.raises(ValueError, match="over a length"):
        _ = replace(PAIR, force=10.0).lift_off
    with pytest.raises(ValueError, match="pull each other"):
        _ = replace(PAIR, pull=-2.2, force=30.0).contact_force
    with pytest.raises(ValueError, match="one lift-off"):
        _ = replace(PAIR, bottom=replace(PAIR.bottom, length=0.04)).lift_off
