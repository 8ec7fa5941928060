"""Complete stations of an answer, and the problems of an answer in sentences.

An answer is complete if it says so, has every station of every stage and no other, every certificate holds, every
number is finite and has the shape of its probe, and branches end at critical points only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from comparisons.quantities import COMPONENTS
from comparisons.stations import begins_at, find_station, span_of
from cprbm_scene import Answer, Ending, Probe, Scene, StationAnswer
from cprbm_scene.statement import STRESSES

ABSENT_WHILE_OPEN = frozenset({"centre", "ends", "closing_load"})
"""Quantities of a contact without a value while the contact is open."""

Where = tuple[str, float]
"""Stage and station."""

_ROUND_OFF = 1e-9  # of a stage's span: round-off of a critical load beside a station


CERTIFICATE_NUMBERS = (
    "residual",
    "residual_floor",
    "violation",
    "penetration",
    "complementarity",
    "force_balance",
    "moment_balance",
)
"""Fields of a certificate that are finite and small in a complete station."""


def stations_of(scene: Scene) -> tuple[Where, ...]:
    """All stations of a scene in order."""
    return tuple((stage.name, value) for stage in scene.stages for value in stage.stations)


def complete_stations(scene: Scene, answer: Answer) -> Mapping[Where, StationAnswer]:
    """Stations of an answer without a problem."""
    known = ((where, find_station(answer, *where)) for where in stations_of(scene))
    return {where: at for where, at in known if at is not None and not any(_station_problems(scene, at))}


def complete_part(scene: Scene, answer: Answer) -> Answer:
    """The answer with its complete stations alone."""
    return replace(answer, stations=tuple(complete_stations(scene, answer).values()))


def ends_at_critical(answer: Answer) -> bool:
    """Whether an answer ends at a critical point and names the point."""
    last = answer.stations[-1].branch if answer.stations else 0
    return answer.ending is Ending.BRANCH_ENDS and len(answer.critical) == last + 1


def _station_name(stage: str, value: float) -> str:
    """Name of a station with the load or drive in SI units."""
    return f"{stage} {value:g}"


def problems(scene: Scene, answer: Answer, name: Callable[[str, float], str] = _station_name) -> tuple[str, ...]:
    """Problems of an answer in sentences; empty if the answer is complete.

    Args:
        scene: the question.
        answer: the answer.
        name: name of a station by stage and value.
    """
    found: list[str] = []
    if not answer.completed:
        found.append(f"it ended early: {answer.sentence or answer.ending.value}")
    asked = stations_of(scene)
    for stage, value in asked:
        station = find_station(answer, stage, value)
        if station is not None:
            found.extend(f"at {name(stage, value)} {problem}" for problem in _station_problems(scene, station))
        elif answer.completed:
            found.append(f"it has no station {name(stage, value)}")
        else:
            break
    if len(answer.stations) > len(asked):
        found.append(f"it has {len(answer.stations)} stations where {len(asked)} were asked")
    return (*found, *_branch_problems(scene, answer, name))


def _station_problems(scene: Scene, station: StationAnswer) -> Iterator[str]:
    certificate = station.certificate
    yield from (f"its certificate does not hold: {failure}" for failure in certificate.failures)
    numbers = [getattr(certificate, name) for name in CERTIFICATE_NUMBERS]
    # without a feasible direction the smallest curvature is infinite
    if not np.isfinite(numbers).all() or np.isnan(certificate.smallest_curvature):
        yield "its certificate holds a number that is not finite"
    for beam in scene.beams:
        shape = station.shapes.get(beam)
        if shape is None or not all(np.isfinite(values).all() for values in (shape.s, shape.x, shape.y)):
            yield f"{beam} has no shape of finite numbers"
    if not all(np.isfinite(places).all() for places in station.touching.values()):
        yield "a place of contact is not finite"
    for probe in scene.probes:
        values = station.values.get(probe.name)
        if values is None:
            yield f"{probe.name} is missing"
        elif values.shape not in (_shapes(probe) if probe.asked_in(station.stage) else ((0,),)):
            yield f"{probe.name} has the shape {values.shape}"
        elif not np.isfinite(values).all():
            yield f"{probe.name} is not finite"
        elif probe.quantity == "ends" and np.any(np.diff(values) < 0.0):
            yield f"{probe.name} are not ascending"


def _shapes(probe: Probe) -> tuple[tuple[int, ...], ...]:
    if probe.quantity in STRESSES:
        return ((probe.points,),)
    closed = (len(COMPONENTS.get(probe.quantity, ("",))),)
    return (closed, (0,)) if probe.quantity in ABSENT_WHILE_OPEN else (closed,)


def _branch_problems(scene: Scene, answer: Answer, name: Callable[[str, float], str]) -> Iterator[str]:
    """Critical points without finite loads, and branches without a critical point at the end."""
    for one in answer.critical:
        if not np.isfinite((one.value, one.uncertainty, one.energy)).all():
            yield f"its critical value in {one.stage} is not finite"
    values = {stage.name: begins_at(scene, stage) for stage in scene.stages}
    slack = {stage.name: _ROUND_OFF * span_of(scene, stage) for stage in scene.stages}
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
            yield (
                f"at {name(station.stage, station.value)} it is on branch {station.branch} after branch {branch}, and "
                "its critical values say otherwise"
            )
        values[station.stage], branch = station.value, station.branch
