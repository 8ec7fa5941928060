"""Tables on the screen: as wide as it is, and no number folded."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.formats import number, percent
from comparisons.present.columns import Column, Table, table_of
from comparisons.present.table import html_cells, screen_text, word_columns

SHEET = Table(
    "Strip: press 20",
    ("probe", "unit", "CPRBM", "FEA", "exact (bending)", "difference", "u CPRBM", "u FEA", "says"),
    (
        (
            "tip.displacement",
            "mm",
            "(-25.572, 10.102)",
            "(-25.771, 10.113)",
            "–",
            "0.718 %",
            "7.95e-13 %",
            "0 %",
            "AGREE",
        ),
        ("scene.potential_energy", "mJ", "-261.61", "-263.80", "-261.82", "0.831 %", "0.100 %", "8.77e-04 %", "DIFFER"),
    ),
    "Fractions of the FEA's value, or of the probe's largest value where that may vanish.",
)
COLOURS = re.compile(r"\x1b\[[0-9;]*m")


def plain(sheet, width):
    return COLOURS.sub("", screen_text(sheet, width=width)).splitlines()


def tables(lines):
    """How many there are: each has one rule below its headers."""
    return sum(set(line.strip()) == {"─"} for line in lines)


@pytest.mark.parametrize("width", [50, 60, 79, 80, 100, 119, 140, 200])
def test_no_number_is_folded_and_no_line_is_too_long(width):
    lines = plain(SHEET, width)
    assert max(map(len, lines)) <= width
    for row in SHEET.rows:
        for cell in row:
            assert any(re.search(rf"(?:^|\s){re.escape(cell)}(?:\s|$)", line) for line in lines), cell
    assert lines[0].strip() == SHEET.title


def test_the_width_is_the_one_that_is_asked_on_a_dumb_terminal_too(monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    assert tables(plain(SHEET, 140)) == 1
    assert max(map(len, plain(SHEET, 140))) > 100


def test_where_there_is_room_there_is_one_table():
    assert tables(plain(SHEET, 140)) == 1
    assert tables(plain(SHEET, 80)) > 1


def test_what_a_row_is_of_and_its_unit_stand_in_each_part():
    lines = plain(SHEET, 80)
    beginnings = [line.split()[:2] for line in lines if "potential_energy" in line]
    assert beginnings == [["scene.potential_energy", "mJ"]] * tables(lines)


def test_every_part_is_aligned():
    """Columns of numbers end where their headers do."""
    lines = plain(SHEET, 80)
    for place, line in enumerate(lines):
        if line.lstrip().startswith("probe"):
            for row in (lines[place + 2], lines[place + 3]):
                assert len(row.rstrip()) == len(line.rstrip())


def test_sentences_fold_between_words():
    claim = "displacement of B within 0.62 % of ANSYS, 80 elements per beam"
    sheet = Table("Claims", ("claim", "theirs", "ours at worst"), ((claim, "0.620 %", "0.718 %"),))
    lines = plain(sheet, 50)
    assert max(map(len, lines)) <= 50
    assert tables(lines) == 1
    told = " ".join(line for line in lines[3:] if "─" not in line and "theirs" not in line)
    told = told.replace("0.620 %", "").replace("0.718 %", "")
    assert " ".join(told.split()) == claim


def test_a_name_longer_than_the_screen_is_told_whole():
    name = "x" * 60 + ".displacement"
    lines = plain(Table("Long", ("probe", "CPRBM"), ((name, "1.2345"),)), 40)
    assert max(map(len, lines)) <= 40
    assert "1.2345" in "".join(lines)
    assert "".join(re.sub(r"[^x.a-z]", "", line.split("1.2345")[0]) for line in lines[4:]) == name


VALUES = st.floats(min_value=-1e9, max_value=1e9, allow_nan=False)


@given(st.lists(st.tuples(VALUES, VALUES, st.floats(1e-300, 1.0)), min_size=1, max_size=4), st.integers(40, 120))
def test_whatever_the_numbers_each_is_there_and_no_error_reads_as_nothing(rows, width):
    cells = tuple((f"probe{n}", number(a, 5), number(b, 5), percent(c)) for n, (a, b, c) in enumerate(rows))
    lines = plain(Table("Any", ("probe", "CPRBM", "FEA", "difference"), cells), width)
    assert max(map(len, lines)) <= width
    for name, *texts in cells:
        found = [line for line in lines if line.split()[:1] == [name]]
        assert all(any(text in line for line in found) for text in texts)
    assert not any(re.search(r"(?<![\d.])0\.0+ %", line) for line in lines)


CELLS = Table(
    "",
    ("probe", "difference", "value", "says", "N"),
    (
        ("a", "0.72 %", "(-1.2, 3)", "met", "-40"),
        ("b", "0.0017 %", "-4.5", "not met", "7"),
        ("c", "–", "max 5", "–", "open"),
        ("d", "7.9e-13 %", "open", "met", "1.25"),
    ),
)


def test_what_is_behind_the_point_has_the_same_room_in_a_column():
    rows = html_cells(CELLS)
    assert [row[1].before for row in rows] == ["0", "0", "–", "7"]
    assert [row[1].behind for row in rows] == [".72 %", ".0017 %", "", ".9e-13 %"]
    assert [row[1].room for row in rows] == [8, 8, 0, 8]
    assert [(row[4].before, row[4].behind, row[4].room) for row in rows] == [
        ("−40", "", 3),
        ("7", "", 3),
        ("open", "", 0),
        ("1", ".25", 3),
    ]


def test_columns_of_words_and_of_vectors_are_left_whole():
    assert word_columns(CELLS) == [True, False, False, True, False]
    rows = html_cells(CELLS)
    assert [row[2].before for row in rows] == ["(−1.2, 3)", "−4.5", "max 5", "open"]
    assert all(row[2].room == row[3].room == 0 for row in rows)
    assert [row[3].text for row in rows] == ["met", "not met", "–", "met"]


def test_a_column_without_a_value_is_left_out_and_a_missing_value_is_a_dash():
    columns = [
        Column("N", lambda item: item[0]),
        Column("IPOPT", lambda item: None),
        Column("ours", lambda item: item[1], lambda value: f"{value:.1f}"),
    ]
    assert table_of("ratios", columns, [(10, 1.3), (20, None)], "medians") == Table(
        "ratios", ("N", "ours"), (("10", "1.3"), ("20", "–")), "medians"
    )
