"""The group of all commands of ``cprbm``, and a command line as a function."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from comparisons.cli.commands import Commands
from comparisons.cli.declarations import HEADINGS
from comparisons.cli.errors import exit_code

if TYPE_CHECKING:
    from comparisons.pairing import Solvers


def _version(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the installed version; a folder of sources without installation has no version."""
    if value:
        from importlib.metadata import PackageNotFoundError, version

        try:
            click.echo(f"cprbm {version('cprbm')}")
        except PackageNotFoundError:
            click.echo("cprbm, run from its sources: no version is installed")
        ctx.exit()


commands = Commands(
    "cprbm",
    HEADINGS,
    "Contact-aided compliant mechanisms: CPRBM beside finite elements, with a verdict.",
    [click.Option(["--version"], is_flag=True, is_eager=True, expose_value=False, callback=_version,
                  help="Show the version and exit.")],
)  # fmt: skip
commands.context_settings = {"help_option_names": ["-h", "--help"]}


def run(arguments: Sequence[str], solvers: Solvers | None = None) -> int:
    """Run a command line.

    Args:
        arguments: without the program's name.
        solvers: solvers in place of the real solvers.

    Returns:
        The exit code; a sentence about any problem is on standard error.
    """

    def command() -> int | None:
        if sys.stdout is None:
            raise click.ClickException("Standard output is closed.")
        # not ``commands.main``: a closed standard output would end the process there
        with commands.make_context("cprbm", list(arguments), obj=solvers) as context:
            code = commands.invoke(context)
        sys.stdout.flush()
        return code if isinstance(code, int) else 0

    return exit_code(command)
