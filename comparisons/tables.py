"""Tables on the screen."""

from __future__ import annotations

import io

from rich import box
from rich.console import Console
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


def drawn(sheet: Sheet, *, width: int) -> str:
    """A sheet as text with terminal colours, at most ``width`` columns wide."""
    table = Table(
        title=sheet.title,
        caption=sheet.note or None,
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        title_style="bold",
    )
    for place, header in enumerate(sheet.headers):
        table.add_column(Text(header), justify="left" if place == 0 else "right", overflow="fold")
    for row in sheet.rows:
        table.add_row(*(Text(cell, style=_COLOURS.get(cell, "")) for cell in row))
    page = io.StringIO()
    Console(file=page, width=width, force_terminal=True, color_system="standard").print(table)
    return page.getvalue()
