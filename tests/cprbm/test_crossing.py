"""Beams that lie on each other's far side: through each other, or round an end."""

import numpy as np
import pytest

import cprbm
import elastica_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force

UNIT = RIGIDITY / LENGTH**2


def line(*points):
    return np.array(points, dtype=float)


def beside_another(other, pressed, stations, *, thick, thicker=1.0):
    """A cantilever, pressed at its tip, and another from one place to another, all over the first one's length."""
    begin, end = (np.array(place) * LENGTH for place in other)
    data = cantilever_data(force(0.0, -1.0), stations)
    if pressed["kind"] == "displacement":
        del data["loads"]
        data["drives"] = {"P": pressed}
    else:
        data["loads"] = {"P": pressed}
    data["bodies"]["wall"]["points"]["Q"] = begin.tolist()
    data["beams"]["other"] = {
        **data["beams"]["beam"],
        "curve": {"kind": "line", "start": begin.tolist(), "end": end.tolist()},
        "thickness": thicker * THICKNESS,
        "start": {"joint": "weld", "point": "Q"},
        "end": {"joint": "free"},
    }
    data["contacts"] = {"contact": {"kind": "beam-beam", "between": ["beam", "other"], "thick": thick}}
    data["probes"] = [
        {"of": "T", "quantity": "displacement"},
        {"of": "tip", "quantity": "rotation"},
        {"of": "contact", "quantity": "force"},
    ]
    return scene_from(data)


def check(scene, links):
    """Against the beams' differential equations at every station; the values there."""
    answer, reference = cprbm.answer(scene, cprbm.Settings(links=links)), elastica_reference.answer(scene)
    assert reference.completed, reference.sentence
    assert answer.completed, answer.sentence
    for ours, true in zip(answer.stations, reference.stations, strict=True):
        for name, values in true.values.items():
            scale = {"T.displacement": LENGTH}.get(name, 1.0)
            assert ours.values[name] == pytest.approx(values, rel=2.0 / links**2, abs=2.0 / links**2 * scale)
    return [station.values for station in answer.stations]


@pytest.mark.parametrize("thick", [False, True])
def test_a_tip_goes_down_beside_a_tip_that_is_then_above_it(thick):
    pressed = {"kind": "force", "point": "T", "direction": [0.0, -1.0]}
    stations = [UNIT * times for times in (0.47, 1.41, 2.81, 4.7)]
    found = check(beside_another(((0.82, -0.66), (1.07, -0.1)), pressed, stations, thick=thick), 20)
    # below the other's tip, which has never been touched
    assert found[-1]["T.displacement"][1] < -0.5 * LENGTH
    assert all(values["contact.force"][0] == 0.0 for values in found)


def test_a_tip_slides_along_a_beam_whose_further_part_it_turns_its_back_on():
    pressed = {"kind": "displacement", "point": "T", "direction": [-0.58, -0.81]}
    stations = [LENGTH * share for share in (0.046, 0.124, 0.216, 0.309, 0.38, 0.45)]
    other = ((1.106, -0.175), (-0.112, -0.036))
    found = check(beside_another(other, pressed, stations, thick=True, thicker=1.7), 20)
    assert found[-1]["contact.force"][0] > 0.0
    assert found[-1]["tip.rotation"][0] < -1.4


@pytest.mark.parametrize(
    ("end", "thick", "links"),
    [((0.45, -0.6), True, 37), ((0.1, -0.5), False, 20)],
)
def test_a_beam_is_drawn_over_the_root_of_another_that_stands_between_its_arms(end, thick, links):
    # what hangs on the far side has come there round the root, and touches nothing else
    pressed = {"kind": "force", "point": "T", "direction": [-0.3, -1.0]}
    scene = beside_another(
        ((0.5 if end[0] > 0.4 else 0.45, -0.05), end), pressed, [3.0 * UNIT, 15.0 * UNIT], thick=thick
    )
    found = check(scene, links)
    assert found[-1]["contact.force"][0] > 14.0 * UNIT
    assert found[-1]["tip.rotation"][0] < -1.4


def fork(half_angle, *, contact):
    """Two leaves of 80 mm welded at a single point, with a force on a tip."""
    tips = {
        name: [80.0 * np.cos(half_angle), sense * 80.0 * np.sin(half_angle)] for name, sense in (("u", 1), ("d", -1))
    }
    return scene_from(
        {
            "name": "fork",
            "units": {"length": "mm"},
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {"root": {"motion": "fixed", "points": {"A": [0.0, 0.0]}}},
            "beams": {
                name: {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": tip},
                    "thickness": 1.0,
                    "width": 8.0,
                    "material": "steel",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "free", "point": f"tip{name}"},
                }
                for name, tip in tips.items()
            },
            "contacts": {"k": {"kind": "beam-beam", "between": ["u", "d"]}} if contact else {},
            "loads": {"F": {"kind": "force", "point": "tipu", "direction": [0.0, -1.0]}},
            "stages": [{"name": "on", "steps": "F", "stations": [1.0, 5.0]}],
            "probes": [{"of": "tipu", "quantity": "displacement"}],
        }
    )


@pytest.mark.parametrize("links", [20, 40, 80])
@pytest.mark.parametrize("degrees", [8.0, 14.0, 30.0])
def test_beams_that_overlap_as_drawn_beside_a_shared_end_do_not_press_there(degrees, links):
    # reference: the leaves do not meet under these forces, so that the contact changes nothing
    with_contact, without = (
        cprbm.answer(fork(np.radians(degrees), contact=contact), cprbm.Settings(links=links))
        for contact in (True, False)
    )
    assert with_contact.completed, with_contact.sentence
    for station, free in zip(with_contact.stations, without.stations, strict=True):
        assert not station.touching
        assert station.values["tipu.displacement"] == pytest.approx(free.values["tipu.displacement"], rel=1e-9)
