"""The nearest place of a graph, held against the roots of the cubic that it is of a parabola."""

from decimal import Decimal, localcontext

import numpy as np
import pytest

from cprbm_scene import FunctionContact
from fea_reference.outline import Broken, HalfPlane, outline_of

COEFFICIENTS = (0.013, -0.31, 0.83)
SPAN = (-0.27, 0.61)


def by_roots(v, w):
    """Distance from the parabola of a place (v, w) above it, nearest place and curvature 1/R there."""
    c, b, a = COEFFICIENTS
    f = np.polynomial.Polynomial(COEFFICIENTS)
    # 0 = (x - v) + (f - w) f', a cubic
    cubic = [2.0 * a**2, 3.0 * a * b, 1.0 + b**2 + 2.0 * a * (c - w), b * (c - w) - v]
    roots = np.roots(cubic)
    real = roots.real[np.abs(roots.imag) < 1e-9]
    inside = real[(real > SPAN[0]) & (real < SPAN[1])]
    distances = np.hypot(inside - v, f(inside) - w)
    x = inside[distances.argmin()]
    return distances.min(), x, 2.0 * a / (1.0 + (b + 2.0 * a * x) ** 2) ** 1.5


@pytest.mark.parametrize("axis", ["x", "y"])
def test_the_nearest_place_of_a_parabola(axis):
    contact = FunctionContact(
        kind="beam-function", beam="b", body="g", axis=axis, coefficients=COEFFICIENTS, range=SPAN, side="above"
    )
    origin, unit = np.array([0.07, -0.11]), 0.37
    outline = outline_of(contact, origin, unit)
    rng = np.random.default_rng(11)
    v, above = rng.uniform(-0.1, 0.4, 83), rng.uniform(-0.05, 0.3, 83)
    w = np.polynomial.Polynomial(COEFFICIENTS)(v) + above
    y = np.stack([v, w] if axis == "x" else [w, v])
    near = outline.near((y - origin[:, None]) / unit)
    for i in range(v.size):
        distance, x, kappa = by_roots(v[i], w[i])
        d = np.sign(above[i]) * distance / unit
        away = np.array([v[i] - x, w[i] - np.polynomial.Polynomial(COEFFICIENTS)(x)]) / (d * unit)
        curved = -kappa * unit  # it bends towards the free side
        assert near.distance[i] == pytest.approx(d, rel=1e-12, abs=1e-13)
        assert near.normal[:, i] == pytest.approx(away if axis == "x" else away[::-1], abs=1e-9)
        assert near.bend[i] == pytest.approx(curved / (1.0 + curved * d), rel=1e-9)
    assert not near.corner.any()


def test_sides_that_meet_behind_an_edge_are_those_of_a_block():
    """An edge of two pieces is the same as a line round all of what is rigid behind it."""
    a, b, c = np.array([[-0.41, -1.01], [-0.44, -0.33], [0.37, -0.36]])
    # straight back from a and c, at right angles to the pieces there
    fourth = np.linalg.solve(np.stack([b - a, c - b]), [(b - a) @ a, (c - b) @ c])
    edge, block = Broken(np.stack([a, b, c], axis=1)), Broken(np.stack([a, b, c, fourth, a], axis=1))
    places = np.random.default_rng(3).uniform(-1.7, 1.7, (2, 977))
    found, expected = edge.near(places), block.near(places)
    assert (expected.distance < 0.0).any()
    assert found.distance == pytest.approx(expected.distance, abs=1e-12)
    assert found.normal == pytest.approx(expected.normal, abs=1e-12)
    assert found.bend == pytest.approx(expected.bend, rel=1e-9, abs=1e-12)
    assert edge.corners.points[:, -1] == pytest.approx(fourth, rel=1e-12)
    assert edge.corners.convex.all()


def test_a_side_ends_where_it_comes_to_the_edge_from_behind():
    """A hook: beyond its long piece, whose other face is free, the side behind its short end is no obstacle."""
    edge = Broken(np.array([[0.0, 0.3, 0.3, 0.1], [0.0, 0.0, 0.9, 0.9]])[:, ::-1])
    # straight back from (0.1, 0.9), downwards, it comes to the first piece at (0.1, 0)
    beyond = edge.near(np.array([[0.1, 0.14, 0.07], [-0.5, -0.7, -0.61]]))
    assert np.abs(beyond.distance) == pytest.approx([0.5, 0.7, 0.61])


@pytest.mark.parametrize("axis", ["x", "y"])
def test_beyond_its_ends_a_graph_goes_straight_back(axis):
    """Behind the edge and beside it its end is as far as that face; in front of it as far as the corner."""
    contact = FunctionContact(
        kind="beam-function", beam="b", body="g", axis=axis, coefficients=COEFFICIENTS, range=SPAN, side="above"
    )
    outline = outline_of(contact, np.zeros(2), 0.37)
    f, beyond = np.polynomial.Polynomial(COEFFICIENTS), 0.023
    for v, outwards in zip(SPAN, (-1.0, 1.0), strict=True):
        tangent = outwards * np.array([1.0, f.deriv()(v)]) / np.hypot(1.0, f.deriv()(v))
        up = outwards * np.array([-tangent[1], tangent[0]])
        end = np.array([v, f(v)]) + beyond * tangent
        y = np.stack([end - 0.031 * up, end + 0.031 * up], axis=1)
        near = outline.near((y if axis == "x" else y[::-1]) / 0.37)
        assert near.distance * 0.37 == pytest.approx([beyond, np.hypot(beyond, 0.031)], rel=1e-12)
        assert near.normal[:, 0] == pytest.approx(tangent if axis == "x" else tangent[::-1], abs=1e-12)
        assert near.bend[0] == 0.0
        assert near.corner.tolist() == [False, True]


@pytest.mark.parametrize("edge", ["a half-plane", "a side", "a corner"])
def test_a_distance_far_along_an_edge_has_all_its_digits(edge):
    """Against decimals of fifty digits, of places in two parts; a place in one is a hundred times as coarse."""
    direction = np.array([0.96, 0.28])
    normal = np.array([-direction[1], direction[0]])
    ends = np.stack([(1.7 if edge == "a corner" else -0.3) * direction, 2.9 * direction], axis=1)
    outline = HalfPlane(ends[:, 0], normal) if edge == "a half-plane" else Broken(ends)
    rng = np.random.default_rng(5)
    along = rng.uniform(1.2, 1.6, 71)
    y = along * direction[:, None] + 0.0037 * normal[:, None]
    if edge == "a corner":
        y = ends[:, :1] + 0.0037 * np.array([np.cos(along + 1.0), np.sin(along + 1.0)])
    rest = rng.uniform(-1.0, 1.0, y.shape) * 1e-16
    found = outline.exact_distance(y, rest, outline.near(y))
    with localcontext() as context:
        context.prec = 50
        for i in range(along.size):
            n = outline.near(y[:, i : i + 1]).normal[:, 0]
            place = [Decimal(float(a)) + Decimal(float(b)) for a, b in zip(y[:, i], rest[:, i], strict=True)]
            away = [at - Decimal(float(b)) for at, b in zip(place, ends[:, 0], strict=True)]
            across = sum((Decimal(float(a)) * b for a, b in zip(n, away, strict=True)), Decimal(0))
            expected = (away[0] ** 2 + away[1] ** 2).sqrt() if edge == "a corner" else across
            assert abs(float(Decimal(float(found[i])) - expected)) < 3e-18
