"""What a run into a folder has solved, kept there until the run ends: killed, it goes on where it was.

Every answer is written as soon as it is there, by the process that has solved it, into ``.unfinished`` of the folder.
The next run into the same folder takes from there what it would solve again: the same scene and the same choices,
by the same sources, libraries and Python.  A run that comes to its end takes ``.unfinished`` away.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path

from comparisons import archive
from comparisons.choices import Choices
from comparisons.pairing import Solver, Solvers
from comparisons.sources import program
from comparisons.writing import clear_partial, write
from cprbm_scene import Answer, Scene

_FOLDER = ".unfinished"
_ENDED = ".ended"
"""What that is called while it is taken away, so that half of it is never taken for the whole."""


@dataclass(frozen=True, slots=True)
class Kept:
    """A solver whose answers are kept in a folder, and taken from there where it has given them before.

    Attributes:
        solver: who answers.
        name: as which solver.
        folder: where its answers are.
    """

    solver: Solver
    name: str
    folder: Path

    def __call__(self, scene: Scene, choices: Choices) -> Answer:
        """The answer, kept or new.

        Raises:
            SceneError: the solver refuses the question.
            OSError: the answer cannot be kept.
        """
        path = self.folder / f"{self._key(scene, choices)}.json"
        with suppress(FileNotFoundError):
            return archive.unpacked(json.loads(path.read_text("utf-8"))["answer"])
        answer = self.solver(scene, choices)
        write(path, archive.text({"answer": answer}))
        return answer

    def _key(self, scene: Scene, choices: Choices) -> str:
        """What the answer depends on, as a file's name; where the scene was read from is no part of it."""
        who = getattr(self.solver, "__qualname__", None) or repr(self.solver)
        asked = (self.name, who, scene.model_dump_json(exclude={"file"}), repr(choices), program())
        return sha256("\n".join(asked).encode()).hexdigest()


@dataclass(frozen=True, slots=True)
class Run:
    """A run that can be resumed.

    Attributes:
        solvers: those whose answers are kept.
        folder: of what is unfinished; None of a run whose answers go to no folder.
        asked: names of the questions, in order.
    """

    solvers: Solvers
    folder: Path | None
    asked: tuple[str, ...]

    def tells(self, name: str) -> None:
        """Note that a page is about to be written that tells of a question too.

        Raises:
            OSError: it cannot be noted.
        """
        if self.folder is not None:
            write(self.folder / f"{name}.shown", name)

    def caught_up(self, names: Collection[str]) -> bool:
        """True if these questions cover all questions of the present page; otherwise the page stays."""
        if self.folder is None:
            return True
        return not any((self.folder / f"{name}.shown").exists() for name in self.asked if name not in names)


@contextmanager
def resumed(out: Path | None, solvers: Solvers, asked: tuple[str, ...]) -> Iterator[Run]:
    """A run into the folder ``out``, which goes on where an earlier one was ended by force; None keeps nothing.

    Raises:
        OSError: the folder cannot be written to.
    """
    if out is None:
        yield Run(solvers, None, asked)
        return
    folder, ended = out / _FOLDER, out / _ENDED
    shutil.rmtree(ended, ignore_errors=True)
    clear_partial((out, folder, *(out / name for name in asked)))
    exact = None if solvers.exact is None else Kept(solvers.exact, "exact", folder)
    solid = None if solvers.solid is None else Kept(solvers.solid, "solid", folder)
    own = Kept(solvers.cprbm, "cprbm", folder), Kept(solvers.fea, "fea", folder)
    kept = replace(solvers, cprbm=own[0], fea=own[1], exact=exact, solid=solid)
    yield Run(kept, folder, asked)
    with suppress(FileNotFoundError):  # nothing was solved
        folder.rename(ended)
    shutil.rmtree(ended, ignore_errors=True)
