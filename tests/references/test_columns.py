"""Euler's columns beside an independent integration, and beside the first term beyond the bifurcation."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.columns import bent, critical
from tests.references.rod import carried

LOADS = {"cantilever": 3.1, "pinned": 12.7}


@pytest.mark.parametrize("ends", ["cantilever", "pinned"])
def test_elliptic_integrals_agree_with_direct_integration(ends):
    # reference: an explicit Runge-Kutta method of order eight, from the point of inflection at which θ = ∓α
    load = LOADS[ends]
    found = bent(ends, load)
    end, _ = carried(np.array([0.0, 0.0, found.angle, 0.0]), np.array([-load, 0.0]), 1.0, 0.0)
    if ends == "pinned":
        assert end == pytest.approx([1.0 - found.shortening, 0.0, -found.angle, 0.0], abs=1e-11)
    else:  # run through from the tip, the clamp has no angle
        assert end[[0, 1, 2]] == pytest.approx([1.0 - found.shortening, found.deflection, 0.0], abs=1e-11)


def test_middle_of_the_pinned_column():
    # reference: as above, half way
    found = bent("pinned", LOADS["pinned"])
    middle, _ = carried(np.array([0.0, 0.0, found.angle, 0.0]), np.array([-LOADS["pinned"], 0.0]), 0.5, 0.0)
    assert middle[1:3] == pytest.approx([found.deflection, 0.0], abs=1e-11)


@pytest.mark.parametrize("ends", ["cantilever", "pinned"])
def test_the_other_branch_rises_from_eulers_load(ends):
    # reference: P/P_E = (2 K/π)² = 1 + k²/2 + 11 k⁴/32 + ..., k² = sin²(α/2)
    for share in (1e-3, 1e-5):
        angle = bent(ends, critical(ends) * (1.0 + share)).angle
        assert angle**2 / 8.0 == pytest.approx(share, rel=share)


@pytest.mark.parametrize("ends", ["cantilever", "pinned"])
@pytest.mark.parametrize("factor", [1.0, 0.3, 2.1, float("nan")])
def test_a_load_out_of_range_is_refused(ends, factor):
    with pytest.raises(ValueError, match="must lie between"):
        bent(ends, factor * critical(ends))
