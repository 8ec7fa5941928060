"""The nearest place of a rigid curve against its samples, and what elements of a thin-ending beam yield."""

import numpy as np
import pytest
from numpy.polynomial import polynomial

import cprbm
from cprbm.faces import Graph
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import cantilever_data, force


@pytest.mark.parametrize("swapped", [False, True])
def test_a_curve_is_seen_from_its_nearest_place(swapped):
    # reference: the least of 400001 distances; between two of them it is less by h²/8ρ, 1e-10 at ρ = 0.03
    coefficients, low, high = (0.13, -0.31, 1.7, 0.9, -2.3), -1.13, 0.97
    graph = Graph(coefficients, low, high, 1.0, swapped, (0.0, 0.0))
    v = np.linspace(low, high, 400001)
    w = polynomial.polyval(v, coefficients)
    random = np.random.default_rng(17)
    q = np.stack((random.uniform(-1.0, 0.8, 60), random.uniform(-1.0, 1.5, 60)), axis=1)
    nearest = np.array([np.min(np.hypot(v - x, w - y)) for x, y in q])
    seen = graph.seen(q[:, ::-1] if swapped else q)
    assert np.count_nonzero(seen.within) > 40  # the others are beside the curve's ends
    assert np.abs(seen.distance)[seen.within] == pytest.approx(nearest[seen.within], abs=1e-8)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_distance_from_a_curve_bends_as_that_of_its_parallel(side, swapped):
    # reference: second differences of the distance itself, across the normal
    graph = Graph((0.13, -0.31, 1.7, 0.9, -2.3), -1.13, 0.97, side, swapped, (0.21, -0.07))
    v = np.linspace(-0.9, 0.8, 31)
    height = np.where(np.arange(31) % 2, 0.031, -0.017)
    q = np.stack((v, polynomial.polyval(v, graph.coefficients) + height), axis=1) - np.array(graph.origin)
    q = q[:, ::-1] if swapped else q
    seen, step = graph.seen(q), 1e-4
    tau = np.stack((-seen.normal[:, 1], seen.normal[:, 0]), axis=1)
    ahead, behind = (graph.seen(q + sign * step * tau).distance for sign in (1.0, -1.0))
    assert np.all(seen.within)
    assert seen.bend == pytest.approx((ahead - 2.0 * seen.distance + behind) / step**2, rel=1e-4, abs=1e-5)


@pytest.mark.parametrize("thinner", [1.7, 7.3, 61.0])
@pytest.mark.parametrize("links", [2, 5])
def test_elements_of_a_beam_that_thins_yield_as_their_integral(thinner, links):
    # closed form for t linear from t₀ to t₁: ∫ (t₀/t)³ ds = L t₀ (t₀ + t₁)/2 t₁²
    data = cantilever_data(force(0.0, 1.0), [1.0])
    t0 = 0.00113
    t1 = t0 / thinner
    data["beams"]["beam"]["thickness"] = {"at": [0.0, 1.0], "values": [t0, t1]}
    (chain,) = mechanism_of(scene_from(data), cprbm.Settings(links=links)).problem.model.chains
    section = chain.section
    yielding = float(section.flexibility(chain.borders).sum() * section.rigidity_at(np.zeros(1))[0])
    assert chain.borders[-1] == pytest.approx(1.0, rel=1e-14)  # the longest beam is the unit
    assert yielding == pytest.approx(t0 * (t0 + t1) / (2.0 * t1**2), rel=1e-6)
