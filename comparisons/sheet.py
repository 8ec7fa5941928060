"""A table of texts, for the screen and for the page alike."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table of texts: ``rows`` have as many cells as ``headers``; ``note`` says how to read it."""

    title: str
    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def without_empty(sheet: Sheet) -> Sheet:
    """The table without the columns that have a dash, or nothing, in every row."""
    kept = [place for place in range(len(sheet.headers)) if any(row[place] not in ("", "–") for row in sheet.rows)]
    headers = tuple(sheet.headers[place] for place in kept)
    return replace(sheet, headers=headers, rows=tuple(tuple(row[place] for place in kept) for row in sheet.rows))
