"""Output of a section that grows step by step: JSON, folder with page and figures, and screen."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

if TYPE_CHECKING:
    from comparisons.present.columns import Section

Found = TypeVar("Found")
Step = TypeVar("Step")


@dataclass(frozen=True, slots=True)
class SectionOutput:
    """Files and screen for a section, also for a partial section."""

    json_file: Path | None
    out: Path | None
    quiet: bool

    @property
    def writes(self) -> bool:
        """True with an output file or folder."""
        return self.out is not None or (self.json_file is not None and str(self.json_file) != "-")

    def write(self, result: Section) -> None:
        """Write the files.

        Raises:
            OSError: a file cannot be written.
        """
        from comparisons.cli import output
        from comparisons.present.page import Page, put_page, put_section

        if self.json_file is not None and str(self.json_file) != "-":
            output.json(self.json_file, dict(result.data))
        if self.out is not None:
            put_section(self.out, result)
            put_page(self.out, Page(result.heading, "", further=(result,)), result.name)

    def show(self, result: Section) -> None:
        """Print the result on standard output."""
        from comparisons.cli import output

        if str(self.json_file) == "-":
            output.json(Path("-"), dict(result.data))
            return
        if self.quiet:
            return
        output.sections([result])
        if self.out is not None:
            click.echo(f"report: {self.out / result.name}.html")


def run_steps(
    found: Found,
    steps: Iterable[Step],
    taken: Callable[[Found, Step], Found],
    result_of: Callable[[Found], Section],
    shown: SectionOutput,
) -> Found:
    """The finished study; every step writes the partial result, and an interrupted study shows its result."""
    last: Section | None = None
    try:
        for step in steps:
            found, last = taken(found, step), None
            if shown.writes:
                last = result_of(found)
                shown.write(last)
    finally:
        if last is None:
            last = result_of(found)
            shown.write(last)
        shown.show(last)
    return found
