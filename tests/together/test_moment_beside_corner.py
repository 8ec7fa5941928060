"""A moment within a beam that a corner presses close by, beside an integration of the line (its module says how)."""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Answer, scene_from
from tests.references import moment_beside_corner as truth

M = -0.2081  # N·m


def gone(answer: Answer, station: int) -> float:
    assert answer.completed, answer.sentence
    x, y = answer.stations[station].values["T.displacement"]
    return float((complex(x, y) * np.conj(truth.ALONG)).real)


def test_the_links_error_is_even_in_their_number() -> None:
    # where the moment falls within its element, the beam's curvature jumps there: that part of h² is nought at a border
    exact = truth.pressed(M)
    scene = scene_from(truth.scene([M]))
    found = {n: cprbm.answer(scene, cprbm.Settings(links=n)) for n in (38, 47, 55, 91)}
    errors = np.array([(gone(answer, 0) / exact.gone - 1.0) * n**2 for n, answer in found.items()])
    assert np.ptp(errors) < 0.2 * np.abs(errors).mean()
    force = found[91].stations[0].values["corner.force"][0]
    assert force == pytest.approx(exact.force, rel=20.0 / 91**2)


def test_what_is_left_at_nodes_is_measured_by_what_bears_on_them() -> None:
    # what bends the elements is 24 times what acts from outside, and so is round-off in a sum of that
    exact = truth.pressed(M)
    settings = fea_reference.Settings(elements=80, kinematics="bending", penetration=1e-4 / 16.0)
    answer = fea_reference.answer(scene_from(truth.scene([-0.104, M, -0.3121])), settings)
    assert gone(answer, 1) == pytest.approx(exact.gone, rel=1e-5)
    assert answer.stations[1].values["corner.force"][0] == pytest.approx(exact.force, rel=1e-4)
