"""The group of all commands of ``cprbm``, and the door for every exception.

Exit codes: 0 all agree or finished; 1 a verdict is DIFFER or a solve did not complete; 2 the question is wrong, or
the output cannot be written; 3 nothing worse than UNDECIDED; 128 plus the number of a signal (130: Ctrl-C).
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING

import click

from comparisons import workshop
from comparisons.cli.commands import Commands, ToolCommand
from comparisons.cli.signals import SignalInterrupt
from comparisons.cli.text import printable

if TYPE_CHECKING:
    from comparisons.pairing import Solvers

GROUPS = {
    "Your mechanism": (
        "new",
        "import",
        "solve",
        "compare",
        "converge",
        "sweep",
        "tolerance",
        "optimise",
        "view",
        "report",
    ),
    "Built-in cases and evidence": ("list", "bench", "study"),
    "Development": ("schema", "doctor", "robustness"),
}
"""Commands under their headings in the help."""

WRONG_QUESTION = 2
CLOSED_PIPE = 141
"""Exit code of a shell for SIGPIPE."""


class _SubCommands(Commands):
    """Sub-commands by name; only the module of the running command is imported."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all sub-commands; the developers' tools belong to a checkout."""
        names = [name for group in GROUPS.values() for name in group]
        return names if workshop.is_checkout() else [name for name in names if name not in workshop.TOOLS]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The sub-command with a name, or None."""
        if cmd_name in workshop.TOOLS:
            return ToolCommand(cmd_name)
        if cmd_name not in self.list_commands(ctx):
            return None
        command: click.Command = import_module(f"comparisons.cli.{cmd_name}_").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the sub-commands of every group under its heading."""
        room = formatter.width - 6 - max(map(len, self.list_commands(ctx)))
        for heading, names in GROUPS.items():
            found = [self.get_command(ctx, name) for name in names if name in self.list_commands(ctx)]
            with formatter.section(heading):
                formatter.write_dl([(str(each.name), each.get_short_help_str(room)) for each in found if each])


def _version(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the installed version; a folder of sources without installation has no version."""
    if value:
        from importlib.metadata import PackageNotFoundError, version

        try:
            click.echo(f"cprbm {version('cprbm')}")
        except PackageNotFoundError:
            click.echo("cprbm, run from its sources: no version is installed")
        ctx.exit()


@click.group(cls=_SubCommands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_version, help="Show the version and exit."
)
def commands() -> None:
    """Contact-aided compliant mechanisms: CPRBM beside finite elements, with a verdict."""


def run(arguments: Sequence[str], solvers: Solvers | None = None) -> int:
    """Run a command line.

    Args:
        arguments: without the program's name.
        solvers: solvers in place of the real solvers.

    Returns:
        The exit code; a sentence about any problem is on standard error.
    """
    if sys.stdout is None:
        return _report("Standard output is closed.")
    try:
        # Not ``commands.main``: a closed standard output would end the process there.
        with commands.make_context("cprbm", list(arguments), obj=solvers) as context:
            code = commands.invoke(context)
        sys.stdout.flush()
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return WRONG_QUESTION
    except click.UsageError as error:
        return _report(_sentence(error.format_message()) + _next_step(error))
    except click.ClickException as error:
        return _report(error.format_message())
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except KeyboardInterrupt as stop:
        return interrupted(stop)
    except BrokenPipeError:  # the reader has seen enough, as ``head`` has
        _drop_output()
        return CLOSED_PIPE
    except ImportError as error:
        # ``errors`` loads libraries, and the missing library may be among them
        from comparisons.cli import missing_library

        return _handle(error, missing_library.message(error))
    except Exception as error:
        from comparisons.cli import errors

        return _handle(error, errors.message(error))
    return code if isinstance(code, int) else 0


def _handle(error: Exception, message: tuple[str, int] | None) -> int:
    """Report the message of an error; an error without a message is a fault of the program and is raised again."""
    _drop_output()
    if message is None:
        raise error
    return _report(*message)


def _sentence(text: str) -> str:
    return text if text.endswith((".", "?", "!")) else f"{text}."


def _next_step(error: click.UsageError) -> str:
    """The next step after a wrong command line, as further sentences."""
    context = error.ctx
    if context is None:
        return ""
    missing = error.param.make_metavar(context) if isinstance(error, click.MissingParameter) and error.param else ""
    cases = " 'cprbm list' names the cases; 'cprbm new NAME' writes a file to start from." if "CASE" in missing else ""
    return f"{cases} Try '{context.command_path} --help'."


def interrupted(stop: KeyboardInterrupt) -> int:
    """Report the signal behind the end of the run; the exit code."""
    interrupt = stop if isinstance(stop, SignalInterrupt) else SignalInterrupt()
    return _report(f"{interrupt.sentence}; finished results stand.", interrupt.code)


def _drop_output() -> None:
    """Discard the rest of standard output after a failure: the interpreter would write it at exit and complain."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _report(sentence: str, code: int = WRONG_QUESTION) -> int:
    with suppress(OSError):  # with standard error closed the exit code remains
        click.echo(f"cprbm: {printable(sentence)}", err=True)
    return code
