"""Row sets of which each state denies the other's: places of their own that come and go, and places beside a clamp."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from

BEAM = {
    "width": 0.01,
    "material": "m",
    "start": {"joint": "weld", "point": "R"},
    "end": {"joint": "weld", "point": "T"},
}
FEW = 60  # iterations; by ever smaller load steps the same took hundreds


def over_a_circle(coefficients, thickness, circle, load, stations):
    """A cantilever y = f(x), 0 ≤ x ≤ 95 mm, pressed over a circle by a force at its tip."""
    tip = [0.095, float(np.polynomial.Polynomial(coefficients)(0.095))]
    return scene_from(
        {
            "name": "over",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 2.0e9, "poisson_ratio": 0.35}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "beam": {
                    **BEAM,
                    "curve": {"kind": "polynomial", "axis": "x", "coefficients": coefficients, "range": [0.0, 0.095]},
                    "thickness": thickness,
                }
            },
            "loads": {"P": {"kind": "force", "point": "T", "direction": load}},
            "contacts": {"circle": {"kind": "beam-circle", "beam": "beam", "body": "wall", **circle}},
            "stages": [{"name": "load", "steps": "P", "stations": stations}],
            "probes": [
                {"of": "T", "quantity": "displacement"},
                {"of": "circle", "quantity": "force"},
                {"of": "circle", "quantity": "ends"},
            ],
        }
    )


@pytest.fixture(scope="module")
def turning():
    """A place that is about to become a zone: 1.5 % of the beam's length at the last load."""
    circle = {"center": [0.0269097646967, -0.0209940789059], "radius": 0.0182130879426}
    coefficients = [0.0, 0.0, -3.59802960659, 29.0003096506]
    return over_a_circle(coefficients, 0.00114733720252, circle, [-0.445842512314, -0.8951114194], [1.1, 2.76, 5.53])


def test_a_place_that_becomes_a_zone_takes_few_iterations_on_every_mesh(turning):
    # reference: the same on 320 links, and the order of the method
    fine = cprbm.answer(turning, cprbm.Settings(links=320))
    assert fine.completed, fine.sentence
    for links in (40, 46, 80, 160):
        answer = cprbm.answer(turning, cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        for station, reference in zip(answer.stations, fine.stations, strict=True):
            assert station.certificate.iterations < FEW
            assert station.values["circle.force"] == pytest.approx(
                reference.values["circle.force"], rel=15.0 / links**2
            )
            moved = station.values["T.displacement"] - reference.values["T.displacement"]
            assert np.hypot(*moved) < 1.5 / links**2 * 0.095


def at_last(turning, links, *stations):
    """What is probed at the last of some loads."""
    stage = turning.stages[0].model_copy(update={"stations": stations})
    answer = cprbm.answer(turning.model_copy(update={"stages": (stage,)}), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


@pytest.mark.parametrize("links", [20, 22, 24])
def test_a_zone_shorter_than_an_element_is_a_point_in_it(turning, links):
    # reference: the same on 320 links, where it is five elements long
    begin, end = at_last(turning, 320, 5.53)["circle.ends"]
    found = at_last(turning, links, 5.53)["circle.ends"]
    assert 4.0 * 0.095 / 320 < end - begin < 0.095 / links
    assert found[0] == found[1]
    assert begin < found[0] < end
