"""The question of an offset curve: exact route, verdict, and command line."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons import cases
from comparisons.cli.main import run
from comparisons.geometry import offset_curve, ordinates
from comparisons.pairing import Solvers, cprbm_offset_points
from comparisons.present import offset
from comparisons.present.offset import compared_offset
from comparisons.verdict import Word
from cprbm_scene import Arc, OffsetQuestion, SceneError
from cprbm_scene.reading import offset_from

FILE = Path(cases.__file__).parent / "offset.toml"
DATA = tomllib.loads(FILE.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def question():
    return cases.asked("offset")


@pytest.fixture(scope="module")
def compared(question):
    return compared_offset(question)


@pytest.fixture
def small(tmp_path):
    """The case with few numbers and offsets, in a file."""
    text = FILE.read_text(encoding="utf-8").splitlines()
    cut = {"numbers = [6": "numbers = [6, 12]", "offsets = [1.0, 2.0": "offsets = [2.0, 20.0]"}
    lines = [next((new for old, new in cut.items() if line.startswith(old)), line) for line in text]
    path = tmp_path / "small.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    return str(path)


def test_the_exact_offset_of_an_arc_and_of_the_parabola(question):
    arc = Arc(kind="arc", center=(0.0, 0.0), start=(-3.0, 4.0), end=(3.0, 4.0), direction="clockwise")
    x = np.linspace(-2.9, 2.9, 31)
    assert ordinates(arc, x, 1.5, along_x=True) == pytest.approx(np.sqrt(6.5**2 - x**2), rel=1e-13)
    assert ordinates(arc, x[5:-5], -1.5, along_x=True) == pytest.approx(np.sqrt(3.5**2 - x[5:-5] ** 2), rel=1e-13)
    v = np.linspace(-9.99, 9.99, 57)
    speed = np.hypot(1.0, 0.12 * v)
    for t in (1.0, 20.0, -8.0):
        x, y = v + t * 0.12 * v / speed, 10.0 - 0.06 * v**2 + t / speed
        assert ordinates(question.curve, x, t, along_x=True) == pytest.approx(y, rel=1e-12), t
    end = offset_curve(question.curve, np.array([1.0]), 5.0)[0]
    found = ordinates(question.curve, end[0] + np.array([-0.1, 0.1]), 5.0, along_x=True)
    assert np.isfinite(found[0])
    assert np.isnan(found[1])


def test_the_construction_agrees_and_states_little_more_than_its_error(compared):
    assert compared.verdict.word is Word.AGREE
    assert len(compared.rows) == 4 * 25 * 20
    rows = [row for row in compared.rows if row.spacing.startswith("sine")]
    assert np.median([np.max(row.stated) / row.difference for row in rows]) < 3.0


def test_errors_on_the_outer_side_fall_with_the_fourth_power(question):
    asked = question.model_copy(update={"numbers": (39, 79, 159), "offsets": (10.0,)})
    rows = [row for row in compared_offset(asked).rows if row.spacing == "sine-joints"]
    errors = np.array([row.difference for row in rows])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([4.0, 4.0], abs=0.1)


@pytest.mark.parametrize("spacing", ["sine-joints", "sine-elements"])
@pytest.mark.parametrize(
    "wrong",
    [
        pytest.param(lambda tau, turn: tau - 0.5 * turn, id="beta left out"),
        pytest.param(lambda tau, turn: tau - turn, id="beta of the wrong sign"),
        pytest.param(lambda tau, turn: tau + 0.25 * turn, id="half as much again"),
    ],
)
def test_a_wrong_beta_differs(question, spacing, wrong):
    def construct(curve, spacing, n, distances):
        right = cprbm_offset_points(curve, spacing, n, distances)
        t = distances[:, None, None]
        tau = right.tangents
        joints = right.points[:1] - t[:1] * np.stack((-np.sin(tau), np.cos(tau)), axis=-1)
        off = wrong(tau, np.gradient(tau))
        return replace(right, points=joints + t * np.stack((-np.sin(off), np.cos(off)), axis=-1))

    asked = question.model_copy(update={"spacings": {spacing: question.spacings[spacing]}})
    assert compared_offset(asked, construct).verdict.word is Word.DIFFER


def test_the_wrong_side_differs(question):
    def construct(curve, spacing, n, distances):
        return cprbm_offset_points(curve, spacing, n, -distances)

    asked = question.model_copy(update={"offsets": (0.5,), "numbers": (12,)})
    assert compared_offset(asked, construct).verdict.word is Word.DIFFER


def test_the_json_says_what_is_documented(compared):
    case = offset.document(compared)
    assert case["case"] == "offset"
    assert case["verdict"] == "AGREE"
    assert set(case["solvers"]) == {"cprbm", "exact"}
    row = next(row for row in case["rows"] if row["stage"] == "N = 10" and row["station"] == 14.0)
    assert row["probe"] == "sine-joints.offset_points"
    assert row["claim"] == 1e-4
    assert row["claim_met"] is True
    assert 0.0 < row["difference"] <= row["uncertainty"]["cprbm"] + row["uncertainty"]["round_off"]


@pytest.mark.usefixtures("printed")
def test_compare_shows_tables_and_writes_a_report(small, tmp_path, capsys):
    assert run(["compare", small, "-v", "--out", str(tmp_path / "report")]) == 0
    printed = capsys.readouterr().out
    assert "offset: AGREE" in printed
    assert "not met" in printed  # sine-elements at N = 6
    names = {path.name for path in (tmp_path / "report" / "offset").iterdir()}
    assert names == {"comparison.json", "errors.svg", "errors.png", "points.svg", "points.png"}
    page = (tmp_path / "report" / "index.html").read_text("utf-8")
    assert "answers.json.gz" not in page


def test_compare_prints_json_alone_and_ends_with_1_if_it_differs(small, right, capsys):
    wrong = Solvers(
        right.cprbm, right.fea, lambda curve, spacing, n, t: cprbm_offset_points(curve, spacing, n, 1.1 * t)
    )
    assert run(["compare", small, "--json", "-"], wrong) == 1
    assert json.loads(capsys.readouterr().out)["cases"][0]["verdict"] == "DIFFER"


def test_what_needs_an_equilibrium_says_so(capsys):
    for command in ("solve", "bench"):
        assert run([command, "offset"]) == 2, command
        assert "no equilibrium" in capsys.readouterr().err


def test_a_wrong_question_is_refused_by_its_key(question):
    for key, value, named, said in (
        ("side", "right", "offsets[8]", "radius of curvature"),
        ("side", "up", "side", "'left' or 'right'"),
        ("axis", "x", "axis", "nowhere parallel"),
        ("ofsets", [1.0], "ofsets", "'offsets'"),
        ("offsets", [1.0, 1.0], "offsets", "each once"),
        ("offsets", [-1.0], "offsets[0]", "greater than 0"),
        ("numbers", [3], "numbers[0]", "at least 4"),
        ("spacings", {"a": {"law": "cosine", "of": "joints"}}, "spacings.a.law", "'even'"),
        ("spacings", {}, "spacings", "at least 1"),
        ("curve", {"kind": "spiral"}, "curve.kind", "'polynomial'"),
        ("curve", {**DATA["curve"], "range": [0.0, 0.0]}, "curve.range", ""),
        ("claims", [{"numbers_from": 31, "bound": 0.1}], "claims[0].numbers_from", "at most 30"),
        ("question", "area", "question", "'offset'"),
        ("file", "x", "file", ""),
    ):
        with pytest.raises(SceneError) as error:
            offset_from({**DATA, key: value})
        found = {mistake.key: str(mistake) for mistake in error.value.mistakes}
        assert named in found, (key, value)
        assert said in found[named]
    with pytest.raises(SceneError, match="spacings"):
        offset_from({key: value for key, value in DATA.items() if key != "spacings"})
    # smallest radius of curvature of y = 10 − 0.06 x²: 1/0.12
    data = {**DATA, "side": "right", "shown": {"numbers": [5], "offsets": [1.0]}}
    assert isinstance(offset_from({**data, "offsets": [8.3]}), OffsetQuestion)
    with pytest.raises(SceneError, match="radius of curvature"):
        offset_from({**data, "offsets": [8.35]})
