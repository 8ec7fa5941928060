"""Events on the load axis: contacts that close and open, critical points, and the stations between.

Answers are compared where all runs have passed the same events.  The events themselves are compared on the load axis.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
λ_c     load of an event in the CPRBM, λ_f in the finite elements, λ_b in ``bending``
U, U_b  stated uncertainty of λ_c − λ_f and of λ_c − λ_b (:mod:`comparisons.verdict.bounds`)
θ       step of theory |λ_b − λ_f|
T       tolerance of an event on the load axis (:func:`comparisons.stages.event_tolerance`)
W       ``verdict_limit`` of the scene times the span of the stage
======  ==========================================================================================

A critical point

* differs if a solver lacks it, if the mechanisms differ, or if |λ_c − λ_b| > max(T, U_b);
* is undecided if runs of one solver disagree, or max(U − θ, U_b) > T, or U > max(T, W);
* agrees otherwise.

The first critical point of a stage is compared with the first of the other runs, the second with the second.  In a stage
that asks for no critical point a run may pass it and go on along another branch: a passed critical point stands in for
a missing one, and the row is undecided.

A station lies between events if runs have passed different numbers of critical points by then, or within T of one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import accumulate, groupby

import numpy as np

from comparisons.geometry import points
from comparisons.quantities import load_unit
from comparisons.stages import begins_at, event_tolerance, span_of
from comparisons.verdict.bounds import Bounds, bounds_of
from comparisons.verdict.completeness import Where
from comparisons.verdict.point_forces import active_contacts
from comparisons.verdict.runs_table import RunsTable, solver_of
from comparisons.verdict.words import Reason, Word
from cprbm_scene import Answer, Beam, Critical, Loss, Scene, Stage, StationAnswer
from cprbm_scene.answer import Shape
from cprbm_scene.frozendict import frozendict


class Place(Enum):
    """Whether all runs have passed the same events at a station."""

    COMPARED = "compared"
    BETWEEN = "between events"


@dataclass(frozen=True, slots=True)
class StationEvents:
    """Events of all runs by a station.

    Attributes:
        branch: number of critical points before; None between events.
        place: whether rows are compared here.
        unsettled: contacts that press in some runs only, and close or open in all runs of the stage, or press in some
            runs of one solver only; ``passed`` where one of the compared runs has passed a critical point near here.
        contradictory: contacts that press in one solver, and in no run of the other; ``passed`` likewise.
    """

    branch: int | None
    place: Place
    unsettled: frozenset[str] = frozenset()
    contradictory: frozenset[str] = frozenset()


PASSED = "passed"
"""Stands for a passed critical point among the names of contacts."""

SIDE = "mirror image"
"""Stands for runs on mirror images of one branch among the names of contacts."""

OTHER_SIDE = 0.05
"""Least distance of two runs' beams behind a bifurcation, of the largest distance from rest, on mirror images."""


@dataclass(frozen=True, slots=True)
class CriticalRow:
    """One critical point; loads in ``unit``.

    Attributes:
        stage: name of the stage; place: number of the critical point in the stage, from 0; unit: SI unit of the loads.
        cprbm, fea: the solvers' critical points; None where a solver has none.
        span: of the stage; allowed: T; largest: W.
        steady: whether all runs of each solver have it by one mechanism, or none has.
        difference, same_theory: |λ_c − λ_f|, |λ_c − λ_b|; NaN where a run lacks it.
        bounds: U and U_b; None where a run lacks it.
        turned: rotation of the state that a run went on to, rad, by name of the run that passed the point.
    """

    stage: str
    place: int
    unit: str
    cprbm: Critical | None
    fea: Critical | None
    span: float
    allowed: float
    largest: float
    steady: bool
    difference: float = math.nan
    same_theory: float = math.nan
    bounds: Bounds | None = None
    turned: Mapping[str, float] = frozendict()

    @property
    def judged(self) -> tuple[Word, Reason | None]:
        """Word and reason of the critical point."""
        if not self.steady:
            return Word.UNDECIDED, Reason.BRANCH
        if self.cprbm is None or self.fea is None or _mechanism(self.cprbm) != _mechanism(self.fea):
            return Word.DIFFER, Reason.EVENTS
        if self.bounds is None:
            return Word.UNDECIDED, Reason.RUN_ENDED
        if self.same_theory > max(self.allowed, self.bounds.same_theory):
            return Word.DIFFER, Reason.EVENTS
        if self.turned:
            return Word.UNDECIDED, Reason.BRANCH
        own = max(self.bounds.own, self.bounds.same_theory)
        if own > self.allowed:
            return Word.UNDECIDED, Reason.COARSE
        if self.bounds.total > max(self.allowed, self.largest):
            return Word.UNDECIDED, Reason.THEORY
        return Word.AGREE, None

    @property
    def word(self) -> Word:
        """Word of the critical point."""
        return self.judged[0]

    @property
    def station(self) -> float:
        """Load of the CPRBM's critical point, or of the finite elements' where the CPRBM has none."""
        found = self.cprbm or self.fea
        return math.nan if found is None else found.value


@dataclass(frozen=True, slots=True)
class ClosingRow:
    """Closing of a contact at loads that the runs do not excuse: |λ_c − λ_b| > max(T, U_b).

    Attributes:
        stage, contact: names; unit: SI unit of the loads; cprbm, fea: the solvers' loads.
        stated: U_b; allowed: T.
    """

    stage: str
    contact: str
    unit: str
    cprbm: float
    fea: float
    stated: float
    allowed: float


def mechanism(critical: Critical) -> str:
    """Mechanism of an instability in words, with the name of the contact or stop that lets go."""
    return f"{critical.what}: {critical.loss.value}" if critical.what else critical.loss.value


def released(critical: Critical) -> float | None:
    """Energy that a jump releases, J; None where the path continues on another branch, or the solver stopped.

    A bifurcation with an energy that falls by less than the round-off of both energies releases none.
    """
    if critical.after is None:
        return None
    fall = critical.energy - critical.after
    return fall if fall > CONTINUES * abs(critical.energy) else None


CONTINUES = 1e-3
"""Least fall of the energy in a jump, a share of the energy: a path that continues on another branch loses none."""


def station_events(table: RunsTable) -> dict[Where, StationEvents]:
    """Events of all runs by every station that both compared runs reach."""
    found: dict[Where, StationEvents] = {}
    for stage in table.scene.stages:
        reached = [where for where in table.reached if where[0] == stage.name]
        tolerance = event_tolerance(table.scene, stage)
        near = [one.value for answer in table.pair for one in answer.critical if one.stage == stage.name]
        passed = {name: passed_by(table.scene, stage, answer) for name, answer in table.answers.items()}
        ends = [one.end.value for answer in table.pair for one in answer.gone_over if one.end.stage == stage.name]
        sequences = _sequences(table, reached)
        earlier = {stage.name for stage in table.scene.stages[: table.scene.stages.index(stage)]}
        before = [sum(one.end.stage in earlier for one in answer.gone_over) for answer in table.pair]
        for where in reached:
            here = table.at(where)
            index = stage.stations.index(where[1])
            counts = {name: passed[name][index] for name in here}
            branches = {station.branch for station in here.values()}
            matched = len({passed[name][-1] for name in here}) == 1
            unsettled, contradictory = _contact_differences(here, sequences)
            beside = any(abs(where[1] - value) <= tolerance for value in ends)
            if beside or (not matched and len(set(counts.values())) > 1):
                alone = beside or _disagree_within_a_solver(counts)
                unsettled, contradictory = (
                    (unsettled | {PASSED}, contradictory) if alone else (unsettled, contradictory | {PASSED})
                )
            met = (
                _met_bifurcation(answer, here[name].branch, count + counts[name])
                for name, answer, count in zip(table.compared, table.pair, before, strict=True)
            )
            if any(met) and _on_mirror_images(table, here):
                unsettled.add(SIDE)
            between = len(branches) > 1 or any(abs(where[1] - value) <= tolerance for value in near)
            between = between or (matched and len(set(counts.values())) > 1)
            found[where] = StationEvents(
                None if len(branches) > 1 else min(branches),
                Place.BETWEEN if between else Place.COMPARED,
                frozenset(unsettled),
                frozenset(contradictory),
            )
    return found


def _met_bifurcation(answer: Answer, branch: int, passed: int) -> bool:
    """Whether one of the first critical points, or of the first passed ones, is a bifurcation."""
    points = (*answer.critical[:branch], *(one.end for one in answer.gone_over[:passed]))
    return any(one.loss is Loss.BIFURCATION for one in points)


def _on_mirror_images(table: RunsTable, here: Mapping[str, StationAnswer]) -> bool:
    """Whether beams of some runs lie far from those of the compared CPRBM run."""
    first = here[table.compared[0]].shapes
    rest = max(_distance(first[name], None, beam) for name, beam in table.scene.beams.items())
    apart = max(
        _distance(first[name], station.shapes[name], beam)
        for station in here.values()
        for name, beam in table.scene.beams.items()
    )
    return apart > OTHER_SIDE * rest


def _distance(one: Shape, other: Shape | None, beam: Beam) -> float:
    """Largest distance, m, of nine places of a beam in two shapes, or from rest."""
    s = np.linspace(0.0, one.s[-1], 9)
    mine = np.stack([np.interp(s, one.s, one.x), np.interp(s, one.s, one.y)], axis=1)
    if other is None:
        theirs = points(beam.curve, s)
    else:
        theirs = np.stack([np.interp(s, other.s, other.x), np.interp(s, other.s, other.y)], axis=1)
    return float(np.max(np.hypot(*(mine - theirs).T)))


def passed_by(scene: Scene, stage: Stage, answer: Answer) -> tuple[int, ...]:
    """Numbers of critical points that an answer has passed in a stage by each of the stage's stations."""
    found, before = [], begins_at(scene, stage)
    for value in stage.stations:
        least, most = sorted((before, value))
        found.append(sum(one.end.stage == stage.name and least < one.end.value <= most for one in answer.gone_over))
        before = value
    return tuple(accumulate(found))


def _sequences(table: RunsTable, reached: Sequence[Where]) -> Mapping[str, Mapping[str, tuple[bool, ...]]]:
    """By contact and run the sequence of open and closed over a stage, repetitions left out."""
    by_run = {
        name: [active_contacts(stations[where]) for where in reached if where in stations]
        for name, stations in table.stations.items()
    }
    return {
        contact: {
            name: tuple(key for key, _ in groupby(contact in each for each in active))
            for name, active in by_run.items()
        }
        for contact in table.scene.contacts
    }


def _contact_differences(
    here: Mapping[str, StationAnswer], sequences: Mapping[str, Mapping[str, tuple[bool, ...]]]
) -> tuple[set[str], set[str]]:
    """Contacts with different states in some runs: unsettled ones, and ones in which the solvers contradict."""
    unsettled, contradictory = set[str](), set[str]()
    active = {name: active_contacts(station) for name, station in here.items()}
    for contact, by_run in sequences.items():
        states = {name: contact in each for name, each in active.items()}
        if len(set(states.values())) == 1:
            continue
        same_sequence = len({by_run[name] for name in states}) == 1
        settled = not same_sequence and not _disagree_within_a_solver(states)
        (contradictory if settled else unsettled).add(contact)
    return unsettled, contradictory


def _disagree_within_a_solver(states: Mapping[str, object]) -> bool:
    """Whether runs of one solver have different states."""
    return any(
        len({state for name, state in states.items() if solver_of(name) == solver}) > 1 for solver in ("cprbm", "fea")
    )


def critical_rows(table: RunsTable) -> tuple[CriticalRow, ...]:
    """All critical points of the two compared runs, in the order of stages."""
    found = []
    for stage in table.scene.stages:
        own = {
            name: tuple(one for one in answer.critical if one.stage == stage.name)
            for name, answer in {**table.following, **dict(zip(table.compared, table.pair, strict=True))}.items()
        }
        for place in range(max(len(own[name]) for name in table.compared)):
            here = {name: each[place] if len(each) > place else None for name, each in own.items()}
            row = _critical_row(table, stage, place, here)
            if row.word is not Word.AGREE and row.same_theory != row.same_theory:
                row = next(_with_passed_points(table, stage, row, here), row)
            found.append(row)
    return tuple(found)


def _with_passed_points(
    table: RunsTable, stage: Stage, row: CriticalRow, here: Mapping[str, Critical | None]
) -> Iterator[CriticalRow]:
    """The row in which passed critical points stand in for missing ones, if the solvers then do not differ."""
    for known in (row.cprbm, row.fea):
        if known is None:
            continue
        points, turned = dict(here), {}
        for name in here:
            alike = [
                one
                for one in table.answers[name].gone_over
                if (one.end.stage, _mechanism(one.end)) == (known.stage, _mechanism(known))
            ]
            own = here[name]
            if alike and (own is None or _mechanism(own) != _mechanism(known)):
                nearest = min(alike, key=lambda one: abs(one.end.value - known.value))
                points[name], turned[name] = nearest.end, nearest.turned
        if turned:
            found = replace(_critical_row(table, stage, row.place, points), turned=frozendict(turned))
            if found.steady and found.word is not Word.DIFFER:
                yield found


def _critical_row(table: RunsTable, stage: Stage, place: int, here: Mapping[str, Critical | None]) -> CriticalRow:
    first, second = table.compared
    span = span_of(table.scene, stage)
    mechanisms = {name: None if one is None else _mechanism(one) for name, one in here.items()}
    row = CriticalRow(
        stage=stage.name,
        place=place,
        unit=load_unit(table.scene, stage),
        cprbm=here[first],
        fea=here[second],
        span=span,
        allowed=event_tolerance(table.scene, stage),
        largest=table.scene.verdict_limit * span,
        steady=not _disagree_within_a_solver(mechanisms),
    )
    present = {name: one for name, one in here.items() if one is not None}
    if len(present) < len(here):
        return row
    located = sum(
        max(one.uncertainty for name, one in present.items() if solver_of(name) == solver)
        for solver in ("cprbm", "fea")
    )
    difference, same_theory, bounds = _on_load_axis(table, {name: one.value for name, one in present.items()}, located)
    return replace(row, difference=difference, same_theory=same_theory, bounds=bounds)


def closing_rows(table: RunsTable) -> tuple[ClosingRow, ...]:
    """Closings of contacts at loads that differ by more than the runs excuse."""
    loads: dict[tuple[str, str, int], dict[str, float]] = {}
    for name, answer in table.following.items():
        count: dict[tuple[str, str], int] = {}
        for event in answer.events:
            if event.kind == "closes":
                key = event.stage, event.contact
                count[key] = count.get(key, -1) + 1
                loads.setdefault((*key, count[key]), {})[name] = event.value
    stages = {stage.name: stage for stage in table.scene.stages}
    found = []
    for (stage, contact, _), here in loads.items():
        if len(here) < len(table.following) or not set(table.compared) <= set(here):
            continue
        _, same_theory, bounds = _on_load_axis(table, here, 0.0)
        allowed = event_tolerance(table.scene, stages[stage])
        if bounds is not None and same_theory > max(allowed, bounds.same_theory):
            cprbm, fea = (here[name] for name in table.compared)
            unit = load_unit(table.scene, stages[stage])
            found.append(ClosingRow(stage, contact, unit, cprbm, fea, bounds.same_theory, allowed))
    return tuple(found)


def _on_load_axis(table: RunsTable, loads: Mapping[str, float], round_off: float) -> tuple[float, float, Bounds | None]:
    """|λ_c − λ_f|, |λ_c − λ_b| and the stated uncertainties of an event's loads."""
    first, second = table.compared
    values = {name: np.array([load]) for name, load in loads.items()}
    bounds = bounds_of(table.runs, values, lambda difference: float(np.abs(difference).max()), round_off)
    return (
        abs(loads[first] - loads[second]),
        abs(loads[first] - loads.get("fea bending", loads[second])),
        bounds,
    )


def _mechanism(critical: Critical) -> tuple[str, str]:
    return critical.loss.name, critical.what
