"""Beams that are splines when free of stress: near what their points were taken from, and of both solvers' orders."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import elastica_reference
from cprbm_scene import Ending, scene_from
from cprbm_scene.curve_records import shape_of
from tests.together.bowed import RIGIDITY, cantilever, on_a_beam, on_a_circle
from tests.together.test_bowed import LENGTH, LOADS, cprbm_answer, fea_answer, values
from tests.together.test_bowed import exact as parabola


def through(n, directions=(False, False)):
    """A spline through n points of the parabola of :mod:`tests.together.bowed`, not even."""
    share = np.linspace(0.0, 1.0, n)
    y = 0.05 * (share + 0.03 * np.sin(2.0 * np.pi * share))
    curve = {"kind": "spline", "points": [[float(0.05 + 14.64 * v * v), float(v)] for v in y]}
    given = {"start_direction": [0.0, 1.0], "end_direction": [29.28 * 0.05, 1.0]}
    return curve | {name: given[name] for name, there in zip(given, directions, strict=True) if there}


def loaded(curve, name):
    load, value = LOADS[name]
    return cantilever(load, [value], curve)


def exact_answer(scene, _):
    return elastica_reference.answer(scene)


@cache
def of_five_points(name, directions=(False, False)):
    """Reference: the third solver, whose pieces end at the spline's points."""
    return values(exact_answer, loaded(through(5, directions), name), 0)


@pytest.mark.parametrize("name", ["wound", "moment"])
def test_the_third_solver_comes_near_the_parabola(name):
    """Reference: the integration of tests.references.curved over the parabola itself; order four in the points."""
    errors = []
    for n in (9, 17, 33):
        found = values(exact_answer, loaded(through(n), name), 0)
        errors.append(np.hypot(*(found["T.displacement"] - parabola(name).displacement)) / LENGTH)
    assert errors[-1] < 3e-8
    assert np.log2(errors[0] / errors[-1]) / 2.0 > 3.5


@pytest.mark.parametrize("directions", [(False, False), (True, False), (True, True)])
@pytest.mark.parametrize("name", ["opened", "wound"])
def test_orders(name, directions):
    """Points are few enough for the kinks of the curvature to lie within elements."""
    true = of_five_points(name, directions)
    for solve, counts, least, last in (
        (cprbm_answer, (20, 40, 80), 2.5, 2e-6),
        (fea_answer, (6, 12, 24, 48), 3.5, 1e-7),
    ):
        errors = []
        for n in counts:
            found = values(solve, loaded(through(5, directions), name), n)
            errors.append(
                [
                    np.hypot(*(found["T.displacement"] - true["T.displacement"])) / LENGTH,
                    abs(found["tip.rotation"][0] - true["tip.rotation"][0]),
                    abs(found["R.reaction_moment"][0] / true["R.reaction_moment"][0] - 1.0),
                ]
            )
        overall = np.log2(np.array(errors[0]) / errors[-1]) / (len(counts) - 1)
        assert np.all(overall > least)
        assert np.all(np.array(errors[-1]) < last)


def test_an_even_moment_turns_a_spline_like_any_beam():
    # reference: M ℓ/EI, with the length by many small steps
    load, value = LOADS["moment"]
    data = cantilever(load, [value], through(5))
    p = shape_of(scene_from(data).beams["beam"].curve).point(np.linspace(0.0, 1.0, 20_001))
    turned = value / RIGIDITY * np.sum(np.hypot(*np.diff(p, axis=0).T))
    for solve in (exact_answer, cprbm_answer, fea_answer):
        assert values(solve, data, 20)["tip.rotation"] == pytest.approx([turned], rel=1e-8)


@pytest.mark.parametrize("scene_of", [on_a_circle, on_a_beam])
def test_contact(scene_of):
    """Where the points are dense the spline touches like the parabola; both solvers on the spline agree."""
    data = scene_of(8.0)
    smooth = values(fea_answer, data, 80)
    data["beams"]["beam"]["curve"] = through(17)
    reference = values(fea_answer, data, 80)
    for name in ("T.displacement", "tip.rotation", "touch.force"):
        size = np.linalg.norm(smooth[name])
        assert np.linalg.norm(reference[name] - smooth[name]) < 2e-5 * size, name
        found = [values(cprbm_answer, data, n)[name] for n in (20, 40, 80, 160)]
        # reference: the finite elements, whose penetration of 1e-4 thicknesses leaves 4e-5 of the force
        assert all(np.linalg.norm(value - reference[name]) < 1e-4 * size for value in found), name
        if name != "touch.force":
            # theory: as without contact, kinks of the spline's curvature leave the third order, unevenly
            steps = [np.linalg.norm(b - a) for a, b in pairwise(found)]
            assert np.log2(steps[0] / steps[-1]) / 2.0 > 2.5, name


def test_the_third_solver_covers_contact_in_a_point():
    data = on_a_circle(2.0)
    data["beams"]["beam"]["curve"] = through(7)
    answers = [solve(scene_from(data), n) for solve, n in ((exact_answer, 0), (fea_answer, 80))]
    assert [answer.ending for answer in answers] == [Ending.COMPLETED] * 2
    one, other = (answer.stations[-1].values for answer in answers)
    for name in ("T.displacement", "touch.force"):
        assert one[name] == pytest.approx(other[name], rel=1e-4, abs=1e-7)
