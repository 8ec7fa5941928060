"""The clamped and pinned arch beside the published load, and beside energy's curvatures."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.deppo import BENCHMARK, displacement_fold, force_fold, whole
from tests.references.stability import Loaded, curvatures

FIXED = [(0, (0.0, 0.0, 1.0)), (2, (1.0, 0.0, 0.0)), (2, (0.0, 1.0, 0.0))]


def pieces(found):
    start = np.array([-np.sin(BENCHMARK), np.cos(BENCHMARK), BENCHMARK, found.moment])
    X = np.array([found.moment, *-found.reaction, found.force])
    crown = whole(BENCHMARK, X)[2]
    after = X[1:3] + np.array([0.0, found.force])
    return [Loaded(start, X[1:3], BENCHMARK, -1.0), Loaded(crown, after, BENCHMARK, -1.0)]


def test_published_load():
    # reference: DaDeppo and Schmidt (1975), 8.97 EI/R² at 215°
    assert force_fold().force == pytest.approx(8.97, abs=0.005)


def test_a_curvature_vanishes():
    # reference: Ritz's method for all changes of the arch; all others are still positive there
    found = curvatures(pieces(force_fold()), FIXED)
    assert found[0] == pytest.approx(0.0, abs=1e-6)
    assert found[1] > 0.1
    driven = curvatures(pieces(displacement_fold()), [*FIXED, (1, (0.0, 1.0, 0.0))])
    assert driven[0] == pytest.approx(0.0, abs=1e-6)
    assert driven[1] > 0.1


def test_a_drive_goes_further():
    assert 1.0 - force_fold().place[1] < 1.0 - displacement_fold().place[1]
    assert displacement_fold().force < force_fold().force
