"""Numbers that leave the program: documented JSON and records in SI, files and tables in the units of the scene."""

import csv
import io
import json
import math
from dataclasses import replace

import numpy as np
import pytest

import comparisons
import cprbm
from comparisons import cases, formats
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers, paired
from comparisons.present import json_document
from comparisons.present.case_tables import answer_tables
from comparisons.present.columns import plain
from comparisons.present.csv_table import contact_csv, csv_of, records
from comparisons.writing import text_of
from cprbm_scene import Answer, Certificate, Ending, Scene, StationAnswer, scene_from
from tests.robustness.toml import toml_of
from tests.verdict.made_up import CERTIFICATE, MadeUp

NUMBER = (int, float)
BENT = {
    "name": "leaf",
    "units": {"length": "mm", "force": "N", "angle": "deg", "stress": "MPa"},
    "theory": "bending",
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
"""A beam that a drive bends to a circle, in mm, N, MPa and degrees."""


@pytest.fixture(scope="module")
def case():
    hinge = cases.opened("hinge")
    right = Solvers(cprbm=MadeUp("cprbm", 2e-3), fea=MadeUp("fea", -5e-4))
    data = json_document.comparison(compare(paired(hinge, Choices(), right)))
    return json.loads(text_of(data), parse_constant=lambda constant: pytest.fail(constant))


@pytest.fixture(scope="module")
def scene():
    return scene_from(BENT)


@pytest.fixture(scope="module")
def bent(scene):
    return cprbm.answer(scene, cprbm.Settings(links=20))


@pytest.fixture(scope="module")
def wrapped():
    scene = cases.opened("wrapped")
    return scene, cprbm.answer(scene, cprbm.Settings(links=23))


def test_a_case_and_its_rows_have_the_documented_keys_and_kinds(case):
    assert {"case", "verdict", "sentence", "solvers", "rows"} <= set(case)
    assert (case["case"], case["verdict"]) == ("hinge", "AGREE")
    for solver in ("cprbm", "fea"):
        assert {"ending", "seconds", "settings", "certificate"} <= set(case["solvers"][solver])
        assert case["solvers"][solver]["ending"] == "COMPLETED"
        assert case["solvers"][solver]["certificate"]["holds"] is True
    for row in case["rows"]:
        assert {"probe", "stage", "station", "unit", "cprbm", "fea", "claim", "claim_met"} <= set(row)
        assert isinstance(row["station"], NUMBER)
        assert row["difference"] is None or row["difference"] >= 0.0
        assert {"cprbm", "fea", "theory"} <= set(row["uncertainty"])
        assert (row["other_theory"] is None) is (row["uncertainty"]["theory"] is None)
        assert row["contact_model"] is None or row["contact_model"] >= 0.0


def test_a_value_is_a_number_a_vector_a_curve_or_null(case):
    rows = {(row["probe"], row["station"]): row for row in case["rows"]}
    assert len(rows["B.displacement", 0.67]["cprbm"]) == 2
    turned, stress = rows["BD.rotation", 0.67], rows["beam1.bending_stress", 0.67]
    assert "arc_length" not in turned
    # fractions are of the denominator
    assert turned["difference"] * turned["denominator"] == pytest.approx(abs(turned["cprbm"] - turned["fea"]), rel=1e-9)
    assert len(stress["cprbm"]) == len(stress["fea"]) == len(stress["arc_length"]) == 81
    assert stress["arc_length"][-1] == pytest.approx(math.pi * 0.025)
    centre = rows["contact.centre", 0.067]  # the contact is open
    assert centre["cprbm"] is centre["fea"] is centre["difference"] is centre["verdict"] is None
    assert centre["uncertainty"] == dict.fromkeys(centre["uncertainty"])
    assert rows["contact.force", 0.067]["cprbm"] == 0.0


def test_claims_stand_at_their_station_only(case):
    claimed = {(row["probe"], row["station"]): row for row in case["rows"] if row["claim"] is not None}
    assert set(claimed) == {("B.displacement", 0.67), ("D.displacement", 0.67)}
    for row in claimed.values():
        assert row["claim_met"] is (row["difference"] <= row["claim"])


def test_a_case_without_rows_and_a_single_solver_have_documents_too(hinge, right):
    early = Solvers(MadeUp("cprbm", 0.0, until=0), right.fea)
    data = json_document.comparison(compare(paired(hinge, Choices(), early)))
    assert (data["verdict"], data["rows"], data["solvers"]["cprbm"]["certificate"]) == ("UNDECIDED", [], None)
    data = json_document.solution(hinge, right.cprbm(hinge, Choices()))
    assert set(data) == {"case", "solvers", "rows"}
    assert set(data["solvers"]) == {"cprbm"}
    assert all("fea" not in row and "verdict" not in row and "cprbm" in row for row in data["rows"])


def test_the_worst_of_certificates_is_taken_number_by_number():
    other = Certificate(1e-9, 1e-14, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1, 7, ("turned over",))
    stations = tuple(StationAnswer("load", 1.0, {}, {}, {}, each) for each in (CERTIFICATE, other))
    worst = json_document.worst_certificate(Answer("cprbm", "hinge", {}, Ending.COMPLETED, "", stations))
    assert (worst["residual"], worst["residual_floor"], worst["smallest_curvature"]) == (1e-9, 1e-13, -0.1)
    assert (worst["iterations"], worst["holds"], worst["failures"]) == (12, False, ["turned over"])


def test_no_number_that_is_not_finite_leaves_as_json():
    assert plain({"a": [math.nan, math.inf, 1.0]}) == {"a": [None, None, 1.0]}
    with pytest.raises(ValueError, match="JSON"):
        text_of({"a": math.nan})


def test_every_number_of_an_answer_has_a_record_in_si(wrapped):
    scene, answer = wrapped
    found = comparisons.records(scene, answer)
    assert len(found) == sum(values.size for station in answer.stations for values in station.values.values())
    last = {(each["probe"], each["component"], each["arc_length"]): each for each in found if each["station"] == 191.0}
    values = answer.stations[-1].values
    assert last["T.displacement", "y", None]["value"] == values["T.displacement"][1]
    assert last["contact.ends", "last", None]["value"] == values["contact.ends"][1]
    assert last["contact.force", "", None]["value"] == values["contact.force"][0]
    places = sorted(place for probe, _, place in last if probe == "beam.bending_stress")
    np.testing.assert_allclose(places, np.linspace(0.0, 0.0973, 81), rtol=1e-12)
    units = {"T.displacement": "m", "tip.rotation": "rad", "beam.bending_stress": "Pa", "C.reaction_moment": "N·m"}
    assert {(each["probe"], each["unit"]) for each in last.values()} >= set(units.items())
    assert {(each["scene"], each["solver"], each["stage"]) for each in found} == {("wrapped", "cprbm", "load")}


def test_a_file_reads_back_to_the_records_and_keeps_its_headers_without_stations(wrapped, tmp_path):
    scene, answer = wrapped
    path = tmp_path / "numbers.csv"
    comparisons.write_csv(path, scene, answer, answer)
    lines = list(csv.DictReader(path.read_text("utf-8").splitlines()))
    found = comparisons.records(scene, answer)
    for line, each in zip(lines, [*found, *found], strict=True):
        assert float(line["value"]) == each["value"]
        assert line["arc_length"] == ("" if each["arc_length"] is None else repr(each["arc_length"]))
        assert all(line[key] == each[key] for key in ("probe", "component", "unit"))
    comparisons.write_csv(tmp_path / "none", scene, replace(answer, stations=()))
    (headers,) = (tmp_path / "none").read_text(encoding="utf-8").splitlines()
    assert headers == path.read_text(encoding="utf-8").splitlines()[0]


def test_contact_forces_sum_up_to_the_resultant_of_the_probe(wrapped):
    scene, answer = wrapped
    rows = list(csv.DictReader(contact_csv(scene, [answer]).splitlines()))
    assert {(row["contact"], row["beam"], row["arc_length_unit"]) for row in rows} == {("contact", "beam", "m")}
    for station in answer.stations:
        mine = [row for row in rows if float(row["station"]) == station.value]
        resultant = np.hypot(*(sum(float(row[key]) for row in mine) for key in ("force_x", "force_y")))
        assert resultant == pytest.approx(station.values["contact.force"][0], rel=1e-9)
        assert max((float(row["arc_length"]) for row in mine), default=0.0) < 0.0973  # the length of the beam


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
    assert formats.display_unit(scene, unit, size) == (pytest.approx(factor, rel=1e-15), name)


def test_units_are_stated_by_the_file_or_one_prefix_for_the_largest_value_of_a_table(hinge, scene):
    sizes = [("m", 0.02), ("m", 3e-6), ("Pa", 2e7), ("rad", 0.1)]
    assert formats.display_units(hinge, sizes) == {"m": (1e-3, "mm"), "Pa": (1e6, "MPa"), "rad": (1.0, "rad")}
    in_si = Scene(**dict(scene))
    assert in_si == scene
    assert formats.load_text(in_si, "bend", math.radians(45.0)) == "0.785398 rad (45.00°)"
    assert formats.load_text(scene, "bend", math.radians(45.0)) == "45°"


def test_tables_and_files_are_in_the_units_of_the_scene(scene, bent):
    """M = EIφ/L and σ = Etφ/(2L) of a beam bent to a circle: 45° of 210 GPa, 1 mm by 10 mm, 100 mm."""
    table = answer_tables(scene, bent)[0]
    first, last = (dict(zip(table.headers, row, strict=True)) for row in table.rows)
    assert (first["turn, °"], last["turn, °"]) == ("15", "45")
    assert float(last["tip.rotation, °"]) == pytest.approx(45.0)
    assert float(last["tip.reaction_moment, N·mm"]) == pytest.approx(1374.4, rel=1e-4)
    assert float(last["leaf.bending_stress max, MPa"]) == pytest.approx(824.67, rel=1e-4)
    assert float(last["scene.potential_energy, N·mm"]) == pytest.approx(0.5 * 1374.4 * 0.785398, rel=1e-4)
    rows = list(csv.DictReader(io.StringIO(csv_of(scene, bent))))
    turned = next(row for row in rows if row["probe"] == "tip.rotation" and row["station"] == "45.0")
    assert (turned["station_unit"], turned["unit"], float(turned["value"])) == ("deg", "deg", pytest.approx(45.0))
    end = [row for row in rows if row["probe"] == "leaf.bending_stress"][-1]
    assert (end["arc_length"], end["arc_length_unit"], end["unit"]) == ("100.0", "mm", "MPa")
    record = next(record for record in records(scene, bent) if record["probe"] == "tip.reaction_moment")
    assert record["unit"] == "N·m"


def test_a_station_is_typed_as_in_the_file_and_json_is_in_si(tmp_path, capsys):
    path, picture = tmp_path / "leaf.toml", tmp_path / "leaf.svg"
    path.write_text(toml_of(BENT), encoding="utf-8")
    assert run(["view", str(path), "-n", "20", "--station", "15", "--out", str(picture), "-q"]) == 0
    assert run(["view", str(path), "-n", "20", "--station", "0.2618", "--out", str(picture)]) == 2
    assert "allowed: one of bend:15, bend:45" in capsys.readouterr().err
    assert run(["solve", str(path), "-n", "20", "--json", "-"]) == 0
    (case,) = json.loads(capsys.readouterr().out)["cases"]
    turns = [row["cprbm"] for row in case["rows"] if row["probe"] == "tip.rotation"]
    assert turns == pytest.approx([math.radians(15.0), math.radians(45.0)])
