"""Stations of stages and of answers: the load axis, shown stations, and complete stations of an answer.

An answer is complete if it says so, has every station of every stage and no other, every certificate holds, every
number is finite and has the shape of its probe, and branches end at critical points only.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from comparisons.quantities import COMPONENTS
from cprbm_scene import STRESSES, Answer, Ending, Probe, RotationDrive, Scene, Stage, StationAnswer

ROTATION_TOLERANCE = math.radians(0.3)
"""Distance of two events on the axis of a rotation that still counts as one event, rad."""

SPAN_TOLERANCE = 0.01
"""The same on the axis of any other load or drive, a share of the stage's span."""

_SAME = 1e-12
"""Relative distance of two values of one station: round-off of units."""

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


def stations_of(scene: Scene) -> tuple[Where, ...]:
    """All stations of a scene in order."""
    return tuple((stage.name, value) for stage in scene.stages for value in stage.stations)


def last_station(scene: Scene) -> Where:
    """The last station of the last stage."""
    return scene.stages[-1].name, scene.stages[-1].stations[-1]


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


def problems(scene: Scene, answer: Answer, name: Callable[[str, float], str] = "{} {:g}".format) -> tuple[str, ...]:
    """Problems of an answer in sentences; empty if the answer is complete.

    Args:
        scene: the question.
        answer: the answer.
        name: name of a station by stage and value; by itself with the value in SI units.
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
    for station in (each for each in answer.stations if each.stage in values):
        (least, most), margin = sorted((values[station.stage], station.value)), slack[station.stage]
        ends = answer.critical[branch : station.branch]
        if len(ends) != station.branch - branch or not all(
            one.stage == station.stage and least - margin <= one.value <= most + margin for one in ends
        ):
            yield (
                f"at {name(station.stage, station.value)} it is on branch {station.branch} after branch {branch}, and "
                "its critical values say otherwise"
            )
        values[station.stage], branch = station.value, station.branch
