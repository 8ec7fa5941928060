"""Options of the commands that solve a scene at many points."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import click

from comparisons.cli.options import Decorated, parameters, positive, settings, sized, variants, verbose


def _place(ctx: click.Context, param: click.Parameter, value: str | None) -> str:
    """A place of workers."""
    if value is None:
        return f"local:{min(2, os.cpu_count() or 1)}"
    from comparisons.sweeps.workers import PLACES, place_of

    if place_of(value) is None:
        raise click.BadParameter(f"found {value!r}; allowed: {PLACES}")
    return value


def solved_often(command: Decorated) -> Decorated:
    """The command with the values of parameters, sizes and variants, and with workers, time limit and folder."""
    for option in (
        click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR",
                     help="Folder of tables and page; a stopped command goes on from there.  [default: COMMAND-NAME]"),
        verbose,
        click.option("-q", "--quiet", is_flag=True, help="Print neither tables nor progress."),
        click.option("--at-most", callback=positive, metavar="SECONDS", default="600", show_default=True,
                     help="Time limit of a solve; a solve that crashes or takes longer is tried twice."),
        click.option("--on", "place", callback=_place, metavar="local:N|dask://HOST:PORT",
                     help="Worker processes, or the scheduler of a Dask cluster.  [default: a process per core, at "
                     "most two]"),
        variants,
        sized,
        parameters,
    ):  # fmt: skip
        command = option(command)
    return command


def in_si(case: str) -> Callable[[str, str], float]:
    """Function that returns the SI value of a text for a parameter.

    The function raises SceneError for an unknown parameter, a wrong unit and a wrong value.
    """
    from comparisons.cases import opened

    return lambda name, text: opened(case, {**settings(), name: text}).parameters[name].value
