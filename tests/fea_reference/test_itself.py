"""A beam that meets itself, against exact references, a rigid wall in the mirror's place, and differences."""

from dataclasses import replace

import numpy as np
import pytest

from cprbm_scene import Ending
from fea_reference import Settings, answer
from fea_reference.contact import self_contacts, touch
from fea_reference.contacts import passed_through, with_current_sides, zones_of
from fea_reference.crossing import crosses_itself, lines_cross
from fea_reference.edge import Edge
from fea_reference.facing import Tapers
from fea_reference.hermite import NeutralLine
from fea_reference.itself import survey_self, without_known_sides
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from fea_reference.zones import no_zones
from tests.fea_reference.differences import check
from tests.fea_reference.meeting_itself import (
    AT,
    BETA,
    HALF,
    LENGTH,
    SHARES,
    START,
    WIDTH,
    YOUNG,
    arch,
    strip,
)
from tests.references import neck, rolled

T_ARCH, T_STRIP = 0.002, 0.0012


def solved(scene, elements=40, **settings):
    found = answer(scene, Settings(elements=elements, kinematics="bending", penetration=1e-6, **settings))
    assert found.ending is Ending.COMPLETED, found.sentence
    return found


@pytest.mark.parametrize("thick", [True, False])
def test_a_neck_that_closes(thick):
    """Reference: tests.references.neck; 40 elements of order four, the penalty's error besides."""
    T = T_ARCH / HALF if thick else 0.0
    EI = YOUNG * WIDTH * T_ARCH**3 / 12.0
    force, energy = EI / HALF**2, EI / HALF
    touched = neck.first_touch(BETA, T, 0.14, 0.24)
    found = solved(arch(T_ARCH, [0.02, 0.0115, 0.0095], thick=thick))
    before, *closed = found.stations
    open_ = neck.opened(BETA, 0.2)
    assert before.values["neck.force"] == 0.0
    assert before.values["B.reaction"] == pytest.approx([-open_.push * force, 0.0], rel=1e-5, abs=1e-6 * force)
    assert found.events[0].value == pytest.approx(2.0 * (START - touched.clamp * HALF), rel=1e-5)
    for station, clamp in zip(closed, (0.115, 0.095), strict=True):
        exact = neck.closed(BETA, T, touched, clamp)
        values = station.values
        assert values["neck.force"] == pytest.approx(exact.force * force, rel=5e-3)
        assert values["B.reaction"] == pytest.approx([-exact.push * force, 0.0], rel=3e-3, abs=1e-6 * force)
        assert values["A.reaction"] == pytest.approx(-values["B.reaction"], abs=1e-6 * force)
        assert values["A.reaction_moment"] == pytest.approx(-exact.moment * energy, rel=2e-3)
        assert values["scene.potential_energy"] == pytest.approx(2.0 * exact.energy * energy, rel=1e-4)
        # the smaller of both arc lengths; a contact in a point has both ends there
        assert values["neck.centre"] == pytest.approx(exact.place * HALF, abs=1e-3 * HALF)
        assert values["neck.ends"] == pytest.approx([exact.place * HALF] * 2, abs=1e-3 * HALF)
        (places,) = station.touching.values()
        assert np.abs(places[:, 0] + 0.5 * station.value).max() < 1e-6 * HALF  # on the mirror


def test_the_necks_force_converges():
    """Reference: tests.references.neck.

    Within an element the force acts somewhere, and makes a jump of the third derivative there: an error of third order
    in the element's length, uneven as the place in its element is.
    """
    T = T_ARCH / HALF
    exact = neck.closed(BETA, T, neck.first_touch(BETA, T, 0.14, 0.24), 0.09)
    scale = YOUNG * WIDTH * T_ARCH**3 / 12.0 / HALF**2
    for elements in (20, 40):
        force = solved(arch(T_ARCH, [0.009], thick=True), elements).stations[-1].values["neck.force"][0]
        assert force == pytest.approx(exact.force * scale, rel=0.03 * (20.0 / elements) ** 3)


@pytest.mark.parametrize(("thick", "backwards"), [(True, False), (False, True)])
def test_a_strip_that_is_rolled(thick, backwards):
    """Reference: tests.references.rolled. As a line its sides are told by the states before alone."""
    exact = rolled.Strip(AT, SHARES, T_STRIP / LENGTH if thick else 0.0)
    EI = YOUNG * WIDTH * T_STRIP**3 / 12.0
    touched = rolled.first_touch(exact, rolled.free(exact, 7.0).moment, 0.09, 0.976)
    found = solved(strip(T_STRIP, [6.5, 7.4, 8.2], thick=thick, backwards=backwards))
    assert found.events[0].value == pytest.approx(touched.rotation, rel=2e-5)
    for station in found.stations:
        values, rotation = station.values, station.value
        at = rolled.free(exact, rotation) if rotation < touched.rotation else rolled.touching(exact, touched, rotation)
        assert values["tip.reaction_moment"] == pytest.approx(at.moment * EI / LENGTH, rel=1e-6)
        assert values["C.reaction_moment"] == pytest.approx(-at.moment * EI / LENGTH, rel=1e-6)
        assert values["C.reaction"] == pytest.approx([0.0, 0.0], abs=1e-9 * EI / LENGTH**2)
        assert values["T.displacement"] == pytest.approx((at.tip - [1.0, 0.0]) * LENGTH, abs=2e-5 * LENGTH)
        assert values["scene.potential_energy"] == pytest.approx(at.energy * EI / LENGTH, rel=1e-6)
        assert values["lap.force"] == pytest.approx(at.force * EI / LENGTH**2, rel=1e-3)
        if at.force > 0.0:
            place = (1.0 - at.inner if backwards else at.outer) * LENGTH
            assert values["lap.centre"] == pytest.approx(place, abs=2e-4 * LENGTH)


@pytest.mark.parametrize("backwards", [False, True])
def test_an_end_that_meets_its_beam(backwards):
    """Reference: tests.references.rolled, where the strip's own end touches."""
    shares = (1.0, 0.6, 0.7, 0.3)
    exact = rolled.Strip(AT, shares, T_STRIP / LENGTH)
    EI = YOUNG * WIDTH * T_STRIP**3 / 12.0
    found = solved(strip(T_STRIP, [6.3, 6.5], shares=shares, backwards=backwards))
    at = rolled.tip_touching(exact, 6.5, 0.1, 0.05)
    before, after = (station.values for station in found.stations)
    assert before["lap.force"] == 0.0
    assert after["lap.force"] == pytest.approx(at.force * EI / LENGTH**2, rel=1e-3)
    assert after["lap.centre"] == pytest.approx((0.0 if backwards else at.outer) * LENGTH, abs=1e-4 * LENGTH)
    assert after["tip.reaction_moment"] == pytest.approx(at.moment * EI / LENGTH, rel=1e-6)


def test_a_thin_strip_in_one_station():
    """Reference: tests.references.rolled, with a thickness of a thousandth of what the end moves by."""
    t = 3e-5
    exact = rolled.Strip(AT, SHARES, t / LENGTH)
    touched = rolled.first_touch(exact, rolled.free(exact, 7.1).moment, 0.096, 0.9756)
    at = rolled.touching(exact, touched, 8.2)
    (station,) = solved(strip(t, [8.2])).stations
    assert station.values["lap.force"] == pytest.approx(at.force * YOUNG * WIDTH * t**3 / 12.0 / LENGTH**2, rel=1e-3)


def closed_arch(kinematics, elements=14):
    """The arch's model shaped like a neck, every unknown disturbed, and its contact, so thick that it overlaps."""
    scene = arch(T_ARCH, [0.02], thick=True)
    model = build(scene, Settings(elements=elements, kinematics=kinematics))
    drawn = solved(scene, elements).stations[-1].shapes["strip"]
    x, y = (np.stack([drawn.x, drawn.y]) - model.units.origin[:, None]) / model.units.length
    rng = np.random.default_rng(5)
    z = model.start.values.copy()
    z[model.node_dofs] = np.stack([x, y, tangents(x, y)]) + 0.003 * rng.standard_normal((3, x.size))
    z[model.element_dofs[6]] = rng.standard_normal(model.element_dofs.shape[1])
    (pair,) = self_contacts(scene, model)
    least = zones_of(model, pair, State.of(z)).least
    assert least > 0.0
    return model, replace(pair, distance=pair.distance + least + 0.01), z


def tangents(x, y):
    """Angles of the tangents of a line through even points, about."""
    return np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))


@pytest.mark.parametrize("kinematics", ["bending", "shear"])
def test_the_contacts_derivatives(kinematics):
    """Gradient and tangent of ½ ε ∫ ⟨−g⟩² ds; both places are of one beam."""
    model, pair, z = closed_arch(kinematics)

    def gathered(z):
        one = touch(model, pair, Penalty(1.0), 12, State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        return 0.5 * float((one.stiffness * one.gap**2).sum()), gradient, hessian

    value, gradient, hessian = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    # a translation and a rotation about the origin change no gap: the forces are in balance, and so are the moments
    x, y, _ = z[model.node_dofs]
    turn = np.zeros(model.size)
    turn[model.node_dofs] = np.stack([-y, x, np.ones_like(x)])
    for way in (0, 1):
        assert gradient[model.node_dofs[way]].sum() == pytest.approx(0.0, abs=1e-10 * np.abs(gradient).max())
    assert gradient @ turn == pytest.approx(0.0, abs=1e-10 * np.abs(gradient).max())
    check(model, gathered, z, times=4, rel=1e-5, tangent=1e-4)


def curve(x, y, angle):
    lengths = np.full(x.size - 1, float(np.hypot(np.diff(x), np.diff(y)).mean()))
    nothing = np.zeros(x.size - 1)
    return NeutralLine.through(np.stack([x, y]), angle, lengths, np.zeros((2, x.size)), nothing, nothing)


def spiral(pitch, nodes):
    """Two turns of an Archimedean spiral of radius about one."""
    phi = np.linspace(0.0, 4.0 * np.pi, nodes)
    r = 1.0 - pitch * phi / (2.0 * np.pi)
    x, y = r * np.cos(phi), r * np.sin(phi)
    slope = -pitch / (2.0 * np.pi)
    return curve(x, y, phi + np.arctan2(r, slope))


def test_which_lines_cross_themselves():
    """Laps much nearer than the chords of elements bow do not; a loop of a wire does."""
    near = spiral(0.02, 26)
    assert lines_cross(near, near)  # the chords do
    assert not crosses_itself(near, no_zones(0.0))
    t = np.linspace(-1.3, 1.3, 25)  # the cubic t ↦ (t² − 1, t (t² − 1)) crosses itself at the origin
    assert crosses_itself(
        curve(t**2 - 1.0, t * (t**2 - 1.0), np.unwrap(np.arctan2(3.0 * t**2 - 1.0, 2.0 * t))), no_zones(0.0)
    )


def test_a_beam_that_has_passed_through_itself_is_seen():
    """A neck whose halves have changed places: no gap says so, and the state is refused all the same."""
    scene = arch(T_ARCH, [0.02, 0.0118], thick=True)
    model = build(scene, Settings(elements=40))
    drawn = solved(scene).stations[-1].shapes["strip"]
    x, y = (np.stack([drawn.x, drawn.y]) - model.units.origin[:, None]) / model.units.length
    (pair,) = self_contacts(scene, model)

    def state(x):
        z = model.start.values.copy()
        z[model.node_dofs] = np.stack([x, y, tangents(x, y)])
        return State.of(z)

    before = state(x)
    pair = with_current_sides(model, pair, before)
    assert not passed_through(model, pair, model.start, before)
    middle, share = x.mean(), np.linspace(-1.0, 1.0, x.size)
    after = state(x - 0.12 * np.sign(x - middle) * (1.0 - share**2) * (np.abs(share) > 0.3))
    # what lies on the other side than before is as deep as it has passed, and no equilibrium is certified with that
    assert zones_of(model, pair, after).least < -pair.distance
    # where nothing is known of the sides, chords tell
    assert passed_through(
        model, replace(pair, distance=0.0, roles=without_known_sides(later=True, ended=False)), before, after
    )


def test_neighbours_never_touch():
    """A bend much tighter than the thickness is not one that touches itself."""
    scene = arch(T_ARCH, [0.09], thick=True)
    model = build(scene, Settings(elements=40))
    (pair,) = self_contacts(scene, model)
    thick = replace(pair, distance=0.5)
    assert zones_of(model, thick, model.start).least > 0.0


def test_a_place_across_from_an_end_that_leans_is_looked_at():
    """A strip that grows thicker runs out and back, past above its start: its edge leans, and so does the way across.

    By n·x_m' = T' the last place that faces the start is twice the bend's radius times tan(asin T') beyond it.
    """
    n, bend = 37, 0.15
    s = np.linspace(0.0, 2.05 + np.pi * bend, n + 1)
    turned = np.clip((s - 1.0) / bend, 0.0, np.pi)
    back = 1.0 - (s - 1.0 - np.pi * bend)
    x = np.where(s < 1.0, s, np.where(turned < np.pi, 1.0 + bend * np.sin(turned), back))
    line = curve(x, bend * (1.0 - np.cos(turned)), turned)
    edge = Edge((0.0, float(n)), (0.05, 0.15))
    survey = survey_self(line, without_known_sides(later=True, ended=False), 0.2, Tapers(edge, edge))
    last = float(line.at(survey.zeta[-1:])[0][0, 0])
    assert last == pytest.approx(-2.0 * bend * np.tan(np.arcsin(0.1 / line.lengths.sum())), rel=1e-2)
    assert survey.there.zeta_m[-1] == pytest.approx(0.0, abs=1e-9)
