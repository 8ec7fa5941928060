"""The audit's gap between a beam and a rigid line that ends beside the beam's middle."""

import numpy as np
import pytest

import cprbm
from comparisons.audit.gaps import spaces
from comparisons.audit.rest import rests_of
from comparisons.audit.seen import seen_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MOMENT, THICKNESS, cantilever_data


def test_the_gap_before_an_open_line_is_measured():
    # closed form: a nearly straight beam, 0.02 of its length below a line that ends beside its middle
    data = cantilever_data(MOMENT, [1e-9])
    line = {"points": [[0.4 * LENGTH, 0.02 * LENGTH], [0.8 * LENGTH, 0.02 * LENGTH]], "side": "right"}
    data["contacts"] = {"line": {"kind": "beam-line", "beam": "beam", "body": "wall", **line}}
    question = scene_from(data)
    answer = cprbm.answer(question, cprbm.Settings(links=40))
    (seen,) = seen_of(question, answer, rests_of(question))
    (space,) = spaces(seen, "line")
    least = np.min(space.gap, where=space.counted, initial=np.inf)
    assert least == pytest.approx(0.02 * LENGTH - 0.5 * THICKNESS, rel=1e-6)
