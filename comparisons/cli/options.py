"""Options of the commands as data: readers of their values, and groups of options that commands share."""

import logging
import math
import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

from comparisons import logs
from comparisons.choices import KINEMATICS, Choices

Value = TypeVar("Value")
Reader = Callable[[click.Context, click.Parameter, Any], Any]
"""Callback of click: the value of a text, None for an absent option; click.BadParameter for a wrong text."""

COUNT = "N|BEAM=N,..."
"""Metavar of a number of links or elements."""


def _reader(read: Callable[[Any], Value], allowed: str, holds: Callable[[Value], bool] = lambda value: True) -> Reader:
    """Reader of texts with a value that ``holds``; the message for all other texts says what is ``allowed``."""

    def value_of(ctx: click.Context, param: click.Parameter, text: Any) -> Any:  # noqa: ANN401 - text, path or None
        with suppress(ValueError):
            if text is None or holds(value := read(text)):
                return None if text is None else value
        raise click.BadParameter(f"found {getattr(text, 'name', text)!r}; allowed: {allowed}")

    return value_of


def _whole(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 4 and int(text) >= 1):
        raise click.BadParameter(f"found {text!r}; allowed: a whole number from 1 to 9999")
    return int(text)


def _several(text: str) -> tuple[int, ...]:
    return tuple(_whole(part.strip()) for part in text.split(","))


def _by_beam(text: str) -> int | dict[str, int]:
    if "=" not in text:
        return _whole(text)
    pairs = [[piece.strip() for piece in part.split("=", 1)] for part in text.split(",")]
    found = {beam: _whole(number) for beam, number in pairs}  # a pair without "=" is a ValueError
    if "" in found or len(found) < len(pairs):
        raise ValueError(text)
    return found


def _share(text: str) -> float:
    number = text.strip()
    return float(number.removesuffix("%")) / (100.0 if number.endswith("%") else 1.0)


def _values(texts: tuple[str, ...]) -> dict[str, str]:
    pairs = {name.strip(): text.strip() for name, _, text in (each.partition("=") for each in texts)}
    if not all((*pairs, *pairs.values())) or len(pairs) < len(texts):
        raise click.BadParameter(f"found {', '.join(texts)}; allowed: NAME=VALUE, such as t=1.9mm, once for each name")
    return pairs


count = _reader(_by_beam, "one number, or beam=number once for each beam")
whole = _reader(_whole, "a whole number from 1 to 9999")
counts = _reader(_several, "whole numbers between commas")
family_sizes = _reader(_several, "two numbers or more, each larger than the one before",
                       lambda found: len(found) > 1 and all(a < b for a, b in pairwise(found)))  # fmt: skip
positive = _reader(float, "a number greater than 0", lambda value: 0.0 < value < math.inf)
fraction = _reader(float, "a number greater than 0 and less than 1", lambda value: 0.0 < value < 1.0)
power_of_2 = _reader(int, "a power of 2 from 16 to 65536", lambda value: value in [1 << bits for bits in range(4, 17)])
tolerance = _reader(_share, "as 0.1% or as 0.001, greater than 0 and less than 1", lambda value: 0.0 < value < 1.0)
shard = _reader(lambda text: tuple(map(int, text.split("/"))), "I/N with I from 1 to N, as 3/64",
                lambda found: len(found) == 2 and 1 <= found[0] <= found[1])  # fmt: skip
opinions = _reader(lambda text: tuple(sorted(part.strip() for part in text.split(","))),
                   "cprbm,fea or cprbm,fea,solid",
                   lambda found: found in (("cprbm", "fea"), ("cprbm", "fea", "solid")))  # fmt: skip
drawing = _reader(Path, "a name that ends in .svg or .png", lambda path: path.suffix.lower() in (".svg", ".png"))


def numbers(ctx: click.Context, param: click.Parameter, texts: tuple[str, ...]) -> tuple[Any, ...]:
    """A number of links for every text of an option that may be repeated."""
    return tuple(count(ctx, param, text) for text in texts)


def listen(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the log of the solvers on standard error until the command ends."""
    if value:
        logs.print_from(logging.INFO)
        ctx.call_on_close(partial(logs.print_from, logging.NOTSET))


def candidates(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Names of cases with the beginning ``incomplete``, and files, if the argument accepts files."""
    from comparisons import cases

    accepted = param.metavar or ""
    # a shell looks for files if no name fits, and drops names in front of this item
    files = [CompletionItem(incomplete, type="file")] if "FILE" in accepted else []
    names = (*cases.names(), "all") if "all" in accepted else cases.names()
    return [*files, *(CompletionItem(name) for name in names if name.startswith(incomplete))]


_STANDARD, _THEORIES = Choices(), click.Choice(KINEMATICS)
FILE = click.Path(dir_okay=False, path_type=Path)
READ_FILE = click.Path(exists=True, dir_okay=False, path_type=Path)

flag = partial(click.Option, is_flag=True)
"""Option without a value."""

folder = partial(click.Option, ["--out"], type=click.Path(file_okay=False, path_type=Path), metavar="DIR")
"""Option ``--out DIR``."""

solver = partial(click.Option, ["--solver"], default="cprbm", show_default=True)
"""Option ``--solver`` with a name."""

opinions_for = partial(click.Option, ["--solver", "opinions"], callback=opinions, default="cprbm,fea",
                       show_default=True, metavar="SOLVERS")  # fmt: skip
"""Option ``--solver`` of a comparison."""

time_limit = partial(click.Option, ["--at-most"], callback=positive, metavar="SECONDS", show_default=True)
"""Option ``--at-most``."""

repeated = partial(click.Option, ["--repeat"], callback=whole, metavar="TIMES", default="5", show_default=True)
"""Option ``--repeat``."""

CASE = click.Argument(["case"], metavar="CASE|FILE.toml", shell_complete=candidates)
CASES = click.Argument(["arguments"], nargs=-1, required=True, metavar="CASE|FILE.toml...|all",
                       shell_complete=candidates)  # fmt: skip
SET = click.Option(["--set", "values"], callback=_reader(_values, "NAME=VALUE, such as t=1.9mm"), multiple=True,
                   metavar="NAME=VALUE",
                   help="Value of a parameter of the scene, such as t=1.9mm; may be repeated.")  # fmt: skip
SIZED = (
    click.Option(["-n", "--links", "links"], metavar=COUNT, default=str(_STANDARD.links), show_default=True,
                 callback=count, help="CPRBM links per beam: 40 for all beams, or beam1=30,beam2=40."),
    click.Option(["--elements"], metavar=COUNT, default=str(_STANDARD.elements), show_default=True, callback=count,
                 help="Finite elements per beam: 80 for all beams, or beam1=60,beam2=80."),
)  # fmt: skip
VARIANTS = (
    click.Option(["--formulation"], type=click.Choice(["auto", "paper"]), default=_STANDARD.formulation,
                 show_default=True, help="Contact formulation of the CPRBM."),
    click.Option(["--theory"], type=_THEORIES, help="Beam theory of both solvers.  [default: the scene's]"),
    click.Option(["--kinematics"], type=_THEORIES,
                 help="Beam theory of the finite elements; beside them the CPRBM answers in this theory.  "
                 "[default: as --theory]"),
)  # fmt: skip
NUMERICAL = (
    *SIZED,
    *VARIANTS,
    click.Option(["--across"], metavar="N", default=str(_STANDARD.across), show_default=True, callback=whole,
                 help="Elements of the solid across a beam's thickness."),
    click.Option(["--penetration"], metavar="SHARE", default=str(_STANDARD.penetration), show_default=True,
                 callback=fraction, help="Allowed overlap of the finite elements, over the thickness."),
    click.Option(["--tol"], callback=tolerance, metavar="TOL",
                 help="Double N until the stated error is below TOL, as 0.1% or 0.001, at every probe and station; "
                 "in place of -n, --elements, --across."),
)  # fmt: skip
EXACT = click.Option(
    ["--exact/--no-exact", "exact"], default=None,
    help="Ask the exact reference in bending, or leave the reference out; otherwise a rule on the number of pieces "
    "and stations decides.",
)  # fmt: skip
QUIET = flag(["-q", "--quiet"], help="Print neither tables nor progress.")
BRIEF = flag(["-q", "--quiet"], help="Print nothing about the written file.")
VERBOSE = flag(["-v", "--verbose"], expose_value=False, callback=listen,
               help="Print runs, stations and iterations on standard error, and all tables of 'compare'.")  # fmt: skip
OUTPUT = (
    click.Option(["--json", "json_file"], type=FILE, metavar="FILE",
                 help="Write the numbers as JSON in SI; '-' is standard output without further text."),
    QUIET,
    VERBOSE,
)  # fmt: skip
EXPORTS = (
    click.Option(["--csv", "csv_file"], type=FILE, metavar="FILE",
                 help="Write a table with a row per station, probe and component."),
    click.Option(["--plot", "plot_file"], type=FILE, metavar="FILE", callback=drawing,
                 help="Draw the mechanism at the last station, as .svg or .png."),
)  # fmt: skip
MANY = (
    SET,
    *SIZED,
    *VARIANTS,
    click.Option(["--on", "place"], default=lambda: f"local:{min(2, os.cpu_count() or 1)}",
                 metavar="local:N|dask://HOST:PORT",
                 help="Worker processes, or the scheduler of a Dask cluster.  [default: a process per core, at most "
                 "two]"),
    time_limit(help="Time limit of a solve; a solve that crashes or takes longer is tried twice.", default="600"),
    QUIET,
    VERBOSE,
    folder(help="Folder of tables and page; a stopped command goes on from there.  [default: COMMAND-NAME]"),
)  # fmt: skip
"""Options of a command that solves a scene at many points."""
