"""``cprbm import``: a scene from the curves of a drawing."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.options import fraction, positive
from comparisons.cli.text import printable

if TYPE_CHECKING:
    from comparisons.importing.scene_text import Unit

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]{0,63}")


@click.command("import")
@click.argument("drawing", metavar="FILE", type=click.Path(path_type=Path))
@click.option("--thickness", callback=positive, required=True, metavar="T",
              help="Thickness of the beams, in the file's unit.")  # fmt: skip
@click.option("--width", callback=positive, required=True, metavar="W", help="Width of the beams, in the file's unit.")
@click.option("--unit", type=click.Choice(["m", "cm", "mm", "um", "in"]), default="mm", show_default=True,
              help="Unit of lengths in the file, and in the scene.")  # fmt: skip
@click.option("--within", callback=fraction, default="1e-5", show_default=True, metavar="SHARE",
              help="Allowed distance of a spline from its curve, over the length of the curve.")  # fmt: skip
@click.option("--name", metavar="NAME", help="Name of the scene.  [default: the name of the file]")
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", default=".", show_default=True,
              help="Folder for NAME.toml.")  # fmt: skip
def command(
    drawing: Path, thickness: float, width: float, unit: Unit, within: float, name: str | None, out: Path
) -> int:
    """Write a scene from the curves of a drawing.

    FILE is a table of points (.csv), a .dxf (read by ezdxf), or a .geo, .step, .msh, .brep or .iges (read by gmsh).
    Lines and circular arcs stay exact; other curves become splines with a stated distance. Wrong curves are left out
    and named. gmsh runs a .geo file as a program: import trusted files only.
    """
    from comparisons.importing.formats import read_drawing
    from comparisons.importing.scene_text import Choices, scene_text
    from comparisons.writing import write

    named = re.sub(r"[^A-Za-z0-9_-]", "_", drawing.stem) if name is None else name
    if not _NAME.fullmatch(named):
        allowed = "letters, digits, '_' and '-', a letter or '_' first, 64 at most"
        raise click.BadParameter(f"found {named!r}; allowed: {allowed}", param_hint="--name")
    path = out / f"{named}.toml"
    if path.exists():
        raise click.UsageError(f"found {path}, an existing file; allowed: another --name.")
    try:
        drawn = read_drawing(drawing, unit)
    except ImportError as error:
        from comparisons.starting.present import line_for

        line = line_for("gmsh", str(error))
        if not line:
            raise
        raise click.ClickException(
            f"gmsh cannot be loaded ({error}). On Debian and Ubuntu install its libraries with: {line}"
        ) from None
    text, notes = scene_text(drawn, drawing, Choices(named, unit, thickness, width, within))
    write(path, text)
    for note in notes:
        click.echo(printable(f"{drawing}: {note}"), err=True)
    click.echo(printable(f"{path}: change load and probes, then run 'cprbm compare {path}'."))
    return 0
