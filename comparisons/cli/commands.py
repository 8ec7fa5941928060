"""Lazy commands, groups of commands under headings, and the door to the developers' tools.

A list of commands, and the help of a command, load no command's module: the module comes with the first call.  The
tools stand in ``tests`` and ``benchmarks`` of a checkout, and the wheel has none of them.
"""

import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import click
from click.core import ParameterSource

from comparisons.choices import Choices

SEARCHED = {"links": "-n", "elements": "--elements", "across": "--across"}
"""Options that ``--tol`` takes the place of, by the names of their values."""


class SolvingCommand(click.Command):
    """A command whose function takes a :class:`comparisons.cli.output.Request` and the values of its own options."""

    def invoke(self, ctx: click.Context) -> Any:  # noqa: ANN401 - click's form
        """Exit code of the command.

        Raises:
            click.UsageError: the command line has a number of links or elements beside a tolerance.
        """
        from comparisons.cli.output import Request  # not for a list or help

        for name, option in SEARCHED.items() if ctx.params.get("tol") else ():
            if ctx.get_parameter_source(name) is not ParameterSource.DEFAULT:
                raise click.UsageError(
                    f"found --tol and {option}; allowed: only one of the two, since --tol searches N.", ctx
                )
        chosen, shared = (
            {each.name: ctx.params.pop(each.name) for each in fields(record) if each.name in ctx.params}
            for record in (Choices, Request)
        )
        assert self.callback is not None
        return ctx.invoke(self.callback, Request(ctx.obj, choices=Choices(**chosen), **shared), **ctx.params)


def later(place: str) -> Callable[..., Any]:
    """Function that loads the function ``module.name`` of the command line with the first call."""
    module, _, name = place.rpartition(".")
    return lambda *given, **named: getattr(import_module(f"comparisons.cli.{module}"), name)(*given, **named)


class Commands(click.Group):
    """Commands under headings; the message for an unknown name lists the known names.

    A developers' tool stands here by name and purpose alone, since a list imports no tool.

    Attributes:
        headings: the listed commands by heading.
    """

    def __init__(
        self,
        name: str,
        headings: Mapping[str, Iterable[click.Command]],
        text: str,
        params: Iterable[click.Option] = (),
        callback: Callable[[], None] | None = None,
    ) -> None:
        """The group; with a ``callback`` a command line without a command calls the callback."""
        self.headings = {heading: tuple(commands) for heading, commands in headings.items()}
        every = [command for commands in self.headings.values() for command in commands]
        super().__init__(
            name,
            every,
            callback=callback,
            params=[*params],
            help=text,
            invoke_without_command=callback is not None,
        )

    def tool_of(self, name: str) -> str:
        """Key of a command in ``TOOLS``; empty for a command that is no developers' tool."""
        key = name if self.name == "cprbm" else f"{self.name} {name}"
        return key if key in TOOLS else ""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands; the developers' tools belong to a checkout."""
        return [name for name in self.commands if not absence_of(self.tool_of(name))]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands of every group under its heading."""
        known = self.list_commands(ctx)
        room = formatter.width - 6 - max(map(len, known))
        for heading, commands in self.headings.items():
            found = [(str(each.name), each.get_short_help_str(room)) for each in commands if each.name in known]
            with formatter.section(heading):
                formatter.write_dl(found)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command at the start of the arguments.

        Raises:
            click.ClickException: the command is a developers' tool and this is no checkout.
            click.UsageError: no command has this name.
        """
        name, *rest = args
        tool = self.tool_of(name)
        if absence := absence_of(tool):
            raise click.ClickException(absence)
        if name not in self.commands:
            known = self.list_commands(ctx)
            near = get_close_matches(name.casefold(), known, n=1)
            meant = f" (is {near[0]!r} meant?)" if near else ""
            ctx.fail(f"found {name!r}, no command of '{ctx.command_path}'{meant}; allowed: {', '.join(known)}")
        command: click.Command = load_tool(tool).command if tool else self.commands[name]
        return name, command, rest


ROOT = Path(__file__).resolve().parents[2]
"""Folder above the packages: the checkout, or the folder of installed packages."""

FOLDERS = ("tests/robustness", "benchmarks")


TOOLS = {
    "robustness": ("tests.robustness.command", "Judge both solvers on random scenes."),
    "study relations": (
        "tests.relations.command",
        "Compare a scene with its moved, mirrored, reordered and scaled images.",
    ),
    "bench --method slsqp": ("benchmarks.peers.slsqp", ""),
    "bench --method ipopt": ("benchmarks.peers.ipopt", ""),
}
"""Modules and purposes of the developers' tools by their commands, without the name of the program."""


def is_checkout() -> bool:
    """True if this package stands in a checkout, beside the tools' folders."""
    return all((ROOT / folder).is_dir() for folder in FOLDERS)


def absence_of(command: str) -> str:
    """The sentence that says why a tool cannot run here; empty for every other command."""
    where = "it runs in a checkout of the repository, not from an installed package"
    return f"'cprbm {command}' is a developers' tool: {where}." if command in TOOLS and not is_checkout() else ""


def load_tool(command: str) -> ModuleType:
    """The module of a tool, from this checkout whatever the current folder holds."""
    if sys.path[0] != str(ROOT):
        sys.path.insert(0, str(ROOT))  # processes that share the work take this path over
    return import_module(TOOLS[command][0])
