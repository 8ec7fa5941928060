"""What is told of a solved scene beside the mechanics: stresses to all digits, gaps from afar, seconds."""

from itertools import count
from types import SimpleNamespace

import numpy as np
import pytest

from cprbm_scene import scene_from
from fea_reference import Settings, answer
from fea_reference.contacts import contacts, least_gap
from fea_reference.model import build
from tests.cprbm.scenes import LENGTH, MOMENT, RIGIDITY, THICKNESS, WIDTH, cantilever_data

LOAD = 0.37 * RIGIDITY / LENGTH


def test_the_stress_of_an_even_bend_has_all_its_digits():
    # reference: M t/2I, the same everywhere
    data = cantilever_data(MOMENT, [LOAD])
    data["probes"].append({"of": "beam", "quantity": "combined_stress", "points": 11})
    values = answer(scene_from(data), Settings(elements=3, kinematics="bending")).stations[0].values
    for quantity in ("bending_stress", "combined_stress"):
        stress = np.abs(values[f"beam.{quantity}"])
        assert stress == pytest.approx(np.full(11, 6.0 * LOAD / (WIDTH * THICKNESS**2)), rel=1e-9)


@pytest.mark.parametrize(("share", "high"), [(0.31, 0.27), (0.77, -0.29)])
def test_the_gap_of_a_circle_elements_away_is_that_of_the_nearest_place(share, high):
    # reference: a straight beam and the circle's middle beside it
    center, radius = [share * LENGTH, high * LENGTH], 0.11 * LENGTH
    data = cantilever_data(MOMENT, [LOAD])
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": radius}
    scene, settings = scene_from({**data, "contacts": {"circle": circle}}), Settings(elements=20)
    model = build(scene, settings)
    (pair,) = contacts(scene, model, settings.penetration)
    gap = least_gap(model, pair, model.start) * model.units.length
    assert gap == pytest.approx((abs(high) - 0.11) * LENGTH - 0.5 * THICKNESS, rel=1e-9)


def test_the_seconds_are_those_of_making_ready_and_of_solving(monkeypatch):
    # reference: a clock that goes on by 1.7 s whenever it is looked at: before and after either
    ticks = count(3.1, 1.7)
    monkeypatch.setattr("fea_reference.solve.time", SimpleNamespace(perf_counter=lambda: next(ticks)))
    found = answer(scene_from(cantilever_data(MOMENT, [LOAD])), Settings(elements=3))
    assert found.seconds == pytest.approx(2 * 1.7)
