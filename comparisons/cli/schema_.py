"""``cprbm schema``: the JSON schema for editors of scene files."""

from __future__ import annotations

import json

import click


@click.command("schema")
def command() -> int:
    """Print the JSON schema of scene files."""
    from cprbm_scene.reading import schema

    click.echo(json.dumps(schema(), indent=1, ensure_ascii=False))
    return 0
