"""``cprbm``: the group of the sub-commands, and what becomes of every kind of trouble.

Exit codes: 0 all agree, or all finished; 1 a verdict is DIFFER or a solve did not complete; 2 the question
was wrong, or what comes out cannot be written; 3 nothing worse than UNDECIDED; 128 and the number of the signal
(130: of Ctrl-C) if a signal ended it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

import click

from comparisons import workshop
from comparisons.cli.commands import Commands, ToolCommand
from comparisons.cli.signals import Ended

if TYPE_CHECKING:
    from comparisons.pairing import Solvers

_COMMANDS = (
    "list",
    "solve",
    "compare",
    "converge",
    "bench",
    "study",
    "report",
    "view",
    "new",
    "import",
    "schema",
    "doctor",
)

WRONG_QUESTION = 2


class _SubCommands(Commands):
    """Finds a sub-command in the module of its name, so that only the one that runs is imported."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all sub-commands; the developers' tools are among them in a checkout."""
        return [*_COMMANDS, *(["robustness"] if workshop.is_checkout() else [])]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The sub-command of a name."""
        match cmd_name:
            case "list":
                from comparisons.cli.list_ import command
            case "solve":
                from comparisons.cli.solve_ import command
            case "view":
                from comparisons.cli.view_ import command
            case "compare":
                from comparisons.cli.compare_ import command
            case "converge":
                from comparisons.cli.converge_ import command
            case "bench":
                from comparisons.cli.bench_ import command
            case "study":
                from comparisons.cli.study_ import command
            case "robustness" | "stress":
                command = ToolCommand(cmd_name)
            case "report":
                from comparisons.cli.report_ import command
            case "new":
                from comparisons.cli.new_ import command
            case "import":
                from comparisons.cli.import_ import command
            case "schema":
                from comparisons.cli.schema_ import command
            case "doctor":
                from comparisons.cli.doctor_ import command
            case _:
                return None
        return command


def _version(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Say which version is installed; a folder of sources that is not installed has none."""
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
        solvers: who answers in place of the real solvers.

    Returns:
        The exit code; a sentence about any trouble is on standard error.
    """
    if sys.stdout is None:
        return _said("Standard output is closed.")
    try:
        # Not ``commands.main``, which would end the process by itself when standard output is closed.
        with commands.make_context("cprbm", list(arguments), obj=solvers) as context:
            code = commands.invoke(context)
        sys.stdout.flush()
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return WRONG_QUESTION
    except click.UsageError as error:
        return _said(_sentence(error.format_message()) + _next_step(error))
    except click.ClickException as error:
        return _said(error.format_message())
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except KeyboardInterrupt as stop:
        return interrupted(stop)
    except BrokenPipeError:
        _give_up_output()
        return _said("Standard output was closed before everything was written.")
    except ImportError as error:
        # what tells of other troubles loads libraries, of which the one that is wanting may be one
        from comparisons.cli import wanting

        return _in_trouble(error, wanting.told(error))
    except Exception as error:
        from comparisons.cli import troubles

        return _in_trouble(error, troubles.told(error))
    return code if isinstance(code, int) else 0


def _in_trouble(error: Exception, told: tuple[str, int] | None) -> int:
    """Say what is told of an error; one of which nothing is told is ours, and raised again."""
    _give_up_output()
    if told is None:
        raise error
    return _said(*told)


def _sentence(text: str) -> str:
    return text if text.endswith((".", "?", "!")) else f"{text}."


def _next_step(error: click.UsageError) -> str:
    """What to ask next, as sentences after that of the error."""
    context = error.ctx
    if context is None:
        return ""
    missing = error.param.make_metavar(context) if isinstance(error, click.MissingParameter) and error.param else ""
    cases = " 'cprbm list' names the cases; 'cprbm new NAME' writes a file to start from." if "CASE" in missing else ""
    return f"{cases} Try '{context.command_path} --help'."


def interrupted(stop: KeyboardInterrupt) -> int:
    """Say that a signal has ended the run; the exit code."""
    ended = stop if isinstance(stop, Ended) else Ended()
    return _said(f"{ended.sentence}; what was finished before stands.", ended.code)


def _give_up_output() -> None:
    """Let go of what standard output does not take: the interpreter would try once more as it ends, and complain."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _said(sentence: str, code: int = WRONG_QUESTION) -> int:
    with suppress(OSError):  # where nobody can be told, the code still tells
        click.echo(f"cprbm: {sentence}", err=True)
    return code
