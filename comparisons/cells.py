"""Cells of a table as a page has them: numbers under each other at their decimal points.

What stands behind the point of a number has a box of its own, which is as wide in all cells of a column.  A column in
which no text begins with a number is one of words.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from comparisons.sheet import Sheet

_NUMBER = re.compile(r"(?P<before>[+-]?\d+)(?P<behind>(?:\.\d+)?(?:e[+-]?\d+)?(?: %|°)?)")
_SEVERAL = re.compile(r"\(?[+-]?\d")
_NOTHING = ("–", "open", "none", "all", "")


@dataclass(frozen=True, slots=True)
class Cell:
    """A text in two parts.

    Attributes:
        before: up to the decimal point, or all of it.
        behind: the rest.
        room: how many digits wide the box of that is; 0 where there is none.
        words: whether the column is one of words.
    """

    before: str
    behind: str
    room: int
    words: bool

    @property
    def text(self) -> str:
        """All of it."""
        return self.before + self.behind


def cells_of(sheet: Sheet) -> list[list[Cell]]:
    """The cells of all rows."""
    columns = [_column([row[place] for row in sheet.rows]) for place in range(len(sheet.headers))]
    return [list(row) for row in zip(*columns, strict=True)]


def words_in(sheet: Sheet) -> list[bool]:
    """Of each column whether it is one of words."""
    return [all(_is_word(row[place]) for row in sheet.rows) for place in range(len(sheet.headers))]


def signed(text: str) -> str:
    """With a minus that is as wide as a plus."""
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)


def _is_word(text: str) -> bool:
    return not _SEVERAL.match(text)


def _column(texts: list[str]) -> list[Cell]:
    if all(map(_is_word, texts)):
        return [Cell(text, "", 0, words=True) for text in texts]
    found = [_NUMBER.fullmatch(text) for text in texts]
    if not all(match or text in _NOTHING for match, text in zip(found, texts, strict=True)):
        return [Cell(signed(text), "", 0, words=False) for text in texts]
    room = max(len(match["behind"]) for match in found if match)
    return [
        Cell(signed(match["before"]), match["behind"], room, words=False) if match else Cell(text, "", 0, words=False)
        for text, match in zip(texts, found, strict=True)
    ]
