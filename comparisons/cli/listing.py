"""``cprbm list``: the built-in cases."""

from __future__ import annotations

import click

from comparisons import cases


def list_cases() -> None:
    """Print name, title and source of every built-in case."""
    for name, title, source in cases.described():
        click.echo(f"{name:<16} {title}" + (f" ({source})" if source else ""))
