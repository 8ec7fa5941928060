"""Cells of a table as a page has them: numbers under each other at their decimal points.

A column whose numbers have different digits behind the point is moved by spaces that are as wide as a digit, behind
each of its texts.  A column in which no text begins with a number is one of words.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from comparisons.sheet import Sheet

_NUMBER = re.compile(r"[+-]?\d+(?P<behind>(?:\.\d+)?(?:e[+-]?\d+)?)(?: %|°)?")
_SEVERAL = re.compile(r"\(?[+-]?\d")
_NOTHING = ("–", "open", "none", "all", "")
_DIGIT, _POINT = "\u2007", "\u2008"
"""Spaces as wide as a digit, and as a point."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A ``text``, the spaces ``behind`` it, and whether its column is one of ``words``."""

    text: str
    behind: str
    words: bool


def cells_of(sheet: Sheet) -> list[list[Cell]]:
    """The cells of all rows."""
    columns = [_column([row[place] for row in sheet.rows]) for place in range(len(sheet.headers))]
    return [list(row) for row in zip(*columns, strict=True)]


def words_in(sheet: Sheet) -> list[bool]:
    """Of each column whether it is one of words."""
    return [all(_is_word(row[place]) for row in sheet.rows) for place in range(len(sheet.headers))]


def _is_word(text: str) -> bool:
    return not _SEVERAL.match(text)


def _column(texts: list[str]) -> list[Cell]:
    if all(map(_is_word, texts)):
        return [Cell(text, "", words=True) for text in texts]
    found = [_NUMBER.fullmatch(text) for text in texts]
    alike = all(match or text in _NOTHING for match, text in zip(found, texts, strict=True))
    behind = [_width(match["behind"]) if match else "" for match in found]
    widest = max(behind, key=len) if alike else ""
    return [
        Cell(_signed(text), widest[: len(widest) - len(own)] if match else "", words=False)
        for text, match, own in zip(texts, found, behind, strict=True)
    ]


def _width(behind: str) -> str:
    """Spaces as wide as what stands behind a number's first digits, the point last, where it is missing first."""
    return _DIGIT * (len(behind) - behind.count(".")) + _POINT * behind.count(".")


def _signed(text: str) -> str:
    """With a minus that is as wide as a plus."""
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)
