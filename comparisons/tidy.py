"""Answers and comparisons as tables with one number on each line: records in SI, files in the units of the scene."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping
from typing import TypedDict

from comparisons.case import Comparison
from comparisons.display_units import file_unit
from comparisons.quantities import COMPONENTS, arc_lengths, load_unit, unit_of
from cprbm_scene import Answer, Probe, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES


class Number(TypedDict):
    """One number, in the SI ``unit``.

    ``station`` is the value of the load or drive that the stage steps, ``branch`` how many branches have ended before;
    ``component`` is empty of what has one number only, and ``arc_length``, m, None but along a beam.
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


def numbers(scene: Scene, answer: Answer) -> Iterator[Number]:
    """Every number of an answer, station by station and probe by probe; of what has no value there is none."""
    stages = {stage.name: stage for stage in scene.stages}
    for station in answer.stations:
        for probe in scene.probes_in(station.stage):
            values = station.values[probe.name]
            for component, arc_length, value in _parts(scene, probe, values):
                yield Number(
                    scene=scene.name,
                    solver=answer.solver,
                    stage=station.stage,
                    station=station.value,
                    branch=station.branch,
                    probe=probe.name,
                    component=component,
                    arc_length=arc_length,
                    unit=unit_of(scene, probe, stages[station.stage]),
                    value=value,
                    station_unit=load_unit(scene, stages[station.stage]),
                )


def _parts(scene: Scene, probe: Probe, values: Array) -> Iterator[tuple[str, float | None, float]]:
    """Component, place and value of each number of a probe."""
    if probe.quantity in STRESSES:
        for place, value in zip(arc_lengths(scene, probe), values, strict=True):
            yield "", float(place), float(value)
        return
    names = COMPONENTS.get(probe.quantity, ("",))[: len(values)]
    for name, value in zip(names, values, strict=True):
        yield name, None, float(value)


class ComparedNumber(TypedDict):
    """One number of a comparison in the SI ``unit``, with the values of both solvers; ``arc_length`` in m."""

    scene: str
    stage: str
    station: float
    station_unit: str
    branch: int | None
    probe: str
    component: str
    arc_length: float | None
    unit: str
    cprbm: float | None
    fea: float | None
    difference: float
    stated: float | None
    word: str


_MEASURED = (
    ("station_unit", ("station",)),
    ("arc_length_unit", ("arc_length",)),
    ("unit", ("value", "cprbm", "fea", "difference", "stated")),
)
"""Columns of units, and the columns that have numbers in each."""


def comparison_records(compared: Comparison) -> Iterator[ComparedNumber]:
    """Every number of a comparison with the values of both solvers beside each other.

    ``difference`` and ``stated`` are norms of the probe, in ``unit``; ``word`` is empty where the row takes no part.
    """
    scene = compared.scene
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    for row, word in zip(compared.rows, compared.verdict.words, strict=True):
        cprbm, fea = (
            {(component, place): value for component, place, value in _parts(scene, row.probe, values)}
            for values in (row.cprbm, row.fea)
        )
        for component, place in cprbm | fea:
            yield {
                "scene": scene.name,
                "stage": row.stage,
                "station": row.station,
                "station_unit": units[row.stage],
                "branch": row.branch,
                "probe": row.probe.name,
                "component": component,
                "arc_length": place,
                "unit": row.unit,
                "cprbm": cprbm.get((component, place)),
                "fea": fea.get((component, place)),
                "difference": row.difference,
                "stated": None if row.bounds is None else row.bounds.total,
                "word": "" if word is None else word.value,
            }


def csv_of(scene: Scene, *answers: Answer) -> str:
    """Answers to one scene as comma-separated values in the units of the scene's file, with a line of headers."""
    rows = (_in_file_units(scene, number) for answer in answers for number in numbers(scene, answer))
    return _csv_text(rows, Number)


def csv_of_comparisons(comparisons: Iterable[Comparison]) -> str:
    """Comparisons as comma-separated values in the units of each scene's file, with a line of headers."""
    rows = (_in_file_units(each.scene, record) for each in comparisons for record in comparison_records(each))
    return _csv_text(rows, ComparedNumber)


def _in_file_units(scene: Scene, record: Mapping[str, object]) -> dict[str, object]:
    """A record with its numbers, to 15 digits, and its units as the scene's file states them."""
    row: dict[str, object] = {**record, "arc_length_unit": "m"}
    for unit, columns in _MEASURED:
        factor, row[unit] = file_unit(scene, str(row[unit]))
        for column in columns:
            number = row.get(column)
            if factor != 1.0 and isinstance(number, float):
                row[column] = float(f"{number / factor:.15g}")
    return row


def _csv_text(rows: Iterable[Mapping[str, object]], kind: type) -> str:
    """Rows of a ``kind`` as comma-separated values; also without rows a line of headers."""
    text = io.StringIO()
    columns = [*kind.__annotations__, "arc_length_unit"]
    table = csv.DictWriter(text, fieldnames=columns, lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()
