"""Answers and comparisons as tables with a number on every line: records in SI, files in the units of the scene."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypedDict

from comparisons.case import Comparison
from comparisons.display_units import file_unit
from comparisons.plain import Plain
from comparisons.present.columns import Column, records_of
from comparisons.quantities import COMPONENTS, arc_lengths, load_unit, unit_of
from comparisons.verdict.rows import Row
from comparisons.verdict.words import Word
from cprbm_scene import Answer, Probe, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES


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


class _Entry(NamedTuple):
    """A number of a comparison: row, word, component, place, and the values of both solvers."""

    row: Row
    word: Word | None
    component: str
    arc_length: float | None
    cprbm: float | None
    fea: float | None


_MEASURED = {
    "station_unit": ("station",),
    "arc_length_unit": ("arc_length", "x", "y"),
    "unit": ("value", "cprbm", "fea", "difference", "stated", "force_x", "force_y"),
}
"""Columns of units, and the columns of numbers in the unit."""


def numbers(scene: Scene, answer: Answer) -> Iterator[Number]:
    """Every number of an answer, station by station and probe by probe; a missing value has no record."""
    stages = {stage.name: stage for stage in scene.stages}
    for station in answer.stations:
        stage = stages[station.stage]
        for probe in scene.probes_in(station.stage):
            for (component, arc_length), value in _parts(scene, probe, station.values[probe.name]).items():
                yield Number(
                    scene=scene.name,
                    solver=answer.solver,
                    stage=stage.name,
                    station=station.value,
                    branch=station.branch,
                    probe=probe.name,
                    component=component,
                    arc_length=arc_length,
                    unit=unit_of(scene, probe, stage),
                    value=value,
                    station_unit=load_unit(scene, stage),
                )


def _parts(scene: Scene, probe: Probe, values: Array) -> dict[tuple[str, float | None], float]:
    """Numbers of a probe by component and place."""
    if probe.quantity in STRESSES:
        return {("", place): value for place, value in zip(arc_lengths(scene, probe).tolist(), values.tolist())}  # noqa: B905 - a station without stresses has no values
    names = COMPONENTS.get(probe.quantity, ("",))[: len(values)]
    return {(name, None): value for name, value in zip(names, values.tolist(), strict=True)}


def comparison_columns(scene: Scene) -> Sequence[Column[_Entry]]:
    """Columns of a comparison; ``difference`` and ``stated`` are norms of the probe, in ``unit``."""
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    return (
        Column("scene", lambda at: scene.name),
        Column("stage", lambda at: at.row.stage),
        Column("station", lambda at: at.row.station),
        Column("station_unit", lambda at: units[at.row.stage]),
        Column("branch", lambda at: at.row.branch),
        Column("probe", lambda at: at.row.probe.name),
        Column("component", lambda at: at.component),
        Column("arc_length", lambda at: at.arc_length),
        Column("unit", lambda at: at.row.unit),
        Column("cprbm", lambda at: at.cprbm),
        Column("fea", lambda at: at.fea),
        Column("difference", lambda at: at.row.difference),
        Column("stated", lambda at: None if at.row.bounds is None else at.row.bounds.total),
        Column("word", lambda at: "" if at.word is None else at.word.value),
    )


def comparison_records(compared: Comparison) -> list[Plain]:
    """Every number of a comparison with the values of both solvers; ``word`` is empty where a row takes no part."""
    scene, entries = compared.scene, []
    for row, word in zip(compared.rows, compared.verdict.words, strict=True):
        cprbm, fea = (_parts(scene, row.probe, values) for values in (row.cprbm, row.fea))
        entries += [_Entry(row, word, *part, cprbm.get(part), fea.get(part)) for part in cprbm | fea]
    return records_of(comparison_columns(scene), entries)


def csv_of(scene: Scene, *answers: Answer) -> str:
    """Answers to a scene as comma-separated values in the units of the scene's file, with a line of headers."""
    rows = (in_file_units(scene, number) for answer in answers for number in numbers(scene, answer))
    return csv_text([*Number.__annotations__, "arc_length_unit"], rows)


def csv_of_comparisons(comparisons: Sequence[Comparison]) -> str:
    """Comparisons as comma-separated values in the units of the scenes' files, with a line of headers."""
    rows = (in_file_units(each.scene, record) for each in comparisons for record in comparison_records(each))
    headers = [column.header for each in comparisons[:1] for column in comparison_columns(each.scene)]
    return csv_text([*headers, "arc_length_unit"], rows)


def in_file_units(scene: Scene, record: Mapping[str, object]) -> Plain:
    """A record with numbers, to 15 digits, and units as in the scene's file."""
    row: Plain = {**record, "arc_length_unit": "m"}
    for unit, columns in _MEASURED.items():
        factor, row[unit] = file_unit(scene, row[unit])
        for column in columns:
            if isinstance(row.get(column), float):
                row[column] = in_unit(row[column], factor)
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
