"""The harness: one scene to both solvers, their answers beside each other, and a verdict.

Only :mod:`comparisons.pairing` knows the solvers, and only :mod:`comparisons.figures` knows matplotlib.

From Python it is :func:`compare` for a verdict, and :func:`records` and :func:`write_csv` for an answer's numbers::

    >>> import comparisons, cprbm, cprbm_scene
    >>> hinge = cprbm_scene.read("comparisons/cases/hinge.toml")
    >>> answer = cprbm.answer(hinge, cprbm.Settings(links=20))
    >>> answer.stations[-1].values["BD.rotation"].round(3)
    array([0.782])
    >>> len(comparisons.records(hinge, answer)) == sum(
    ...     station.values[probe.name].size for station in answer.stations for probe in hinge.probes
    ... )
    True
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from comparisons.case import Comparison
    from comparisons.choices import Choices
    from comparisons.tidy import Number
    from cprbm_scene import Answer, Scene

__all__ = ["compare", "records", "write_csv"]


def compare(scene: Scene, choices: Choices | None = None) -> Comparison:
    """Both solvers' answers to a scene beside each other, and the verdict.

    Args:
        scene: the question, as :func:`cprbm_scene.read` hands it back.
        choices: how finely, and by which variants (:class:`comparisons.choices.Choices`); the standard ones if None.

    Returns:
        What ``cprbm compare`` tells: ``verdict``, ``rows`` with what is stated of each, and the answers in ``runs``.

    Raises:
        SceneError: a solver refuses the question.
    """
    from comparisons.case import compare
    from comparisons.choices import Choices
    from comparisons.pairing import paired, solvers_of

    return compare(scene, paired(scene, choices or Choices(), solvers_of(None)))


def records(scene: Scene, answer: Answer) -> list[Number]:
    """Every number of an answer with what it is of: ``pandas.DataFrame(records(scene, answer))`` is one table.

    Args:
        scene: the question.
        answer: a solver's to it.

    Returns:
        A dictionary of each number: ``scene``, ``solver``, ``stage``, ``station``, ``branch``, ``probe``,
        ``component``, ``arc_length`` (m, along a beam), ``unit`` (SI) and ``value``.
    """
    from comparisons.tidy import numbers

    return list(numbers(scene, answer))


def write_csv(path: str | Path, scene: Scene, *answers: Answer) -> None:
    """The same of one answer or several as a file of comma-separated values with a line of headers.

    Args:
        path: where the file goes; its folder is made where it is missing.
        scene: the question.
        answers: of one solver or several to it, one below the other.

    Raises:
        OSError: the file cannot be written.
    """
    from comparisons.tidy import csv_of
    from comparisons.writing import write

    write(Path(path), csv_of(scene, *answers))
