"""``cprbm view``: picture, animation or VTU files of the deformed mechanism."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from comparisons.audit import audit
from comparisons.cli.answers import SolverName, answer_of, report_problems
from comparisons.cli.output import make_room
from comparisons.cli.questions import scene_of
from comparisons.cli.request import Request
from comparisons.display_units import at_station, file_unit
from comparisons.present import animation
from comparisons.present.space import DrawingError
from comparisons.present.strips import Coloured, with_stresses
from comparisons.quantities import load_unit
from comparisons.starting.present import WHAT_DRAWS
from comparisons.writing import write
from cprbm_scene import Scene

_ROUNDING = 1e-9
"""Largest distance of a typed station, a share of the station: decimal digits are rounded."""


def view(request: Request, solver: SolverName, quantity: Coloured, station: str | None) -> int:
    """Write pictures of the answer of a solver; the exit code.

    Raises:
        click.BadParameter: the file has no known ending, or the station does not exist.
        click.ClickException: VTK cannot draw here.
    """
    scene = with_stresses(scene_of(request))
    path = request.out or Path(f"{scene.name}.png")
    kind = animation.kind_of(path)
    if kind is None:
        allowed = f"a name that ends in {', '.join(animation.KINDS)}"
        raise click.BadParameter(f"found {path.name!r}; allowed: {allowed}", param_hint="--out")
    last = None if station is None else _station(scene, station)
    make_room(out=path.parent)
    answer, searches = answer_of(request, scene, solver)
    code = report_problems(scene, answer, searches, audit(scene, answer).complaints)
    places = [place for place, each in enumerate(answer.stations, 1) if last in (None, (each.stage, each.value))]
    if not places:
        click.echo(f"cprbm: {scene.name}: no picture, since the solver did not reach the station.", err=True)
        return code
    shown = replace(answer, stations=answer.stations[: places[-1]])
    try:
        for file, content in animation.files(scene, shown, path, kind, quantity):
            write(file, content)
    except DrawingError as trouble:
        remedy = f"On Debian and Ubuntu install its libraries with: {WHAT_DRAWS}"
        raise click.ClickException(f"VTK cannot draw in space here ({trouble}). {remedy}") from None
    if not request.quiet:
        end = shown.stations[-1]
        click.echo(f"{path}: {scene.name} by {solver}, {at_station(scene, end.stage, end.value)}.")
    return code


def _station(scene: Scene, text: str) -> tuple[str, float]:
    """The last station of the scene with the stage and the value of a text, in the units of the scene's file.

    Raises:
        click.BadParameter: the text names no station.
    """
    stage, _, value = text.rpartition(":")
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    known = [(each.name, v, v / file_unit(scene, load_unit(scene, each))[0])
             for each in scene.stages for v in each.stations]  # fmt: skip
    for name, load, typed in reversed(known):
        if stage in ("", name) and abs(typed - number) <= _ROUNDING * max(abs(typed), abs(number)):
            return name, load
    allowed = ", ".join(f"{name}:{typed:g}" for name, _, typed in known[:40]) + (", ..." if len(known) > 40 else "")
    raise click.BadParameter(f"found {text!r}; allowed: one of {allowed}", param_hint="--station")
