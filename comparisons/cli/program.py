"""Entry point of ``cprbm``: every end, also during the import of modules, has a sentence and an exit code."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Run the command line of this process and exit."""
    try:
        from comparisons.cli import signals
        from comparisons.threads import ONE_THREAD

        signals.install_handlers()
        _fill_gaps()
        os.environ.update(ONE_THREAD)  # before any BLAS is loaded; worker processes inherit the variables
        from comparisons.cli.completion import VARIABLE
        from comparisons.cli.main import commands, run

        if VARIABLE in os.environ:
            commands.main(prog_name="cprbm", complete_var=VARIABLE)
        code = run(sys.argv[1:])
        signals.ignore_signals()
    except ImportError as error:  # click itself may be missing
        from comparisons.cli.missing_library import message

        problem = message(error)
        if problem is None:
            raise
        sentence, code = problem
        _say(sentence)
    except KeyboardInterrupt as stop:  # during the import of modules, or during the report of another signal
        code = getattr(stop, "code", 130)
        _say(getattr(stop, "sentence", "Interrupted") + ".")
    sys.exit(code)


def _fill_gaps() -> None:
    """Open the null device for a closed standard stream, so that no file takes the number of the stream."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _say(sentence: str) -> None:
    try:
        sys.stderr.write(f"cprbm: {sentence}\n")
        sys.stderr.flush()
    except (OSError, AttributeError):  # standard error is closed
        pass
