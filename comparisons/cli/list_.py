"""``cprbm list``: the built-in cases."""

from __future__ import annotations

import click


@click.command("list")
def command() -> None:
    """Show the built-in cases, one line each."""
    from comparisons import cases

    for name in cases.names():
        scene = cases.opened(name)
        click.echo(f"{name:<16} {scene.title}" + (f" ({scene.source})" if scene.source else ""))
