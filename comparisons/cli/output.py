"""Output of the commands: tables, sentences and JSON."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable
from pathlib import Path

import click

from comparisons.present.columns import Section, Table
from comparisons.writing import Plain, text_of, write

_PLAIN_WIDTH = 140
"""Columns of tables outside a terminal."""


def print_tables(tables: Iterable[Table], most: int = 10_000) -> None:
    """Print tables with at most ``most`` columns; colours appear on a terminal only."""
    from comparisons.present.table import screen_text  # loads rich

    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else _PLAIN_WIDTH
    for table in tables:
        click.echo(screen_text(table, width=min(width, most)))


def print_section(section: Section) -> None:
    """Print the tables and sentences of a section."""
    print_tables(section.tables)
    for sentence in section.sentences:
        click.echo(sentence + "\n")


def write_json(file: Path | None, data: Plain) -> None:
    """Write JSON to a file, or to standard output if the file is ``-``; without a file nothing.

    Raises:
        OSError: the file cannot be written.
    """
    if str(file) == "-":
        click.echo(text_of(data), nl=False)
    elif file is not None:
        write(file, text_of(data))
