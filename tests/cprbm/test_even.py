"""Errors that fall evenly with N: N² times the error is the same from each number of links to the next.

Limits are Richardson's, from 80 and 160 links; that the order is two is part of what is tested.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
from cprbm.kinematics import State, positions, rest_state
from cprbm.kinks import kinks_at, missed
from cprbm.model import NO_KINKS, Kinks, build
from cprbm.smooth import smooth_line
from cprbm_scene import read
from tests.cprbm.scenes import cantilever, force

CASES = Path(__file__).parents[2] / "comparisons" / "cases"
CONSECUTIVE = range(37, 48)
COARSER, FINER = 80, 160


def families(case, *stations):
    """A built-in case at some stations: for each, by the number of links, values by probe."""
    scene = read(CASES / f"{case}.toml")
    stage = scene.stages[0].model_copy(update={"stations": stations})
    scene = scene.model_copy(update={"stages": (stage,)})
    found = {}
    for links in (*CONSECUTIVE, COARSER, FINER):
        answer = cprbm.answer(scene, cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        found[links] = [station.values for station in answer.stations]
    return [{links: values[i] for links, values in found.items()} for i in range(len(stations))]


def scaled(found, probe):
    """N² times the error's norm for all N in CONSECUTIVE, and for COARSER."""
    coarse, fine = found[COARSER][probe], found[FINER][probe]
    limit = fine + (fine - coarse) / 3.0
    errors = [n**2 * np.linalg.norm(found[n][probe] - limit) for n in (*CONSECUTIVE, COARSER)]
    return np.array(errors[:-1]), errors[-1]


@pytest.fixture(scope="module")
def gripper():
    """Just after beam 2 has left the clamp on the circle; and on the circle and beam 1 in points anywhere."""
    return families("gripper", 6.4, 12.8)


@pytest.mark.parametrize(
    ("probe", "part"),
    [
        ("A.displacement", 0.03),
        ("B.displacement", 0.03),
        ("scene.potential_energy", 0.02),
        ("circle.force", 0.06),
        ("C.reaction", 0.06),
        ("contact.closing_load", 0.03),
        ("contact.centre", 0.12),
        ("circle.centre", 0.2),
    ],
)
def test_the_error_is_even_where_contacts_are_in_points(gripper, probe, part):
    errors, finer = scaled(gripper[1], probe)
    assert np.max(np.abs(errors / errors.mean() - 1.0)) < part
    assert finer == pytest.approx(errors.mean(), rel=part)


def test_the_error_is_even_just_after_a_contact_has_left_the_clamp(gripper):
    # even elements, of which there are two before the place, take it for a wrap that goes on from the clamp
    errors, finer = scaled(gripper[0], "A.displacement")
    assert np.max(np.abs(errors / errors.mean() - 1.0)) < 0.1
    assert finer == pytest.approx(errors.mean(), rel=0.1)
    forces, finer = scaled(gripper[0], "circle.force")
    assert np.max(np.abs(forces / forces.mean() - 1.0)) < 0.5
    assert finer == pytest.approx(forces.mean(), rel=0.5)


@pytest.mark.parametrize(
    ("probe", "part"),
    [("T.displacement", 0.05), ("tip.rotation", 0.05), ("contact.centre", 0.15), ("scene.potential_energy", 0.01)],
)
def test_the_error_is_even_on_a_wrap(wrapped, probe, part):
    errors, finer = scaled(wrapped, probe)
    assert np.max(np.abs(errors / errors.mean() - 1.0)) < part
    assert finer == pytest.approx(errors.mean(), rel=part)


@pytest.fixture(scope="module")
def wrapped():
    return families("wrapped", 137.0)[0]


@pytest.fixture(scope="module")
def pressed():
    return families("hinge", 0.67)[0]


@pytest.mark.parametrize(
    ("case", "probe"),
    [
        ("pressed", "beam1.bending_stress"),
        ("pressed", "beam2.bending_stress"),
        ("wrapped", "beam.bending_stress"),
    ],
)
def test_the_error_of_the_stress_is_even_at_each_place(case, probe, request):
    # wherever in their elements the place, the contact and the ends of the zone lie
    found = request.getfixturevalue(case)
    coarse, fine = found[COARSER][probe], found[FINER][probe]
    limit = fine + (fine - coarse) / 3.0
    errors = np.array([n**2 * (found[n][probe] - limit) for n in (*CONSECUTIVE, COARSER)])
    assert np.max(np.ptp(errors, axis=0)) < 0.12 * np.max(np.abs(limit))


def bent_by_two_moments(places, place, p, q, kappa):
    """Angles of links and true tangents at ``places`` of a beam whose curvature is a broken line with its corner."""

    def angle(s):
        off = s - place
        return kappa * off + 0.5 * np.where(off < 0.0, p, q) * off**2

    return angle(places)


def at_rest(model, s):
    """Points of a model's only beam at arc lengths ``s`` (k,)."""
    state = rest_state(model)
    return smooth_line(model.chains[0], model.unit_length, state, positions(model, state)).at(s)


@pytest.mark.parametrize("part", [0.0, 0.2, 0.5, 0.9])
def test_what_is_missed_of_the_tangent_is_what_a_broken_line_of_curvature_says(part):
    # the reference is the integral of that line, exact at the elements' borders, less its mean over all places
    # that the corner may have, by Gauss's rule of three points
    model = build(cantilever(force(0.0, -1.0), [1.0]), cprbm.Settings(links=10))
    (chain,) = model.chains
    place, p, q, kappa = chain.borders[5] + part * chain.sizes[5], 2.3, -1.7, 0.9
    theta = bent_by_two_moments(chain.borders, place, p, q, kappa)
    kinks = kinks_at(chain, State(chain.rest + theta, np.zeros((1, 3))), np.array([place]))
    assert kinks.before == pytest.approx([p])
    assert kinks.behind == pytest.approx([q])

    def beyond(part):
        corner = chain.borders[5] + part * chain.sizes[5]
        first, last = bent_by_two_moments(chain.borders[5:7], corner, p, q, kappa)
        return bent_by_two_moments(corner, corner, p, q, kappa) - (first + part * (last - first))

    mean = np.mean(
        [beyond(part) for part in (0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15))] * np.array([5.0, 8.0, 5.0]) / 6.0
    )
    assert missed(chain, kinks, at_rest(model, np.array([place]))).angle == pytest.approx(
        [beyond(part) - mean], abs=1e-14
    )


def test_bend_and_integral_of_what_is_missed_are_its_own():
    # central differences, in the pressed element and in those beside it
    model = build(cantilever(force(0.0, -1.0), [1.0]), cprbm.Settings(links=10))
    (chain,) = model.chains
    kinks = Kinks(np.array([0.537]), np.array([2.3]), np.array([-1.7]))
    s, step = np.array([0.43, 0.49, 0.51, 0.56, 0.62, 0.68]), 1e-6
    more, less, here = (missed(chain, kinks, at_rest(model, s + d)) for d in (step, -step, 0.0))
    assert (more.angle - less.angle) / (2.0 * step) == pytest.approx(here.bend, abs=1e-8)
    assert (more.integral - less.integral) / (2.0 * step) == pytest.approx(here.angle, abs=1e-8)
    far = missed(chain, kinks, at_rest(model, np.array([0.15, 0.85])))
    assert not np.any(far.angle)


def test_the_largest_slope_is_that_of_the_kinks_themselves():
    # by which it is told whether others are the same: under a small load all are small
    assert Kinks(np.array([0.3, 0.7]), np.array([2e-7, -7e-7]), np.array([5e-7, 1e-7])).largest == 7e-7
    assert NO_KINKS.largest == 0.0
