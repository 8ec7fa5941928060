"""What each solver derives from a scene for itself, beside the other's, at random places.

The duplication is deliberate: a fault in a shared helper would fool both solvers alike. Here the two derivations
of geometry, stiffness and gap are held against each other, and against a third where a textbook has one.
"""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons import geometry
from cprbm.curves import neutral_line
from cprbm.feet import distance_along
from cprbm.kinematics import positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.stops import stop_of
from cprbm_scene import Arc, Line, Polynomial, Spline
from fea_reference import curves
from fea_reference.model import build
from fea_reference.projection import project
from fea_reference.section import compliance
from tests.cprbm.scenes import hinge, hinge_data
from tests.together.pivots import wheel

RANDOM = np.random.default_rng(20261121)


def random_curves():
    for _ in range(12):
        center, radius = RANDOM.normal(size=2), RANDOM.uniform(0.01, 3.0)
        angles = RANDOM.uniform(-np.pi, np.pi, 2)
        ends = [tuple(map(float, center + radius * np.array([np.cos(a), np.sin(a)]))) for a in angles]
        for direction in ("counterclockwise", "clockwise"):
            yield Arc(kind="arc", center=tuple(map(float, center)), start=ends[0], end=ends[1], direction=direction)
        yield Line(kind="line", start=ends[0], end=ends[1])
        size, degree = RANDOM.uniform(0.01, 3.0), RANDOM.integers(1, 8)
        # f/size is a polynomial of v/size with coefficients of order one
        coefficients = RANDOM.normal(size=degree + 1) * size ** (1.0 - np.arange(degree + 1))
        first = size * RANDOM.uniform(-1.0, 1.0)
        for axis, last in (("x", first + size), ("y", first - size)):
            span = float(first), float(last)
            yield Polynomial(kind="polynomial", axis=axis, coefficients=tuple(map(float, coefficients)), range=span)


def random_splines():
    random = np.random.default_rng(20261122)
    for count in (3, 3, 4, 4, 5, 6, 8, 13):
        size, steps = random.uniform(0.01, 3.0), np.cumsum(random.uniform(0.4, 1.0, count))
        places = size * np.column_stack((steps, 0.15 * random.normal(size=count))) @ random.normal(size=(2, 2))
        given = [tuple(map(float, places[k + 1] - places[k])) for k in (0, -2)]
        start, end = (direction if random.uniform() < 0.5 else None for direction in given)
        points = tuple((float(x), float(y)) for x, y in places)
        yield Spline(kind="spline", points=points, start_direction=start, end_direction=end)


@pytest.mark.parametrize("curve", [*random_curves(), *random_splines()])
def test_curves(curve):
    ours, fractions = neutral_line(curve), RANDOM.uniform(0.0, 1.0, 17)
    s = fractions * ours.length
    theirs, angle = curves.sample(curve, fractions)
    assert curves.length(curve) == pytest.approx(ours.length, rel=1e-13)
    scale = ours.length + np.hypot(*curve.start)
    assert np.stack(ours.position(s), axis=1) == pytest.approx(theirs, abs=1e-13 * scale)
    turned = ours.angle(s) - angle
    assert turned / (2.0 * np.pi) == pytest.approx(np.round(turned / (2.0 * np.pi)), abs=1e-13)
    # a third derivation: chords of many small steps
    fine = np.linspace(0.0, ours.length, 20_001)
    x, y = ours.position(fine)
    assert np.sum(np.hypot(np.diff(x), np.diff(y))) == pytest.approx(ours.length, rel=1e-7)
    assert (x[-1], y[-1]) == pytest.approx(curve.end, abs=1e-12 * scale)
    # and the harness's
    assert geometry.length(curve) == pytest.approx(ours.length, rel=1e-13)
    assert geometry.points(curve, s) == pytest.approx(theirs, abs=1e-13 * scale)
    curvature = np.diff(ours.angle(fine)) / np.diff(fine)
    assert 1.0 / geometry.radius(curve) == pytest.approx(np.max(np.abs(curvature)), rel=1e-3, abs=1e-9 / ours.length)


def test_bending_stiffness():
    for _ in range(10):
        modulus, thickness, width = RANDOM.uniform(1e8, 3e11), RANDOM.uniform(5e-4, 2.3e-3), RANDOM.uniform(1e-3, 0.02)
        data = hinge_data()
        data["materials"] = {"abs": {"youngs_modulus": modulus, "poisson_ratio": 0.3}}
        beams = {name: {**beam, "thickness": thickness, "width": width} for name, beam in data["beams"].items()}
        scene = hinge(materials=data["materials"], beams=beams)
        chain = mechanism_of(scene, cprbm.Settings(links=7)).problem.model
        ours = chain.chains[0].section.rigidity_at(np.zeros(1))[0] * chain.unit_moment * chain.unit_length
        model = build(scene, fea_reference.Settings(elements=5))
        theirs = model.beams[0].stiffest * model.units.bending
        textbook = modulus * width * thickness**3 / 12.0  # second moment of a rectangle
        assert ours == pytest.approx(textbook, rel=1e-12)
        assert theirs == pytest.approx(textbook, rel=1e-12)


def test_how_elements_of_a_varying_section_turn():
    data = hinge_data()
    for _ in range(10):
        at = [0.0, *sorted(map(float, RANDOM.uniform(0.05, 0.95, 2))), 1.0]
        sizes = {"thickness": RANDOM.uniform(2e-4, 2.3e-3, 4), "width": RANDOM.uniform(1e-3, 0.02, 4)}
        profiles = {key: {"at": at, "values": list(map(float, values))} for key, values in sizes.items()}
        contact = {**data["contacts"]["contact"], "thick": False}
        beams = {name: {**beam, **profiles} for name, beam in data["beams"].items()}
        scene = hinge(beams=beams, contacts={"contact": contact})
        beam, n = scene.beams["beam1"], 6
        material = scene.materials[beam.material]
        model = mechanism_of(scene, cprbm.Settings(links=n)).problem.model
        chain = model.chains[0]
        ours = chain.section.flexibility(chain.borders) / model.unit_moment
        length = curves.length(beam.curve)
        F = compliance(beam, material, length, n, (0.0, 0.0)).bending
        assert ours == pytest.approx(F[0, 0] - 2.0 * F[0, 1] + F[1, 1], rel=1e-13)
        # a third derivation: many small steps, each with the section of its middle
        u = (np.arange(n * 30_000) + 0.5) / (n * 30_000)
        EI = material.youngs_modulus * np.interp(u, at, sizes["width"]) * np.interp(u, at, sizes["thickness"]) ** 3 / 12
        xi = u * n % 1.0
        element = (u * n).astype(int)
        for i, j, times in ((0, 0, (1 - xi) ** 2), (0, 1, -xi * (1 - xi)), (1, 0, -xi * (1 - xi)), (1, 1, xi**2)):
            steps = np.bincount(element, weights=times / EI, minlength=n) * length / len(u)
            assert F[i, j] == pytest.approx(steps, rel=1e-6)


def test_gaps_between_the_undeformed_beams():
    scene = hinge()
    mechanism = mechanism_of(scene, cprbm.Settings(links=160))
    pair, model = mechanism.pairs["contact"], mechanism.problem.model
    state = rest_state(model)
    lines = pair.lines(state, positions(model, state))
    s = RANDOM.uniform(0.15, 0.85, 31) * pair.a.s[-1]
    ours, _, foot = distance_along(pair, lines, s)
    assert np.all(foot)

    reference = build(scene, fea_reference.Settings(elements=160))
    first, second = (reference.line(beam, reference.start) for beam in reference.beams)
    points = first.at(s / pair.a.s[-1] * first.n)[0]
    grid = np.linspace(0.0, second.n, 400)
    places = second.at(grid)[0]
    nearest = np.argmin(((points[:, :, None] - places[:, None, :]) ** 2).sum(axis=0), axis=1)
    zeta, found = project(second, points, grid[nearest])
    assert np.all(found)
    theirs = np.hypot(*(points - second.at(zeta)[0])) * reference.units.length

    # a third derivation: the distance of a point from a circle
    center, radius = np.array(scene.beams["beam2"].curve.center), 0.025
    x, y = pair.a.line.position(s * model.unit_length)
    exact = np.hypot(x - center[0], y - center[1]) - radius
    assert ours * model.unit_length == pytest.approx(exact, abs=1e-10)
    # the finite elements' places follow the arc length to third order, their gap is that of the place itself
    at = points * reference.units.length + reference.units.origin[:, None]
    assert at == pytest.approx(np.stack([x, y]), abs=1e-9)
    exact_there = np.hypot(*(at - center[:, None])) - radius
    assert theirs == pytest.approx(exact_there, abs=1e-12)


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("behind", [np.pi, -np.pi, 2.3])
def test_the_angle_at_a_stop_is_the_same_however_the_scene_is_turned(end, behind):
    # straight back it is π and never −π, of which rounding makes either; the limit is one that −π would be beyond
    expected = np.pi if abs(behind) == np.pi else -behind
    for drawn_at in np.random.default_rng(20261122).uniform(-np.pi, np.pi, 25):
        scene = wheel(behind, end, {"least": expected - 0.3}, [[0.1]], drawn_at)
        model = mechanism_of(scene, cprbm.Settings(links=4)).problem.model
        assert stop_of(scene, model, "stop").angle(rest_state(model)) == pytest.approx(expected, abs=1e-12)
        reference = build(scene, fea_reference.Settings(elements=4))
        assert reference.stops[0].angle(reference.start) == pytest.approx(expected, abs=1e-12)
