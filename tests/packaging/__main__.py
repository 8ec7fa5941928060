"""``python -m tests.packaging``: the installed wheel under every Python on this machine.

Every interpreter has an environment in a folder aside.  The wheel is installed there with the declared libraries, the
program is tried far from the checkout, and then tests of the checkout run.  A failure under any Python ends with 1.
``--lowest`` installs the lowest declared versions under the oldest Python (by uv).
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.packaging.made import ROOMS, ROOT, copied, sources, wheel

MINORS = (11, 12, 13, 14)
QUICK = (
    "tests/cprbm_scene",
    "tests/house/test_loaded.py",
    "tests/house/test_threads.py",
    "tests/cprbm/test_cantilever.py",
    "tests/cprbm/test_hinge.py",
    "tests/cprbm/test_derivatives.py",
    "tests/fea_reference/test_cantilever.py",
    "tests/fea_reference/test_contact.py",
    "tests/elastica_reference/test_pieces.py",
    "tests/comparisons/test_starting.py",
    "tests/comparisons/test_documents.py",
    "tests/comparisons/test_pairing.py",
    "tests/comparisons/test_report.py",
    "tests/comparisons/test_tables.py",
)
"""Tests of every room that take minutes together, run under each Python with warnings as errors."""
TEST_LIBRARIES = ("pytest", "hypothesis", "jsonschema")
IMPORTED = f"import {', '.join(ROOMS)}; comparisons.compare, cprbm.answer, fea_reference.answer"
"""All rooms, and what is loaded only as it is asked for; under ``-W error``, so that nothing is on its way out."""

COMMANDS = (
    ("--version",),
    ("list",),
    ("doctor",),
    ("schema",),
    ("new", "mine"),
    ("solve", "mine.toml", "--json", "mine.json"),
    ("compare", "mine.toml", "--quiet"),
    ("solve", "hinge", "--solver", "fea", "--quiet"),
    ("compare", "hinge", "--out", "report"),
)
WRONG = ((), ("nothing",), ("solve",), ("solve", "nothing"), ("new", "9"))


@dataclass(frozen=True)
class Tried:
    """A trial: the command, the exit code and the wanted code, the seconds, and the output."""

    what: str
    code: int
    wanted: int
    seconds: float
    said: str

    @property
    def failed(self) -> bool:
        """Whether the exit code is not the wanted code."""
        return self.code != self.wanted


def interpreters() -> list[Path]:
    """An interpreter for every version: on the path, or installed by pyenv."""
    kept = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    found = []
    for minor in MINORS:
        here = sorted(kept.glob(f"3.{minor}.*/bin/python"))
        named = shutil.which(f"python3.{minor}")
        works = [path for path in (*here, *([Path(named)] if named else ())) if _is(path, minor)]
        found += works[:1]
    return found


def _is(python: Path, minor: int) -> bool:
    """Whether an interpreter has a version: pyenv puts names of absent versions on the path."""
    done = subprocess.run([python, "-c", "import sys; print(sys.version_info[1])"], capture_output=True, check=False)
    return done.returncode == 0 and done.stdout.strip() == str(minor).encode()


def tried(python: Path, made: Path, folder: Path, *, lowest: bool) -> Iterator[Tried]:
    """The wheel under one interpreter, in a folder of its own."""
    aside = folder / "aside"
    aside.mkdir(parents=True)
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    environment |= {"MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    binaries = folder / "venv" / "bin"

    def do(*command: str | Path, cwd: Path = aside, wanted: int = 0) -> Tried:
        began = time.monotonic()
        run = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
        what = " ".join(Path(part).name if isinstance(part, Path) else part for part in command)
        return Tried(what, run.returncode, wanted, time.monotonic() - began, run.stdout + run.stderr)

    yield do(python, "-m", "venv", folder / "venv")
    if lowest:
        install: tuple[str | Path, ...] = ("uv", "pip", "install", "--quiet", "--python", binaries / "python")
        how: tuple[str, ...] = ("--resolution", "lowest-direct")
    else:
        install, how = (binaries / "python", "-m", "pip", "install", "--quiet"), ()
    for wanted in ((*how, str(made)), TEST_LIBRARIES):
        installed = do(*install, *wanted)
        yield installed
        if installed.failed:
            return
    yield do(binaries / "python", "-m", "pip", "check")
    yield do(binaries / "python", "-W", "error", "-c", IMPORTED)
    for command in COMMANDS:
        yield do(binaries / "cprbm", *command)
    # a mistake is told in the words of click's errors, which its releases have not all had
    for wrong in WRONG:
        yield do(binaries / "cprbm", *wrong, wanted=2)
    yield do(binaries / "python", "-m", "comparisons", "list")
    yield do(binaries / "python", "-m", "pytest", "-q", "-p", "no:cacheprovider", *QUICK, cwd=ROOT)


def main() -> int:
    """Try what is asked for; the exit code."""
    parser = argparse.ArgumentParser(description="Try the wheel under each Python that is found.")
    parser.add_argument("--lowest", action="store_true", help="the lowest versions declared, under the oldest Python")
    parser.add_argument("pythons", nargs="*", type=Path, help="interpreters, in place of those that are found")
    asked = parser.parse_args()
    pythons = asked.pythons or interpreters()
    if asked.lowest:
        pythons = pythons[:1]
    failed = not pythons
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        made = wheel(sources(copied(folder), folder / "sdist"), folder / "wheel")
        for number, python in enumerate(pythons):
            sys.stdout.write(f"{python}\n")
            for one in tried(python, made, folder / str(number), lowest=asked.lowest):
                sys.stdout.write(f"  {one.code:3d} {one.seconds:7.1f} s  {one.what[:100]}\n")
                if one.failed:
                    failed = True
                    sys.stdout.write(f"{one.said[-6000:]}\n")
                sys.stdout.flush()
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
