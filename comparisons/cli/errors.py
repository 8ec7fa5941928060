"""The end of a command line: an exit code, and a sentence on standard error for every exception and signal.

Exit codes: 0 all agree or finished; 1 a verdict is DIFFER or a solve did not complete; 2 the question is wrong, or
the output cannot be written; 3 nothing worse than UNDECIDED; 128 plus the number of a signal (130: Ctrl-C).

The module imports the standard library only, since any other library may be missing.
"""

import os
import shlex
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from difflib import get_close_matches
from pathlib import Path
from traceback import walk_tb
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cprbm_scene import Mistake

INCOMPLETE, WRONG_QUESTION, UNDECIDED = 1, 2, 3
CLOSED_PIPE = 141
"""Exit code of a shell for SIGPIPE."""


def code_of(*, incomplete: bool, undecided: bool = False) -> int:
    """Exit code of a finished command: an incomplete result counts more than an undecided result."""
    if incomplete:
        return INCOMPLETE
    return UNDECIDED if undecided else 0


End = tuple[str, int]
"""Sentence on standard error, and exit code."""

_CONTROLS = {*map(chr, (*range(32), *range(127, 160)))} - {"\n"}
_SIGNALS = {"SIGINT": "Interrupted", "SIGTERM": "Asked to end", "SIGHUP": "The terminal was closed"}
"""Sentences by signal name; some systems lack some of the signals."""

_PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
_CASES = " 'cprbm list' names the cases; 'cprbm new NAME' writes a file to start from."
_KEPT = "Finished results stand"


def handle_signals(*, ignore: bool = False) -> None:
    """Let every signal interrupt with its number, except signals that this process ignores; or ignore all."""
    for number in (getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)):
        if ignore or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, signal.SIG_IGN if ignore else _interrupt)


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt(number)


def printable(text: object) -> str:
    """Text with control characters, except line ends, as visible escapes: a path may hold commands of a terminal."""
    return "".join(repr(letter)[1:-1] if letter in _CONTROLS else letter for letter in str(text))


def say(text: str) -> None:
    """Write a line on standard error; with standard error closed the exit code remains."""
    with suppress(OSError, AttributeError):
        sys.stderr.write(f"cprbm: {printable(text)}\n")
        sys.stderr.flush()


def exit_code(command: Callable[[], int | None]) -> int:
    """Exit code of a command; a sentence about an exception is on standard error.

    Raises:
        Exception: the exception is a fault of the program.
    """
    try:
        return command() or 0
    except Exception as error:
        found = _end(error)
        _drop_output()
        if found is None:
            raise
    except KeyboardInterrupt as stop:
        number = signal.Signals(*(stop.args or (signal.SIGINT,)))
        found = f"{_SIGNALS[number.name]}. {_KEPT}; repeat the command to go on.", 128 + number
    text, code = found
    if text:
        say(text)
    return code


def _end(error: Exception) -> End | None:
    """The end after an exception; None for a fault of the program."""
    match error:
        case BrokenPipeError():  # the reader has seen enough, as ``head`` has
            return "", CLOSED_PIPE
        case ImportError():
            return _end_without_library(error)
        case MemoryError():
            return f"The memory is too small for this model. {_KEPT}; ask for fewer links.", INCOMPLETE
        case OSError():
            return f"Cannot write {error.filename or 'the output'}: {error.strerror or error}.", WRONG_QUESTION
    import click

    match error:
        case click.exceptions.Exit():
            return "", error.exit_code
        case click.exceptions.NoArgsIsHelpError():
            click.echo(error.format_message(), err=True)
            return "", WRONG_QUESTION
        case click.UsageError(ctx=context):
            text = error.format_message()
            argument = error.param if isinstance(error, click.MissingParameter) else None
            cases = _CASES if argument and context and "CASE" in argument.make_metavar(context) else ""
            help_ = f" Try '{context.command_path} --help'." if context else ""
            return f"{text if text.endswith(('.', '?', '!')) else f'{text}.'}{cases}{help_}", WRONG_QUESTION
        case click.ClickException():
            return error.format_message(), WRONG_QUESTION
    # behind wrong words and answered requests for help, which need no numbers
    from concurrent.futures import BrokenExecutor

    from comparisons.executor import WorkerDiedError
    from cprbm_scene import SceneError

    match error:
        case SceneError():
            lines = [_with_next_step(mistake) for mistake in error.mistakes]
            return ("\n  " if len(lines) > 1 else " ").join(("The question is wrong.", *lines)), WRONG_QUESTION
        case WorkerDiedError():
            return (
                f"A worker process was killed, perhaps for lack of memory. {_KEPT}; repeat the command to go on.",
                INCOMPLETE,
            )
        case BrokenExecutor():
            return f"{error} {_KEPT}; repeat the command to go on.", INCOMPLETE
    return None


def _with_next_step(mistake: "Mistake") -> str:
    """A mistake, with the next step for a missing file."""
    path = Path(mistake.file)
    if mistake.key or path.suffix != ".toml" or path.exists():
        return str(mistake)
    near = get_close_matches(path.name, [file.name for file in path.parent.glob("*.toml")], n=1)
    meant = f"is {path.parent / near[0]} meant? " if near else ""
    return f"{mistake}; {meant}'cprbm new NAME' writes a scene to start from, 'cprbm list' names the built-in cases"


def _end_without_library(error: ImportError) -> End | None:
    """The end without a library; None for a module of this project."""
    # NumPy and other libraries raise errors without a name
    modules = [str(frame.f_globals.get("__name__", "")) for frame, _ in walk_tb(error.__traceback__)]
    library = (error.name or modules[-1]).partition(".")[0]
    if not library or library in _PACKAGES:
        return None
    reason = next(iter(str(error).strip().splitlines()), "without a reason")
    distribution = "scikit-fem" if library == "skfem" else library
    install = f"{shlex.quote(sys.executable)} -m pip install --upgrade --force-reinstall {distribution}"
    return f"The library {library} cannot be loaded ({reason}). Install it with: {install}", WRONG_QUESTION


def _drop_output() -> None:
    """Discard the rest of standard output after a failure: the interpreter would write it at exit and complain."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
