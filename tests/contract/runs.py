"""Promises of runs of the program: exit codes, and keys of the written JSON."""

import contextlib
import importlib
import io
import json
import os
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path

from comparisons.cli.main import run

from .documents import paths
from .packages import Packages
from .planted import PLANTED
from .promises import Promises

SITUATIONS = Path(__file__).parent / "situations.toml"
SCENES = Path(__file__).parent / "scenes"
NAMES = frozenset({"strip", "pin", "press", "clamp", "grip", "tip", "beam", "apex", "bend", "beam1", "beam2"})
"""Names in the scenes of this folder, and of beams in ``study table1``."""

DOCUMENTED = frozenset({"comparison.json", "convergence.json", "bench.json"})
"""Files with documented keys in the folder of a report."""


@dataclass(frozen=True)
class Situation:
    """A command line, and the promises about the run.

    Attributes:
        of: the command, without ``cprbm``.
        name: the situation in words.
        run: the command line; ``SCENES`` is the folder of this package's scenes, ``OUT`` a common folder of all
            situations, ``JSON`` a file and ``REPORT`` a folder of this situation alone.
        json: the kind of the document in ``JSON`` or on standard output; empty without a document.
        planted: a key of ``planted.PLANTED``.
        needs: a library, without which the situation is impossible.
        fresh: whether a process of its own runs the program by ``python -m comparisons``.
    """

    of: str
    name: str
    run: str
    json: str = ""
    planted: str = ""
    needs: str = ""
    fresh: bool = False

    @property
    def words(self) -> list[str]:
        """The command line in words."""
        return shlex.split(self.run)

    @property
    def meant(self) -> str:
        """The full name of the command of the situation."""
        return " ".join(["cprbm", *self.of.split()])

    @property
    def possible(self) -> bool:
        """Whether the needed library can be imported."""
        if not self.needs:
            return True
        with contextlib.suppress(ImportError, OSError):
            return importlib.import_module(self.needs) is not None
        return False


def situations(file: Path = SITUATIONS) -> list[Situation]:
    """The table of situations.

    Raises:
        TypeError: a situation has an unknown key.
    """
    known = {field.name for field in fields(Situation)}
    tables = tomllib.loads(file.read_text("utf-8"))["situation"]
    assert all(set(table) <= known for table in tables)
    return [Situation(**table) for table in tables]


def promised_by(situation: Situation, place: int, out: Path, packages: Packages) -> Promises:
    """The promises of a situation: an exit code, and keys of the written JSON.

    Args:
        situation: a line of the table.
        place: the place in the table.
        out: the common folder of all situations.
        packages: names of the packages.
    """
    file, report = out / f"{place}.json", out / f"report-{place}"
    places = {"SCENES": str(SCENES), "JSON": str(file), "REPORT": str(report), "OUT": str(out)}
    pattern = re.compile(rf"\b({'|'.join(places)})\b")
    words = [pattern.sub(lambda found: places[found[1]], word) for word in situation.words]
    command = situation.meant
    code, said = _run(words, situation, out, packages)
    promises: Promises = {f"{command} exit: {situation.name}": code}
    if situation.json:
        document = file.read_text("utf-8") if file.is_file() else said
        promises |= {f"{command} json {situation.json}: {path}": "" for path in _paths(document)}
    for each in sorted(report.rglob("*.json")):
        promises[f"{command} file {each.name}"] = ""
        if each.name in DOCUMENTED:
            promises |= {f"{command} file {each.name}: {path}": "" for path in _paths(each.read_text("utf-8"))}
    return promises


def _run(words: list[str], situation: Situation, out: Path, packages: Packages) -> tuple[int | str, str]:
    """Exit code and standard output of the program."""
    with contextlib.chdir(out):
        if situation.fresh:
            path = os.pathsep.join(filter(None, sys.path))
            environment = {**os.environ, "PYTHONPATH": path, "NUMBA_DISABLE_JIT": "1"}
            command = [sys.executable, "-m", "comparisons", *words]
            done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
            return done.returncode, done.stdout
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
            try:
                return run(words, PLANTED[situation.planted](packages)), said.getvalue()
            except Exception as error:  # a crash breaks promises, and hides none
                return f"crashed: {error!r}", said.getvalue()


def _paths(document: str) -> set[str]:
    """Paths of keys; none of a text other than JSON, such as the output of a refusal."""
    with contextlib.suppress(json.JSONDecodeError):
        return set(paths(json.loads(document), NAMES))
    return set()


def unmet(promised: Iterable[str]) -> set[str]:
    """The promises of impossible situations, for want of a library."""
    table = situations()
    missing = [each for each in table if not each.possible]
    seen = {(each.meant, each.json) for each in table if each.possible}
    unseen = {(each.meant, each.json) for each in missing if each.json} - seen
    begins = tuple(f"{command} json {kind}: " for command, kind in unseen)
    exits = {f"{each.meant} exit: {each.name}" for each in missing}
    return {item for item in promised if item in exits or item.startswith(begins)}
