"""A clamped column beyond Euler's load, without an imperfection: both solvers converge to elliptic integrals."""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY
from tests.elastica_reference.scenes import post_buckled as scene_data
from tests.references.post_buckled import post_buckled

LOAD = 55.0  # 1.4 times Euler's


def by_cprbm(scene, n):
    return cprbm.answer(scene, cprbm.Settings(links=n))


def by_fea(scene, n):
    return fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending"))


def errors(solve, n):
    """Of the middle's place over the length, of the guide's, and of the clamp's moment over its own."""
    found = solve(scene_from(scene_data(LOAD)), n)
    assert found.completed, found.sentence
    values, exact = found.stations[-1].values, post_buckled(LOAD)
    moment = exact.moment * RIGIDITY / LENGTH
    return np.array(
        [
            np.hypot(*(values["M.displacement"] / LENGTH - [-0.5 * exact.shortening, exact.deflection])),
            abs(values["E.displacement"][0] / LENGTH + exact.shortening),
            abs(abs(values["R.reaction_moment"][0]) - moment) / moment,
        ]
    )


@pytest.mark.parametrize(
    ("solve", "counts", "order", "last"),
    [(by_cprbm, (20, 40, 80), 4.0, 2e-5), (by_fea, (8, 16, 32), 4.0, 1e-6)],
    ids=["cprbm", "fea"],
)
def test_convergence(solve, counts, order, last):
    found = np.array([errors(solve, n) for n in counts])
    assert np.log2(found[:-1] / found[1:]) == pytest.approx(np.full((2, 3), order), abs=0.15)
    assert np.all(found[-1] < last)
