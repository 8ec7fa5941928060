"""Options of several sub-commands: readers of their values, and groups of options as decorators."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from comparisons.choices import KINEMATICS, Choices, check

if TYPE_CHECKING:
    from cprbm_scene import Question

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
Value = TypeVar("Value")
Reader = Callable[[click.Context, click.Parameter, Any], Any]
"""Callback of click: the value of a text, None for an absent option; click.BadParameter for a wrong text."""

COUNT = "N|BEAM=N,..."
"""Metavar of a number of links or elements."""


def _reader(read: Callable[[str], Value], holds: Callable[[Value], bool], allowed: str) -> Reader:
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
    text = text.strip()
    return float(text[:-1]) / 100.0 if text.endswith("%") else float(text)


def _solvers(text: str) -> bool:
    named = sorted(part.strip() for part in text.split(","))
    if named not in (["cprbm", "fea"], ["cprbm", "fea", "solid"]):
        raise ValueError(text)
    return "solid" in named


def _always(value: object) -> bool:
    return True


def _is_fraction(value: float) -> bool:
    return 0.0 < value < 1.0


count = _reader(_by_beam, _always, "one number, or beam=number once for each beam")
whole = _reader(_whole, _always, "a whole number from 1 to 9999")
counts = _reader(_several, _always, "whole numbers between commas")
family_sizes = _reader(_several, lambda found: len(found) > 1 and all(a < b for a, b in pairwise(found)),
                       "two numbers or more, each larger than the one before")  # fmt: skip
positive = _reader(float, lambda value: 0.0 < value < math.inf, "a number greater than 0")
fraction = _reader(float, _is_fraction, "a number greater than 0 and less than 1")
tolerance = _reader(_share, _is_fraction, "as 0.1% or as 0.001, greater than 0 and less than 1")
opinions = _reader(_solvers, _always, "cprbm,fea or cprbm,fea,solid")
_drawing = _reader(Path, lambda path: path.suffix.lower() in (".svg", ".png"), "a name that ends in .svg or .png")


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


def settings() -> dict[str, str]:
    """Values of the option ``--set`` of the running command, by parameter name."""
    return dict(click.get_current_context().meta.get(__name__, {}))


def _choice(read: Reader | None = None) -> Reader:
    """Callback that stores the value of an option as a field of :class:`Choices` in the context."""

    def store(ctx: click.Context, param: click.Parameter, value: Any) -> None:  # noqa: ANN401 - any option
        ctx.meta.setdefault(Choices.__name__, {})[param.name] = value if read is None else read(ctx, param, value)

    return store


def choices_for(*questions: Question) -> Choices:
    """Choices of the running command, from the options ``sized``, ``variants`` and ``numerical``.

    Raises:
        SceneError: a scene of the ``questions`` lacks a beam with an own number.
    """
    from cprbm_scene import OffsetQuestion

    found = Choices(**click.get_current_context().meta.get(Choices.__name__, {}))
    for question in questions:
        if not isinstance(question, OffsetQuestion):
            check(found, question)
    return found


def _listen(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the log of the solvers on standard error."""
    if value:
        from comparisons import logs

        logs.print_from(logging.INFO)
        ctx.call_on_close(lambda: logs.print_from(logging.NOTSET))


def group(*options: Decorator) -> Decorator:
    """Decorator with several options, in the order of the help."""

    def decorated(command: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(options):
            command = option(command)
        return command

    return decorated


def folder(text: str) -> Decorator:
    """Decorator for ``--out DIR`` with the help ``text``."""
    return click.option("--out", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help=text)


def time_limit(text: str, seconds: str) -> Decorator:
    """Decorator for ``--at-most`` with the help ``text`` and the default ``seconds``."""
    return click.option("--at-most", callback=positive, metavar="SECONDS", default=seconds, show_default=True,
                        help=text)  # fmt: skip


def timed(repeated: str, longer: str, most: str = "60") -> Decorator:
    """Decorator for ``--repeat`` with the help ``repeated``, and ``--at-most`` with the help ``longer``.

    ``most`` is the default of ``--at-most``, s.
    """
    return group(
        click.option("--repeat", callback=whole, metavar="TIMES", default="5", show_default=True, help=repeated),
        time_limit(f"A solve that takes longer {longer}", most),
    )


_STANDARD, _THEORIES = Choices(), click.Choice(KINEMATICS)
_FILE = click.Path(dir_okay=False, path_type=Path)

parameters = click.option("--set", callback=_store, multiple=True, expose_value=False, metavar="NAME=VALUE",
                          help="Value of a parameter of the scene, such as t=1.9mm; may be repeated.")  # fmt: skip
variants = group(
    click.option("--formulation", type=click.Choice(["auto", "paper"]), default=_STANDARD.formulation,
                 show_default=True, callback=_choice(), expose_value=False,
                 help="Contact formulation of the CPRBM."),
    click.option("--theory", type=_THEORIES, callback=_choice(), expose_value=False,
                 help="Beam theory of both solvers.  [default: the scene's]"),
    click.option("--kinematics", type=_THEORIES, callback=_choice(), expose_value=False,
                 help="Beam theory of the finite elements; beside them the CPRBM answers in this theory.  "
                 "[default: as --theory]"),
)  # fmt: skip
sized = group(
    click.option("-n", "--links", "links", metavar=COUNT, default=str(_STANDARD.links), show_default=True,
                 callback=_choice(count), expose_value=False,
                 help="CPRBM links per beam: 40 for all beams, or beam1=30,beam2=40."),
    click.option("--elements", metavar=COUNT, default=str(_STANDARD.elements), show_default=True,
                 callback=_choice(count), expose_value=False,
                 help="Finite elements per beam: 80 for all beams, or beam1=60,beam2=80."),
)  # fmt: skip
numerical = group(
    sized,
    variants,
    click.option("--across", metavar="N", default=str(_STANDARD.across), show_default=True,
                 callback=_choice(whole), expose_value=False,
                 help="Elements of the solid across a beam's thickness."),
    click.option("--penetration", metavar="SHARE", default=str(_STANDARD.penetration), show_default=True,
                 callback=_choice(fraction), expose_value=False,
                 help="Allowed overlap of the finite elements, over the thickness."),
    click.option("--tol", callback=tolerance, metavar="TOL",
                 help="Double N until the stated error is below TOL, as 0.1% or 0.001, at every probe and station; "
                 "in place of -n, --elements, --across."),
)  # fmt: skip
exactness = click.option(
    "--exact/--no-exact", "exact", default=None,
    help="Ask the exact reference in bending, or leave the reference out; otherwise a rule on the number of pieces "
    "and stations decides.",
)  # fmt: skip
quietness = click.option("-q", "--quiet", is_flag=True, help="Print neither tables nor progress.")
verbose = click.option("-v", "--verbose", is_flag=True, expose_value=False, callback=_listen,
                       help="Print runs, stations and iterations on standard error.")  # fmt: skip
output_options = group(
    click.option("--json", "json_file", type=_FILE, metavar="FILE",
                 help="Write the numbers as JSON in SI; '-' is standard output without further text."),
    quietness,
    verbose,
)  # fmt: skip
exports = group(
    click.option("--csv", "csv_file", type=_FILE, metavar="FILE",
                 help="Write a table with a row per station, probe and component."),
    click.option("--plot", "plot_file", type=_FILE, metavar="FILE", callback=_drawing,
                 help="Draw the mechanism at the last station, as .svg or .png."),
)  # fmt: skip
