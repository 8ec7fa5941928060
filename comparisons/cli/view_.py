"""``cprbm view``: picture, animation or VTU files of the deformed mechanism."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.cli.answers import SOLVERS, SolverName, report_problems, solve_scene
from comparisons.cli.completion import candidates
from comparisons.cli.options import choices_for, numerical, parameters, refuse_sizes_with, settings, verbose

if TYPE_CHECKING:
    from comparisons.present.strips import Coloured
    from cprbm_scene import Answer, Scene

_ROUNDING = 1e-9
"""Share of a station by which a typed station may differ: decimal digits are rounded."""

_QUANTITIES = ("bending_stress", "combined_stress", "moment")


@click.command("view")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@parameters
@click.option("--solver", type=click.Choice(SOLVERS), default="cprbm", show_default=True,
              help="Solver of the scene.")  # fmt: skip
@click.option("--out", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE",
              help="File to write; the ending selects the kind: .png, .svg; .gif, .apng (animation through the "
              "stations); .3d.png, .3d.gif, .3d.apng (in space, by PyVista); .vtu, .pvd (a station, all stations, "
              "for ParaView).  [default: the scene's name with .png]")  # fmt: skip
@click.option("--quantity", type=click.Choice(_QUANTITIES), default=_QUANTITIES[0], show_default=True,
              help="Quantity behind the colours of the beams.")  # fmt: skip
@click.option("--station", metavar="[STAGE:]VALUE",
              help="The station to show, in the file's units.  [default: the last of all]")  # fmt: skip
@numerical
@click.option("-q", "--quiet", is_flag=True, help="Print nothing about the written file.")
@verbose
@click.pass_obj
def command(
    planted: object,
    case: str,
    solver: SolverName,
    out: Path | None,
    quantity: Coloured,
    station: str | None,
    tol: float | None,
    quiet: bool,  # noqa: FBT001 - click passes a keyword
) -> int:
    """Draw a solver's answer: picture, animation or VTU files."""
    from comparisons import cases
    from comparisons.audit import audit
    from comparisons.cli import output
    from comparisons.display_units import at_station
    from comparisons.present.animation import KINDS, files, kind_of
    from comparisons.present.space import DrawingError
    from comparisons.present.strips import with_stresses
    from comparisons.writing import write

    refuse_sizes_with(tol)
    scene = with_stresses(cases.opened(case, settings()))
    path = Path(f"{scene.name}.png") if out is None else out
    kind = kind_of(path)
    if kind is None:
        raise click.BadParameter(f"found {path.name!r}; allowed: a name that ends in {', '.join(KINDS)}",
                                 param_hint="--out")  # fmt: skip
    wanted = None if station is None else _wanted(scene, station)
    choices = choices_for(scene)
    output.room_for(None, path.parent)
    answer, found = solve_scene(planted, scene, solver, choices, tol, shown=not quiet)
    code = report_problems(scene, answer, found, audit(scene, answer).complaints)
    seen = _up_to(answer, wanted)
    if not seen.stations:
        click.echo(f"cprbm: {scene.name}: no picture, since the solver did not reach the station.", err=True)
        return code
    try:
        for file, content in files(scene, seen, path, kind, quantity):
            write(file, content)
    except DrawingError as trouble:
        from comparisons.starting.present import WHAT_DRAWS

        raise click.ClickException(
            f"VTK cannot draw in space here ({trouble}). On Debian and Ubuntu install its libraries with: {WHAT_DRAWS}"
        ) from None
    if not quiet:
        click.echo(
            f"{path}: {scene.name} by {solver}, {at_station(scene, seen.stations[-1].stage, seen.stations[-1].value)}."
        )
    return code


def _wanted(scene: Scene, text: str) -> tuple[str, float]:
    """The last station of the scene that a text names, by its value in the units of the scene's file.

    Raises:
        click.BadParameter: the text names no station.
    """
    from comparisons.display_units import file_unit
    from comparisons.quantities import load_unit

    stage, _, value = text.rpartition(":")
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    known = [(s.name, v, v / file_unit(scene, load_unit(scene, s))[0]) for s in scene.stages for v in s.stations]
    for name, load, typed in reversed(known):
        if stage in ("", name) and abs(typed - number) <= _ROUNDING * max(abs(typed), abs(number)):
            return name, load
    allowed = ", ".join(f"{name}:{typed:g}" for name, _, typed in known[:40]) + (", ..." if len(known) > 40 else "")
    raise click.BadParameter(f"found {text!r}; allowed: one of {allowed}", param_hint="--station")


def _up_to(answer: Answer, wanted: tuple[str, float] | None) -> Answer:
    """The answer up to the ``wanted`` station; without stations if the solver did not reach the station."""
    if wanted is None:
        return answer
    places = [place for place, each in enumerate(answer.stations) if (each.stage, each.value) == wanted]
    return replace(answer, stations=answer.stations[: places[-1] + 1] if places else ())
