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

A function loads its module with the first use: the command line imports this package at every start.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from comparisons.mechanism import compare, open, sweep  # noqa: A004 - as in gzip.open or Image.open
    from comparisons.present.csv_table import records, write_csv
else:

    def __getattr__(name: str) -> object:
        """A function of this package by name."""
        match name:
            case "open" | "compare" | "sweep":
                from comparisons import mechanism as module
            case "records" | "write_csv":
                from comparisons.present import csv_table as module
            case _:
                raise AttributeError(f"module 'comparisons' has no attribute {name!r}")
        return getattr(module, name)


__all__ = ["compare", "open", "records", "sweep", "write_csv"]
