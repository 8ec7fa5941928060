"""Options of several sub-commands, and the readers of their values."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from comparisons.choices import KINEMATICS, Choices

Decorated = Callable[..., Any]

COUNT = "N|BEAM=N,..."
"""Metavar of a number of links or elements."""


def count(ctx: click.Context, param: click.Parameter, value: str) -> int | dict[str, int]:
    """One number for all beams, or ``beam1=30,beam2=40`` as numbers by beam.

    Raises:
        click.BadParameter: the text is neither.
    """
    if "=" not in value:
        return _whole(value)
    counts: dict[str, int] = {}
    for part in value.split(","):
        beam, equals, text = (piece.strip() for piece in part.partition("="))
        if not equals or not beam or beam in counts:
            raise click.BadParameter(f"found {value!r}; allowed: one number, or beam=number once for each beam")
        counts[beam] = _whole(text)
    return counts


def _whole(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 4 and int(text) >= 1):
        raise click.BadParameter(f"found {text!r}; allowed: a whole number from 1 to 9999")
    return int(text)


def whole(ctx: click.Context, param: click.Parameter, value: str) -> int:
    """A whole number from 1 to 9999.

    Raises:
        click.BadParameter: the text is no such number.
    """
    return _whole(value)


def counts(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[int, ...] | None:
    """Whole numbers between commas; None without the option.

    Raises:
        click.BadParameter: the text is something else.
    """
    return None if value is None else tuple(_whole(text.strip()) for text in value.split(","))


def family_sizes(ctx: click.Context, param: click.Parameter, value: str) -> tuple[int, ...]:
    """Two or more ascending whole numbers.

    Raises:
        click.BadParameter: the text is something else.
    """
    found = tuple(_whole(text.strip()) for text in value.split(","))
    if len(found) < 2 or any(b <= a for a, b in pairwise(found)):
        raise click.BadParameter(f"found {value!r}; allowed: two numbers or more, each larger than the one before")
    return found


def positive(ctx: click.Context, param: click.Parameter, value: str) -> float:
    """A positive, finite number.

    Raises:
        click.BadParameter: the text is no such number.
    """
    number = _number(value)
    if not 0.0 < number < math.inf:
        raise click.BadParameter(f"found {value!r}; allowed: a number greater than 0")
    return number


def fraction(ctx: click.Context, param: click.Parameter, value: str) -> float:
    """A positive number below 1.

    Raises:
        click.BadParameter: the text is no such number.
    """
    number = _number(value)
    if not 0.0 < number < 1.0:
        raise click.BadParameter(f"found {value!r}; allowed: a number greater than 0 and less than 1")
    return number


def tolerance(ctx: click.Context, param: click.Parameter, value: str | None) -> float | None:
    """``0.1%`` or ``0.001`` as a fraction; None without the option.

    Raises:
        click.BadParameter: the text is neither, or does not lie between 0 and 100 %.
    """
    if value is None:
        return None
    text = value.strip()
    number = _number(text[:-1]) / 100.0 if text.endswith("%") else _number(text)
    if not 0.0 < number < 1.0:
        raise click.BadParameter(f"found {value!r}; allowed: as 0.1% or as 0.001, greater than 0 and less than 1")
    return number


def opinions(ctx: click.Context, param: click.Parameter, value: str) -> bool:
    """True for ``cprbm,fea,solid``, False for ``cprbm,fea``.

    Raises:
        click.BadParameter: the text names other solvers.
    """
    named = [part.strip() for part in value.split(",")]
    if sorted(named) not in (["cprbm", "fea"], ["cprbm", "fea", "solid"]):
        raise click.BadParameter(f"found {value!r}; allowed: cprbm,fea or cprbm,fea,solid")
    return "solid" in named


def refuse_sizes_with(tol: float | None) -> None:
    """Refuse a number of links or elements beside a tolerance.

    Raises:
        click.UsageError: the command line has both.
    """
    source = click.get_current_context().get_parameter_source
    for name, option in (("links", "-n"), ("elements", "--elements"), ("across", "--across")):
        if tol is not None and source(name) is not ParameterSource.DEFAULT:
            raise click.UsageError(f"found --tol and {option}; allowed: only one of the two, since --tol searches N.")


def _store(ctx: click.Context, param: click.Parameter, value: tuple[str, ...]) -> None:
    """Store the values of parameters by name in the context."""
    named = [part.partition("=") for part in value]
    if not all(name.strip() and text.strip() for name, _, text in named):
        raise click.BadParameter(f"found {', '.join(value)}; allowed: NAME=VALUE, such as t=1.9mm")
    ctx.meta[__name__] = {name.strip(): text.strip() for name, _, text in named}


parameters = click.option("--set", callback=_store, multiple=True, expose_value=False, metavar="NAME=VALUE",
                          help="Value of a parameter of the scene, such as t=1.9mm; may be repeated.")  # fmt: skip


def settings() -> dict[str, str]:
    """Values of the option ``--set`` of the running command, by parameter name."""
    return dict(click.get_current_context().meta.get(__name__, {}))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def variants(command: Decorated) -> Decorated:
    """The command with ``--formulation``, ``--theory`` and ``--kinematics``."""
    standard, theories = Choices(), click.Choice(KINEMATICS)
    command = click.option("--kinematics", type=theories, help="Beam theory of the finite elements; beside them the "
                           "CPRBM answers in this theory.  [default: as --theory]")(command)  # fmt: skip
    command = click.option("--theory", type=theories, help="Beam theory of both solvers.  [default: the scene's]",
                           )(command)  # fmt: skip
    return click.option("--formulation", type=click.Choice(["auto", "paper"]), default=standard.formulation,
                        show_default=True, help="Contact formulation of the CPRBM.")(command)  # fmt: skip


def numerical(command: Decorated) -> Decorated:
    """The command with the options of :class:`comparisons.choices.Choices` and with ``--tol``."""
    standard = Choices()
    command = click.option("--tol", callback=tolerance, metavar="TOL",
                           help="Double N until the stated error is below TOL, as 0.1% or 0.001, "
                           "at every probe and station; in place of -n, --elements, --across.")(command)  # fmt: skip
    command = click.option("--penetration", callback=fraction, metavar="SHARE", default=str(standard.penetration),
                           show_default=True, help="Allowed overlap of the finite elements, over the thickness.",
                           )(command)  # fmt: skip
    command = click.option("--across", callback=whole, metavar="N", default=str(standard.across), show_default=True,
                           help="Elements of the solid across a beam's thickness.")(command)  # fmt: skip
    return sized(variants(command))


def exactness(command: Decorated) -> Decorated:
    """The command with ``--exact`` and ``--no-exact``; the value is None without either."""
    return click.option("--exact/--no-exact", "exact", default=None,
                        help="Ask the exact reference in bending, or leave the reference out; otherwise a rule on "
                        "the number of pieces and stations decides.")(command)  # fmt: skip


def sized(command: Decorated) -> Decorated:
    """The command with ``-n``, ``--links`` and ``--elements``."""
    standard = Choices()
    for option in (
        click.option("--elements", callback=count, metavar=COUNT, default=str(standard.elements),
                     show_default=True, help="Finite elements per beam: 80 for all beams, or beam1=60,beam2=80."),
        click.option("-n", "--links", "links", callback=count, metavar=COUNT, default=str(standard.links),
                     show_default=True, help="CPRBM links per beam: 40 for all beams, or beam1=30,beam2=40."),
    ):  # fmt: skip
        command = option(command)
    return command


def _listen(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the log of the solvers on standard error."""
    if value:
        from comparisons import logs

        logs.print_from(logging.INFO)
        ctx.call_on_close(lambda: logs.print_from(logging.NOTSET))


def verbose(command: Decorated) -> Decorated:
    """The command with ``--verbose``."""
    text = "Print runs, stations and iterations on standard error."
    return click.option("-v", "--verbose", is_flag=True, expose_value=False, callback=_listen, help=text)(command)


def output_options(command: Decorated) -> Decorated:
    """The command with ``--json``, ``--quiet`` and ``--verbose``."""
    command = verbose(command)
    command = click.option("-q", "--quiet", is_flag=True, help="Print neither tables nor progress.")(command)
    return click.option(
        "--json", "json_file", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE",
        help="Write the numbers as JSON in SI; '-' is standard output without further text.",
    )(command)  # fmt: skip


def _drawing(ctx: click.Context, param: click.Parameter, value: Path | None) -> Path | None:
    if value is not None and value.suffix.lower() not in (".svg", ".png"):
        raise click.BadParameter(f"found {value.name!r}; allowed: a name that ends in .svg or .png")
    return value


def exports(command: Decorated) -> Decorated:
    """The command with ``--csv`` and ``--plot``."""
    file = click.Path(dir_okay=False, path_type=Path)
    command = click.option("--plot", "plot_file", type=file, metavar="FILE", callback=_drawing,
                           help="Draw the mechanism at the last station, as .svg or .png.")(command)  # fmt: skip
    return click.option("--csv", "csv_file", type=file, metavar="FILE",
                        help="Write a table with a row per station, probe and component.")(command)  # fmt: skip


def folder(text: str) -> Callable[[Decorated], Decorated]:
    """Decorator for ``--out DIR`` with the help ``text``."""
    return click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help=text)


def timed(repeated: str, longer: str, most: str = "60") -> Callable[[Decorated], Decorated]:
    """Decorator for ``--repeat`` with the help ``repeated``, and ``--at-most`` with the help ``longer``.

    ``most`` is the default of ``--at-most``, s.
    """

    def both(command: Decorated) -> Decorated:
        command = click.option("--at-most", callback=positive, metavar="SECONDS", default=most, show_default=True,
                               help=f"A solve that takes longer {longer}")(command)  # fmt: skip
        return click.option("--repeat", callback=whole, metavar="TIMES", default="5", show_default=True, help=repeated)(
            command
        )

    return both
