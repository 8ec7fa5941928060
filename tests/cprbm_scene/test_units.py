"""Files in millimetres and degrees: every number with a unit is taken to SI, and no other."""

import math
from typing import Annotated, get_args, get_origin, get_type_hints

import pytest
from pydantic import BaseModel

from comparisons import cases
from cprbm_scene import SceneError, scene_from, statement
from cprbm_scene.statement import Record, Units
from cprbm_scene.units import Measured
from tests.robustness.toml import toml_of


def units(annotation):
    """The units that an annotation states for its numbers, None for numbers without a unit."""
    if annotation is float:
        return {None}
    if get_origin(annotation) is Annotated:
        inner, *metadata = get_args(annotation)
        stated = {each for each in metadata if isinstance(each, Measured)}
        return stated or units(inner)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return set()
    return set().union(*(units(each) for each in get_args(annotation)))


def records():
    return [each for each in vars(statement).values() if isinstance(each, type) and issubclass(each, Record)]


@pytest.mark.parametrize("record", records(), ids=lambda record: record.__name__)
def test_every_number_states_a_unit(record):
    hints = get_type_hints(record, include_extras=True)
    assert [name for name in record.model_fields if None in units(hints[name])] == []


DATA = {
    "name": "measured",
    "units": {"length": "mm", "force": "kN", "angle": "deg", "stress": "GPa"},
    "materials": {"steel": {"youngs_modulus": 207.3, "poisson_ratio": 0.29}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"A": [9.7, -2.9], "P": [0.0, 0.0], "Q": [0.0, 31.7]}},
        "tip": {"motion": "free", "points": {"T": [110.4, -2.9]}},
        "knee": {"motion": "slides", "along": [0.0, 1.0], "points": {"K": [1.46509, 20.9]}},
        "crank": {"motion": "turns", "about": "C", "points": {"C": [-71.3, 0.0], "D": [-71.3, 20.9]}},
    },
    "beams": {
        "straight": {
            "curve": {"kind": "line", "start": [9.7, -2.9], "end": [110.4, -2.9]},
            "thickness": {"at": [0.0, 0.43, 1.0], "values": [1.1, 1.3, 0.9]},
            "width": 9.7,
            "material": "steel",
            "start": {"joint": "weld", "point": "A"},
            "end": {"joint": "weld", "point": "T"},
        },
        "curved": {
            "curve": {"kind": "polynomial", "axis": "y", "coefficients": [0.0, 0.3, -0.011], "range": [0.0, 20.9]},
            "thickness": 0.7,
            "width": 9.7,
            "material": "steel",
            "start": {"joint": "pin", "point": "P"},
            "end": {"joint": "weld", "point": "K"},
        },
    },
    "loads": {
        "M": {"kind": "moment", "body": "tip"},
        "F": {"kind": "force", "point": "T", "direction": [0.3, -0.7]},
        "q": {"kind": "distributed", "beam": "straight", "direction": [0.0, -1.0]},
    },
    "drives": {
        "turn": {"kind": "rotation", "body": "crank"},
        "push": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]},
    },
    "stops": {"stop": {"beam": "curved", "end": "start", "towards": "Q", "least": -107.0, "most": 61.0}},
    "contacts": {
        "wall": {
            "kind": "beam-function",
            "beam": "straight",
            "body": "ground",
            "axis": "x",
            "coefficients": [-20.3, 0.07, 0.0009, 0.000003],
            "range": [11.0, 83.0],
            "side": "above",
        },
        "ball": {
            "kind": "beam-circle", "beam": "straight", "body": "ground", "center": [61.0, 17.0], "radius": 7.3
        },
    },
    "stages": [
        {"name": "one", "steps": "M", "stations": [0.0013, 0.0029], "shown": [0.0013]},
        {"name": "two", "steps": "turn", "stations": [11.0, 37.0], "critical_limit": 0.3},
        {"name": "three", "steps": "q", "stations": [0.0007]},
    ],
    "probes": [
        {"of": "T", "quantity": "displacement"},
        {"of": "tip", "quantity": "rotation"},
        {"of": "scene", "quantity": "potential_energy"},
        {"of": "wall", "quantity": "closing_load"},
        {"of": "wall", "quantity": "force"},
        {"of": "straight", "quantity": "bending_stress"},
    ],
    "claims": [
        {"probe": "tip.rotation", "stage": "two", "station": 37.0, "value": 41.0, "bound": 0.03},
        {"probe": "scene.potential_energy", "value": 0.0017, "bound": 0.03},
        {"probe": "wall.force", "stage": "one", "station": 0.0029, "value": 0.031, "bound": 0.03},
        {"probe": "wall.closing_load", "stage": "three", "value": 0.0005, "bound": 0.03},
    ],
}  # fmt: skip


def test_a_scene_in_millimetres_kilonewtons_degrees_and_gigapascals_is_read_in_si():
    scene = scene_from({**DATA, "drives": {"turn": DATA["drives"]["turn"]}})
    degree = math.pi / 180.0
    assert scene.units == Units()
    assert scene.materials["steel"].youngs_modulus == 207.3e9
    assert scene.materials["steel"].poisson_ratio == 0.29
    assert scene.bodies["ground"].points["A"] == (0.0097, -0.0029)
    beam = scene.beams["straight"]
    assert (beam.thickness.at, beam.thickness.values) == ((0.0, 0.43, 1.0), (0.0011, 0.0013, 0.0009))
    assert (beam.width, beam.curve.end) == (0.0097, (0.1104, -0.0029))
    # x = f(y): 0.3 y − 0.011 y² in mm is 0.3 y − 11 y² in m
    assert scene.beams["curved"].curve.coefficients == pytest.approx((0.0, 0.3, -11.0), rel=1e-15)
    assert scene.beams["curved"].curve.range == (0.0, 0.0209)
    assert scene.contacts["wall"].coefficients == pytest.approx((-0.0203, 0.07, 0.9, 3.0), rel=1e-15)
    assert (scene.contacts["ball"].center, scene.contacts["ball"].radius) == ((0.061, 0.017), 0.0073)
    assert scene.stops["stop"].least == pytest.approx(-107.0 * degree, rel=1e-15)
    assert scene.loads["F"].direction == (0.3, -0.7)
    one, two, three = scene.stages
    # kN·mm are N·m, and kN/mm a million N/m
    assert (one.stations, one.shown) == ((0.0013, 0.0029), (0.0013,))
    assert two.stations == pytest.approx((11.0 * degree, 37.0 * degree), rel=1e-15)
    assert two.critical_limit == pytest.approx(0.3 * degree, rel=1e-15)
    assert three.stations == pytest.approx((700.0,), rel=1e-15)
    rotation, energy, force, closing = scene.claims
    assert (rotation.station, rotation.value) == pytest.approx((37.0 * degree, 41.0 * degree), rel=1e-15)
    assert (energy.station, energy.value) == (None, 0.0017)
    assert (force.station, force.value) == (0.0029, 31.0)
    assert closing.value == pytest.approx(500.0, rel=1e-15)
    assert all(claim.bound == 0.03 for claim in scene.claims)


@pytest.mark.parametrize("name", cases.scenes())
def test_a_scene_that_states_si_is_the_scene(name):
    data = cases.data(name)
    stated = scene_from({**data, "units": {"length": "m", "force": "N", "angle": "rad", "stress": "Pa"}})
    assert stated == scene_from(data)


def test_the_data_of_a_file_in_other_units_are_those_of_the_scene(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(toml_of({**DATA, "drives": {"turn": DATA["drives"]["turn"]}}), encoding="utf-8")
    assert scene_from(cases.data(str(path)), file=str(path)) == cases.opened(str(path))


def test_a_unit_that_there_is_not_is_refused():
    with pytest.raises(SceneError, match=r"units\.length: found 'inch' \(is 'in' meant\?\); allowed: .*'mm'.*'in'"):
        scene_from({**DATA, "units": {"length": "inch"}})
    with pytest.raises(SceneError, match=r"units\.mass"):
        scene_from({**DATA, "units": {"mass": "kg"}})


def test_a_claim_that_may_be_of_moments_and_angles_is_to_say_its_stage():
    claims = [{"probe": "T.displacement", "station": 0.0013, "bound": 0.03}]
    with pytest.raises(SceneError, match=r"claims\[0\]\.station: found a number in the unit of several stages"):
        scene_from({**DATA, "claims": claims})


@pytest.mark.parametrize("modulus", [1e300, 1e100, 1e-100])
def test_a_modulus_beyond_all_materials_is_refused_with_the_allowed_range(modulus):
    materials = {"steel": {"youngs_modulus": modulus, "poisson_ratio": 0.29}}
    with pytest.raises(SceneError, match=r"materials\.steel\.youngs_modulus: .*between 1e-50 and 1e\+50 in SI units"):
        scene_from({**DATA, "materials": materials})


def test_what_a_mistake_in_the_scene_is_called_is_told_in_other_units_too():
    data = {**DATA, "stages": [{"name": "one", "steps": "nothing", "stations": [1.0]}]}
    with pytest.raises(SceneError, match=r"stages\[0\]\.steps: found 'nothing'"):
        scene_from({**data, "claims": []})
