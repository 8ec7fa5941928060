"""Events on the load axis: critical points and closings of contacts in both solvers.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
λ_c     load of an event in the CPRBM, λ_f in the finite elements, λ_o in the CPRBM in the other theory
U       stated uncertainty of λ_c − λ_f (:mod:`comparisons.verdict.runs`)
θ       step of theory |λ_o − λ_c|; infinite where the CPRBM has no such critical point in the other theory
T       tolerance of an event on the load axis (:func:`comparisons.stations.event_tolerance`)
W       ``verdict_limit`` of the scene times the span of the stage
======  ==========================================================================================

A critical point

* is undecided if a solver lacks it, since the run ended early before the load;
* differs if a solver lacks it otherwise, if the mechanisms differ, or if |λ_c − λ_f| > max(T, U);
* is undecided if runs of one solver disagree, or U > T, or, in ``bending``, θ > max(T, W);
* agrees otherwise.

The first critical point of a stage is compared with the first of the other runs, the second with the second.  In a
stage without ``beyond`` a run may pass a critical point and go on along another branch.  A passed critical point stands
in for a missing critical point, and the row is undecided.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from comparisons.quantities import load_unit
from comparisons.stations import event_tolerance, span_of
from comparisons.verdict import Reason, Word
from comparisons.verdict.completeness import ends_at_critical
from comparisons.verdict.runs import SOLVERS, Bounds, RunsTable, solver_of
from cprbm_scene import Critical, Stage
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class CriticalRow:
    """One critical point; loads in ``unit``.

    Attributes:
        stage: name of the stage; place: number of the critical point in the stage, from 0; unit: SI unit of the loads.
        cprbm, fea: the solvers' critical points; None where a solver has none.
        span: of the stage; allowed: T; largest: max(T, W) in ``bending``, otherwise infinite.
        steady: whether all runs of each solver have it by one mechanism, or none has.
        ended_before: whether a run without the critical point ended early before the load.
        difference: |λ_c − λ_f|; NaN where a run lacks it.
        theory: θ; NaN where it is not known.
        bounds: U; None where a run lacks it.
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
    ended_before: bool = False
    difference: float = math.nan
    theory: float = math.nan
    bounds: Bounds | None = None
    turned: Mapping[str, float] = frozendict()

    @property
    def judged(self) -> tuple[Word, Reason | None]:
        """Word and reason of the critical point."""
        if not self.steady:
            return Word.UNDECIDED, Reason.BRANCH
        if self.ended_before:
            return Word.UNDECIDED, Reason.RUN_ENDED
        if self.cprbm is None or self.fea is None or mechanism(self.cprbm) != mechanism(self.fea):
            return Word.DIFFER, Reason.EVENTS
        if self.bounds is None:
            return Word.UNDECIDED, Reason.RUN_ENDED
        if self.difference > max(self.allowed, self.bounds.total):
            return Word.DIFFER, Reason.EVENTS
        if self.turned:
            return Word.UNDECIDED, Reason.BRANCH
        if self.bounds.total > self.allowed:
            return Word.UNDECIDED, Reason.COARSE
        if self.theory > self.largest:
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
    """Closing of a contact at loads farther apart than max(T, U).

    Attributes:
        stage, contact: names; unit: SI unit of the loads; cprbm, fea: the solvers' loads.
        stated: U; allowed: T.
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


def disagree_within_a_solver(states: Mapping[str, object]) -> bool:
    """Whether runs of one solver have different states, by the names of the runs."""
    return any(
        len({state for name, state in states.items() if solver_of(name) == solver}) > 1 for solver in ("cprbm", "fea")
    )


def critical_rows(table: RunsTable) -> tuple[CriticalRow, ...]:
    """All critical points of the two compared runs, in the order of stages."""
    found = []
    for stage in table.scene.stages:
        own = {
            name: tuple(one for one in answer.critical if one.stage == stage.name)
            for name, answer in {**table.following, "cprbm": table.pair[0], "fea": table.pair[1]}.items()
        }
        for place in range(max(len(own[name]) for name in SOLVERS)):
            here = {name: each[place] if len(each) > place else None for name, each in own.items()}
            row = _critical_row(table, stage, place, here)
            found.append(row if row.word is Word.AGREE else _with_passed_points(table, stage, row, here))
    return tuple(found)


def _with_passed_points(
    table: RunsTable, stage: Stage, row: CriticalRow, here: Mapping[str, Critical | None]
) -> CriticalRow:
    """The row with passed critical points in place of missing critical points, unless the solvers then differ."""
    for known in filter(None, (row.cprbm, row.fea)):
        points, turned = dict(here), {}
        for name, own in here.items():
            alike = [
                one
                for one in table.answers[name].gone_over
                if one.end.stage == stage.name and mechanism(one.end) == mechanism(known)
            ]
            if alike and (own is None or mechanism(own) != mechanism(known)):
                nearest = min(alike, key=lambda one: abs(one.end.value - known.value))
                points[name], turned[name] = nearest.end, nearest.turned
        found = replace(_critical_row(table, stage, row.place, points), turned=frozendict(turned))
        if turned and found.steady and found.word is not Word.DIFFER:
            return found
    return row


def _critical_row(table: RunsTable, stage: Stage, place: int, here: Mapping[str, Critical | None]) -> CriticalRow:
    span, allowed = span_of(table.scene, stage), event_tolerance(table.scene, stage)
    mechanisms = {name: None if one is None else mechanism(one) for name, one in here.items()}
    row = CriticalRow(
        stage=stage.name,
        place=place,
        unit=load_unit(table.scene, stage),
        cprbm=here["cprbm"],
        fea=here["fea"],
        span=span,
        allowed=allowed,
        largest=max(allowed, table.scene.verdict_limit * span) if table.runs.theory == "bending" else math.inf,
        steady=not disagree_within_a_solver(mechanisms),
        ended_before=_ended_before(table, here["cprbm"], here["fea"]),
    )
    present = {name: one for name, one in here.items() if one is not None}
    if len(present) < len(here):
        return row
    located = sum(
        max(one.uncertainty for name, one in present.items() if solver_of(name) == solver)
        for solver in ("cprbm", "fea")
    )
    bounds = _on_load_axis(table, {name: one.value for name, one in present.items()}, located)
    difference = abs(present["cprbm"].value - present["fea"].value)
    return replace(row, difference=difference, theory=_step_of_theory(table, row), bounds=bounds)


def _step_of_theory(table: RunsTable, row: CriticalRow) -> float:
    """θ; NaN without a CPRBM's critical point, and where the run in the other theory ends early."""
    other, own = table.runs.other, row.cprbm
    if other is None or own is None or not (other.completed or ends_at_critical(other)):
        return math.nan
    mine = [one for one in other.critical if one.stage == row.stage][row.place :]
    return abs(mine[0].value - own.value) if mine and mechanism(mine[0]) == mechanism(own) else math.inf


def _ended_before(table: RunsTable, cprbm: Critical | None, fea: Critical | None) -> bool:
    """Whether the compared run without the critical point ended early, and has no station behind the point."""
    known = cprbm or fea
    if known is None or None not in (cprbm, fea):
        return False
    name, answer = ("fea", table.pair[0]) if fea is None else ("cprbm", table.pair[1])
    if name in table.following or known not in answer.critical:
        return False
    before = sum(station.branch <= answer.critical.index(known) for station in answer.stations)
    return len(table.stations[name]) <= before


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
        if len(here) < len(table.following) or not set(SOLVERS) <= set(here):
            continue
        bounds = _on_load_axis(table, here, 0.0)
        allowed = event_tolerance(table.scene, stages[stage])
        cprbm, fea = (here[name] for name in SOLVERS)
        if bounds is not None and abs(cprbm - fea) > max(allowed, bounds.total):
            unit = load_unit(table.scene, stages[stage])
            found.append(ClosingRow(stage, contact, unit, cprbm, fea, bounds.total, allowed))
    return tuple(found)


def _on_load_axis(table: RunsTable, loads: Mapping[str, float], round_off: float) -> Bounds | None:
    """Stated uncertainties of an event's loads."""
    values = {name: np.array([load]) for name, load in loads.items()}
    return table.runs.bounds(values, lambda difference: float(np.abs(difference).max()), round_off)
