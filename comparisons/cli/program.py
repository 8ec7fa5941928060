"""The program ``cprbm``: whatever ends it, even as its modules are loaded, it ends with a sentence and a code."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Run the command line of this process, and end it."""
    try:
        from comparisons.cli import signals
        from comparisons.threads import ONE_THREAD

        signals.heed()
        _fill_gaps()
        os.environ.update(ONE_THREAD)  # before anything loads a BLAS; for the processes that share the work as well
        from comparisons.cli.completing import VARIABLE
        from comparisons.cli.main import commands, run

        if VARIABLE in os.environ:
            commands.main(prog_name="cprbm", complete_var=VARIABLE)
        code = run(sys.argv[1:])
        signals.ignore()
    except ImportError as error:  # of click, without which there is no command line at all
        from comparisons.cli.wanting import told

        trouble = told(error)
        if trouble is None:
            raise
        sentence, code = trouble
        _say(sentence)
    except KeyboardInterrupt as stop:  # as modules were loaded, or as another signal was being told of
        code = getattr(stop, "code", 130)
        _say(getattr(stop, "sentence", "Interrupted") + ".")
    sys.exit(code)


def _fill_gaps() -> None:
    """See that no file is opened in the place of standard input, output or error where one of them is closed."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _say(sentence: str) -> None:
    try:
        sys.stderr.write(f"cprbm: {sentence}\n")
        sys.stderr.flush()
    except (OSError, AttributeError):  # there is nobody to tell
        pass
