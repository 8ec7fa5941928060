"""Numbers are displayed in the units of the scene's file; records and JSON stay in SI."""

import csv
import io
import json
import math

import pytest

from comparisons import display_units
from comparisons.cli.main import run
from comparisons.present.answer_tables import answer_tables
from comparisons.present.csv_table import csv_of, numbers
from cprbm import Settings, answer
from cprbm_scene import Scene, scene_from
from tests.robustness.toml import toml_of

DATA = {
    "name": "leaf",
    "units": {"length": "mm", "force": "N", "angle": "deg", "stress": "MPa"},
    "materials": {"steel": {"youngs_modulus": 210e3, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0]}},
        "tip": {"motion": "free", "points": {"T": [100.0, 0.0]}},
    },
    "beams": {
        "leaf": {
            "material": "steel",
            "curve": {"kind": "line", "start": [0.0, 0.0], "end": [100.0, 0.0]},
            "thickness": 1.0,
            "width": 10.0,
            "start": {"joint": "weld", "point": "O"},
            "end": {"joint": "weld", "point": "T"},
        }
    },
    "drives": {"turn": {"kind": "rotation", "body": "tip"}},
    "stages": [{"name": "bend", "steps": "turn", "stations": [15.0, 45.0]}],
    "probes": [
        {"of": "tip", "quantity": "rotation"},
        {"of": "tip", "quantity": "reaction_moment"},
        {"of": "leaf", "quantity": "bending_stress"},
        {"of": "scene", "quantity": "potential_energy"},
    ],
}


@pytest.fixture(scope="module")
def scene():
    return scene_from(DATA)


@pytest.fixture(scope="module")
def bent(scene):
    return answer(scene, Settings(links=20))


@pytest.mark.parametrize(
    ("unit", "size", "factor", "name"),
    [
        ("m", 3.0, 1e-3, "mm"),
        ("N·m", 1e-9, 1e-3, "N·mm"),
        ("J", 1.0, 1e-3, "N·mm"),
        ("N/m", 1.0, 1e3, "N/mm"),
        ("Pa", 1.0, 1e6, "MPa"),
        ("rad", 1.0, 0.017453292519943295, "°"),
    ],
)
def test_a_stated_unit_has_no_prefix_by_size(scene, unit, size, factor, name):
    assert display_units.display_unit(scene, unit, size) == (pytest.approx(factor, rel=1e-15), name)


def test_without_a_stated_unit_a_table_has_one_prefix_for_the_largest_value(hinge):
    sizes = [("m", 0.02), ("m", 3e-6), ("Pa", 2e7), ("rad", 0.1)]
    assert display_units.display_units(hinge, sizes) == {"m": (1e-3, "mm"), "Pa": (1e6, "MPa"), "rad": (1.0, "rad")}


def test_pure_bending_is_told_in_the_units_of_the_file(scene, bent):
    """M = EIφ/L and σ = Etφ/(2L) of a beam bent to a circle: 45° of 210 GPa, 1 mm by 10 mm, 100 mm."""
    sheet = answer_tables(scene, bent)[0]
    rows = [dict(zip(sheet.headers, row, strict=True)) for row in sheet.rows]
    assert [row["turn, °"] for row in rows] == ["15", "45"]
    last = rows[-1]
    assert float(last["tip.rotation, °"]) == pytest.approx(45.0)
    assert float(last["tip.reaction_moment, N·mm"]) == pytest.approx(1374.4, rel=1e-4)
    assert float(last["leaf.bending_stress max, MPa"]) == pytest.approx(824.67, rel=1e-4)
    assert float(last["scene.potential_energy, N·mm"]) == pytest.approx(0.5 * 1374.4 * 0.785398, rel=1e-4)


def test_a_csv_file_is_in_the_units_of_the_file_and_records_are_in_si(scene, bent):
    rows = list(csv.DictReader(io.StringIO(csv_of(scene, bent))))
    turned = next(row for row in rows if row["probe"] == "tip.rotation" and row["station"] == "45.0")
    assert (turned["station_unit"], turned["unit"], float(turned["value"])) == ("deg", "deg", pytest.approx(45.0))
    end = [row for row in rows if row["probe"] == "leaf.bending_stress"][-1]
    assert (end["arc_length"], end["arc_length_unit"], end["unit"]) == ("100.0", "mm", "MPa")
    record = next(record for record in numbers(scene, bent) if record["probe"] == "tip.reaction_moment")
    assert record["unit"] == "N·m"


def test_units_are_no_part_of_the_question(scene):
    in_si = Scene(**dict(scene))
    assert in_si == scene
    assert display_units.load_text(in_si, "bend", math.radians(45.0)) == "0.785398 rad (45.00°)"
    assert display_units.load_text(scene, "bend", math.radians(45.0)) == "45°"


def test_a_station_is_typed_as_in_the_file_and_json_is_in_si(tmp_path, capsys):
    path, picture = tmp_path / "leaf.toml", tmp_path / "leaf.svg"
    path.write_text(toml_of(DATA), encoding="utf-8")
    assert run(["view", str(path), "-n", "20", "--station", "15", "--out", str(picture), "-q"]) == 0
    assert run(["view", str(path), "-n", "20", "--station", "0.2618", "--out", str(picture)]) == 2
    assert "allowed: one of bend:15, bend:45" in capsys.readouterr().err
    assert run(["solve", str(path), "-n", "20", "--json", "-"]) == 0
    (case,) = json.loads(capsys.readouterr().out)["cases"]
    turns = [row["cprbm"] for row in case["rows"] if row["probe"] == "tip.rotation"]
    assert turns == pytest.approx([math.radians(15.0), math.radians(45.0)])
