"""Curves: exact at rest, continuous to the second derivative, rigid motions, lost compliance."""

from __future__ import annotations

import numpy as np
import pytest

from cprbm.chain import add_rows, mechanism_of
from cprbm.chain.spline import lost_compliance
from cprbm.contact import Frames, beam_curve, contact_geometry
from cprbm_scene.curve_records import shape_of
from tests.cprbm.contact.workshop import at, mechanism, random_state

INNER, HELD, FREE = range(3)


def named(geometry, name):
    return next(curve for curve in geometry.curves if curve.name == name)


def test_a_beams_curve_meets_the_rest_line_at_every_joint():
    m, geometry, rest = mechanism(12)
    curve = named(geometry, "upper")
    joints = curve.arcs[1:-1]
    line = m.units.place(shape_of(m.scene.beams["upper"].curve).point(joints / curve.arcs[-1])) @ np.array([1.0, 1.0j])
    np.testing.assert_allclose(at(curve, rest, joints), line, atol=1e-13)


def test_between_joints_the_curve_is_right_to_fourth_order():
    errors = []
    for links in (20, 40):
        m, geometry, rest = mechanism(links)
        curve = named(geometry, "upper")
        s = np.linspace(0.3, 0.7, 401) * curve.arcs[-1]
        line = m.units.place(shape_of(m.scene.beams["upper"].curve).point(s / curve.arcs[-1])) @ np.array([1.0, 1.0j])
        # distance across the line: the curve's parameter is not exactly the arc length
        along = np.gradient(line)
        errors.append(np.abs(((at(curve, rest, s) - line) * np.conj(along / np.abs(along))).imag).max())
    assert errors[0] / errors[1] > 2.0**3.5


@pytest.mark.parametrize("name", ["upper", "lower"])
def test_a_beams_curve_has_a_continuous_second_derivative_in_every_state(name):
    m, geometry, rest = mechanism(11)
    curve = named(geometry, name)
    z = random_state(m, geometry, rest, 2)
    nodes = z[curve.stencil] + 1j * z[curve.stencil + 1]
    powers = np.einsum("pi,pik->pk", nodes, curve.weights) / np.diff(curve.arcs)[:, None] ** np.arange(4)
    h = np.diff(curve.arcs)
    value = sum(powers[:, k] * h**k for k in range(4))
    slope = sum(k * powers[:, k] * h ** (k - 1) for k in range(1, 4))
    bend = 2.0 * powers[:, 2] + 6.0 * powers[:, 3] * h
    np.testing.assert_allclose(value[:-1], powers[1:, 0], atol=1e-13)
    np.testing.assert_allclose(slope[:-1], powers[1:, 1], atol=1e-12)
    np.testing.assert_allclose(bend[:-1], 2.0 * powers[1:, 2], atol=1e-10)


def test_rigid_curves_move_with_their_body():
    """The nodes of a frame turned about the body's point carry a curve like the body."""
    m, _, _ = mechanism()
    frames = Frames(m)
    points = np.array([[0.1, 0.2], [0.4, 0.1], [0.3, -0.2], [0.1, 0.2]])
    curve = frames.polyline("triangle", "block", points)
    assert curve.closed
    z = np.array(m.rest)
    motion, shift = np.exp(0.7j), 0.3 - 0.2j
    for node in frames.of("block"):
        moved = (z[node] + 1j * z[node + 1]) * motion + shift
        z[node], z[node + 1] = moved.real, moved.imag
    corners = (points @ np.array([1.0, 1.0j])) * motion + shift
    np.testing.assert_allclose(at(curve, z, curve.arcs), corners, atol=1e-13)


def test_smooth_edges_are_closed_and_right_to_fourth_order():
    """A circle; the error of a cubic spline is h⁴/384 of the fourth derivative, here 1."""
    errors = []
    for pieces in (16, 32):
        m, _, _ = mechanism()
        angle = np.linspace(0.0, 2.0 * np.pi, pieces + 1)
        points = np.column_stack([np.cos(angle), np.sin(angle)])
        tangents = np.column_stack([-np.sin(angle), np.cos(angle)])
        curve = Frames(m).smooth_edge("round", "block", points, tangents, 2.0 * np.pi)
        assert curve.closed
        errors.append(np.abs(np.abs(at(curve, np.array(m.rest), np.linspace(0.0, 6.28, 997))) - 1.0).max())
    assert errors[0] / errors[1] > 2.0**3.8
    assert errors[1] == pytest.approx((2.0 * np.pi / 32.0) ** 4 / 384.0, rel=0.1)


def test_lines_have_no_thickness_and_circles_no_length():
    m, geometry, _ = mechanism()
    assert named(geometry, "contact circle").is_point
    assert named(geometry, "contact circle").half_thickness[0] == pytest.approx(0.008 / m.units.length)
    assert not beam_curve(m, "upper", thick=False).half_thickness.any()
    half = beam_curve(m, "upper", thick=True).half_thickness * m.units.length
    assert half[[0, -1]] == pytest.approx([0.0011, 0.00065])


def simple_beam_compliance(weights, places, length):
    """Compliances of bending and of shear, h = EI = GA = 1, of the chain between two pins under forces on its nodes."""
    right = weights @ places / length
    forces = -weights
    forces[0] += 1.0 - right
    forces[-1] += right
    moments = [np.sum(np.where(places < joint, (joint - places) * forces, 0.0)) for joint in places[1:-1]]
    shears = np.cumsum(forces)[:-1]
    sheared = np.sum(np.diff(places) * shears**2)
    return np.sum(np.square(moments)) + sheared / 12.0, sheared


@pytest.mark.parametrize("xi", [0.0, 0.2, 0.5, 0.9])
def test_inner_lost_compliance_does_not_depend_on_the_supports(xi):
    """A beam between two pins, by statics; the exact compliances are a² b²/(3 (a + b)) and a b/(a + b)."""
    count = 30
    m, _, _ = mechanism(count)
    curve = beam_curve(m, "lower", thick=True)
    h = curve.arcs[-1] / count
    place = 12.5 + xi
    piece = 13
    weights = np.zeros(count + 2)
    first = m.beam_nodes("lower")[0]
    np.add.at(weights, (curve.stencil[piece] - first) // 5, (curve.weights[piece] @ xi ** np.arange(4)).real)
    chain, sheared = simple_beam_compliance(weights, curve.arcs / h, float(count))
    exact = place**2 * (count - place) ** 2 / (3.0 * count)
    assert np.polyval(lost_compliance("bending")[INNER][::-1], xi) == pytest.approx(exact - chain, abs=1e-9)
    by_shear = place * (count - place) / count - sheared
    assert np.polyval(lost_compliance("shear")[INNER][::-1], xi) == pytest.approx(by_shear, abs=1e-9)
    # stored with h³/EI; the unit of EI is the largest EI of the upper beam
    stiffer = (2.2 / 2.1) ** 3
    assert np.polyval(curve.lost[piece][::-1], xi) == pytest.approx((exact - chain) * h**3 * stiffer, rel=1e-6)


def test_half_links_lose_nothing_at_a_joint_and_little_at_a_free_end():
    held, free = lost_compliance("bending")[[HELD, FREE]]
    assert abs(held[0]) < 1e-5
    assert np.polyval(held[::-1], 1.0) == pytest.approx(2e-5, abs=1e-5)
    assert np.polyval(free[::-1], 1.0) == pytest.approx(
        np.polyval(lost_compliance("bending")[INNER][::-1], 0.0), rel=0.02
    )


def test_the_plain_chain_touches_by_its_polygon():
    m, _, _ = mechanism()
    plain = mechanism_of(m.scene, dict.fromkeys(m.chains, 9), "bending", corrected=False)
    add_rows(plain)
    geometry = contact_geometry(plain)
    curve = named(geometry, "upper")
    z = np.array(plain.rest)
    nodes = z[plain.beam_nodes("upper")] + 1j * z[plain.beam_nodes("upper") + 1]
    middle = 0.5 * (curve.arcs[:-1] + curve.arcs[1:])
    np.testing.assert_allclose(at(curve, z, middle), 0.5 * (nodes[:-1] + nodes[1:]), atol=1e-14)
    assert not curve.lost.any()
