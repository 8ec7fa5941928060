"""``cprbm new``: a scene of one's own to start from."""

from __future__ import annotations

import re
from pathlib import Path

import click

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]{0,63}")


@click.command("new")
@click.argument("name")
@click.option("-q", "--quiet", is_flag=True, help="Say nothing of what was written.")
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", default=".", show_default=True,
              help="Folder for the scene and its schema.")  # fmt: skip
def command(
    name: str,
    out: Path,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
) -> int:
    """Write NAME.toml: a small mechanism with comments, to be changed into one's own.

    Beside it stands a JSON schema, by which editors that know TOML complete keys and mark mistakes.
    """
    if not _NAME.fullmatch(name):
        allowed = "letters, digits, '_' and '-', a letter or '_' first, 64 at most"
        raise click.BadParameter(f"found {name!r}; allowed: {allowed}", param_hint="NAME")
    from comparisons.starting.begun import begin

    try:
        path = begin(name, out)
    except FileExistsError as error:
        raise click.UsageError(f"found {error.args[0]}, which is kept as it is; allowed: another name.") from None
    if not quiet:
        click.echo(f"{path}: change it, and ask 'cprbm compare {path}'.")
    return 0
