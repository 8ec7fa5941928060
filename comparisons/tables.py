"""Tables on the screen."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping
from typing import Literal

from rich import box
from rich.cells import cell_len
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from comparisons.sheet import Sheet

_COLOURS = {
    "AGREE": "green",
    "met": "green",
    "DIFFER": "bold red",
    "not met": "yellow",
    "UNDECIDED": "yellow",
    "within": "green",
    "beyond": "yellow",
    "far beyond": "bold red",
}


_BETWEEN, _EDGES = 3, 1
"""Columns of the screen that each column of a table takes beside its own, and the table as a whole."""

_PROSE = 24
"""Cells that are longer, and have spaces, are sentences: they fold between words, and numbers never do."""


def drawn(sheet: Sheet, *, width: int) -> str:
    """A sheet as text with terminal colours, at most ``width`` columns wide.

    A table that is wider is cut between columns into several, one below the other; the first column, and the unit
    beside it, stand in each.
    """
    texts = [list(column) for column in zip(sheet.headers, *sheet.rows, strict=True)]
    whole = [max(map(cell_len, column)) for column in texts]
    if _taken(whole) <= width:
        parts = [dict(enumerate(whole))]
    else:
        parts = _parted([_least(column) for column in texts], whole, width, led=_led(sheet))
    return "".join(
        _printed(_table(sheet, widths, first=place == 0, last=place == len(parts) - 1), width)
        for place, widths in enumerate(parts)
    )


def fitted(sheet: Sheet, *, width: int) -> list[str]:
    """Lines of a sheet without title and note, at most ``width`` columns wide: names fold, numbers do not."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for place, header in enumerate(sheet.headers):
        justify: Literal["left", "right"] = "left" if place == 0 or header == "word" else "right"
        table.add_column(header, justify=justify, overflow="fold", no_wrap=place > 0)
    for row in sheet.rows:
        table.add_row(*(Text(cell, style=_COLOURS.get(cell, "")) for cell in row))
    return [line.rstrip() for line in _printed(table, width).splitlines()]


def _printed(table: RenderableType, width: int) -> str:
    """Text of a table with terminal colours."""
    page = io.StringIO()
    # without a height a terminal that says it is "dumb" would have 80 columns whatever the width
    console = Console(file=page, width=width, height=25, force_terminal=True, color_system="standard")
    console.print(table)
    return page.getvalue()


def _table(sheet: Sheet, widths: Mapping[int, int], *, first: bool, last: bool) -> Table:
    """Those columns of a sheet that have ``widths``."""
    table = Table(
        title=sheet.title if first else None,
        caption=(sheet.note or None) if last else None,
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        title_style="bold",
    )
    for place, width in widths.items():
        justify: Literal["left", "right"] = "left" if place == 0 else "right"
        table.add_column(Text(sheet.headers[place]), justify=justify, overflow="fold", width=width)
    for row in sheet.rows:
        table.add_row(*(Text(row[place], style=_COLOURS.get(row[place], "")) for place in widths))
    return table


def _taken(widths: Iterable[int]) -> int:
    return _EDGES + sum(width + _BETWEEN for width in widths)


def _led(sheet: Sheet) -> int:
    """How many columns say what a row is of."""
    return 2 if sheet.headers[1:2] == ("unit",) else 1


def _least(column: list[str]) -> int:
    """The least width at which nothing folds within a word of the header, a sentence or a number."""
    header, *cells = column
    least = _longest_word(header)
    for cell in cells:
        prose = cell_len(cell) > _PROSE and " " in cell
        least = max(least, max(_PROSE, _longest_word(cell)) if prose else cell_len(cell))
    return least


def _longest_word(text: str) -> int:
    return max(map(cell_len, text.split()), default=0)


def _parted(least: list[int], whole: list[int], width: int, *, led: int) -> list[dict[int, int]]:
    """Widths by columns for as many tables as it takes, of which each begins with the columns that are ``led`` by."""
    lead = {place: least[place] for place in range(led)}
    # a name may be as long as it likes: then it folds
    lead[0] = min(lead[0], max(width - _taken([*least[1:led], max(least[led:], default=0)]) - _BETWEEN, 1))
    parts = [dict(lead)]
    for place in range(led, len(least)):
        if len(parts[-1]) > led and _taken([*parts[-1].values(), least[place]]) > width:
            parts.append(dict(lead))
        parts[-1][place] = min(least[place], max(width - _taken(lead.values()) - _BETWEEN, 1))
    for part in parts:
        for place in part:  # what room is left goes to the first columns that would have it
            part[place] += min(whole[place] - part[place], max(width - _taken(part.values()), 0))
    return parts
