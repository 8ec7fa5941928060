"""Where a zone of contact ends, against the closed form of the wrapped beam."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import quad

from cprbm_scene import Ending, read, scene_from
from fea_reference import Settings, answer
from tests.fea_reference.test_circle import on_circle
from tests.references.wrapped import Wrapped

T, WIDTH, RADIUS = 0.01, 0.05, 0.5
EXACT = Wrapped(
    length=1.0, radius=RADIUS - T / 2, thickness=T, width=WIDTH, youngs_modulus=12 / (WIDTH * T**3), force=1.0
)


def asked(scene):
    return scene.model_copy(update={"probes": (*scene.probes, scene.probes[3].model_copy(update={"quantity": "ends"}))})


def ends(scene, **settings):
    got = answer(asked(scene), Settings(**{"kinematics": "bending", "elements": 80, **settings}))
    assert got.ending is Ending.COMPLETED, got.sentence
    return [station.values["contact.ends"] for station in got.stations]


def test_a_wrap_ends_where_the_closed_form_says_to_second_order():
    """An overlap would end a layer's width, a third of an element, beyond or before."""
    loads = (5.0, 7.0, 11.0)
    exact = [replace(EXACT, force=load).wrap_length for load in loads]
    errors = []
    for n in (20, 40, 80, 160):
        found = ends(on_circle(loads), elements=n)
        assert all(first == 0.0 for first, _ in found)
        errors.append(np.abs([last for _, last in found] - np.array(exact)).max())
    assert errors[0] < 1e-3
    assert np.log2(errors[0] / errors[-1]) / 3 > 1.8


@pytest.mark.parametrize("kinematics", ["bending", "stretch", "shear"])
def test_a_circle_that_props_in_a_point_has_both_ends_there(kinematics):
    (found,) = ends(on_circle((1e-3,), center=(0.4, -0.01 - T / 2), circle=0.01), kinematics=kinematics)
    assert found == pytest.approx([0.4, 0.4], abs=1.0 / 80)
    assert found[0] == found[1]


def test_a_place_that_touches_by_round_off_is_no_end():
    # both beams begin side by side: penalties of 80 elements pressed there with 1e-8 of the force in the middle
    scene = read(Path(__file__).parents[2] / "comparisons" / "cases" / "prestressed.toml")
    first = scene.stages[0].model_copy(update={"stations": scene.stages[0].stations[:3]})
    got = answer(scene.model_copy(update={"stages": (first,)}), Settings(elements=80, kinematics="bending"))
    found = [station.values["contact.ends"] for station in got.stations]
    assert [ends.tolist() for ends in found] == [pytest.approx([0.0235, 0.0235], rel=1e-3)] * 3


def test_an_open_contact_has_no_ends():
    (found,) = ends(on_circle((1e-3,), center=(0.4, -0.3), circle=0.1))
    assert found.size == 0


def test_a_wave_on_a_table_begins_and_ends_in_its_bottoms():
    """A table touches y = h ((16 x² − 1)² − 1) at x = ±1/4: in two points, not in a zone from the first to the last."""
    wave = Polynomial([0.0, 0.0, -32.0, 0.0, 256.0]) * 0.005
    table = wave(0.25) - 0.5 * T
    ends_of_wave = {"A": [-0.5, wave(-0.5)], "B": [0.5, wave(0.5)]}
    scene = scene_from(
        {
            "name": "wave",
            "materials": {"m": {"youngs_modulus": EXACT.youngs_modulus, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": ends_of_wave},
                "table": {"motion": "slides", "along": [0.0, 1.0], "points": {"O": [0.0, table]}},
            },
            "beams": {
                "wave": {
                    "curve": {"kind": "polynomial", "axis": "x", "coefficients": [*wave.coef], "range": [-0.5, 0.5]},
                    "thickness": T,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "B"},
                }
            },
            "contacts": {
                "edge": {
                    "kind": "beam-line",
                    "beam": "wave",
                    "body": "table",
                    "points": [[-0.6, table], [0.6, table]],
                    "side": "left",
                }
            },
            "drives": {"d": {"kind": "displacement", "point": "O", "direction": [0.0, 1.0]}},
            "stages": [{"name": "press", "steps": "d", "stations": [1e-4]}],
            "probes": [{"of": "edge", "quantity": "ends"}],
        }
    )
    got = answer(scene, Settings(kinematics="stretch", elements=80))
    assert got.completed, got.sentence
    bottoms = [quad(lambda x: np.hypot(1.0, wave.deriv()(x)), -0.5, x)[0] for x in (-0.25, 0.25)]
    assert got.stations[-1].values["edge.ends"] == pytest.approx(bottoms, abs=2e-3)
