"""A scene with spaces and umlauts in all names, beside the same scene without spaces."""

import csv
import json
import re
from urllib.parse import unquote

import pytest

from comparisons.cli.main import run
from comparisons.sweeps import outcome
from cprbm_scene import SceneError, read

TEXT = """
name = "press on a cam"
theory = "bending"
parameters = { t = { value = 1.0, unit = "mm" } }
[materials."spring steel"]
youngs_modulus = 2.0e9
poisson_ratio = 0.3
[bodies."the wall"]
motion = "fixed"
points = { "root of arm" = [0.0, 0.0] }
[bodies."the tip"]
motion = "free"
points = { "end of arm" = [0.1, 0.0] }
[beams."left Ärm"]
curve = { kind = "line", start = [0.0, 0.0], end = [0.1, 0.0] }
thickness = "= t"
width = 0.012
material = "spring steel"
start = { joint = "weld", point = "root of arm" }
end = { joint = "weld", point = "end of arm" }
[loads."push down"]
kind = "force"
point = "end of arm"
direction = [0.0, -1.0]
[contacts."cam below"]
kind = "beam-circle"
beam = "left Ärm"
body = "the wall"
center = [0.06, -0.0305]
radius = 0.028
[[stages]]
name = "first push"
steps = "push down"
stations = [0.2, 0.5]
[[probes]]
of = "end of arm"
quantity = "displacement"
[[probes]]
of = "cam below"
quantity = "force"
[[probes]]
of = "left Ärm"
quantity = "bending_stress"
points = 9
"""


def plain(text):
    """A text with underscores in place of the spaces in names."""
    return re.sub(r'"[^"=\n]*"', lambda name: name[0].replace(" ", "_"), text)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Paths of the scene with spaces, and of the scene without."""
    folder = tmp_path_factory.mktemp("a folder")
    paths = folder / "my press.toml", folder / "press.toml"
    for path, text in zip(paths, (TEXT, plain(TEXT)), strict=True):
        path.write_text(text, encoding="utf-8")
    return paths


SIZES = ["-n", "8", "--elements", "8"]


@pytest.mark.usefixtures("unprinted")
@pytest.mark.usefixtures("unprinted")
def test_a_report_has_the_numbers_of_the_scene_without_spaces(files, tmp_path, capsys):
    rows = []
    for number, path in enumerate(files):
        out = tmp_path / f"report {number}"
        numbers = out / "numbers.json", out / "numbers.csv"
        code = run(
            ["compare", str(path), *SIZES, "--no-exact", "--out", str(out), *(f"--{f.suffix[1:]}={f}" for f in numbers)]
        )
        assert code in (0, 3)
        (case,) = json.loads(numbers[0].read_text("utf-8"))["cases"]
        with numbers[1].open(encoding="utf-8", newline="") as stream:
            table = list(csv.DictReader(stream))
        assert {row["probe"] for row in table} == {row["probe"] for row in case["rows"]}
        rows.append([(row["stage"], row["probe"], row["cprbm"], row["fea"]) for row in case["rows"]])
    assert {row[1] for row in rows[0]} >= {"end of arm.displacement", "left Ärm.bending_stress"}
    for (stage, probe, *values), (expected_stage, expected_probe, *expected) in zip(*rows, strict=True):
        assert (stage.replace(" ", "_"), probe.replace(" ", "_")) == (expected_stage, expected_probe)
        assert values == [pytest.approx(value, rel=1e-9) for value in expected]
    assert "end of arm.displacement" in capsys.readouterr().out
    page = (tmp_path / "report 0" / "index.html").read_text("utf-8")
    identifiers = re.findall(r'\bid="([^"]*)"', page)
    assert not [each for each in identifiers if " " in each]
    links = [each for each in re.findall(r'\bhref="([^"]*)"', page) if each != "data:,"]
    assert len(links) > 6
    for link in links:
        assert (link[1:] in identifiers) if link[0] == "#" else (tmp_path / "report 0" / unquote(link)).is_file(), link


def test_commands_take_names_with_spaces(files, tmp_path, capsys):
    path, table = files[0], tmp_path / "one.csv"
    assert run(["solve", str(path), "--solver", "fea", "--elements", "left Ärm=8", "--csv", str(table)]) == 0
    with table.open(encoding="utf-8", newline="") as stream:
        assert {row["probe"] for row in csv.DictReader(stream)} >= {"end of arm.displacement"}
    picture = tmp_path / "a picture.svg"
    assert run(["view", str(path), "-n", "8", "--station", "first push:0.2", "--out", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"<?xml")
    collection = tmp_path / "a series.pvd"
    assert run(["view", str(path), "-n", "8", "--out", str(collection)]) == 0
    shown = re.findall(r'file="([^"]*)"', collection.read_text("utf-8"))
    assert len(shown) >= 2
    assert all((tmp_path / file).is_file() for file in shown)
    capsys.readouterr()


@pytest.mark.usefixtures("unprinted")
def test_a_sweep_has_columns_with_spaces(files, tmp_path, monkeypatch):
    monkeypatch.setattr(outcome, "call_limited", lambda seconds, call, *arguments: call(*arguments))
    out = tmp_path / "all points"
    assert run(["sweep", str(files[0]), "-n", "6", "--quiet", "--vary", "t=1mm..1.1mm:2", "--out", str(out)]) == 0
    with (out / "last.csv").open(encoding="utf-8", newline="") as stream:
        first, _ = csv.DictReader(stream)
    assert float(first["first push end of arm.displacement.y, m"]) < 0.0


@pytest.mark.parametrize("name", ["left  arm", " left arm", "left arm ", "left\tarm", "left\u00a0arm"])
def test_spaces_are_single_and_inside(files, name):
    wrong = files[0].with_name("wrong.toml")
    wrong.write_text(TEXT.replace("left Ärm", name), encoding="utf-8")
    with pytest.raises(SceneError, match="single spaces inside"):
        read(wrong)
    wrong.write_text(TEXT.replace("{ t =", '{ "t u" =').replace("= t", "= 1e-3"), encoding="utf-8")
    with pytest.raises(SceneError, match="a name of letters, digits, '_' and '-' that") as caught:
        read(wrong)
    assert len(caught.value.mistakes) == 1
