"""Mechanisms, comparisons and sweeps from Python: tables, files and drawings in one call."""

import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import dataclass, fields, replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from comparisons import case, cases
from comparisons.choices import Choices
from comparisons.pairing import ANSWERS, SolverName, Solvers, paired, solvers_of
from comparisons.present import figures
from comparisons.present.brief import headline, last_rows_of_stages, nearest_rows
from comparisons.present.case_tables import answer_tables
from comparisons.present.columns import Figure, Table
from comparisons.present.csv_table import comparison_records, csv_of, csv_of_comparisons, records
from comparisons.present.page import rendered
from comparisons.writing import write
from cprbm_scene import Answer, Scene, frozendict

if TYPE_CHECKING:
    from comparisons.sweeps.running import Sweep


@dataclass(frozen=True, slots=True, repr=False)
class MechanismComparison(case.Comparison):
    """Comparison with tables, files and drawings."""

    def __repr__(self) -> str:
        """Name, verdict and number of rows."""
        return f"<Comparison {headline(self.scene.name, self.verdict, f'{len(self.rows)} rows')}>"

    def plot(self, path: str | Path | None = None) -> Figure:
        """Drawing of both answers at the last common station.

        Args:
            path: file for the drawing, with the ending ``.svg`` or ``.png``; no file if None.

        Raises:
            ValueError: the path ends otherwise, or the answers have no common station.
            OSError: the file cannot be written.
        """
        if not self.rows:
            raise ValueError(f"{self.scene.name}: no drawing, since the answers have no common station")
        return _saved(figures.comparison_figures(self)[0], path)

    def to_csv(self, path: str | Path) -> None:
        """Write a file with a row per station, probe and component, and the values of both solvers.

        Raises:
            OSError: the file cannot be written.
        """
        write(Path(path), csv_of_comparisons([self]))

    def to_pandas(self) -> Any:  # noqa: ANN401 - pandas is no dependency
        """The rows of :meth:`to_csv` in SI, as a ``pandas.DataFrame``.

        Raises:
            ImportError: pandas is not installed.
        """
        return _data_frame(comparison_records(self))

    def _repr_html_(self) -> str:
        """Verdict, table of the last station of each stage, and drawing, for a notebook."""
        rows = last_rows_of_stages(self)
        sentence = headline(self.scene.name, self.verdict, self.verdict.sentence)
        return _html(sentence, (nearest_rows(self, rows, len(rows)),), figures.comparison_figures(self)[:1])


@dataclass(frozen=True, slots=True)
class Mechanism:
    """A scene with its solvers.

    Attributes:
        scene: the question.
    """

    scene: Scene

    def solve(self, solver: SolverName = "cprbm", choices: Choices | None = None) -> Answer:
        """Answer of one solver.

        Args:
            solver: ``cprbm``, ``fea``, ``exact`` or ``solid``.
            choices: links, elements and variants; the standard ones if None.

        Raises:
            SceneError: the solver refuses the scene.
            ValueError: no solver has this name.
        """
        if solver not in ANSWERS:
            raise ValueError(f"found the solver {solver!r}; allowed: {', '.join(ANSWERS)}")
        answer = ANSWERS[solver](self.scene, choices or Choices())
        # an unknown key of a frozendict is refused with the known keys
        named = (replace(station, values=frozendict(station.values)) for station in answer.stations)
        return replace(answer, stations=tuple(named))

    def compare(self, choices: Choices | None = None) -> MechanismComparison:
        """Answers of both solvers and the verdict.

        Raises:
            SceneError: a solver refuses the scene.
        """
        found = case.compare(paired(self.scene, choices or Choices(), solvers_of(None)))
        return MechanismComparison(**{each.name: getattr(found, each.name) for each in fields(found)})

    def plot(
        self, path: str | Path | None = None, solver: SolverName = "cprbm", choices: Choices | None = None
    ) -> Figure:
        """Drawing of an answer at its last station.

        Args:
            path: file for the drawing, with the ending ``.svg`` or ``.png``; no file if None.
            solver, choices: as :meth:`solve`.

        Raises:
            SceneError: the solver refuses the scene.
            ValueError: the path ends otherwise, or the answer has no station.
            OSError: the file cannot be written.
        """
        return _saved(figures.answer_figure(self.scene, self.solve(solver, choices)), path)

    def to_csv(self, path: str | Path, solver: SolverName = "cprbm", choices: Choices | None = None) -> None:
        """Write a file with a row per station, probe and component of an answer.

        Raises:
            SceneError: the solver refuses the scene.
            OSError: the file cannot be written.
        """
        write(Path(path), csv_of(self.scene, self.solve(solver, choices)))

    def to_pandas(self, solver: SolverName = "cprbm", choices: Choices | None = None) -> Any:  # noqa: ANN401
        """The rows of :meth:`to_csv` in SI, as a ``pandas.DataFrame``.

        Raises:
            SceneError: the solver refuses the scene.
            ImportError: pandas is not installed.
        """
        return _data_frame(records(self.scene, self.solve(solver, choices)))

    def _repr_html_(self) -> str:
        """Tables and drawing of the CPRBM's answer, for a notebook."""
        answer = self.solve()
        drawing = (figures.answer_figure(self.scene, answer),) if answer.stations else ()
        ended = "" if answer.stations else f": {answer.sentence or answer.ending.value}"  # otherwise the table has it
        return _html(f"{self.scene.name}: {answer.ending.name}{ended}", answer_tables(self.scene, answer), drawing)


def open(  # noqa: A001 - as in gzip.open or Image.open
    case: str | Path, parameters: Mapping[str, float | str] | None = None
) -> Mechanism:
    """The mechanism of a scene file, or of a built-in case.

    Args:
        case: path of a TOML file, or name of a built-in case.
        parameters: values of the scene's parameters by name, numbers in SI units or texts such as ``1.9mm``.

    Returns:
        The mechanism.

    Raises:
        SceneError: no case has this name, or the file is no valid scene.
    """
    return Mechanism(cases.opened(str(case), parameters))


def compare(scene: Scene, choices: Choices | None = None) -> MechanismComparison:
    """Both solvers' answers to a scene beside each other, and the verdict.

    Args:
        scene: the question, as :func:`cprbm_scene.read` hands it back.
        choices: how finely, and by which variants (:class:`comparisons.choices.Choices`); the standard ones if None.

    Returns:
        The comparison of ``cprbm compare``: ``verdict``, ``rows`` with their uncertainties, and the answers in
        ``runs``.

    Raises:
        SceneError: a solver refuses the question.
    """
    return Mechanism(scene).compare(choices)


def sweep(
    scene: Scene,
    vary: Mapping[str, Sequence[float]],
    solver: Literal["cprbm", "fea", "compare"] = "cprbm",
    check: int = 0,
    choices: Choices | None = None,
    executor: Executor | str | None = None,
    at_most: float = 600.0,
    out: str | Path | None = None,
) -> "Sweep":
    """A scene at all combinations of values of its parameters.

    Points are solved in processes: a script calls this function below ``if __name__ == "__main__":``.

    Args:
        scene: the question, read from a file with parameters.
        vary: two values or more by the name of a parameter, SI.
        solver: solver of every point, or ``compare`` for both with a verdict.
        check: number of points at which both solvers are compared.
        choices: how finely, and by which variants; the standard choices if None.
        executor: executor of the solves, as of :mod:`concurrent.futures`, or ``dask://HOST:PORT`` with the address of
            a scheduler; None for this machine.
        at_most: time limit of a solve, s.
        out: folder of the tables, where a stopped sweep goes on; None for no folder.

    Returns:
        The points with their outcomes.

    Raises:
        SceneError: the scene refuses a name or a value.
        OSError: the folder cannot be written to.
    """
    from comparisons.sweeps import points, running, tables, workers  # load the statistics of SciPy

    rows = tuple(dict(zip(vary, map(float, values), strict=True)) for values in product(*vary.values()))
    axes = [points.Axis(name, min(each), max(each), len(each)) for name, each in vary.items()]
    chosen, place = choices or Choices(), executor or f"local:{os.cpu_count() or 1}"
    tasks = running.tasks_of(scene, rows, solver, points.chosen_for_check(rows, axes, check), chosen)
    folder = None if out is None else Path(out)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    with workers.workers_on(place) if isinstance(place, str) else nullcontext(workers.Workers(place.submit)) as pool:
        runner = running.Runner(pool, chosen, Solvers(), at_most, folder)
        found = runner.run(running.Sweep(scene, points.in_file_units(scene, axes), tasks))
    if folder is not None:
        tables.write_tables(folder, found)
    return found


def _saved(drawing: Figure, path: str | Path | None) -> Figure:
    if path is not None:
        drawing.save(Path(path))
    return drawing


def _data_frame(rows: Iterable[Mapping[str, object]]) -> Any:  # noqa: ANN401
    try:
        import pandas
    except ImportError:
        raise ImportError("to_pandas needs pandas; `python -m pip install pandas` installs it", name="pandas") from None
    return pandas.DataFrame(list(rows))


def _html(sentence: str, tables: Iterable[Table], drawings: Iterable[Figure]) -> str:
    return rendered("notebook.html", {"sentence": sentence, "tables": tables, "figures": drawings})
