"""``cprbm list``: the built-in cases."""

from __future__ import annotations

import click


@click.command("list")
def command() -> None:
    """List the built-in cases."""
    from comparisons import cases

    for name, title, source in cases.described():
        click.echo(f"{name:<16} {title}" + (f" ({source})" if source else ""))
