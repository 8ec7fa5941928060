"""Tables on the screen and cells of tables on a page.

A table wider than the screen splits between columns into several tables; the first column, and a unit beside it, stand
in all of them.  Sentences fold between words, and numbers never fold.
"""

import io
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from rich import box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table as Grid
from rich.text import Text

from comparisons.present.columns import Table

STYLES = {
    "AGREE": "green", "met": "green", "within": "green", "UNDECIDED": "yellow", "not met": "yellow",
    "beyond": "yellow", "DIFFER": "bold red", "far beyond": "bold red",
}  # fmt: skip
"""Colours of cells; a page has styles for the same words."""

_GAP, _EDGES = 3, 1
"""Columns of the screen beside every column of a table, and beside the table."""

_NAME = 8
"""Least columns for the names of a brief table."""

_LONG = 24
"""Most characters of a text with spaces without a fold."""

_SENTENCE = 60
"""Characters of a text longer than all numbers."""

_NUMBER = re.compile(r"([+−-]?\d+)((?:\.\d+)?(?:e[+-]?\d+)?(?: %|°)?)")
_NUMERIC = re.compile(r"\(?[+−-]?\d")
_OTHERS = ("–", "open", "none", "all", "")
"""Further texts in a column of numbers."""


def screen_text(table: Table, *, width: int) -> str:
    """The table with terminal colours, at most ``width`` columns wide."""
    columns = [*zip(table.headers, *table.rows, strict=True)]
    parts = [_printed(Text(table.title, style="bold"), width)] if table.title else []
    for widths in _split(columns, 2 if table.headers[1:2] == ("unit",) else 1, width):
        grid = Grid(box=box.SIMPLE_HEAD)
        for column, size in widths.items():
            left = column == 0 or any(cell_len(row[column]) > _LONG for row in table.rows)  # names and sentences
            grid.add_column(
                Text(table.headers[column]), justify="left" if left else "right", overflow="fold", width=size
            )
        _fill(grid, [[row[column] for column in widths] for row in table.rows])
        parts.append(_printed(grid, width))
    return "".join((*parts, _printed(Text(table.note, style="dim italic"), width) if table.note else ""))


def brief_lines(table: Table, *, width: int) -> list[str]:
    """Lines of the table without title and note, at most ``width`` columns wide.

    Names fold behind points, spaces or underscores.  Where less than ``_NAME`` columns are left for the names, the
    table splits as on the screen.
    """
    others = zip(*(row[1:] for row in (table.headers, *table.rows)), strict=True)
    room = width - sum(2 + max(map(cell_len, cells)) for cells in others)
    if room < _NAME:
        return screen_text(replace(table, title="", note=""), width=width).splitlines()
    grid = Grid(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for place, header in enumerate(table.headers):
        left = place == 0 or header == "word"
        grid.add_column(header, justify="left" if left else "right", overflow="fold", no_wrap=place > 0)
    part = rf".{{1,{room}}}(?:$|(?<=[. ])(?=[^\W\d]))|.{{1,{room}}}(?<=_)|.{{1,{room}}}"
    _fill(grid, (("\n".join(re.findall(part, name)), *cells) for name, *cells in table.rows))
    return [line.rstrip() for line in _printed(grid, width).splitlines()]


def _fill(grid: Grid, rows: Iterable[Iterable[str]]) -> None:
    for row in rows:
        grid.add_row(*(Text(cell, style=STYLES.get(cell.partition(" (")[0], "")) for cell in row))


def _printed(content: Grid | Text, width: int) -> str:
    page = io.StringIO()
    # without a height a "dumb" terminal would have 80 columns whatever the width
    Console(file=page, width=width, height=25, force_terminal=True, color_system="standard").print(content)
    return page.getvalue()


def _total(widths: Iterable[int]) -> int:
    return _EDGES + sum(width + _GAP for width in widths)


def _least(column: Iterable[str]) -> int:
    """Least width of a column: of long texts with spaces the longest word."""
    prose = (max(map(cell_len, text.split())) if cell_len(text) > _LONG and " " in text else cell_len(text)
             for text in column)  # fmt: skip
    return max(prose)


def _split(columns: list[tuple[str, ...]], leading: int, width: int) -> list[dict[int, int]]:
    """Widths by column for every part of a table; all parts begin with the ``leading`` columns."""
    whole, least = [max(map(cell_len, column)) for column in columns], [*map(_least, columns)]
    if _total(whole) <= width:
        return [dict(enumerate(whole))]
    lead = dict(enumerate(least[:leading]))
    lead[0] = min(lead[0], max(width - _total([*least[1:leading], max(least[leading:], default=0)]) - _GAP, 1))
    parts = [dict(lead)]
    for place in range(leading, len(columns)):
        if len(parts[-1]) > leading and _total([*parts[-1].values(), least[place]]) > width:
            parts.append(dict(lead))
        parts[-1][place] = min(least[place], max(width - _total(lead.values()) - _GAP, 1))
    for part in parts:
        for place in part:  # the first columns take the rest of the width
            part[place] += min(whole[place] - part[place], max(width - _total(part.values()), 0))
    return parts


class Cell(NamedTuple):
    """Cell on a page: texts ``before`` and ``behind`` the decimal point.

    ``room`` is the width of the part behind the point in digits, 0 without such a part; ``words`` marks a column of
    words.
    """

    before: str
    behind: str = ""
    room: int = 0
    words: bool = False

    @property
    def text(self) -> str:
        """The whole text."""
        return self.before + self.behind


def html_cells(table: Table) -> list[list[Cell]]:
    """Cells of all rows; numbers of a column align at their decimal points."""
    columns = [_aligned([row[place] for row in table.rows]) for place in range(len(table.headers))]
    return [list(row) for row in zip(*columns, strict=True)]


def with_minus(text: str) -> str:
    """Text with true minus signs, as wide as a plus."""
    return re.sub(r"(?<![\w.])-(?=\d)", "−", text)


def _aligned(texts: list[str]) -> list[Cell]:
    if not any(map(_NUMERIC.match, texts)) or max(map(len, texts)) > _SENTENCE:
        return [Cell(text, words=True) for text in texts]
    found = [(text, match[1], match[2]) if (match := _NUMBER.fullmatch(text)) else (text, "", "") for text in texts]
    whole = not all(before or text in _OTHERS for text, before, _ in found)
    room = max(len(behind) for *_, behind in found)
    return [
        Cell(with_minus(before), behind, room) if before and not whole else Cell(with_minus(text))
        for text, before, behind in found
    ]
