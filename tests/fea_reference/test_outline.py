"""The nearest place of a graph, held against the roots of the cubic that it is of a parabola."""

import numpy as np
import pytest

from fea_reference.outline import outline_of
from scene.statement import FunctionContact

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
