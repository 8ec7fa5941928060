"""A wedge so sharp that the sides of what is rigid, straight back from its ends, do not meet behind it."""

import numpy as np
import pytest

import cprbm
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


@pytest.mark.parametrize("angle", np.radians([0, 45, 135, 225, 315]).tolist())
def test_a_joint_before_the_very_end_of_an_edge_has_the_distance_of_the_edge(angle):
    """An edge slides along a straight beam until the perpendicular through the edge's end meets a joint."""
    # joints lie at odd multiples of half a link
    slope, height, slide = 1.0, 0.2 * LENGTH, 0.1 * LENGTH
    axes = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    end = np.array([0.825 * LENGTH - slope * height - slide, height])
    points = np.array([end, end + 0.3 * LENGTH * np.array([1.0, slope])]) @ axes
    edge = {"kind": "beam-line", "beam": "beam", "body": "slider", "points": points.tolist(), "side": "right"}
    way = {"kind": "displacement", "point": "V", "direction": axes[0].tolist()}
    data = cantilever_data(way, [slide])
    data["bodies"]["slider"] = {"motion": "slides", "along": axes[0].tolist(), "points": {"V": [0.0, 0.0]}}
    data["bodies"]["tip"]["points"]["T"] = data["beams"]["beam"]["curve"]["end"] = (LENGTH * axes[0]).tolist()
    data |= {"contacts": {"edge": edge}, "drives": data.pop("loads"), "probes": [{"of": "edge", "quantity": "force"}]}
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    assert answer.stations[-1].values["edge.force"] == pytest.approx([0.0], abs=0.0)
