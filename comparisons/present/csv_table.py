"""Answers and comparisons as tables with a number on every line: records in SI, files in the units of the scene."""

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypedDict

from comparisons.case import Comparison
from comparisons.formats import file_unit
from comparisons.present.columns import Plain
from comparisons.quantities import COMPONENTS, arc_lengths, load_unit, unit_of
from comparisons.writing import write
from cprbm_scene import STRESSES, Answer, Array, PointForce, Probe, Scene, StationAnswer


class Number(TypedDict):
    """One number, in the SI ``unit``.

    ``station`` is the value of the load or drive that the stage steps, ``branch`` the number of critical points before
    the station; ``component`` is empty for a single number, and ``arc_length``, m, is None except along a beam.
    """

    scene: str
    solver: str
    stage: str
    station: float
    branch: int
    probe: str
    component: str
    arc_length: float | None
    unit: str
    value: float
    station_unit: str


_MEASURED = {
    "station_unit": ("station",),
    "arc_length_unit": ("arc_length", "x", "y"),
    "unit": ("value", "cprbm", "fea", "difference", "stated", "force_x", "force_y"),
}
"""Columns of units, and the columns of numbers in the unit."""

_COMPARISON = (
    *("scene", "stage", "station", "station_unit", "branch", "probe", "component", "arc_length", "unit"),
    *("cprbm", "fea", "difference", "stated", "word"),
)
_CONTACT_FORCE = (
    *("scene", "solver", "stage", "station", "station_unit", "contact", "beam", "arc_length", "x", "y"),
    *("arc_length_unit", "force_x", "force_y", "unit"),
)


def records(scene: Scene, answer: Answer) -> list[Number]:
    """Every number of an answer with its origin: ``pandas.DataFrame(records(scene, answer))`` is one table.

    Args:
        scene: the question.
        answer: a solver's answer to the question.

    Returns:
        A dictionary of each number, station by station and probe by probe: ``scene``, ``solver``, ``stage``,
        ``station``, ``branch``, ``probe``, ``component``, ``arc_length`` (m, along a beam), ``unit`` (SI) and
        ``value``.  A missing value has no record.
    """
    station_units = {stage.name: load_unit(scene, stage.name) for stage in scene.stages}
    return [
        Number(
            scene=scene.name,
            solver=answer.solver,
            stage=station.stage,
            station=station.value,
            branch=station.branch,
            probe=probe.name,
            component=component,
            arc_length=arc_length,
            unit=unit_of(scene, probe, station.stage),
            value=value,
            station_unit=station_units[station.stage],
        )
        for station in answer.stations
        for probe in scene.probes_in(station.stage)
        for (component, arc_length), value in _parts(scene, probe, station.values[probe.name]).items()
    ]


def write_csv(path: str | Path, scene: Scene, *answers: Answer) -> None:
    """Write the numbers of answers as a file of comma-separated values with a line of headers.

    Args:
        path: of the file; a missing folder is made.
        scene: the question.
        answers: of one solver or several to the question, one below the other.

    Raises:
        OSError: the file cannot be written.
    """
    write(Path(path), csv_of(scene, *answers))


def _parts(scene: Scene, probe: Probe, values: Array) -> dict[tuple[str, float | None], float]:
    """Numbers of a probe by component and place."""
    if probe.quantity in STRESSES:
        return {("", place): value for place, value in zip(arc_lengths(scene, probe).tolist(), values.tolist())}  # noqa: B905 - a station without stresses has no values
    names = COMPONENTS.get(probe.quantity, ("",))[: len(values)]
    return {(name, None): value for name, value in zip(names, values.tolist(), strict=True)}


def comparison_records(compared: Comparison) -> list[Plain]:
    """Every number of a comparison with the values of both solvers; ``word`` is empty where a row takes no part.

    ``difference`` and ``stated`` are norms of the probe, in ``unit``.
    """
    scene, found = compared.scene, list[Plain]()
    for row in compared.rows:
        cprbm, fea = (_parts(scene, row.probe, values) for values in (row.cprbm, row.fea))
        where = (scene.name, *row.where, load_unit(scene, row.stage), row.branch, row.probe.name)
        judged = (row.difference, row.bounds and row.bounds.total, row.word.value if row.word else "")
        found += [
            dict(zip(_COMPARISON, (*where, *part, row.unit, cprbm.get(part), fea.get(part), *judged), strict=True))
            for part in cprbm | fea
        ]
    return found


def csv_of(scene: Scene, *answers: Answer) -> str:
    """Answers to a scene as comma-separated values in the units of the scene's file, with a line of headers."""
    rows = (in_file_units(scene, number) for answer in answers for number in records(scene, answer))
    return csv_text([*Number.__annotations__, "arc_length_unit"], rows)


def csv_of_comparisons(comparisons: Sequence[Comparison]) -> str:
    """Comparisons as comma-separated values in the units of the scenes' files, with a line of headers."""
    rows = (in_file_units(each.scene, record) for each in comparisons for record in comparison_records(each))
    return csv_text([*_COMPARISON, "arc_length_unit"], rows)


def contact_csv(scene: Scene, answers: Sequence[Answer]) -> str:
    """Contact forces of answers as comma-separated values in the units of the scene's file, with a line of headers."""
    lines = (
        (scene.name, answer.solver, at.stage, at.value, load_unit(scene, at.stage), force.source, force.target,
         *map(float, (force.s, *force.place)), "m", *map(float, force.force), "N")
        for answer in answers for at in answer.stations for force in pressing(scene, at)
    )  # fmt: skip
    return csv_text(
        _CONTACT_FORCE, (in_file_units(scene, dict(zip(_CONTACT_FORCE, line, strict=True))) for line in lines)
    )


def pressing(scene: Scene, station: StationAnswer) -> Iterator[PointForce]:
    """Forces of contacts on beams, in the order of contacts and beams."""
    return (at for at in station.forces if at.source in scene.contacts and at.target in scene.beams and at.force.any())


def in_file_units(scene: Scene, record: Mapping[str, object]) -> Plain:
    """A record with numbers, to 15 digits, and units as in the scene's file."""
    row: Plain = {**record, "arc_length_unit": "m"}
    for unit, columns in _MEASURED.items():
        factor, row[unit] = file_unit(scene, row[unit])
        row |= {column: in_unit(row[column], factor) for column in columns if isinstance(row.get(column), float)}
    return row


def in_unit(value: float | None, factor: float) -> float | None:
    """A number in a unit of size ``factor``, to 15 digits."""
    return value if value is None or factor == 1.0 else float(f"{value / factor:.15g}")


def csv_text(headers: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> str:
    """Rows as comma-separated values with a line of headers; an absent value is empty."""
    text = io.StringIO()
    table = csv.DictWriter(text, fieldnames=headers, lineterminator="\n", restval="")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()
