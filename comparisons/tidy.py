"""An answer as a table with one number on each line, which tools for tables take as it is."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import TypedDict

from comparisons.quantities import COMPONENTS, arc_lengths, unit_of
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


def numbers(scene: Scene, answer: Answer) -> Iterator[Number]:
    """Every number of an answer, station by station and probe by probe; of what has no value there is none."""
    stages = {stage.name: stage for stage in scene.stages}
    for station in answer.stations:
        for probe in scene.probes:
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


def csv_of(scene: Scene, *answers: Answer) -> str:
    """Answers to one scene as comma-separated values, with a line of headers."""
    text = io.StringIO()
    table = csv.DictWriter(text, fieldnames=list(Number.__annotations__), lineterminator="\n")
    table.writeheader()
    for answer in answers:
        table.writerows(numbers(scene, answer))
    return text.getvalue()
