"""Stages on the load axis: begin, span, tolerance of an event, shown stations, and the station of an answer."""

from __future__ import annotations

import math

from cprbm_scene import Answer, Scene, Stage, StationAnswer
from cprbm_scene.statement import RotationDrive

ROTATION_TOLERANCE = math.radians(0.3)
"""Distance of two events on the axis of a rotation that still counts as one event, rad."""

SPAN_TOLERANCE = 0.01
"""The same on the axis of any other load or drive, a share of the stage's span."""

_SAME = 1e-12
"""Relative distance of two values of one station: round-off of units."""


def begins_at(scene: Scene, stage: Stage) -> float:
    """Value of the load or drive at the begin of a stage: the last value in the stages before, or 0."""
    before = reversed(scene.stages[: scene.stages.index(stage)])
    return next((earlier.stations[-1] for earlier in before if earlier.steps == stage.steps), 0.0)


def span_of(scene: Scene, stage: Stage) -> float:
    """Largest less least value of the load or drive in a stage, in the unit of the load or drive."""
    visited = (begins_at(scene, stage), *stage.stations)
    return max(visited) - min(visited)


def event_tolerance(scene: Scene, stage: Stage) -> float:
    """Largest distance of two loads of one event on the load axis, in the unit of the axis."""
    turns = isinstance(scene.stepped(stage), RotationDrive)
    return stage.critical_limit or (ROTATION_TOLERANCE if turns else SPAN_TOLERANCE * span_of(scene, stage))


def kept(stage: Stage) -> tuple[float, ...]:
    """The shown stations of a stage in order, otherwise the middle station; and the last station."""
    middle = len(stage.stations) // 2
    few = {*(stage.shown or stage.stations[middle : middle + 1]), stage.stations[-1]}
    return tuple(value for value in stage.stations if value in few)


def at_shown(scene: Scene) -> Scene:
    """The scene with the shown stations and the last station of a stage; a stage that shows all keeps all.

    A stage that asks for the ends of branches still finds the events between stations.
    """
    stages = (each.model_copy(update={"stations": kept(each)}) if each.shown else each for each in scene.stages)
    return scene.model_copy(update={"stages": tuple(stages)})


def find_station(answer: Answer, stage: str, value: float) -> StationAnswer | None:
    """An answer's station of a stage at a value of the load or drive; None without this station."""
    mine = [station for station in answer.stations if station.stage == stage]
    near = (station for station in mine if math.isclose(station.value, value, rel_tol=_SAME, abs_tol=0.0))
    return next((station for station in mine if station.value == value), None) or next(near, None)


def station_of(answer: Answer, stage: str, value: float) -> StationAnswer:
    """An answer's station of a stage at a value of the load or drive.

    Raises:
        KeyError: the answer lacks the station.
    """
    station = find_station(answer, stage, value)
    if station is None:
        raise KeyError(f"{answer.solver} has no station {stage} {value:g}")
    return station
