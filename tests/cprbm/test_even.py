"""What even elements miss of the tangent at a place that presses, in the chain of second order."""

import numpy as np
import pytest

import cprbm
from cprbm.kinematics import State, positions, rest_state
from cprbm.kinks import kinks_at, missed
from cprbm.model import NO_KINKS, Kinks, build
from cprbm.smooth import smooth_line
from tests.cprbm.scenes import cantilever, force


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
