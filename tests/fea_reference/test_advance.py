"""Steps that turn chords, against a beam that turns as a whole."""

import numpy as np
import pytest

from cprbm_scene import scene_from
from fea_reference import Settings
from fea_reference.advance import advance, step_between, transported
from fea_reference.model import build
from tests.cprbm.scenes import cantilever_data, force


@pytest.fixture(scope="module")
def model():
    return build(scene_from(cantilever_data(force(0.0, -1.0), [1.0])), Settings(elements=7))


def turning(model, z, about):
    """The rate (size,) at which the beam's nodes move as all turn about a place by one radian."""
    (beam,) = model.beams
    rate = np.zeros(model.size)
    x, y, turned = model.node_dofs[:, beam.nodes]
    rate[x], rate[y], rate[turned] = about[1] - z[y], z[x] - about[0], 1.0
    return rate


ABOUT = np.array([0.31, -0.47])


def turned_by(model, angle):
    """Where the beam's nodes are, (2, n + 1), turned about ABOUT as drawn."""
    (beam,) = model.beams
    r = model.start[model.node_dofs[:2, beam.nodes]] - ABOUT[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    return ABOUT[:, None] + np.array([[cos, -sin], [sin, cos]]) @ r


@pytest.mark.parametrize("angle", [0.83, -2.1])
def test_a_rate_that_turns_all_goes_round(model, angle):
    (beam,) = model.beams
    dofs = model.node_dofs[:2, beam.nodes]
    step = angle * turning(model, model.start, ABOUT)
    there = advance(model, model.start, step)
    # the first node goes as it is told, what follows keeps its chords' lengths
    at = turned_by(model, angle)
    assert there[dofs] - there[dofs[:, :1]] == pytest.approx(at - at[:, :1], abs=1e-14)
    assert step_between(model, model.start, there) == pytest.approx(step, abs=1e-13)
    # and the same rate of there turns all of it about the place that it has gone to
    now = transported(model, model.start, there, turning(model, model.start, ABOUT))
    hub = there[dofs[:, 0]] - np.array([[0.0, -1.0], [1.0, 0.0]]).T @ now[dofs[:, 0]]
    assert now == pytest.approx(turning(model, there, hub), abs=1e-13)
