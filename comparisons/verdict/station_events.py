"""Events of all runs by a station: answers are compared where all runs have passed the same events.

The state of a run at a station has these parts: the number of its branch, the number of passed critical points, and
each contact, active or not.  A part may differ between the runs:

* If each run goes through the same sequence of states in the stage, the station lies between the runs' loads of one
  event.  A contact is then *unsettled*.
* If runs of one solver disagree, the part is *unsettled* as well.
* In all other cases the part is *contradictory*.

A station within T of a critical point (:func:`comparisons.stations.event_tolerance`) also lies between events: beside a
fold the difference grows with the square root of the distance.  Runs on mirror images behind a bifurcation are
unsettled.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import groupby, pairwise

import numpy as np

from comparisons.stations import begins_at, event_tolerance
from comparisons.verdict.completeness import Where
from comparisons.verdict.events import disagree_within_a_solver
from comparisons.verdict.point_forces import active_contacts
from comparisons.verdict.runs import SOLVERS, RunsTable
from comparisons.verdict.scales import deflection
from cprbm_scene import Answer, Loss, Scene, Stage, StationAnswer
from cprbm_scene.answer import Shape

BRANCH = "branch"
PASSED = "passed critical points"
MIRRORED = "mirror images"
"""Parts of a state beside the names of contacts, which hold no blank; ``BRANCH`` is never in a set of such names."""

MIRROR_DISTANCE = 0.05
"""Least distance of beams on mirror images, a share of their largest distance from rest."""

State = Mapping[str, int]
"""Parts of a run's state at a station, a contact's 1 where the contact is active."""


class Place(Enum):
    """Whether all runs have passed the same critical points at a station."""

    COMPARED = "compared"
    BETWEEN = "between events"


@dataclass(frozen=True, slots=True)
class StationEvents:
    """Events of all runs by a station.

    Attributes:
        branch: number of critical points before; None where the runs have met different numbers.
        place: whether rows are compared here.
        unsettled, contradictory: contacts and other parts of the state, as the module says.
    """

    branch: int | None
    place: Place
    unsettled: frozenset[str] = frozenset()
    contradictory: frozenset[str] = frozenset()


NO_EVENTS = StationEvents(0, Place.COMPARED)


def station_events(table: RunsTable) -> dict[Where, StationEvents]:
    """Events of all runs by every station that both compared runs reach."""
    found: dict[Where, StationEvents] = {}
    for stage in table.scene.stages:
        reached = [where for where in table.reached if where[0] == stage.name]
        states = {
            name: _states(table.scene, stage, answer, table.stations[name]) for name, answer in table.answers.items()
        }
        sequences = {
            name: _sequences([mine[where] for where in reached if where in mine]) for name, mine in states.items()
        }
        critical = [one.value for answer in table.pair for one in answer.critical if one.stage == stage.name]
        passed = [one.end.value for answer in table.pair for one in answer.gone_over if one.end.stage == stage.name]
        for where in reached:
            here = {name: mine[where] for name, mine in states.items() if where in mine}
            found[where] = _events(
                table, where, here, sequences, (critical, passed), event_tolerance(table.scene, stage)
            )
    return found


def passed_by(scene: Scene, stage: Stage, answer: Answer, station: int) -> int:
    """Number of passed critical points in a stage by the station with the number ``station``."""
    values = (begins_at(scene, stage), *stage.stations[: station + 1])
    mine = [one.end.value for one in answer.gone_over if one.end.stage == stage.name]
    steps = [sorted(pair) for pair in pairwise(values)]
    return sum(least < value <= most for value in mine for least, most in steps)


def _events(
    table: RunsTable,
    where: Where,
    here: Mapping[str, State],
    sequences: Mapping[str, Mapping[str, tuple[int, ...]]],
    loads: tuple[Sequence[float], Sequence[float]],
    tolerance: float,
) -> StationEvents:
    """Events by one station, with the states of the runs there and the loads of critical and of passed points."""
    between, unsettled, contradictory = set[str](), set[str](), set[str]()
    for part in here[SOLVERS[0]]:
        values = {name: state[part] for name, state in here.items()}
        if len(set(values.values())) == 1:
            continue
        if part == BRANCH:
            between.add(part)
        elif len({sequences[name][part] for name in here}) == 1:
            (between if part == PASSED else unsettled).add(part)
        else:
            (unsettled if disagree_within_a_solver(values) else contradictory).add(part)
    critical, passed = (any(abs(where[1] - load) <= tolerance for load in each) for each in loads)
    if passed:
        unsettled.add(PASSED)
    if _on_mirror_images(table, table.at(where)):
        unsettled.add(MIRRORED)
    return StationEvents(
        None if BRANCH in between else here[SOLVERS[0]][BRANCH],
        Place.BETWEEN if between or critical else Place.COMPARED,
        frozenset(unsettled),
        frozenset(contradictory - unsettled),
    )


def _states(
    scene: Scene, stage: Stage, answer: Answer, stations: Mapping[Where, StationAnswer]
) -> dict[Where, dict[str, int]]:
    """States of a run at its stations of a stage."""
    found = {}
    for index, value in enumerate(stage.stations):
        if (stage.name, value) in stations:
            station = stations[stage.name, value]
            active = active_contacts(station)
            found[stage.name, value] = {
                BRANCH: station.branch,
                PASSED: passed_by(scene, stage, answer, index),
                **{name: int(name in active) for name in scene.contacts},
            }
    return found


def _sequences(states: Sequence[State]) -> dict[str, tuple[int, ...]]:
    """Values of every part of the state in order, repetitions left out."""
    parts = states[0] if states else {}
    return {part: tuple(value for value, _ in groupby(state[part] for state in states)) for part in parts}


def _on_mirror_images(table: RunsTable, here: Mapping[str, StationAnswer]) -> bool:
    """Whether a compared run has met a bifurcation, and beams of some runs lie far from the compared CPRBM's."""
    points_met = (
        one
        for answer, name in zip(table.pair, SOLVERS, strict=True)
        for one in (*answer.critical[: here[name].branch], *(each.end for each in answer.gone_over))
    )
    if not any(one.loss is Loss.BIFURCATION for one in points_met):
        return False
    first = here[SOLVERS[0]].shapes
    beams = table.scene.beams.items()
    bent = max(deflection(beam, first[name]) for name, beam in beams)
    apart = max(_distance(first[name], station.shapes[name]) for station in here.values() for name, _ in beams)
    return apart > MIRROR_DISTANCE * bent


def _distance(one: Shape, other: Shape) -> float:
    """Largest distance of nine places of a beam in two shapes, m."""
    first, second = (
        np.stack([np.interp(np.linspace(0.0, shape.s[-1], 9), shape.s, along) for along in (shape.x, shape.y)])
        for shape in (one, other)
    )
    return float(np.max(np.hypot(*(first - second))))
