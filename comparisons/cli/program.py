"""Entry point of ``cprbm``: every end, also during the import of modules, has a sentence and an exit code."""

import os
import sys

from comparisons.cli.errors import exit_code, handle_signals
from comparisons.threads import ONE_THREAD

COMPLETION = "_CPRBM_COMPLETE"
"""Environment variable of click: a shell sets the variable to ask for completions or for the set-up lines."""


def main() -> None:
    """Run the command line of this process and exit."""
    sys.exit(exit_code(_run))


def _run() -> int:
    """Exit code of the command line of this process."""
    handle_signals()
    for number in range(3):  # no file shall take the number of a closed standard stream
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    os.environ.update(ONE_THREAD)  # before any BLAS is loaded; worker processes inherit the variables
    from comparisons.cli.main import commands, run  # loads click, which may be missing

    if COMPLETION in os.environ:
        commands.main(prog_name="cprbm", complete_var=COMPLETION)
    code = run(sys.argv[1:])
    handle_signals(ignore=True)
    return code
