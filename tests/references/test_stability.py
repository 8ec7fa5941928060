"""Curvatures of the energy of straight columns: Euler's loads, where the smallest of them vanish."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.small import euler_load_cantilever, euler_load_clamped, euler_load_pinned
from tests.references.stability import Loaded, curvatures

TURN, ACROSS = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("held", "load"),
    [
        ([(0, TURN)], euler_load_cantilever(1.0, 1.0)),
        ([(2, ACROSS)], euler_load_pinned(1.0, 1.0)),
        ([(0, TURN), (2, ACROSS), (2, TURN)], euler_load_clamped(1.0, 1.0)),
        # half way a support: the first buckling of each half is left
        ([(1, ACROSS), (2, ACROSS)], 4.0 * euler_load_pinned(1.0, 1.0)),
        # tan x = x, S. P. Timoshenko and J. M. Gere, chapter 2
        ([(0, TURN), (2, ACROSS)], 4.493409457909064**2),
    ],
    ids=["cantilever", "pinned", "clamped", "supported", "propped"],
)
def test_smallest_curvature_vanishes_at_eulers_load(held, load):
    def found(P):
        force = np.array([-P, 0.0])
        pieces = [Loaded(np.array([x, 0.0, 0.0, 0.0]), force, length) for x, length in ((0.0, 0.5), (0.5, 0.5))]
        return curvatures(pieces, held)

    assert found(load)[0] == pytest.approx(0.0, abs=1e-9)
    assert found(0.99 * load)[0] > 0.0
    assert found(1.01 * load)[0] < 0.0 < found(1.01 * load)[1]
