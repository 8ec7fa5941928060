"""Texts of numbers, and tables on the screen and on a page: no number folds, and no small number reads as zero."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.formats import number, percent, scaled_unit, vector
from comparisons.present.columns import Column, Table, columns_of, table_of
from comparisons.present.table import brief_lines, html_cells, screen_text

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
    """Number of printed tables: every table has one rule below its headers."""
    return sum(set(line.strip()) == {"─"} for line in lines)


@given(st.floats(min_value=1e-290, max_value=1.0), st.floats(min_value=1e-300, max_value=1e12), st.booleans())
def test_a_number_keeps_its_digits_and_no_small_number_reads_as_zero(fraction, size, negative):
    value = -size if negative else size
    assert float(number(value)) == pytest.approx(value, rel=0.006)
    assert re.search("[1-9]", percent(fraction))


def test_texts_of_zero_of_missing_values_and_of_units():
    assert percent(0.0) == "0 %"
    assert percent(None) == percent(math.nan) == "–"
    assert vector(np.empty(0), 1.0) == "open"
    assert vector(np.array([-3.0, 2.0, 1.0, 0.0]), 1.0) == "max 3.0000"
    assert scaled_unit("m", 0.0123) == (1e-3, "mm")
    assert scaled_unit("Pa", 3.4e7) == (1e6, "MPa")
    assert scaled_unit("rad", 1e-3) == (1.0, "rad")
    assert scaled_unit("N", 0.0) == (1.0, "N")


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


def test_title_and_note_take_the_width_of_the_screen():
    title, note = "A title that is wider than its table", "COMPLETED: every station was reached and certified"
    lines = lines_of(Table(title, ("stage", "at"), (("press", "1.5 N"),), note), 60)
    assert lines[0] == title
    assert note in lines


def test_sentences_stand_left_and_numbers_right():
    rows = (("slsqp", "0.5", "theory: no part of a single minimum"), ("ipopt", "12.25", "short"))
    lines = lines_of(Table("", ("method", "largest difference over stated", "why"), rows), 120)
    head, _, first, second = lines[1:5]
    assert first.index("0.5") + 3 == second.index("12.25") + 5 == head.index("stated") + 6
    assert first.index("theory") == second.index("short") == head.index("why")


def test_sentences_fold_between_words_and_names_fold_anywhere():
    claim, name = "displacement of B within 0.62 % of ANSYS, 80 elements per beam", "x" * 60 + ".displacement"
    lines = lines_of(Table("Claims", ("claim", "theirs", "ours"), ((claim, "0.620 %", "0.718 %"),)), 50)
    printed = " ".join(line for line in lines[3:] if "─" not in line and "theirs" not in line)
    assert max(map(len, lines)) <= 50
    assert " ".join(printed.replace("0.620 %", "").replace("0.718 %", "").split()) == claim
    lines = lines_of(Table("Long", ("probe", "CPRBM"), ((name, "1.2345"),)), 40)
    assert max(map(len, lines)) <= 40
    assert "".join(re.sub(r"[^x.a-z]", "", line.split("1.2345")[0]) for line in lines[4:]) == name


def test_names_of_a_brief_table_fold_behind_points_spaces_and_underscores():
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
        ("probe", "difference", "value", "says", "N"),
        (
            ("a", "0.72 %", "(-1.2, 3)", "met", "-40"),
            ("b", "0.0017 %", "-4.5", "not met", "7"),
            ("c", "–", "max 5", "–", "open"),
            ("d", "7.9e-13 %", "open", "met", "1.25"),
        ),
    )
    rows = html_cells(table)
    assert [row[1][:3] for row in rows] == [("0", ".72 %", 8), ("0", ".0017 %", 8), ("–", "", 0), ("7", ".9e-13 %", 8)]
    assert [row[4][:3] for row in rows] == [("−40", "", 3), ("7", "", 3), ("open", "", 0), ("1", ".25", 3)]
    assert [cell.words for cell in rows[0]] == [True, False, False, True, False]
    assert [row[2].before for row in rows] == ["(−1.2, 3)", "−4.5", "max 5", "open"]
    assert [row[3].text for row in rows] == ["met", "not met", "–", "met"]
    assert all(row[2].room == row[3].room == 0 for row in rows)


def test_a_column_is_a_path_or_a_function_and_an_empty_column_is_left_out():
    items = [{"n": 10, "bounds": {"total": 1.3}}, {"n": 20, "bounds": None}]
    columns = [
        Column("N", "n"),
        Column("IPOPT", lambda item: None),
        *columns_of(lambda item, value: f"{value:.1f} of {item['n']}", {"ours": "bounds.total"}),
    ]
    assert table_of("ratios", columns, items, "medians") == Table(
        "ratios", ("N", "ours"), (("10", "1.3 of 10"), ("20", "–")), "medians"
    )
