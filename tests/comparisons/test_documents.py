"""Numbers that leave the program: JSON and records in SI, files and tables in the units of the scene, and claims."""

import csv
import io
import json
import math
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import comparisons
import cprbm
from comparisons import cases, formats
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.formats import percent
from comparisons.opinions import claim_difference, claim_met, claim_of, standings
from comparisons.pairing import Solvers, paired
from comparisons.present import json_document
from comparisons.present.case_tables import answer_tables
from comparisons.present.columns import plain
from comparisons.present.csv_table import contact_csv, csv_of, records
from comparisons.verdict.rows import Row
from comparisons.writing import text_of
from cprbm_scene import Answer, Certificate, Claim, Ending, Probe, Scene, StationAnswer, scene_from
from cprbm_scene.answer import frozen_array
from cprbm_scene.reading import mistakes_in
from tests.robustness.toml import toml_of
from tests.tables import tables_of
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
FEW = Choices(links=10, elements=10)


@pytest.fixture(scope="module")
def case(hinge, right):
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


@pytest.fixture(scope="module")
def tapered():
    return comparisons.open("tapered")


@pytest.fixture(scope="module")
def compared(tapered):
    return tapered.compare(FEW)


def lines_of(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


# -- JSON


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
    claimed = {(row["probe"], row["station"]): row for row in case["rows"] if row["claim"] is not None}
    bounds = {key: row["claim"] for key, row in claimed.items()}  # of section 3.2 of the paper
    assert bounds == {("B.displacement", 0.67): 0.0062, ("D.displacement", 0.67): 0.0081}
    assert all(row["claim_met"] is (row["difference"] <= row["claim"]) for row in claimed.values())
    # a value is a number, a vector, a curve or null
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


def test_a_case_without_rows_and_a_single_solver_have_documents_with_the_worst_of_certificates(hinge, right):
    early = Solvers(MadeUp("cprbm", 0.0, until=0), right.fea)
    data = json_document.comparison(compare(paired(hinge, Choices(), early)))
    assert (data["verdict"], data["rows"], data["solvers"]["cprbm"]["certificate"]) == ("UNDECIDED", [], None)
    data = json_document.solution(hinge, right.cprbm(hinge, Choices()))
    assert set(data) == {"case", "solvers", "rows"}
    assert set(data["solvers"]) == {"cprbm"}
    assert all("fea" not in row and "verdict" not in row and "cprbm" in row for row in data["rows"])
    other = Certificate(1e-9, 1e-14, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1, 7, ("turned over",))
    stations = tuple(StationAnswer("load", 1.0, {}, {}, {}, each) for each in (CERTIFICATE, other))
    worst = json_document.worst_certificate(Answer("cprbm", "hinge", {}, Ending.COMPLETED, "", stations))
    assert (worst["residual"], worst["residual_floor"], worst["smallest_curvature"]) == (1e-9, 1e-13, -0.1)
    assert (worst["iterations"], worst["holds"], worst["failures"]) == (12, False, ["turned over"])
    # no number that is not finite leaves as JSON
    assert plain({"a": [math.nan, math.inf, 1.0]}) == {"a": [None, None, 1.0]}
    with pytest.raises(ValueError, match="JSON"):
        text_of({"a": math.nan})


# -- Records and files


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


def test_a_file_reads_back_to_the_records_and_contact_forces_sum_up_to_the_probe(wrapped, tmp_path):
    scene, answer = wrapped
    path = tmp_path / "numbers.csv"
    comparisons.write_csv(path, scene, answer, answer)
    found = comparisons.records(scene, answer)
    for line, each in zip(lines_of(path), [*found, *found], strict=True):
        assert float(line["value"]) == each["value"]
        assert line["arc_length"] == ("" if each["arc_length"] is None else repr(each["arc_length"]))
        assert all(line[key] == each[key] for key in ("probe", "component", "unit"))
    comparisons.write_csv(tmp_path / "none", scene, replace(answer, stations=()))
    (headers,) = (tmp_path / "none").read_text(encoding="utf-8").splitlines()
    assert headers == path.read_text(encoding="utf-8").splitlines()[0]
    rows = list(csv.DictReader(contact_csv(scene, [answer]).splitlines()))
    assert {(row["contact"], row["beam"], row["arc_length_unit"]) for row in rows} == {("contact", "beam", "m")}
    for station in answer.stations:
        mine = [row for row in rows if float(row["station"]) == station.value]
        resultant = np.hypot(*(sum(float(row[key]) for row in mine) for key in ("force_x", "force_y")))
        assert resultant == pytest.approx(station.values["contact.force"][0], rel=1e-9)
        assert max((float(row["arc_length"]) for row in mine), default=0.0) < 0.0973  # the length of the beam


def test_units_are_stated_by_the_file_or_one_prefix_for_the_largest_value_of_a_table(hinge, scene):
    for unit, size, factor, name in (
        ("m", 3.0, 1e-3, "mm"),
        ("N·m", 1e-9, 1e-3, "N·mm"),
        ("J", 1.0, 1e-3, "N·mm"),
        ("N/m", 1.0, 1e3, "N/mm"),
        ("Pa", 1.0, 1e6, "MPa"),
        ("rad", 1.0, 0.017453292519943295, "°"),
    ):
        assert formats.display_unit(scene, unit, size) == (pytest.approx(factor, rel=1e-15), name)
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


# -- Mechanisms from Python, and the files of ``--csv`` and ``--plot``


def test_a_mechanism_opens_by_name_or_file_has_a_short_repr_and_lists_right_names(tapered, compared, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(cases.files(cases.__name__).joinpath("tapered.toml").read_text("utf-8"), "utf-8")
    assert comparisons.open(path).scene.probes == tapered.scene.probes
    answer = compared.runs.answers["fea"]
    assert str(tapered.scene) == repr(tapered.scene) == "<Scene tapered: 1 beams, 0 contacts, 5 probes>"
    assert repr(answer) == "<Answer tapered by fea: COMPLETED, 4 stations>"
    assert len(repr(compared)) < 100
    with pytest.raises(KeyError, match=r"T\.displacment.*allowed:.*'T\.displacement'.*'scene\.potential_energy'"):
        tapered.solve(choices=FEW).stations[-1].values["T.displacment"]
    with pytest.raises(ValueError, match="found the solver 'ansys'; allowed: cprbm, fea, exact, solid"):
        tapered.solve("ansys")


def test_tables_of_an_answer_and_of_a_comparison_have_every_number(tapered, compared, tmp_path, monkeypatch):
    answer = tapered.solve(choices=FEW)
    tapered.to_csv(tmp_path / "answer.csv", choices=FEW)
    lines = lines_of(tmp_path / "answer.csv")
    assert len(lines) == sum(values.size for station in answer.stations for values in station.values.values())
    last = [line for line in lines if line["probe"] == "T.displacement"][-1]
    assert (last["component"], last["unit"], last["station_unit"]) == ("y", "m", "N")
    assert float(last["value"]) == answer.stations[-1].values["T.displacement"][1]
    compared.to_csv(tmp_path / "both.csv")
    lines = lines_of(tmp_path / "both.csv")
    assert len(lines) == sum(row.fea.size for row in compared.rows)
    line = next(line for line in lines if (line["probe"], line["component"]) == ("T.displacement", "x"))
    row = next(row for row in compared.rows if row.probe.name == "T.displacement")
    assert (float(line["cprbm"]), float(line["fea"])) == (row.cprbm[0], row.fea[0])
    assert (float(line["difference"]), float(line["stated"])) == (row.difference, row.bounds.total)
    # pandas is asked when it is needed
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="pip install pandas"):
        compared.to_pandas()
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=list))
    assert len(compared.to_pandas()) == len(lines)


def test_a_notebook_shows_table_and_drawing(tapered, compared, tmp_path):
    for shown, probe in (
        (compared._repr_html_(), "beam.<wbr>bending_<wbr>stress"),
        (tapered._repr_html_(), "beam.bending_stress max, MPa"),
    ):
        assert probe in shown
        assert "data:image/svg+xml,%" in shown or "data:image/svg+xml,<" in shown
    drawing = compared.plot(tmp_path / "both.svg")
    assert (tmp_path / "both.svg").read_bytes() == drawing.svg
    assert tapered.plot(tmp_path / "one.png", choices=FEW).png[:4] == b"\x89PNG"
    with pytest.raises(ValueError, match=r"\.svg or \.png"):
        compared.plot(tmp_path / "both.tiff")


@pytest.mark.usefixtures("printed")
def test_the_program_writes_table_and_drawing_of_an_answer_and_of_comparisons(right, tmp_path):
    for place, (command, *names) in enumerate(
        (("solve", "hinge"), ("compare", "hinge"), ("compare", "hinge", "tapered"))
    ):
        table, drawing = tmp_path / f"new{place}" / "a.csv", tmp_path / f"new{place}" / "a.svg"
        assert run([command, *names, "-q", "--csv", str(table), "--plot", str(drawing)], right) == 0
        assert {line["probe"] for line in lines_of(table)} >= {"B.displacement", "contact.force"}
        assert b"<svg" in drawing.read_bytes()


# -- Claims: at one station or at all, of a displacement or of a force, beside rows written by hand


def row(value, reference, *, station=1.0, quantity="reaction", scale=100.0):
    """A row of a single component with fractions of the scale."""
    probe = Probe(of="A", quantity=quantity)
    both = frozen_array([value]), frozen_array([reference])
    return Row(probe, "load", station, "N", *both, scale, scale, difference=abs(value - reference))


def claiming(hinge, *claims):
    return hinge.model_copy(update={"claims": claims})


ROTATION = Probe(of="BD", quantity="rotation")
EVERYWHERE = Claim(probe="BD.rotation", bound=0.005, text="rotation within 0.5 % everywhere")


def test_a_claim_without_a_station_stands_at_every_row_of_its_probe_and_has_one_line(hinge, right):
    comparison = compare(paired(claiming(hinge, EVERYWHERE), Choices(), right))
    found = json_document.comparison(comparison)["rows"]
    mine = [each for each in found if each["probe"] == "BD.rotation"]
    assert len(mine) == 10
    for each in mine:
        assert each["claim"] == 0.005
        assert each["claim_met"] is (each["claim_difference"] <= 0.005)
    others = {(each["claim"], each["claim_difference"]) for each in found if each["probe"] != "BD.rotation"}
    assert others == {(None, None)}
    # the claim has a line with the worst station and the number of met stations
    fractions = {row.station: claim_difference(row) for row in comparison.rows if row.probe.name == "BD.rotation"}
    worst = max(fractions, key=fractions.get)
    met = sum(fraction <= 0.005 for fraction in fractions.values())
    sheet = next(sheet for sheet in tables_of(comparison) if sheet.title == "Claims of the source")
    ((text, theirs, _, at, how_often, word),) = sheet.rows
    assert (text, theirs, at) == (EVERYWHERE.text, "0.500 %", f"load {worst:g} N·m")
    assert (how_often, word) == (f"{met} of 10", "met" if met == 10 else "not met")


def test_met_everywhere_but_once_is_not_met_and_a_row_without_a_difference_meets_nothing(hinge):
    claim = Claim(probe="A.reaction", bound=0.01)
    scene = claiming(hinge, claim)
    rows = [row(100.0, 100.5, station=1.0), row(100.0, 102.0, station=2.0), row(100.0, 100.0, station=3.0)]
    (standing,) = standings(scene, rows)
    assert (standing.met, standing.stations, standing.holds) == (2, 3, False)
    assert standing.worst.station == 2.0
    assert standings(scene, rows[::2])[0].holds
    nothing = replace(rows[0], cprbm=frozen_array([]), fea=frozen_array([]), difference=math.nan)
    assert claim_met(claim, nothing) is None
    assert standings(scene, [nothing]) == ()


def test_a_claim_of_a_station_goes_before_one_of_all_and_has_a_row_within_round_off(hinge):
    everywhere, here = Claim(probe="A.reaction", bound=0.01), Claim(probe="A.reaction", station=2.0, bound=0.05)
    scene = claiming(hinge, everywhere, here)
    assert claim_of(scene, row(1.0, 1.0, station=2.0)) is here
    assert claim_of(scene, row(1.0, 1.0, station=1.0)) is everywhere
    assert claim_of(scene, row(1.0, 1.0, quantity="force")) is None
    # every station within the tolerance of the scene check has a row
    near = Claim(probe="BD.rotation", station=0.67 * (1.0 + 1e-10), bound=0.01)
    assert not list(mistakes_in(claiming(hinge, near)))
    assert standings(claiming(hinge, near), [replace(row(1.0, 1.0, station=0.67), probe=ROTATION)])


def test_a_claim_of_a_force_is_of_the_value_there(hinge, right):
    """10.2 for 10 where the stage has 100: 0.2 % of the largest, and 2 % of the value that is claimed about."""
    for quantity in ("reaction", "force", "reaction_moment"):
        small = row(10.2, 10.0, quantity=quantity)
        assert small.fraction(small.difference) == pytest.approx(0.002)
        assert claim_difference(small) == pytest.approx(0.02)
        assert claim_met(Claim(probe=small.probe.name, bound=0.01), small) is False
    # a claim of a vanishing force, or of a place of the beam, is relative to the largest value of the stage
    assert claim_difference(row(0.9, 0.5)) == pytest.approx(0.004)
    assert claim_difference(row(10.2, 10.0, quantity="centre")) == pytest.approx(0.002)
    scene = claiming(hinge, Claim(probe="contact.force", station=0.335, bound=0.01))
    comparison = compare(paired(scene, Choices(), right))
    sheet = next(sheet for sheet in tables_of(comparison) if sheet.title == "Claims of the source")
    (small,) = (each for each in comparison.rows if each.probe.name == "contact.force" and each.station == 0.335)
    assert sheet.rows[0][2] == percent(claim_difference(small))
    assert small.fraction(small.difference) != claim_difference(small)
