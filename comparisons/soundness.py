"""Whether an answer can be compared at all: what is incomplete about it, in sentences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from comparisons.branches import begins_at, span_of
from comparisons.measures import COMPONENTS
from comparisons.stations import station_of
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.statement import STRESSES

ABSENT_WHILE_OPEN = frozenset({"centre", "ends", "closing_load"})
"""Quantities of a contact that have no value while it is open."""

_ROUNDED = 1e-9  # of a stage's span, by which a critical value may be beyond the stations beside it


def complaints(scene: Scene, answer: Answer) -> tuple[str, ...]:
    """Why an answer is no whole answer to a scene; empty if it is one.

    An answer is whole if it says that it completed, has every station of every stage and none besides, every
    certificate in it holds, every number in it is finite and of the shape that its probe has, and its branches end
    at its critical values.
    """
    found: list[str] = []
    if not answer.completed:
        found.append(f"it ended early: {answer.ending.value}")
    asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    for stage, value in asked:
        try:
            station = station_of(answer, stage, value)
        except KeyError:
            found.append(f"it has no station {stage} {value:g}")
            continue
        found.extend(f"at {stage} {value:g} {what}" for what in _station_complaints(scene, station))
    if len(answer.stations) > len(asked):
        found.append(f"it has {len(answer.stations)} stations where {len(asked)} were asked")
    return (*found, *_branch_complaints(scene, answer))


def _branch_complaints(scene: Scene, answer: Answer) -> list[str]:
    """Critical values that are no numbers, and branches that end where there is none."""
    found = [
        f"its critical value in {one.stage} is not finite"
        for one in answer.critical
        if not np.all(np.isfinite((one.value, one.uncertainty, one.energy)))
    ]
    values = {stage.name: begins_at(scene, stage) for stage in scene.stages}
    slack = {stage.name: _ROUNDED * span_of(scene, stage) for stage in scene.stages}
    branch = 0
    for station in answer.stations:
        if station.stage not in values:
            continue
        least, most = sorted((values[station.stage], station.value))
        least, most = least - slack[station.stage], most + slack[station.stage]
        ends = answer.critical[branch : station.branch]
        if len(ends) != station.branch - branch or not all(
            one.stage == station.stage and least <= one.value <= most for one in ends
        ):
            found.append(
                f"at {station.stage} {station.value:g} it is on branch {station.branch} after branch {branch}, and its "
                "critical values say otherwise"
            )
        values[station.stage], branch = station.value, station.branch
    return found


def sound_part(scene: Scene, answer: Answer) -> Answer:
    """An answer without the stations that are not whole, however it ended."""
    sound = tuple(station for station in answer.stations if not _station_complaints(scene, station))
    return replace(answer, stations=sound)


def _station_complaints(scene: Scene, station: StationAnswer) -> list[str]:
    found = [f"its certificate does not hold: {failure}" for failure in station.certificate.failures]
    numbers = (
        station.certificate.residual,
        station.certificate.residual_floor,
        station.certificate.violation,
        station.certificate.penetration,
        station.certificate.complementarity,
        station.certificate.force_balance,
        station.certificate.moment_balance,
    )
    if not np.all(np.isfinite(numbers)):
        found.append("its certificate holds a number that is not finite")
    for beam in scene.beams:
        shape = station.shapes.get(beam)
        if shape is None or not all(np.all(np.isfinite(values)) for values in (shape.s, shape.x, shape.y)):
            found.append(f"{beam} has no shape of finite numbers")
    if not all(np.all(np.isfinite(places)) for places in station.touching.values()):
        found.append("a place of contact is not finite")
    for probe in scene.probes:
        values = station.values.get(probe.name)
        if values is None:
            found.append(f"{probe.name} is missing")
        elif values.shape not in _shapes(probe):
            found.append(f"{probe.name} has the shape {values.shape}")
        elif not np.all(np.isfinite(values)):
            found.append(f"{probe.name} is not finite")
        elif probe.quantity == "ends" and np.any(np.diff(values) < 0.0):
            found.append(f"{probe.name} are not ascending")
    return found


def _shapes(probe: Probe) -> tuple[tuple[int, ...], ...]:
    if probe.quantity in STRESSES:
        return ((probe.points,),)
    closed = (len(COMPONENTS.get(probe.quantity, ("",))),)
    return (closed, (0,)) if probe.quantity in ABSENT_WHILE_OPEN else (closed,)
