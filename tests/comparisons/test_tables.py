"""Texts of numbers, tables on the screen, and pages: no number folds, and no small number reads as zero."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons import cases
from comparisons.answer_file import read_answers
from comparisons.case import Comparison, Verdict, compare
from comparisons.choices import Choices
from comparisons.formats import number, percent, scaled_unit, vector
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.present import figures, page, stepper
from comparisons.present.columns import Column, Section, Table, columns_of, table_of
from comparisons.present.curves import curve_figures
from comparisons.present.table import brief_lines, html_cells, screen_text
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from cprbm_scene import (
    Stage,
)
from tests.house.unprinted import without_printing
from tests.verdict.jumping import Jumping
from tests.verdict.made_up import MadeUp

COLOURS = re.compile(r"\x1b\[[0-9;]*m")
TABLE = Table(
    "Strip: press 20",
    ("probe", "unit", "CPRBM", "FEA", "exact (bending)", "difference", "u CPRBM", "u FEA", "says"),
    (
        ("tip.displacement", "mm", "(-25.572, 10.102)", "(-25.771, 10.113)", "–", "0.718 %", "7.95e-13 %", "0 %",
         "AGREE"),
        ("scene.potential_energy", "mJ", "-261.61", "-263.80", "-261.82", "0.831 %", "0.100 %", "8.77e-04 %", "DIFFER"),
    ),
    "Fractions of the FEA's value, or of the probe's largest value where that may vanish.",
)  # fmt: skip


def lines_of(table, width):
    return COLOURS.sub("", screen_text(table, width=width)).splitlines()


def parts(lines):
    """Number of printed tables: every table has a rule below the headers."""
    return sum(set(line.strip()) == {"─"} for line in lines)


@given(st.floats(min_value=1e-290, max_value=1.0), st.floats(min_value=1e-300, max_value=1e12), st.booleans())
def test_a_number_keeps_its_digits_and_no_small_number_reads_as_zero(fraction, size, negative):
    value = -size if negative else size
    assert float(number(value)) == pytest.approx(value, rel=0.006)
    assert re.search("[1-9]", percent(fraction))


def test_texts_of_zero_of_missing_values_and_of_units_and_cells_of_columns():
    assert percent(0.0) == "0 %"
    assert percent(None) == percent(math.nan) == "–"
    assert vector(np.empty(0), 1.0) == "open"
    assert vector(np.array([-3.0, 2.0, 1.0, 0.0]), 1.0) == "max 3.0000"
    assert scaled_unit("m", 0.0123) == (1e-3, "mm")
    assert scaled_unit("Pa", 3.4e7) == (1e6, "MPa")
    assert scaled_unit("rad", 1e-3) == (1.0, "rad")
    assert scaled_unit("N", 0.0) == (1.0, "N")
    # a column is a path or a function, and an empty column is left out
    items = [{"n": 10, "bounds": {"total": 1.3}}, {"n": 20, "bounds": None}]
    columns = [
        Column("N", "n"),
        Column("IPOPT", lambda item: None),
        *columns_of(lambda item, value: f"{value:.1f} of {item['n']}", {"ours": "bounds.total"}),
    ]
    assert table_of("ratios", columns, items, "medians") == Table(
        "ratios", ("N", "ours"), (("10", "1.3 of 10"), ("20", "–")), "medians"
    )


@pytest.mark.parametrize("width", [50, 80, 119, 140])
def test_a_table_keeps_to_its_width_and_splits_between_columns(width, monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    lines = lines_of(TABLE, width)
    assert max(map(len, lines)) <= width
    assert lines[0].strip() == TABLE.title
    assert (parts(lines) == 1) is (width == 140)
    for row in TABLE.rows:
        for cell in row:
            assert any(re.search(rf"(?:^|\s){re.escape(cell)}(?:\s|$)", line) for line in lines), cell
    if width == 50:  # the name folds
        return
    beginnings = [line.split()[:2] for line in lines if "potential_energy" in line]
    assert beginnings == [["scene.potential_energy", "mJ"]] * parts(lines)  # name and unit stand in every part
    heads = [place for place, line in enumerate(lines) if line.lstrip().startswith("probe")]
    assert len(heads) == parts(lines)
    for place in heads:  # columns of numbers end where their headers end
        assert {len(row.rstrip()) for row in lines[place + 2 : place + 4]} == {len(lines[place].rstrip())}


def test_a_word_with_its_reason_has_the_colour_of_the_word():
    sheet = Table("", ("probe", "word"), (("tip", "UNDECIDED"), ("pin", "UNDECIDED (THEORY)")))
    yellow = "\x1b[33m"
    assert screen_text(sheet, width=60).count(yellow) == 2
    chapter = page.Chapter("c", "C", "", (Section("S", tables=(sheet,)),))
    assert page.html(page.report_page([chapter])).count('UNDECIDED">UNDECIDED') == 2


def test_commands_in_sentences_of_a_page_are_code_and_their_text_is_escaped():
    sheet = Table("", ("probe", "remedy"), (("tip", "Use `-n 80`."),), note="As `<b>` says.")
    section = Section("S", ("Use the value in shear: `--theory shear`.",), tables=(sheet,))
    text = page.html(page.report_page([page.Chapter("c", "C", "", (section,))]))
    found = re.findall(r"<code>([^<]*)</code>", text)
    assert {"--theory shear", "-n 80", "&lt;b&gt;"} <= set(found)
    assert "`--theory" not in text


def test_titles_notes_and_sentences_stand_left_numbers_right_and_long_texts_fold():
    title, note = "A title that is wider than its table", "COMPLETED: every station was reached and certified"
    lines = lines_of(Table(title, ("stage", "at"), (("press", "1.5 N"),), note), 60)
    assert lines[0] == title
    assert note in lines
    rows = (("slsqp", "0.5", "theory: no part of a single minimum"), ("ipopt", "12.25", "short"))
    lines = lines_of(Table("", ("method", "largest difference over stated", "why"), rows), 120)
    head, _, first, second = lines[1:5]
    assert first.index("0.5") + 3 == second.index("12.25") + 5 == head.index("stated") + 6
    assert first.index("theory") == second.index("short") == head.index("why")
    # sentences fold between words, and names fold anywhere
    claim, name = "displacement of B within 0.62 % of ANSYS, 80 elements per beam", "x" * 60 + ".displacement"
    lines = lines_of(Table("Claims", ("claim", "theirs", "ours"), ((claim, "0.620 %", "0.718 %"),)), 50)
    printed = " ".join(line for line in lines[3:] if "─" not in line and "theirs" not in line)
    assert max(map(len, lines)) <= 50
    assert " ".join(printed.replace("0.620 %", "").replace("0.718 %", "").split()) == claim
    lines = lines_of(Table("Long", ("probe", "CPRBM"), ((name, "1.2345"),)), 40)
    assert max(map(len, lines)) <= 40
    assert "".join(re.sub(r"[^x.a-z]", "", line.split("1.2345")[0]) for line in lines[4:]) == name
    # in the brief table of ``compare`` behind points, spaces and underscores
    names = "pin.closing_load", "left arm.bending_stress", "tip.displacement x", "a_long_name_of_a_pin.force", "p.angle"
    table = Table("", ("probe", "CPRBM"), tuple((name, "1.23450e-04") for name in names))
    lines = [line.replace("1.23450e-04", "").rstrip() for line in brief_lines(table, width=27)]
    assert [COLOURS.sub("", line).rstrip() for line in lines[2:]] == [
        *("pin.", "closing_load", "left arm.", "bending_stress", "tip.", "displacement x"),
        *("a_long_name_", "of_a_pin.force", "p.angle"),
    ]


VALUES = st.floats(min_value=-1e9, max_value=1e9, allow_nan=False)


@given(st.lists(st.tuples(VALUES, VALUES, st.floats(1e-300, 1.0)), min_size=1, max_size=4), st.integers(40, 120))
def test_all_numbers_of_a_table_are_on_the_screen(rows, width):
    cells = tuple((f"probe{n}", number(a, 5), number(b, 5), percent(c)) for n, (a, b, c) in enumerate(rows))
    lines = lines_of(Table("Any", ("probe", "CPRBM", "FEA", "difference"), cells), width)
    assert max(map(len, lines)) <= width
    for name, *texts in cells:
        found = [line for line in lines if line.split()[:1] == [name]]
        assert all(any(text in line for line in found) for text in texts)
    assert not any(re.search(r"(?<![\d.])0\.0+ %", line) for line in lines)


def test_numbers_on_a_page_align_at_their_points_and_words_stay_whole():
    table = Table(
        "",
        ("probe", "difference", "value", "says", "N", "part"),
        (
            ("a", "0.72 %", "(-1.2, 3)", "met", "-40", "−0.5"),
            ("b", "0.0017 %", "-4.5", "not met", "7", "−1.2e-04"),
            ("c", "–", "max 5", "–", "open", "−40"),
            ("d", "7.9e-13 %", "open", "met", "1.25", "–"),
        ),
    )
    rows = html_cells(table)
    assert [row[1][:3] for row in rows] == [("0", ".72 %", 8), ("0", ".0017 %", 8), ("–", "", 0), ("7", ".9e-13 %", 8)]
    assert [row[4][:3] for row in rows] == [("−40", "", 3), ("7", "", 3), ("open", "", 0), ("1", ".25", 3)]
    assert [row[5][:3] for row in rows] == [("−0", ".5", 6), ("−1", ".2e-04", 6), ("−40", "", 6), ("–", "", 0)]
    assert [cell.words for cell in rows[0]] == [True, False, False, True, False, False]
    assert [row[2].before for row in rows] == ["(−1.2, 3)", "−4.5", "max 5", "open"]
    assert [row[3].text for row in rows] == ["met", "not met", "–", "met"]
    assert all(row[2].room == row[3].room == 0 for row in rows)


# -- The page of ``compare``


@pytest.fixture(scope="module")
def comparison(hinge, right):
    return compare(paired(hinge, Choices(), right))


@pytest.fixture(scope="module")
def drawn(comparison):
    """All figures of the comparison, drawn and not printed."""
    with without_printing():
        return page.figures_of(comparison)


@pytest.fixture(scope="module")
def put(comparison, drawn, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "new" / "folder"
    with without_printing():
        page.put_case(folder, comparison)
    page.put_page(folder, page.report_page([page.case_chapter(comparison, drawn)]))
    return folder


def test_the_folder_holds_everything_and_the_page_shows_verdict_claims_and_certificates(put, drawn):
    found = {str(path.relative_to(put)) for path in put.rglob("*") if path.is_file()}
    names = ("shapes", "stress", "path-M", "contact-forces")
    figures = {f"hinge/{name}.{kind}" for name in names for kind in ("svg", "png")}
    numbers = {f"hinge/{name}" for name in ("comparison.json", "answers.json.gz", "contact-forces.csv")}
    assert found == {"index.html"} | numbers | figures
    data = json.loads((put / "hinge" / "comparison.json").read_text("utf-8"))
    assert data["cases"][0]["case"] == "hinge"
    answers = read_answers(put / "hinge" / "answers.json.gz")
    assert len(answers) == 8
    assert {"cprbm paper", "cprbm shear"} <= answers.keys()
    for figure in drawn:
        assert (put / "hinge" / f"{figure.name}.svg").read_bytes() == figure.svg
        assert (put / "hinge" / f"{figure.name}.png").read_bytes() == figure.png
        assert figure.png.startswith(b"\x89PNG")
    text = (put / "index.html").read_text("utf-8")
    for part in (
        '<span class="badge AGREE"><span aria-hidden="true">✓</span> AGREE</span>',
        "0.62\u00a0%",
        "0.81\u00a0%",
        "t/(3R)",
        "Certificates",
        "Both theories",
        "The formulation paper beside auto",
    ):
        assert part in text.replace(" %", "\u00a0%"), part
    # in folding texts (paragraphs, captions, long cells) a percentage stays on the line of the number
    folding = re.findall(
        r'<(?:p|caption|figcaption|td class="[^"]*long)\b[^>]*>.*?</(?:p|caption|figcaption|td)>', text, re.DOTALL
    )
    assert sum("\u00a0%" in part for part in folding) > 3
    assert not [part for part in folding if re.search(r"\d %", part)]


def test_a_page_has_all_chapters_also_of_incomplete_cases_or_the_section_of_a_study_alone(comparison, right):
    early = compare(paired(comparison.scene, Choices(), replace(right, cprbm=MadeUp("cprbm", 0.0, until=2))))
    renamed = comparison.scene.model_copy(update={"name": "other"})
    chapter = page.case_chapter(early, page.figures_of(early))
    assert chapter.word == "UNDECIDED"
    assert any(section.figures for section in chapter.sections)  # of the two stations that both solvers reached
    other = page.case_chapter(replace(comparison, runs=replace(comparison.runs, scene=renamed)), ())
    text = page.html(page.report_page([chapter, other]))
    assert '<article id="hinge"' in text
    assert '<article id="other"' in text
    assert "UNDECIDED" in text
    text = page.html(page.Page("Study", "", further=[Section("Heading", ("A sentence.",), name="study")]))
    assert "<h2>Heading</h2>" in text
    assert 'href="study.json"' in text
    assert "Verdicts at a glance" not in text


def curves_of(compared):
    return curve_figures(compared.scene, compared.runs.answers["fea"], compared.runs.answers["cprbm"])


@pytest.mark.usefixtures("printed")
def test_a_drive_that_goes_back_and_forth_has_all_its_figures():
    """The prestressed case at a tenth of its stations, by made-up solvers with jumps."""
    whole = cases.opened("prestressed")
    stages = tuple(
        stage.model_copy(update={"stations": stage.stations[::10], "shown": stage.stations[:1]})
        for stage in whole.stages
    )
    scene = whole.model_copy(update={"stages": stages, "claims": ()})
    jumping = compare(paired(scene, Choices(), Solvers(Jumping("cprbm"), Jumping("fea"))))
    found = {figure.name: figure for figure in figures.comparison_figures(jumping)}
    assert list(found) == ["shapes", "stations", "path-alpha", "reaction-alpha", "stress"]
    assert "apart from its pin" in found["shapes"].caption
    path = found["path-alpha"]
    assert path.caption.startswith("Reaction moment")
    assert "potential energy against alpha" in path.caption
    assert "Dashed: jumps" in path.caption
    assert path.svg == next(curves_of(jumping)).svg


def test_a_curve_needs_two_stations_and_may_go_back(hinge, right):
    def of(*stages):
        scene = hinge.model_copy(update={"stages": stages, "claims": ()})
        return list(curves_of(compare(paired(scene, Choices(), right))))

    load = hinge.stages[0]
    assert of(load.model_copy(update={"stations": (0.3,), "shown": (0.3,)})) == []
    back = Stage(name="back", steps="M", stations=(0.1,))
    (path,) = of(load.model_copy(update={"stations": (0.3, 0.6), "shown": (0.6,)}), back)
    assert path.name == "path-M"
    assert path.caption.startswith("Rotation")


# -- The picture with a slider


@pytest.fixture(scope="module")
def solved():
    """The hinge, solved at 13 links and 12 elements."""
    hinge = cases.opened("hinge")
    choices = Choices(links=13, elements=12, kinematics="bending")
    answers = cprbm_answer(hinge, choices), fea_answer(hinge, choices)
    runs = Runs(hinge, "bending", dict(zip(("cprbm", "fea"), answers, strict=True)))
    return Comparison(runs, (), Verdict(Word.UNDECIDED, (), completed=False))


def places(shown):
    """Places of the names at a station, in the picture."""
    return [np.array(list(map(float, place.split()))) for place in shown[2]]


def areas_of(path):
    """Areas of the closed polygons of a path, by the shoelace formula."""
    found = []
    for part in path.split("Z")[:-1]:
        x, y = points_of(part).T
        found.append(0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))))
    return found


def points_of(path):
    """The points of a path of straight lines."""
    return np.array([[float(x) for x in pair.split(",")] for pair in re.findall(r"-?[\d.]+,-?[\d.]+", path)])


def test_the_picture_of_a_station_has_points_contact_and_stresses_of_the_answer(solved):
    steps = stepper.stepper(solved)
    stations = solved.runs.answers["fea"].stations
    zone, push = (steps["moving"].index(kind) for kind in ("zone", "push"))
    at_rest = solved.scene.bodies["BD"].points
    assert steps["points"] == ("A", "C", "B", "D")
    fixed = np.array(solved.scene.bodies["AC"].points["A"])
    other = np.array(solved.scene.bodies["AC"].points["C"])
    largest = max(answer.values["contact.force"][0] for answer in stations)
    for shown, answer in zip(steps["stations"], stations, strict=True):
        A, C, B, D = places(shown)
        scale = np.hypot(*(A - C)) / np.hypot(*(fixed - other))
        for place, name in ((B, "B"), (D, "D")):
            moved = np.array(at_rest[name]) + answer.values[f"{name}.displacement"]
            expected = A + scale * (moved - fixed) * (1.0, -1.0)
            assert place == pytest.approx(expected, abs=1.6)  # places are whole numbers of a thousandth
        force = answer.values["contact.force"][0]
        assert bool(shown[1][zone]) == (force > 0.0)
        assert bool(shown[1][push]) == (force > 0.02 * largest)
    assert [bool(paths[zone]) for _, paths, *_ in steps["stations"]].count(True) == 6
    # area of both beams: half circles of 25 mm radius, 2 mm thick
    scale = np.hypot(*(A - C)) / 0.0525
    _, paths, *_ = steps["stations"][-1]
    areas = [areas_of(paths[steps["moving"].index(f"shade{shade}")]) for shade in range(stepper.SHADES)]
    assert sum(sum(each) for each in areas) == pytest.approx(2 * np.pi * 25e-3 * 2e-3 * scale**2, rel=0.02)
    _, first, *_ = steps["stations"][0]
    strongest = steps["moving"].index(f"shade{stepper.SHADES - 1}")  # the largest stress is at the last station
    assert not first[strongest]
    assert paths[strongest]


def test_a_line_with_fewer_points_is_the_same_line():
    t = np.linspace(0.0, 3.0, 700)
    whole = np.stack([310.0 * t, 200.0 + 170.0 * np.sin(3.7 * t**1.3)], axis=1)
    kept = points_of(stepper.line(whole))
    assert len(kept) < 150
    assert np.max(np.abs(whole[:, 1] - np.interp(whole[:, 0], kept[:, 0], kept[:, 1]))) < 1.0  # steep: 0.3 across
    assert kept[[0, -1]] == pytest.approx(whole[[0, -1]], abs=0.06)
