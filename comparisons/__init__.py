"""The harness: one scene to both solvers, their answers beside each other, and a verdict.

Only :mod:`comparisons.pairing` knows the solvers, and only :mod:`comparisons.present.canvas` knows matplotlib.

From Python it is :func:`open` for a mechanism with all that the program does::

    >>> import comparisons
    >>> comparisons.open("hinge").scene.name
    'hinge'

:func:`compare` returns a verdict on a scene, :func:`records` and :func:`write_csv` the numbers of an answer::

    >>> import comparisons, cprbm, cprbm_scene
    >>> hinge = cprbm_scene.read("comparisons/cases/hinge.toml")
    >>> answer = cprbm.answer(hinge, cprbm.Settings(links=20))
    >>> answer.stations[-1].values["BD.rotation"].round(3)
    array([0.785])
    >>> len(comparisons.records(hinge, answer)) == sum(
    ...     station.values[probe.name].size for station in answer.stations for probe in hinge.probes
    ... )
    True
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from comparisons.choices import Choices
    from comparisons.mechanism import Mechanism, MechanismComparison
    from comparisons.present.csv_table import Number
    from comparisons.sweeps.running import Sweep
    from cprbm_scene import Answer, Scene

__all__ = ["compare", "open", "records", "sweep", "write_csv"]


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
    from comparisons.cases import opened
    from comparisons.mechanism import Mechanism

    return Mechanism(opened(str(case), parameters))


def compare(scene: Scene, choices: Choices | None = None) -> MechanismComparison:
    """Both solvers' answers to a scene beside each other, and the verdict.

    Args:
        scene: the question, as :func:`cprbm_scene.read` hands it back.
        choices: how finely, and by which variants (:class:`comparisons.choices.Choices`); the standard ones if None.

    Returns:
        What ``cprbm compare`` tells: ``verdict``, ``rows`` with what is stated of each, and the answers in ``runs``.

    Raises:
        SceneError: a solver refuses the question.
    """
    from comparisons.mechanism import Mechanism

    return Mechanism(scene).compare(choices)


def records(scene: Scene, answer: Answer) -> list[Number]:
    """Every number of an answer with what it is of: ``pandas.DataFrame(records(scene, answer))`` is one table.

    Args:
        scene: the question.
        answer: a solver's to it.

    Returns:
        A dictionary of each number: ``scene``, ``solver``, ``stage``, ``station``, ``branch``, ``probe``,
        ``component``, ``arc_length`` (m, along a beam), ``unit`` (SI) and ``value``.
    """
    from comparisons.present.csv_table import numbers

    return list(numbers(scene, answer))


def sweep(
    scene: Scene,
    vary: Mapping[str, Sequence[float]],
    solver: Literal["cprbm", "fea", "compare"] = "cprbm",
    check: int = 0,
    choices: Choices | None = None,
    executor: Executor | str | None = None,
    at_most: float = 600.0,
    out: str | Path | None = None,
) -> Sweep:
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
    from comparisons.sweeps.running import start

    return start(scene, vary, solver, check, choices, executor, at_most, None if out is None else Path(out))


def write_csv(path: str | Path, scene: Scene, *answers: Answer) -> None:
    """The same of one answer or several as a file of comma-separated values with a line of headers.

    Args:
        path: where the file goes; its folder is made where it is missing.
        scene: the question.
        answers: of one solver or several to it, one below the other.

    Raises:
        OSError: the file cannot be written.
    """
    from comparisons.present.csv_table import csv_of
    from comparisons.writing import write

    write(Path(path), csv_of(scene, *answers))
