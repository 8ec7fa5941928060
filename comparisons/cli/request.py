"""Values of the shared options of commands, and the questions, solvers and folders that follow from the values."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import click

from comparisons import cases, pairing
from comparisons.choices import Choices, check
from comparisons.cli.errors import printable
from cprbm_scene import Question, Scene
from cprbm_scene.solving import notes


@dataclass(frozen=True, slots=True)
class Request:
    """Values of shared options; an option without a place in a command has the value here.

    Attributes:
        planted: solvers in place of the real solvers.
        choices: links, elements and variants.
        case: name or file of a single scene; arguments: of several questions.
        values: values of the scene's parameters by name.
        tol: wanted error, a share of the scale; None with stated numbers of links and elements.
        exact: whether the exact reference is asked; with None a rule decides.
        opinions: solvers of a comparison.
        json_file, csv_file, plot_file, out: output files and folder.
        quiet: whether tables and progress are left out.
        place: of the workers.
        at_most: time limit of a solve, s.
    """

    planted: object = None
    choices: Choices = field(default_factory=Choices)
    case: str = ""
    arguments: tuple[str, ...] = ()
    values: Mapping[str, str] = field(default_factory=dict)
    tol: float | None = None
    exact: bool | None = None
    opinions: tuple[str, ...] = ("cprbm", "fea")
    json_file: Path | None = None
    csv_file: Path | None = None
    plot_file: Path | None = None
    out: Path | None = None
    quiet: bool = False
    place: str = ""
    at_most: float = math.inf

    @property
    def prints(self) -> bool:
        """Whether standard output is for people: no JSON goes there."""
        return str(self.json_file) != "-"

    @property
    def solvers(self) -> pairing.Solvers:
        """The solvers of a comparison."""
        found = pairing.solvers_of(self.planted, exact=self.exact)
        return pairing.with_solid(found) if "solid" in self.opinions else found

    @property
    def processes(self) -> int:
        """Number of processes for the runs; planted solvers stay in this process."""
        return 1 if isinstance(self.planted, pairing.Solvers) else min(2, os.cpu_count() or 1)

    def scene(self) -> Scene:
        """The scene of a command for a single scene; notes on implausible numbers go to standard error.

        Raises:
            SceneError: the case does not exist, the file is no valid scene, or the choices do not fit the scene.
        """
        scene = cases.opened(self.case, self.values)
        self._check([scene])
        return scene

    def si(self, name: str, text: str) -> float:
        """Value of a parameter of the scene, SI, for a text such as ``1.9mm``.

        Raises:
            SceneError: an unknown parameter, a wrong unit or a wrong value.
        """
        return cases.opened(self.case, {**self.values, name: text}).parameters[name].value

    def questions(self) -> list[Question]:
        """Questions of the arguments, without repetition; notes on implausible numbers go to standard error.

        Raises:
            SceneError: a case does not exist, a file is no valid question, or the choices do not fit a scene.
            click.UsageError: two questions have the same name.
        """
        names = [name for text in self.arguments for name in (cases.names() if text == "all" else (text,))]
        questions = [cases.asked(name, self.values) for name in dict.fromkeys(names)]
        twice = sorted(name for name, number in Counter(question.name for question in questions).items() if number > 1)
        if twice:
            raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each scene.")
        self._check(questions)
        return questions

    def _check(self, questions: Sequence[Question]) -> None:
        """Write notes on implausible numbers to standard error, and check that the choices fit all scenes."""
        for scene in (question for question in questions if isinstance(question, Scene)):
            for note in notes(scene):
                click.echo(printable(f"Note: {scene.file}: {note}"), err=True)
            check(self.choices, scene)

    def with_room(self, folder: str = "") -> Request:
        """The request with its folders made; without ``--out`` the report goes to ``folder``, or nowhere if empty.

        Raises:
            OSError: a folder cannot be created.
        """
        out = self.out or (Path(folder) if folder else None)
        files = (self.json_file, self.csv_file, self.plot_file)
        for needed in (*(file.parent for file in files if file and str(file) != "-"), *filter(None, (out,))):
            needed.mkdir(parents=True, exist_ok=True)
        return replace(self, out=out)
