"""Cells of a table on a page: which are aligned at their points, and how."""

from comparisons.cells import cells_of, words_in
from comparisons.sheet import Sheet

SHEET = Sheet(
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
    rows = cells_of(SHEET)
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
    assert words_in(SHEET) == [True, False, False, True, False]
    rows = cells_of(SHEET)
    assert [row[2].before for row in rows] == ["(−1.2, 3)", "−4.5", "max 5", "open"]
    assert all(row[2].room == row[3].room == 0 for row in rows)
    assert [row[3].text for row in rows] == ["met", "not met", "–", "met"]
