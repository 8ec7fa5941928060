"""The wrapped beam checked by itself: integration, balance, energy, limits, and a minimum found by search."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import NonlinearConstraint, brentq, minimize

from tests.references.elastica import cantilever_under_tip_force
from tests.references.wrapped import Wrapped

BEAM = Wrapped(length=0.0973, radius=0.0711, thickness=1.03e-3, width=9.7e-3, youngs_modulus=2.07e11, force=191.0)
SLIM = replace(BEAM, radius=0.0113)
WRAPPED = [
    replace(BEAM, force=31.0),  # just beyond the load at which the wrap begins
    BEAM,
    replace(BEAM, force=2e4),
    replace(BEAM, pull=0.3, force=3e3),
    replace(SLIM, force=900.0),
    replace(SLIM, pull=0.8 * pi, force=900.0),
    replace(SLIM, pull=1.2 * pi, force=900.0),
    replace(SLIM, pull=1.5 * pi, force=2000.0),  # wrapped round more than half of the circle
]
FREE = [replace(BEAM, force=17.0), replace(BEAM, force=29.0), replace(BEAM, pull=0.4, force=20.0)]


def _name(beam):
    return f"F={beam.force:g}, pull={beam.pull:.2f}, R={beam.neutral_radius:.3g}"


every = pytest.mark.parametrize("beam", WRAPPED + FREE, ids=_name)
wrapped = pytest.mark.parametrize("beam", WRAPPED, ids=_name)


def _cross(arm, force):
    return arm[0] * force[1] - arm[1] * force[0]


def _on_circle(beam, s):
    angle = s / beam.neutral_radius
    place = beam.neutral_radius * np.array([np.sin(angle), np.cos(angle) - 1.0])
    return place, np.array([np.sin(angle), np.cos(angle)])


def _pull(beam):
    return np.array([np.cos(beam.pull), -np.sin(beam.pull)])


def _integrated(beam, start, curvature):
    """x, y, θ, κ along the free part, θ clockwise, from the state ``start`` (s, x, y, θ) with a curvature."""
    load = beam.force / beam.stiffness

    def slope(_, z):
        return [np.cos(z[2]), -np.sin(z[2]), z[3], -load * np.sin(beam.pull - z[2])]

    s, *place = start
    return solve_ivp(slope, (s, beam.length), [*place, curvature], "DOP853", rtol=1e-13, atol=1e-13, dense_output=True)


@wrapped
def test_the_free_part_integrated_from_lift_off_ends_without_moment_at_the_tip(beam):
    c, R = beam.wrap_length, beam.neutral_radius
    assert 0.0 < c < beam.length
    place, _ = _on_circle(beam, c)
    free = _integrated(beam, (c, *place, c / R), 1.0 / R)
    x, y, theta, kappa = free.y[:, -1]
    # an error of κ at lift-off grows as cosh(√(F/EI) ℓ) towards the tip
    growth = np.cosh(np.sqrt(beam.force / beam.stiffness) * (beam.length - c))
    assert growth < 3e5
    assert abs(kappa) * R < 1e-12 * growth
    assert [x, y] == pytest.approx(beam.tip, abs=1e-12 * growth * beam.length)
    assert theta == pytest.approx(-beam.rotation, abs=1e-12 * growth)
    s = np.linspace(c, beam.length, 41)[1:]
    assert beam.curvature(s) * R == pytest.approx(-free.sol(s)[3] * R, abs=1e-12 * growth)


@wrapped
def test_the_free_part_stays_outside_the_circle_and_bends_less_than_it(beam):
    c, R = beam.wrap_length, beam.neutral_radius
    place, _ = _on_circle(beam, c)
    free = _integrated(beam, (c, *place, c / R), 1.0 / R)
    s = np.linspace(c, beam.length, 201)[1:]
    x, y, _, kappa = free.sol(s)
    assert np.all(np.hypot(x, y + R) > R)
    assert np.all(np.diff(kappa) < 0.0)
    assert beam.line_pressure >= 0.0
    assert beam.lift_off_force > 0.0


@pytest.mark.parametrize("force", [1e-3, 17.0, 29.0])
def test_without_wrap_it_is_the_cantilever_of_bisshopp_and_drucker(force):
    beam = replace(BEAM, force=force)
    assert not beam.wrapped
    tip = cantilever_under_tip_force(-force * beam.length**2 / beam.stiffness)
    assert beam.tip / beam.length == pytest.approx([tip.x, tip.y], abs=1e-10)
    assert beam.rotation == pytest.approx(tip.rotation, abs=1e-10)
    assert beam.reaction_moment == pytest.approx(force * tip.x * beam.length, rel=1e-8)


def test_an_inclined_pull_without_wrap_agrees_with_integration():
    beam = FREE[-1]
    free = _integrated(beam, (0.0, 0.0, 0.0, 0.0), beam.reaction_moment / beam.stiffness)
    x, y, theta, kappa = free.y[:, -1]
    assert [x, y] == pytest.approx(beam.tip, abs=1e-12)
    assert theta == pytest.approx(-beam.rotation, abs=1e-11)
    assert abs(kappa) * beam.length < 1e-11


@wrapped
def test_the_contact_force_and_its_centre_are_those_of_pressure_and_lift_off(beam):
    c = beam.wrap_length
    end, normal = _on_circle(beam, c)

    def integral(f):
        return quad(f, 0.0, c, epsabs=0.0, epsrel=1e-13)[0]

    pressed = [integral(lambda s, i=i: beam.line_pressure * _on_circle(beam, s)[1][i]) for i in (0, 1)]
    total = np.array(pressed) + beam.lift_off_force * normal
    assert beam.contact_force == pytest.approx(total, abs=1e-11 * beam.force)
    magnitude = beam.line_pressure * c + beam.lift_off_force
    first = beam.line_pressure * c**2 / 2.0 + beam.lift_off_force * c
    assert beam.contact_centre == pytest.approx(first / magnitude, rel=1e-12)
    moment = integral(lambda s: _cross(_on_circle(beam, s)[0], beam.line_pressure * _on_circle(beam, s)[1]))
    moment += _cross(end, beam.lift_off_force * normal) + _cross(beam.tip, beam.force * _pull(beam))
    assert moment + beam.reaction_moment == pytest.approx(0.0, abs=1e-10 * beam.force * beam.length)


@every
def test_clamp_circle_and_load_are_in_balance(beam):
    assert beam.reaction + beam.contact_force + beam.force * _pull(beam) == pytest.approx(0.0, abs=1e-12 * beam.force)


@every
def test_the_energy_falls_with_the_force_by_the_tips_displacement(beam):
    """dΠ/dF = −u·d, at rest against variations of the shape; central differences, Richardson."""

    def difference(step):
        up, down = (replace(beam, force=beam.force * (1.0 + sign * step)).potential_energy for sign in (1, -1))
        return (up - down) / (2.0 * step * beam.force)

    slope = (4.0 * difference(5e-4) - difference(1e-3)) / 3.0
    assert slope == pytest.approx(-beam.displacement @ _pull(beam), abs=1e-9 * beam.length)


@every
def test_the_strain_energy_is_the_integral_of_the_curvature(beam):
    c = beam.wrap_length
    energy = 0.5 * beam.stiffness * c / beam.neutral_radius**2
    energy += quad(lambda s: 0.5 * beam.stiffness * float(beam.curvature(s)) ** 2, c, beam.length, epsrel=1e-12)[0]
    assert beam.strain_energy == pytest.approx(energy, rel=1e-9)


def test_the_stress_is_that_of_the_circle_along_the_wrap_and_nothing_at_the_tip():
    stress = BEAM.bending_stress(81)
    s = np.linspace(0.0, BEAM.length, 81)
    on = s < BEAM.wrap_length
    assert 40 < on.sum() < 81
    circle = -0.5 * BEAM.youngs_modulus * BEAM.thickness / BEAM.neutral_radius
    assert stress[on] == pytest.approx(circle, rel=1e-14)
    assert np.all(np.diff(stress[~on]) > 0.0)
    assert stress[-1] == pytest.approx(0.0, abs=1e-12 * abs(circle))


def test_the_wrap_begins_where_the_clamps_curvature_is_the_circles():
    """By shooting: the root's curvature for which the tip has none, equal to 1/R at the closing load."""

    def root_curvature(force):
        beam = replace(BEAM, force=force)
        most = force * BEAM.length / BEAM.stiffness
        return brentq(lambda k: _integrated(beam, (0.0, 0.0, 0.0, 0.0), k).y[3, -1], 0.0, most, xtol=1e-13)

    closing = brentq(lambda force: root_curvature(force) * BEAM.neutral_radius - 1.0, 20.0, 40.0, xtol=1e-11)
    assert BEAM.closing_load == pytest.approx(closing, rel=1e-10)


def test_the_contact_takes_over_the_clamps_shear_force_at_once():
    before, after = (replace(BEAM, force=BEAM.closing_load * (1.0 + change)) for change in (-1e-9, 1e-9))
    assert np.all(before.contact_force == 0.0)
    assert after.contact_force == pytest.approx([0.0, after.force], abs=1e-6 * after.force)
    assert before.tip == pytest.approx(after.tip, abs=1e-9)
    assert before.potential_energy == pytest.approx(after.potential_energy, abs=1e-9 * after.force * after.length)
    with pytest.raises(ValueError, match="no centre"):
        _ = before.contact_centre


def test_on_a_flat_circle_the_wrap_begins_as_linear_theory_says():
    """F L = EI/R."""
    flat = replace(BEAM, radius=1e4 * BEAM.length)
    assert flat.closing_load == pytest.approx(flat.stiffness / (flat.neutral_radius * flat.length), rel=1e-7)


def test_under_a_large_force_the_tip_points_along_it_and_the_tension_lacks_the_bending_energy():
    """ϑ(L) = π/2, so F − T = EI/(2R²) whatever the force: what bends a unit of length more comes from the pull."""
    for force in (2e4, 1e5, 1e6):
        rope = replace(SLIM, force=force, pull=1.1 * pi)
        assert rope.rotation == pytest.approx(-1.1 * pi, abs=1e-7)
        assert force - rope.tension == pytest.approx(rope.stiffness / (2.0 * rope.neutral_radius**2), rel=1e-7)


@pytest.mark.parametrize(("pull", "F"), [(0.5 * pi, 12.0), (0.9, 20.0)])
def test_no_other_shape_outside_the_circle_has_less_energy(pull, F):
    """Sixty rigid links with springs, minimised from the straight beam with joints kept outside the circle."""
    n, R = 60, 0.7
    exact = Wrapped(1.0, R - 5e-4, 1e-3, 1.0, 12e9, F, pull)  # EI = 1
    assert exact.stiffness == pytest.approx(1.0)
    assert exact.wrapped
    h = 1.0 / n
    springs = np.full(n, 1.0 / h)
    springs[0] *= 2.0  # from the clamp to the middle of the first link

    def places(theta):
        return h * np.cumsum(np.cos(theta)), -h * np.cumsum(np.sin(theta))

    def energy(theta):
        turns = np.diff(theta, prepend=0.0)
        x, y = places(theta)
        moments = springs * turns
        slope = moments - np.append(moments[1:], 0.0) + F * h * np.sin(theta - pull)
        work = F * (np.cos(pull) * (x[-1] - 1.0) - np.sin(pull) * y[-1])
        return 0.5 * moments @ turns - work, slope

    def gaps(theta):
        x, y = places(theta)
        return x**2 + (y + R) ** 2 - R**2

    def gap_slopes(theta):
        x, y = places(theta)
        return 2.0 * h * np.tril(-np.outer(x, np.sin(theta)) - np.outer(y + R, np.cos(theta)))

    outside = NonlinearConstraint(gaps, 0.0, np.inf, jac=gap_slopes)
    found = minimize(
        energy, np.zeros(n), jac=True, method="SLSQP", constraints=outside, options={"maxiter": 400, "ftol": 1e-13}
    )
    assert found.success, found.message
    x, y = places(found.x)
    # the error of the links is of order h²
    assert found.fun == pytest.approx(exact.potential_energy, rel=h**2)
    assert [x[-1], y[-1]] == pytest.approx(exact.tip, abs=h**2)


@pytest.mark.parametrize(
    ("beam", "words"),
    [
        (replace(BEAM, force=0.0), "must be positive"),
        (replace(BEAM, force=-3.0), "must be positive"),
        (replace(BEAM, force=float("nan")), "must be positive"),
        (replace(BEAM, pull=0.0), "pull must lie in"),
        (replace(BEAM, pull=1.6 * pi), "pull must lie in"),
        (replace(SLIM, force=1e8), "range of floating point"),
        (replace(BEAM, pull=0.9 * pi, force=17.0), "not pressed on the circle"),
        (replace(BEAM, pull=1.2 * pi), "not pressed on the circle"),  # shorter than such a wrap
    ],
)
def test_what_is_no_wrap_from_the_clamp_on_is_refused(beam, words):
    with pytest.raises(ValueError, match=words):
        _ = beam.tip


def test_a_pull_backwards_has_no_load_at_which_the_wrap_begins():
    with pytest.raises(ValueError, match="does not begin to wrap"):
        _ = replace(SLIM, pull=0.8 * pi).closing_load
