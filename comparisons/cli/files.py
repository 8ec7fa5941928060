"""``cprbm new``, ``import`` and ``schema``: scene files to start from."""

import json
import re
from importlib.resources import files
from pathlib import Path
from shlex import quote

import click

from comparisons.cli.doctor import line_for
from comparisons.cli.errors import printable
from comparisons.importing.drawing import read_drawing
from comparisons.importing.scene_text import Choices, Unit, name_of, scene_text
from comparisons.writing import write
from cprbm_scene.fields import NAME
from cprbm_scene.reading import schema as schema_of_scenes

SCHEMA = "scene.schema.json"
"""Name of the schema's file, beside the scene that refers to it."""


def new(name: str, out: Path, quiet: bool) -> None:  # noqa: FBT001 - click passes a keyword
    """Write the first scene and its schema.

    Raises:
        click.UsageError: the name is wrong, or the file exists.
    """
    path = _free_path(out, name.removesuffix(".toml"), "NAME", "another name")
    write(path, first_scene(path.stem, quote(path.name)))
    write(out / SCHEMA, _schema_text())
    if not quiet:
        click.echo(printable(f"{path}: change the scene, then run: cprbm compare {quote(str(path))}"))


def import_drawing(
    drawing: Path, thickness: float, width: float, unit: Unit, within: float, name: str | None, out: Path
) -> None:
    """Write the scene of a drawing, and the notes on wrong curves.

    Raises:
        click.ClickException: the name is wrong, the file exists, or gmsh lacks libraries of the system.
    """
    named = name_of(drawing.stem) if name is None else name
    path = _free_path(out, named, "--name", "another --name")
    try:
        drawn = read_drawing(drawing, unit)
    except ImportError as error:
        if line := line_for("gmsh", str(error)):
            text = f"gmsh cannot be loaded ({error}). On Debian and Ubuntu install its libraries with: {line}"
            raise click.ClickException(text) from None
        raise
    text, notes = scene_text(drawn, drawing, Choices(named, unit, thickness, width, within))
    write(path, text)
    for note in notes:
        click.echo(printable(f"{drawing}: {note}"), err=True)
    click.echo(printable(f"{path}: change load and probes, then run: cprbm compare {quote(str(path))}"))


def schema() -> None:
    """Print the JSON schema of scene files."""
    click.echo(_schema_text(), nl=False)


def first_scene(name: str, file: str) -> str:
    """The first scene, commented, under a ``name``, with commands for a ``file``."""
    template = files("comparisons.importing").joinpath("scene.toml").read_text(encoding="utf-8")
    return template.replace("{schema}", SCHEMA).replace("{name}", name).replace("{file}", file)


def _schema_text() -> str:
    """The JSON schema of scene files, with a line end."""
    return json.dumps(schema_of_scenes(), indent=1, ensure_ascii=False) + "\n"


def _free_path(out: Path, name: str, hint: str, remedy: str) -> Path:
    """The path of a new scene.

    Raises:
        click.UsageError: the name is wrong, or the file exists.
    """
    if not re.search(NAME, name) or len(name) > 64:
        allowed = "letters, digits, '_', '-' and single spaces inside, a letter or '_' first, 64 at most"
        raise click.BadParameter(f"found {name!r}; allowed: {allowed}", param_hint=hint)
    path = out / f"{name}.toml"
    if path.exists():
        raise click.UsageError(f"found {path}, an existing file; allowed: {remedy}.")
    return path
