"""``cprbm new``: a first scene."""

from __future__ import annotations

import re
from pathlib import Path

import click

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]{0,63}")


@click.command("new")
@click.argument("name")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing about the written file.")
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", default=".", show_default=True,
              help="Folder for the scene and its schema.")  # fmt: skip
def command(
    name: str,
    out: Path,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
) -> int:
    """Write NAME.toml, a commented scene to start from.

    The scene is a small mechanism; change the scene into your own. A JSON schema beside the file lets editors
    complete keys and mark mistakes.
    """
    if not _NAME.fullmatch(name):
        allowed = "letters, digits, '_' and '-', a letter or '_' first, 64 at most"
        raise click.BadParameter(f"found {name!r}; allowed: {allowed}", param_hint="NAME")
    from comparisons.starting.begun import begin

    try:
        path = begin(name, out)
    except FileExistsError as error:
        raise click.UsageError(f"found {error.args[0]}, an existing file; allowed: another name.") from None
    if not quiet:
        click.echo(f"{path}: change the scene, then run 'cprbm compare {path}'.")
    return 0
