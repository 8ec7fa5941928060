"""Reports of ``compare``: a mechanism by made-up solvers with known errors, and an offset beside the exact curve."""

import json
import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.geometry import length, offset_curve, ordinates, points
from comparisons.opinions import contact_model
from comparisons.pairing import Solvers, cprbm_offset_points, paired
from comparisons.present import offset
from comparisons.present.brief import brief
from comparisons.present.case_tables import answer_tables, branch_table, case_sections
from comparisons.present.offset import compared_offset, error_table
from comparisons.present.row_tables import paper_table
from comparisons.verdict import Word
from comparisons.verdict.events import NO_EVENTS
from cprbm_scene import Arc, Ending, Line, OffsetQuestion, Polynomial, SceneError
from cprbm_scene.frozendict import frozendict
from cprbm_scene.reading import offset_from
from tests.tables import tables_of
from tests.verdict.made_up import MadeUp, with_value

HEADERS = ["probe", "unit", "CPRBM", "FEA", "difference", "stated", "word"]
FILE = Path(cases.__file__).parent / "offset.toml"
DATA = tomllib.loads(FILE.read_text(encoding="utf-8"))
HALF = Arc(kind="arc", center=(0.0, 0.0), start=(-2.0, 0.0), end=(2.0, 0.0), direction="counterclockwise")
QUARTER = Arc(kind="arc", center=(1.0, 0.0), start=(2.0, 0.0), end=(1.0, -1.0), direction="clockwise")


@pytest.fixture(scope="module")
def comparison():
    """Two solvers that differ by a few parts in ten million."""
    scene = cases.opened("hinge")
    return compare(paired(scene, Choices(), Solvers(MadeUp("cprbm", 2e-7), MadeUp("fea", -5e-8))))


def cell(table, row, header):
    return next(line for line in table.rows if line[0] == row)[table.headers.index(header)]


def titled(tables, start):
    return next(table for table in tables if table.title.startswith(start))


def percentage(text):
    return 0.01 * float(text.removesuffix(" %"))


def printed(capsys, *arguments, solvers=None):
    code = run(["compare", *arguments], solvers)
    return code, capsys.readouterr().out.splitlines()


@pytest.fixture(scope="module")
def question():
    return cases.asked("offset")


@pytest.fixture(scope="module")
def offset_case(question):
    return compared_offset(question)


def test_all_tables_are_complete_and_no_small_error_reads_as_zero(comparison):
    found = tables_of(comparison)
    cells = [cell for table in found for row in table.rows for cell in row]
    assert all(len(row) == len(table.headers) for table in found for row in table.rows)
    assert len({table.title for table in found}) == len(found)
    assert not [cell for cell in cells if re.fullmatch(r"-?0\.0+ %", cell)]
    assert any("e-05 %" in cell for cell in cells)
    headings = [section.heading for section in case_sections(comparison) if not section.empty]
    assert headings == [section.heading for section in case_sections(comparison)]
    assert "Critical points and branches" not in headings
    values, events = answer_tables(comparison.scene, comparison.runs.answers["cprbm"])
    assert [row[0] for row in values.rows] == [f"{station:g}" for station in comparison.scene.stages[0].stations]
    assert events.rows[0][:2] == ("load", "contact")


def test_every_probe_of_the_last_station_stands_once_in_the_tables_of_errors_and_theories_in_one(comparison):
    errors = [table for table in tables_of(comparison) if table.title.startswith("Error")]
    quantities = ("Errors in displacement", "Errors in stress", "Errors in force and reaction", "Error in energy")
    assert [table.title for table in errors] == [f"{name} at load 0.67 N·m" for name in quantities]
    names = [row[0] for table in errors for row in table.rows]
    assert sorted(names) == sorted(probe.name for probe in comparison.scene.probes)
    rows = [row for row in comparison.rows if row.probe.name == "B.displacement"]
    worst = max(rows, key=lambda row: row.difference / row.denominator)
    share = percentage(cell(errors[0], "B.displacement", "largest error"))
    assert share == pytest.approx(worst.difference / worst.denominator, rel=5e-3)
    assert cell(errors[0], "B.displacement", "at") == f"load {worst.station:g} N·m"
    # reference: 2 mm over 3 times a radius of 25 mm
    assert cell(errors[1], "beam1.bending_stress", "t/(3R)") == "2.67 %"
    # before contact shear adds 0.5 % to the made-up displacements, of which the finite elements have 1
    table = titled(tables_of(comparison), "Both theories")
    assert table.headers == ("probe", "unit", "CPRBM in shear", "CPRBM in bending", "FEA in bending", "theory")
    row = next(row for row in comparison.rows if (row.probe.name, row.station) == ("BD.rotation", 0.67))
    assert float(cell(table, "BD.rotation", "CPRBM in shear")) == pytest.approx(row.other[0], rel=1e-3)
    share = percentage(cell(table, "BD.rotation", "theory"))
    assert share == pytest.approx(row.theory / row.denominator, rel=1e-2)


def test_the_distance_of_paper_at_its_largest_and_at_its_last_station_and_why_it_ended(comparison):
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    for formulation in ("auto", "paper"):
        runs = paired(scene, Choices(formulation=formulation), solvers)
        table = titled(tables_of(compare(runs)), "The formulation paper beside auto")
        # f is 1e-3 larger in ``paper``: 0.8·0.67·1e-3 of a rotation behind contact, over the finite elements' value
        share = percentage(cell(table, "BD.rotation", "at load 0.67 N·m"))
        assert share == pytest.approx(0.8 * 0.67e-3 / (0.8 * 0.67 + 0.02), rel=1e-2), formulation
    runs = paired(scene, Choices(), solvers)
    whole = runs.answers["cprbm paper"]
    said = "joint 3 presses beyond the end"
    early = replace(whole, ending=Ending.LEFT_BOUNDARY, sentence=said, stations=whole.stations[:4], notes=("a note",))
    for paper, last in ((whole, 0.67), (early, 0.268)):
        found = compare(replace(runs, answers={**runs.answers, "cprbm paper": paper}))
        table = titled(tables_of(found), "The formulation paper beside auto")
        rows = [row for row in found.rows if row.probe.name == "BD.rotation" and row.station <= last]
        shares = {row.station: contact_model(found.runs, row) / row.denominator for row in rows}
        worst = max(shares, key=shares.get)
        texts = [cell(table, "BD.rotation", header) for header in table.headers]
        assert table.headers[3] == f"at load {last:g} N·m"
        assert texts[2] == f"load {worst:g} N·m"
        assert percentage(texts[1]) == pytest.approx(shares[worst], rel=1e-2)
        assert percentage(texts[3]) == pytest.approx(shares[last], rel=1e-2)
        assert ("In paper: a note." in table.note) is (paper is early)
        assert (f"It ended before load 0.335 N·m: {said}." in table.note) is (paper is early)
        assert all(contact_model(found.runs, row) is None for row in found.rows if row.station > last)
    without = compare(replace(runs, answers={name: runs.answers[name] for name in runs.answers if "paper" not in name}))
    assert without.verdict == found.verdict
    assert not [table for table in tables_of(without) if table.title == "The formulation paper beside auto"]
    # above tenfold a distance has its unit: a force that ``paper`` changes by 0.402 N, as a share of a denominator
    row = [row for row in comparison.rows if row.probe.name == "contact.force"][-1]
    auto = comparison.runs.answers["cprbm"]
    changed = with_value("contact.force", row.cprbm + 0.402)(auto.stations[-1])
    paper = replace(auto, stations=(*auto.stations[:-1], changed))
    runs = replace(comparison.runs, answers={**comparison.runs.answers, "cprbm paper": paper})
    for denominator, text in ((0.05, "804 %"), (0.04, "402 mN")):
        only = replace(comparison, runs=runs, rows=(replace(row, denominator=denominator),))
        assert cell(paper_table(only), "contact.force", "largest distance") == text


def test_a_row_of_the_branch_table_is_an_interval_of_stations(comparison):
    """Stations 3 to 5 and 8 of 10 lie between events: two intervals."""
    stations = comparison.scene.stages[0].stations
    between = replace(NO_EVENTS, branch=None)
    rows = tuple(
        replace(row, events=between) if stations.index(row.station) in (3, 4, 5, 8) else row for row in comparison.rows
    )
    found = [row for row in branch_table(replace(comparison, rows=rows)).rows if "between" in row[0]]
    assert [row[1:3] for row in found] == [("0.268 N·m to 0.402 N·m", "3"), ("0.603 N·m", "1")]


# -- The brief report


def test_a_case_takes_at_most_30_lines_of_80_columns_and_all_tables_come_with_v(right, capsys):
    code, lines = printed(capsys, "hinge", solvers=right)
    assert code == 0
    assert len(lines) <= 30
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith("hinge: AGREE. All 126 rows agree")
    table = lines[next(place for place, line in enumerate(lines) if line.split() == HEADERS) + 2 :]
    assert table[0] == "load 0.67 N·m"
    # the hinge has 13 probes; components of a vector share one word
    assert sum(line.endswith(" AGREE") for line in table) == 12
    assert "1 more row AGREE (-v)" in table
    assert table[-2:] == ["next: cprbm compare hinge --out DIR", ""]
    _, full = printed(capsys, "hinge", "-v", solvers=right)
    assert any(line.startswith("Certificates") for line in full)
    assert not any(line.startswith("Certificates") for line in lines)


def test_the_reason_and_the_worst_row_stand_first_and_the_next_command_last(right, capsys):
    code, lines = printed(capsys, "hinge", solvers=Solvers(MadeUp("cprbm", 2e-3, stiffness=1.02), right.fea))
    assert code == 1
    assert lines[0].startswith("hinge: DIFFER (VALUES). ")
    assert "next: cprbm compare hinge --solver cprbm,fea,solid" in lines
    code, lines = printed(capsys, "hinge", solvers=Solvers(MadeUp("cprbm", 2e-2), right.fea))
    assert code == 3
    assert lines[0].startswith("hinge: UNDECIDED (COARSE). ")
    (line,) = (line for line in lines if line.startswith("next: "))
    assert line.startswith("next: cprbm compare hinge -n ")
    # the command is a command of the program, and its links are sufficient
    assert run(line.removeprefix("next: cprbm ").split(), Solvers(MadeUp("cprbm", 2e-2), right.fea)) == 0
    capsys.readouterr()

    def spoilt(factor):
        def change(station):
            values = dict(station.values)
            values["A.reaction_moment"] = factor * values["A.reaction_moment"]
            values["A.reaction"] = np.array([values["A.reaction"][0], 1e-17])
            return replace(station, values=frozendict(values))

        return change

    solvers = Solvers(MadeUp("cprbm", 2e-3, spoilt=spoilt(1.2)), MadeUp("fea", -5e-4, spoilt=spoilt(1.0)))
    _, lines = printed(capsys, "hinge", solvers=solvers)
    assert next(line for line in lines if line.startswith("A.reaction_moment")).endswith("DIFFER")
    _, lines = printed(capsys, "hinge", "-v", solvers=solvers)
    # a value below its floor prints as 0
    assert next(line for line in lines if line.split()[:1] == ["A.reaction"]).count(", 0)") == 2


def test_several_cases_end_with_a_summary(right, capsys, tmp_path):
    code, lines = printed(capsys, "hinge", "offset", "--out", str(tmp_path / "r"), solvers=right)
    assert code == 0
    assert max(map(len, lines[:-1])) <= 80
    assert len(lines) <= 2 * 30 + 16
    start = lines.index(next(line for line in lines if line.startswith("Summary")))
    cells = {line.split()[0]: line.split() for line in lines[start:] if line.split()[:1] in (["hinge"], ["offset"])}
    assert cells["hinge"][1:5] == ["AGREE", "126", "of", "126"]
    assert 0.0 < float(cells["hinge"][5]) <= 1.0
    assert cells["offset"][1:5] == ["AGREE", "2000", "of", "2000"]
    assert lines[-1] == f"report: {tmp_path / 'r' / 'index.html'}"


@pytest.mark.parametrize("width", [60, 72, 80])
def test_a_brief_report_keeps_to_the_terminal_and_cuts_no_number(comparison, offset_case, width):
    for found in (comparison, offset_case):
        lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in brief(found, "case", None, width).splitlines()]
        assert max(map(len, lines)) <= width
    text = "\n".join(lines)
    table = error_table(offset_case)
    assert all(cell in text for row in table.rows for cell in row)
    assert all(re.search(rf"^ *{row[0]} ", text, re.MULTILINE) for row in table.rows)


# -- Curves: lengths and offsets beside elementary geometry, and the offset question


def test_curves_have_the_lengths_and_points_of_elementary_geometry():
    three_quarters = QUARTER.model_copy(update={"direction": "counterclockwise"})
    line = Line(kind="line", start=(1.0, 1.0), end=(4.0, 5.0))
    parabola = Polynomial(kind="polynomial", axis="x", coefficients=(0.0, 0.0, 0.5), range=(2.0, -1.0))
    # reference: y = x²/2 has the arc length ½(x √(1 + x²) + arsinh x) from its vertex
    to_vertex, beyond = (0.5 * (x * math.hypot(1.0, x) + math.asinh(x)) for x in (2.0, 1.0))
    whole = 2.0 * math.pi
    for curve, expected, s, places in (
        (HALF, whole, [0.0, 0.5 * whole, whole], [[-2, 0], [0, -2], [2, 0]]),
        (QUARTER, 0.25 * whole, [0.125 * whole], [[1 + math.sqrt(0.5), -math.sqrt(0.5)]]),
        (three_quarters, 0.75 * whole, [0.0], [[2, 0]]),
        (line, 5.0, [0.0, 2.5, 5.0], [[1, 1], [2.5, 3], [4, 5]]),
    ):
        assert length(curve) == pytest.approx(expected, rel=1e-15), curve
        np.testing.assert_allclose(points(curve, np.array(s)), places, atol=1e-15, err_msg=curve.kind)
    assert length(parabola) == pytest.approx(to_vertex + beyond, rel=1e-14)
    found = points(parabola, np.array([0.0, to_vertex, to_vertex + beyond]))
    np.testing.assert_allclose(found, [[2, 2], [0, 0], [-1, 0.5]], atol=1e-13)


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


def test_the_construction_agrees_its_errors_fall_with_the_fourth_power_and_the_json_says_it(question, offset_case):
    assert offset_case.verdict.word is Word.AGREE
    assert len(offset_case.rows) == 4 * 25 * 20
    rows = [row for row in offset_case.rows if row.spacing.startswith("sine")]
    assert np.median([np.max(row.stated) / row.difference for row in rows]) < 3.0
    asked = question.model_copy(update={"numbers": (39, 79, 159), "offsets": (10.0,)})
    rows = [row for row in compared_offset(asked).rows if row.spacing == "sine-joints"]
    errors = np.array([row.difference for row in rows])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([4.0, 4.0], abs=0.1)
    asked = question.model_copy(update={"offsets": (0.5,), "numbers": (12,)})
    other_side = lambda curve, spacing, n, t: cprbm_offset_points(curve, spacing, n, -t)  # noqa: E731
    assert compared_offset(asked, other_side).verdict.word is Word.DIFFER
    case = offset.document(offset_case)
    assert (case["case"], case["verdict"]) == ("offset", "AGREE")
    assert set(case["solvers"]) == {"cprbm", "exact"}
    row = next(row for row in case["rows"] if row["stage"] == "N = 10" and row["station"] == 14.0)
    assert row["probe"] == "sine-joints.offset_points"
    assert (row["claim"], row["claim_met"]) == (1e-4, True)
    assert 0.0 < row["difference"] <= row["uncertainty"]["cprbm"] + row["uncertainty"]["round_off"]


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


@pytest.mark.usefixtures("printed")
def test_compare_shows_tables_and_writes_a_report_and_ends_with_1_if_it_differs(tmp_path, right, capsys):
    """The case with few numbers and offsets, in a file."""
    text = FILE.read_text(encoding="utf-8").splitlines()
    cut = {"numbers = [6": "numbers = [6, 12]", "offsets = [1.0, 2.0": "offsets = [2.0, 20.0]"}
    lines = [next((new for old, new in cut.items() if line.startswith(old)), line) for line in text]
    small = tmp_path / "small.toml"
    small.write_text("\n".join(lines), encoding="utf-8")
    assert run(["compare", str(small), "-v", "--out", str(tmp_path / "report")]) == 0
    said = capsys.readouterr().out
    assert "offset: AGREE" in said
    assert "not met" in said  # sine-elements at N = 6
    names = {path.name for path in (tmp_path / "report" / "offset").iterdir()}
    assert names == {"comparison.json", "errors.svg", "errors.png", "points.svg", "points.png"}
    page = (tmp_path / "report" / "index.html").read_text("utf-8")
    assert "answers.json.gz" not in page
    wrong = replace(right, offset=lambda curve, spacing, n, t: cprbm_offset_points(curve, spacing, n, 1.1 * t))
    assert run(["compare", str(small), "--json", "-"], wrong) == 1
    assert json.loads(capsys.readouterr().out)["cases"][0]["verdict"] == "DIFFER"


def test_an_offset_question_shows_its_error_against_the_exact_curve_at_the_allowed_sizes(capsys, tmp_path):
    assert run(["converge", "offset", "--sizes", "3,10,20,40,400", "--json", str(tmp_path / "c.json")], Solvers()) == 0
    assert "offset: An offset question takes 4 to 200 springs; left out: 3, 400." in capsys.readouterr().out
    families = json.loads((tmp_path / "c.json").read_text("utf-8"))["families"]
    question = cases.asked("offset")
    assert len(families) == len(question.spacings) * len(question.offsets)
    # second order of the midpoints of even elements, fourth of the rest: see the table of the errors in the page
    for family in families:
        expected = 2.0 if family["settings"]["spacing"] == "even-elements" else 4.0
        assert family["order"] == pytest.approx(expected, abs=0.25)
        assert family["exact"] == 0.0
    assert run(["converge", "offset", "--sizes", "100,400"], Solvers()) == 0
    assert "left out: 400" in capsys.readouterr().out


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
