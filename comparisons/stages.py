"""The load axis: begin and span of a stage, and the tolerance of an event on it."""

from __future__ import annotations

import math

from cprbm_scene import Scene, Stage
from cprbm_scene.statement import RotationDrive

ROTATION_TOLERANCE = math.radians(0.3)
"""Distance of two events on the axis of a rotation that still counts as one event, rad."""

SPAN_TOLERANCE = 0.01
"""The same on the axis of any other load or drive, a share of the stage's span."""


def begins_at(scene: Scene, stage: Stage) -> float:
    """Value of the load or drive at the begin of a stage: the last value in the stages before, or 0."""
    before = scene.stages[: scene.stages.index(stage)]
    return next((earlier.stations[-1] for earlier in reversed(before) if earlier.steps == stage.steps), 0.0)


def span_of(scene: Scene, stage: Stage) -> float:
    """Largest less least value of the load or drive in a stage, in the unit of the load or drive."""
    visited = (begins_at(scene, stage), *stage.stations)
    return max(visited) - min(visited)


def event_tolerance(scene: Scene, stage: Stage) -> float:
    """Largest distance of two loads of one event on the load axis, in the unit of the axis."""
    if stage.critical_limit:
        return stage.critical_limit
    turns = isinstance(scene.stepped(stage), RotationDrive)
    return ROTATION_TOLERANCE if turns else SPAN_TOLERANCE * span_of(scene, stage)
