"""Answers that no run solves twice: in memory, and as compressed files that outlive a killed run.

A file has the name of its key, a digest of the question and of the program.  The process that solves also
writes, at once, into ``.unfinished`` of the folder of a run.  A run that comes to its end removes ``.unfinished``.  A
damaged file is ignored with a note.
"""

import logging
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

from comparisons.answer_file import DAMAGES, packed, read_answers
from comparisons.choices import Choices
from comparisons.executor import Crew, Decided, Job, Solver, crew_of
from comparisons.pairing import Solvers, load_solvers
from comparisons.provenance import program
from comparisons.writing import clear_partial, write
from cprbm_scene import Answer, Scene, frozendict

_LOG = logging.getLogger(__name__)

_FOLDER, _ENDED = ".unfinished", ".ended"
"""Folder of kept answers, and its name during the removal: a part of the answers is never taken for the whole."""

_CHOSEN: Mapping[str, tuple[str, ...]] = {
    "cprbm": ("links", "formulation", "theory"),
    "fea": ("elements", "kinematics", "theory", "penetration"),
    "solid": ("elements", "across"),
    "exact": (),
}
"""Choices that an answer depends on, by solver."""


_DESCRIPTION = {
    "cprbm": "CPRBM {0.theory} {0.formulation}, N = {0.links}",
    "fea": "FEA {0.theory}, {0.elements} elements",
    "solid": "solid, {0.elements} × {0.across} elements",
    "exact": "exact",
}
"""Solve of a solver at its choices."""


def relevant(solver: str, choices: Choices) -> Choices:
    """The choices that a ``solver`` looks at, and the standard values of all others."""
    chosen: dict[str, Any] = {name: getattr(choices, name) for name in _CHOSEN[solver]}
    counts = {name: frozendict(each) for name, each in chosen.items() if isinstance(each, Mapping)}
    return replace(Choices(), **chosen | counts)


def digest(*parts: str) -> str:
    """Digest of texts and of the program."""
    return sha256("\n".join((*parts, program())).encode()).hexdigest()


def _kept_answer(solver: Solver, name: str, folder: Path, scene: Scene, choices: Choices) -> Answer:
    """The answer of a solver with a ``name``: from a ``folder``, or else solved and written into the folder.

    The name of a file is a digest of all that an answer depends on; the file of the scene is no part.

    Raises:
        SceneError: the solver refuses the question.
        OSError: the answer cannot be read or kept.
    """
    own = getattr(solver, "__qualname__", None) or repr(solver)
    key = digest(name, own, scene.model_dump_json(exclude={"file"}), repr(relevant(name, choices)))
    path = folder / f"{key}.json.gz"
    try:
        return read_answers(path)["answer"]
    except FileNotFoundError:
        pass
    except DAMAGES as error:
        _LOG.warning("%s is damaged (%s); the answer is solved again", path, error)
    answer = solver(scene, choices)
    write(path, packed({"answer": answer}))
    return answer


def kept(solvers: Solvers, folder: Path) -> Solvers:
    """The solvers with their answers kept in a folder."""
    own = {name: getattr(solvers, name) for name in _CHOSEN}
    changes: dict[str, Any] = {
        name: partial(_kept_answer, each, name, folder) for name, each in own.items() if each is not None
    }
    return replace(solvers, **changes)


@dataclass(frozen=True, slots=True)
class Run:
    """A run into a folder, which goes on where a killed run has ended.

    Attributes:
        solvers: with kept answers.
        crew: worker processes.
        folder: of the kept answers; None for a run without a folder.
        names: of all questions, in order.
    """

    solvers: Solvers
    crew: Crew
    folder: Path | None
    names: tuple[str, ...]

    def may_show(self, names: Sequence[str]) -> bool:
        """True if ``names`` have all questions of the present page; otherwise the present page stays.

        The last of the ``names`` counts as shown from now on.

        Raises:
            OSError: the folder cannot be written to.
        """
        if self.folder is None:
            return True
        write(self.folder / f"{names[-1]}.shown", names[-1])
        return not any((self.folder / f"{name}.shown").exists() for name in self.names if name not in names)


@contextmanager
def run_into(out: Path | None, solvers: Solvers, names: tuple[str, ...] = (), processes: int = 1) -> Iterator[Run]:
    """A run of the questions ``names`` into the folder ``out``, by ``processes``; None keeps no answers.

    Raises:
        OSError: the folder cannot be written to.
    """
    if processes > 1:
        load_solvers()
    with crew_of(processes) as crew:
        if out is None:
            yield Run(solvers, crew, None, names)
            return
        folder, ended = out / _FOLDER, out / _ENDED
        for path in (folder, ended):
            if path.is_symlink():  # answers belong into this folder, and no removal leaves the folder
                path.unlink()
        shutil.rmtree(ended, ignore_errors=True)
        clear_partial((out, folder, *(out / name for name in names)))
        yield Run(kept(solvers, folder), crew, folder, names)
        with suppress(FileNotFoundError):  # nothing was solved
            folder.rename(ended)
        shutil.rmtree(ended, ignore_errors=True)


@dataclass(frozen=True, slots=True)
class AnswerMemory(Crew):
    """A crew with a memory of the answers of ``solvers``.

    Attributes:
        solvers: the functions that answer.
        say: called with a description of the next solve.
        known: all answers.
    """

    solvers: Solvers = field(default_factory=Solvers)
    say: Callable[[str], None] = lambda text: None
    known: dict[Job, Answer] = field(default_factory=dict)

    def answers(self, jobs: list[Job], decided: Decided | None = None) -> list[Answer]:
        """The answers to all jobs, in the order of the jobs; only unknown answers are solved.

        Raises:
            SceneError: a solver refuses a job.
        """
        known = [(solver, scene, relevant(self._name(solver), choices)) for solver, scene, choices in jobs]
        new = {short: job for short, job in zip(known, jobs, strict=True) if short not in self.known}
        if new:
            names = (
                f"{scene.name}: {_DESCRIPTION[self._name(own)].format(choices)}" for own, scene, choices in new.values()
            )
            self.say("; ".join(dict.fromkeys(names)))
            # not super(), which a class with slots does not know
            self.known.update(zip(new, Crew.answers(self, list(new.values())), strict=True))
        return [self.known[short] for short in known]

    def _name(self, solver: Solver) -> str:
        return next((name for name in _CHOSEN if getattr(self.solvers, name) == solver), "fea")
