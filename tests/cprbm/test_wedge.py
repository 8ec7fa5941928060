"""A wedge so sharp that the sides of what is rigid, straight back from its ends, do not meet behind it."""

import numpy as np
import pytest

import cprbm
from cprbm.mechanism import mechanism_of
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MOMENT, RIGIDITY, THICKNESS, cantilever_data

# of the beam's length: a face 0.11 long and one 0.29 long, at 59 degrees to each other
WEDGE = np.array([[0.92, 0.18], [0.99, 0.1], [1.08, 0.38]]) * LENGTH


def under_a_wedge(stations, *, other_way_round=False):
    """A straight beam, turned upwards by a moment at its end, and a wedge above, its tip near the beam's."""
    data = cantilever_data(MOMENT, stations)
    points, side = (WEDGE[::-1], "left") if other_way_round else (WEDGE, "right")
    wedge = {"kind": "beam-line", "beam": "beam", "body": "wall", "points": points.tolist(), "side": side}
    data["contacts"] = {"wedge": wedge}
    data["probes"].append({"of": "wedge", "quantity": "force"})
    return scene_from(data)


@pytest.mark.parametrize("other_way_round", [False, True])
def test_what_is_before_a_sharp_wedge_is_not_behind_its_sides(other_way_round):
    # closed form: a moment M bends the beam to a circle, and turns its end by M L/EI
    turn = 0.06
    assert 0.5 * turn * LENGTH + 0.5 * THICKNESS < WEDGE[:, 1].min()  # the circle's end, lower than the wedge
    scene = under_a_wedge([turn * RIGIDITY / LENGTH], other_way_round=other_way_round)
    answer = cprbm.answer(scene, cprbm.Settings(links=20))
    assert answer.completed
    (station,) = answer.stations
    assert station.values["tip.rotation"] == pytest.approx([turn], rel=1e-10)
    assert station.values["wedge.force"] == pytest.approx([0.0], abs=0.0)


@pytest.mark.parametrize("other_way_round", [False, True])
def test_what_lies_behind_a_wedges_side_lies_behind_both_of_its_faces(other_way_round):
    # reference: what is rigid behind a corner that stands out is what is behind both of its lines
    scene = under_a_wedge([1.0], other_way_round=other_way_round)
    edge = mechanism_of(scene, cprbm.Settings(links=5)).pairs["wedge"]
    begin, along = WEDGE[:-1] / edge.unit_length, np.diff(WEDGE, axis=0)
    q = np.random.default_rng(5).uniform(-2.0, 2.0, (20000, 2))
    away = q[:, None] - begin
    in_front = np.any(along[:, 1] * away[:, :, 0] - along[:, 0] * away[:, :, 1] > 0.0, axis=1)
    seen = edge.whole.seen(q)
    sunk = (edge.whole.facing(q, seen) & (seen.distance < 0.0))[len(edge.pieces) :]
    assert np.any(sunk)
    assert not np.any(sunk & in_front)
