"""Options of the commands that solve a scene at many points."""

from __future__ import annotations

import os
from collections.abc import Callable

import click

from comparisons.cli.options import (
    folder,
    group,
    parameters,
    quietness,
    settings,
    sized,
    time_limit,
    variants,
    verbose,
)


def _place(ctx: click.Context, param: click.Parameter, value: str | None) -> str:
    """A place of workers."""
    if value is None:
        return f"local:{min(2, os.cpu_count() or 1)}"
    from comparisons.sweeps.workers import PLACES, place_of

    if place_of(value) is None:
        raise click.BadParameter(f"found {value!r}; allowed: {PLACES}")
    return value


solved_often = group(
    parameters,
    sized,
    variants,
    click.option("--on", "place", callback=_place, metavar="local:N|dask://HOST:PORT",
                 help="Worker processes, or the scheduler of a Dask cluster.  [default: a process per core, at most "
                 "two]"),
    time_limit("Time limit of a solve; a solve that crashes or takes longer is tried twice.", "600"),
    quietness,
    verbose,
    folder("Folder of tables and page; a stopped command goes on from there.  [default: COMMAND-NAME]"),
)  # fmt: skip
"""Options of a command that solves often: parameters, sizes, variants, workers, time limit and folder."""


def in_si(case: str) -> Callable[[str, str], float]:
    """Function that returns the SI value of a text for a parameter.

    The function raises SceneError for an unknown parameter, a wrong unit and a wrong value.
    """
    from comparisons.cases import opened

    return lambda name, text: opened(case, {**settings(), name: text}).parameters[name].value
