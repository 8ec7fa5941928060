"""Mechanisms from Python, and the files of ``--csv`` and ``--plot``."""

import csv
import sys
from types import SimpleNamespace

import pytest

import comparisons
from comparisons.choices import Choices
from comparisons.cli.main import run

FEW = Choices(links=10, elements=10)


@pytest.fixture(scope="module")
def tapered():
    return comparisons.open("tapered")


@pytest.fixture(scope="module")
def compared(tapered):
    return tapered.compare(FEW)


def lines_of(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_a_file_opens_as_a_built_in_case_does(tapered, tmp_path):
    from comparisons import cases

    path = tmp_path / "mine.toml"
    path.write_text(cases.files(cases.__name__).joinpath("tapered.toml").read_text("utf-8"), "utf-8")
    assert comparisons.open(path).scene.probes == tapered.scene.probes


def test_reprs_are_short(tapered, compared):
    answer = compared.runs.answers["fea"]
    assert str(tapered.scene) == repr(tapered.scene) == "<Scene tapered: 1 beams, 0 contacts, 5 probes>"
    assert repr(answer) == "<Answer tapered by fea: COMPLETED, 4 stations>"
    assert len(repr(compared)) < 100


def test_a_wrong_probe_or_solver_lists_the_right_ones(tapered):
    with pytest.raises(KeyError, match=r"T\.displacment.*allowed:.*'T\.displacement'.*'scene\.potential_energy'"):
        tapered.solve(choices=FEW).stations[-1].values["T.displacment"]
    with pytest.raises(ValueError, match="found the solver 'ansys'; allowed: cprbm, fea, exact, solid"):
        tapered.solve("ansys")


def test_the_table_of_an_answer_has_every_number(tapered, tmp_path):
    answer = tapered.solve(choices=FEW)
    tapered.to_csv(tmp_path / "answer.csv", choices=FEW)
    lines = lines_of(tmp_path / "answer.csv")
    assert len(lines) == sum(values.size for station in answer.stations for values in station.values.values())
    last = [line for line in lines if line["probe"] == "T.displacement"][-1]
    assert (last["component"], last["unit"], last["station_unit"]) == ("y", "m", "N")
    assert float(last["value"]) == answer.stations[-1].values["T.displacement"][1]


def test_the_table_of_a_comparison_has_both_values(compared, tmp_path):
    compared.to_csv(tmp_path / "both.csv")
    lines = lines_of(tmp_path / "both.csv")
    assert len(lines) == sum(row.fea.size for row in compared.rows)
    line = next(line for line in lines if (line["probe"], line["component"]) == ("T.displacement", "x"))
    row = next(row for row in compared.rows if row.probe.name == "T.displacement")
    assert (float(line["cprbm"]), float(line["fea"])) == (row.cprbm[0], row.fea[0])
    assert (float(line["difference"]), float(line["stated"])) == (row.difference, row.bounds.total)


def test_pandas_is_asked_when_it_is_needed(compared, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="pip install pandas"):
        compared.to_pandas()
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=list))
    assert len(compared.to_pandas()) == sum(row.fea.size for row in compared.rows)


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
@pytest.mark.parametrize("command", ["solve", "compare"])
def test_the_program_writes_table_and_drawing(right, tmp_path, command):
    table, drawing = tmp_path / "new" / "a.csv", tmp_path / "new" / "a.svg"
    assert run([command, "hinge", "-q", "--csv", str(table), "--plot", str(drawing)], right) == 0
    assert {line["probe"] for line in lines_of(table)} >= {"B.displacement", "contact.force"}
    assert b"<svg" in drawing.read_bytes()


def test_a_drawing_of_two_designs_and_of_an_unknown_kind(right, tmp_path, capsys):
    drawing = tmp_path / "two.svg"
    assert run(["compare", "hinge", "tapered", "-q", "--plot", str(drawing)], right) == 0
    assert b"<svg" in drawing.read_bytes()
    assert run(["compare", "hinge", "--plot", str(tmp_path / "a.tiff")], right) == 2
    assert "allowed: a name that ends in .svg or .png" in capsys.readouterr().err
