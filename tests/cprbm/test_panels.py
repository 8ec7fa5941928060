"""Arc length along a line and back, against integrals that are known."""

import numpy as np

from cprbm.panels import Panels, panelled


def parabola(v):
    return np.hypot(1.0, 2.0 * v)


def arc_length(v):
    # ∫ √(1 + 4v²) dv
    return 0.5 * v * np.hypot(1.0, 2.0 * v) + 0.25 * np.arcsinh(2.0 * v)


def test_the_variable_of_an_arc_length_is_exact_with_cubics_and_with_newtons_method():
    fine = panelled(parabola, np.linspace(0.0, 3.0, 65))
    assert fine.fine
    coarse = Panels(fine.v[::128], fine.s[::128], fine.slope[::128], parabola, fine=False)
    v = np.linspace(0.0, 3.0, 997)
    for panels in (fine, coarse):
        np.testing.assert_allclose(panels.inverted(arc_length(v)), v, rtol=0.0, atol=1e-13)
