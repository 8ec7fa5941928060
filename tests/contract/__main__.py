"""``python -m tests.contract``: undeclared changes as entries for ``declared.toml``; with ``record`` a recording.

The recording of 3c78333 came from a copy of this package under another name, run with a checkout of 3c78333::

    python -m NAME record --scene scene --exact exact --pages docs/api > promises.json
"""

import argparse
import importlib
import sys
from pathlib import Path

from .declared import declared
from .packages import Packages
from .promises import recorded, text
from .python_names import documented
from .recorder import library, program
from .today import today, undeclared, visible


def main() -> None:
    """Print a recording, or entries for ``declared.toml``."""
    parser = argparse.ArgumentParser(prog="tests.contract", description=__doc__)
    parser.add_argument("what", nargs="?", choices=["changes", "record"], default="changes")
    parser.add_argument("--scene", default=Packages.scene, help="name of the scene's package")
    parser.add_argument("--exact", default=Packages.exact, help="name of the exact reference's package")
    parser.add_argument("--pages", type=Path, default=Path("docs/api"), help="pages that document the library")
    given = parser.parse_args()
    if given.what == "record":
        packages = Packages(given.scene, given.exact)
        exported = {f"{each}.{name}" for each in packages.all for name in importlib.import_module(each).__all__}
        names = documented(given.pages) | exported
        sys.stdout.write(text(program(packages) | library(names, packages.all)))
        return
    promised, changes = visible(recorded()), declared()
    sys.stdout.write(undeclared(promised, today(promised, changes), changes))


if __name__ == "__main__":
    main()
