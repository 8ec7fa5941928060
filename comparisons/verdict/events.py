"""Events of all runs: critical points and closings on the load axis, and the states of the runs by a station.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
λ_c     load of an event in the CPRBM, λ_f in the finite elements, λ_o in the CPRBM in the other theory
U       stated uncertainty of λ_c − λ_f (:mod:`comparisons.verdict.runs`)
θ       step of theory |λ_o − λ_c|; infinite where the CPRBM has no such critical point in the other theory
T       tolerance of an event on the load axis (:func:`comparisons.stations.event_tolerance`)
W       ``verdict_limit`` of the scene times the span of the stage
======  ==========================================================================================

*Critical points.*  A critical point is undecided if a solver lacks it, since the run ended early before the load.  It
differs if a solver lacks it otherwise, if the mechanisms differ, or if |λ_c − λ_f| > max(T, U).  It is undecided if
runs of one solver disagree, or U > T, or, in ``bending``, θ > max(T, W).  It agrees otherwise.

A fold of one solver and a bifurcation of the other at |λ_c − λ_f| ≤ U are undecided: the loads agree, and the kind of
the critical point is open.  An answer states no mode that could tell whether both are one point.  So are two contacts
that let go at one load, as on both sides of a symmetric mechanism.  So is a fold of one solver alone that releases less
than 0.1 % of the energy: a step of the other solver may pass such a fold.

The first critical point of a stage is compared with the first of the other runs, the second with the second.  In a
stage without ``beyond`` a run may pass a critical point and go on along another branch.  A passed critical point stands
in for a missing critical point, and the row is undecided.

*States.*  The state of a run at a station has these parts: the number of its branch, the number of passed critical
points, and each contact, active or not.  Answers are compared where all runs have the same state.  A part may differ:

* If each run goes through the same sequence of states in the stage, the station lies between the runs' loads of one
  event.  A contact is then *unsettled*.
* If runs of one solver disagree, the part is *unsettled* as well.
* In all other cases the part is *contradictory*.

A station within T of a critical point also lies between events: beside a fold the difference grows with the square root
of the distance.  Runs on mirror images behind a bifurcation are unsettled.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np

from comparisons.quantities import deflection, load_unit, stage_of
from comparisons.stations import Where, begins_at, ends_at_critical, event_tolerance, span_of
from comparisons.verdict.runs import SOLVERS, Bounds, Runs, solver_of
from comparisons.verdict.words import Reason, Word, first_met
from cprbm_scene import Answer, Critical, Loss, Scene, Shape, Stage, StationAnswer, frozendict

BRANCH = "branch"
PASSED = "passed critical points"
MIRRORED = "mirror images"
"""Parts of a state beside the names of contacts, which hold no blank; ``BRANCH`` is never in a set of such names."""

MIRROR_DISTANCE = 0.05
"""Least distance of beams on mirror images, a share of their largest distance from rest."""

UNSTABLE = {Loss.FOLD, Loss.BIFURCATION}
"""Kinds of critical points at which the smallest curvature reaches zero, and nothing lets go."""

State = Mapping[str, int]
"""Parts of a run's state at a station, a contact's 1 where the contact is active."""

CONTINUES = 1e-3
"""Least fall of the energy in a jump, a share of the energy: a path that continues on another branch loses none."""


Closing = tuple[Stage, str, tuple[float, float], Bounds]
"""Closing of a contact at loads farther apart than max(T, U): stage, contact, the solvers' loads, and U."""


@dataclass(frozen=True, slots=True)
class CriticalRow:
    """One critical point; loads in ``unit``.

    Attributes:
        stage: name of the stage; place: number of the critical point in the stage, from 0; unit: SI unit of the loads.
        cprbm, fea: the solvers' critical points; None where a solver has none.
        span: of the stage; allowed: T; largest: max(T, W) in ``bending``, otherwise infinite.
        mechanisms: mechanism by name of the run; None of a run without the critical point.
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
    mechanisms: Mapping[str, str | None]
    ended_before: bool = False
    difference: float = math.nan
    theory: float = math.nan
    bounds: Bounds | None = None
    turned: Mapping[str, float] = frozendict()

    @property
    def judged(self) -> tuple[Word, Reason | None]:
        """Word and reason of the critical point."""
        total = math.nan if self.bounds is None else self.bounds.total
        pair = [one and mechanism(one) for one in (self.cprbm, self.fea)]
        rules: tuple[tuple[bool, tuple[Word, Reason | None]], ...] = (
            (disagree_within_a_solver(self.mechanisms), (Word.UNDECIDED, Reason.BRANCH)),
            (self.ended_before, (Word.UNDECIDED, Reason.RUN_ENDED)),
            (self.kind_open or self.is_faint, (Word.UNDECIDED, Reason.BRANCH)),
            (None in pair or pair[0] != pair[1], (Word.DIFFER, Reason.EVENTS)),
            (self.bounds is None, (Word.UNDECIDED, Reason.RUN_ENDED)),
            (self.difference > max(self.allowed, total), (Word.DIFFER, Reason.EVENTS)),
            (bool(self.turned), (Word.UNDECIDED, Reason.BRANCH)),
            (total > self.allowed, (Word.UNDECIDED, Reason.COARSE)),
            (self.theory > self.largest, (Word.UNDECIDED, Reason.THEORY)),
        )
        return first_met(rules, (Word.AGREE, None))

    @property
    def kind_open(self) -> bool:
        """Whether the solvers have a fold and a bifurcation, or two contacts that let go, at loads that agree."""
        kinds = {one and one.loss for one in (self.cprbm, self.fea)}
        return (
            len(set(self.mechanisms.values())) > 1
            and kinds in (UNSTABLE, {Loss.CONTACT})
            and self.bounds is not None
            and self.difference <= self.bounds.total
        )

    @property
    def is_faint(self) -> bool:
        """Whether one solver alone has the point, a fold that releases no energy: a step of the other may pass it."""
        alone = [one for one in (self.cprbm, self.fea) if one is not None]
        return [one.loss for one in alone] == [Loss.FOLD] and alone[0].after is not None and released(alone[0]) is None

    @property
    def word(self) -> Word:
        """Word of the critical point."""
        return self.judged[0]

    @property
    def station(self) -> float:
        """Load of the CPRBM's critical point, or of the finite elements' where the CPRBM has none."""
        found = self.cprbm or self.fea
        return math.nan if found is None else found.value


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


def disagree_within_a_solver(states: Mapping[str, object]) -> bool:
    """Whether runs of one solver have different states, by the names of the runs."""
    return any(len({state for name, state in states.items() if solver_of(name) == solver}) > 1 for solver in SOLVERS)


def critical_rows(runs: Runs) -> tuple[CriticalRow, ...]:
    """All critical points of the two compared runs, in the order of stages."""
    found = list[CriticalRow]()
    followed = {**runs.following, "cprbm": runs.answers["cprbm"], "fea": runs.answers["fea"]}
    for stage in runs.scene.stages:
        own = {
            name: tuple(one for one in answer.critical if one.stage == stage.name) for name, answer in followed.items()
        }
        for place in range(max(len(own[name]) for name in SOLVERS)):
            here = {name: each[place] if len(each) > place else None for name, each in own.items()}
            row = _critical_row(runs, stage, place, here)
            found.append(row if row.word is Word.AGREE else _with_passed_points(runs, stage, row, here))
    return tuple(found)


def _with_passed_points(runs: Runs, stage: Stage, row: CriticalRow, here: Mapping[str, Critical | None]) -> CriticalRow:
    """The row with passed critical points in place of missing critical points, unless the solvers then differ."""
    for known in filter(None, (row.cprbm, row.fea)):
        points, turned = dict(here), {}
        for name, own in here.items():
            alike = [
                one
                for one in runs.same_theory[name].gone_over
                if one.end.stage == stage.name and mechanism(one.end) == mechanism(known)
            ]
            if alike and (own is None or mechanism(own) != mechanism(known)):
                nearest = min(alike, key=lambda one: abs(one.end.value - known.value))
                points[name], turned[name] = nearest.end, nearest.turned
        found = replace(_critical_row(runs, stage, row.place, points), turned=frozendict(turned))
        if turned and not disagree_within_a_solver(found.mechanisms) and found.word is not Word.DIFFER:
            return found
    return row


def _critical_row(runs: Runs, stage: Stage, place: int, here: Mapping[str, Critical | None]) -> CriticalRow:
    span, allowed = span_of(runs.scene, stage), event_tolerance(runs.scene, stage)
    row = CriticalRow(
        stage=stage.name,
        place=place,
        unit=load_unit(runs.scene, stage.name),
        cprbm=here["cprbm"],
        fea=here["fea"],
        span=span,
        allowed=allowed,
        largest=max(allowed, runs.scene.verdict_limit * span) if runs.theory == "bending" else math.inf,
        mechanisms={name: None if one is None else mechanism(one) for name, one in here.items()},
        ended_before=_ended_before(runs, here["cprbm"], here["fea"]),
    )
    present = {name: one for name, one in here.items() if one is not None}
    if len(present) < len(here):
        return row
    located = sum(
        max(one.uncertainty for name, one in present.items() if solver_of(name) == solver) for solver in SOLVERS
    )
    return replace(
        row,
        difference=abs(present["cprbm"].value - present["fea"].value),
        theory=_step_of_theory(runs, row),
        bounds=_on_load_axis(runs, {name: one.value for name, one in present.items()}, located),
    )


def _step_of_theory(runs: Runs, row: CriticalRow) -> float:
    """θ; NaN without a CPRBM's critical point, and where the run in the other theory ends early."""
    other, own = runs.other, row.cprbm
    if other is None or own is None or not (other.completed or ends_at_critical(other)):
        return math.nan
    mine = [one for one in other.critical if one.stage == row.stage][row.place :]
    return abs(mine[0].value - own.value) if mine and mechanism(mine[0]) == mechanism(own) else math.inf


def _ended_before(runs: Runs, cprbm: Critical | None, fea: Critical | None) -> bool:
    """Whether the compared run without the critical point ended early, and has no station behind the point."""
    known = cprbm or fea
    if known is None or None not in (cprbm, fea):
        return False
    without, answer = ("fea", runs.pair[0]) if fea is None else ("cprbm", runs.pair[1])
    if without in runs.following or known not in answer.critical:
        return False
    before = sum(station.branch <= answer.critical.index(known) for station in answer.stations)
    return len(runs.stations[without]) <= before


def far_closings(runs: Runs) -> Iterator[Closing]:
    """Closings of contacts at loads that differ by more than the runs excuse."""
    loads: dict[tuple[str, str, int], dict[str, float]] = {}
    for name, answer in runs.following.items():
        count = Counter[tuple[str, str]]()
        for event in (event for event in answer.events if event.kind == "closes"):
            key = event.stage, event.contact
            count[key] += 1
            loads.setdefault((*key, count[key]), {})[name] = event.value
    for (name, contact, _), here in loads.items():
        if {*SOLVERS} <= here.keys() == runs.following.keys():
            bounds, pair = _on_load_axis(runs, here, 0.0), (here["cprbm"], here["fea"])
            allowed = event_tolerance(runs.scene, stage := stage_of(runs.scene, name))
            if bounds is not None and abs(pair[0] - pair[1]) > max(allowed, bounds.total):
                yield stage, contact, pair, bounds


def _on_load_axis(runs: Runs, loads: Mapping[str, float], round_off: float) -> Bounds | None:
    """Stated uncertainties of an event's loads."""
    values = {name: np.array([load]) for name, load in loads.items()}
    return runs.bounds(values, lambda difference: float(np.abs(difference).max()), round_off)


@dataclass(frozen=True, slots=True)
class StationEvents:
    """Events of all runs by a station.

    Attributes:
        branch: number of critical points before; None where the runs have met different numbers.
        between: whether the runs have met different critical points, so that no rows are compared here.
        unsettled, contradictory: contacts and other parts of the state, as the module says.
    """

    branch: int | None
    between: bool = False
    unsettled: frozenset[str] = frozenset()
    contradictory: frozenset[str] = frozenset()


NO_EVENTS = StationEvents(0)


def station_events(runs: Runs) -> dict[Where, StationEvents]:
    """Events of all runs by every station that both compared runs reach."""
    found: dict[Where, StationEvents] = {}
    for stage in runs.scene.stages:
        reached = [where for where in runs.reached if where[0] == stage.name]
        states = {
            name: {
                where: _state(runs.scene, stage, answer, index, runs.stations[name][where])
                for index, where in enumerate((stage.name, value) for value in stage.stations)
                if where in reached and where in runs.stations[name]
            }
            for name, answer in runs.same_theory.items()
        }
        found |= {where: _events(runs, stage, where, states) for where in reached}
    return found


def passed_by(scene: Scene, stage: Stage, answer: Answer, station: int) -> int:
    """Number of passed critical points in a stage by the station with the number ``station``."""
    values = (begins_at(scene, stage), *stage.stations[: station + 1])
    mine = [one.end.value for one in answer.gone_over if one.end.stage == stage.name]
    steps = [sorted(pair) for pair in pairwise(values)]
    return sum(least < value <= most for value in mine for least, most in steps)


def _state(scene: Scene, stage: Stage, answer: Answer, index: int, station: StationAnswer) -> State:
    """State of a run at the station with the number ``index``."""
    active = {name for name, contact in station.contacts.items() if contact.active}
    passed = passed_by(scene, stage, answer, index)
    return {BRANCH: station.branch, PASSED: passed, **{name: int(name in active) for name in scene.contacts}}


def _events(runs: Runs, stage: Stage, where: Where, states: Mapping[str, Mapping[Where, State]]) -> StationEvents:
    """Events by one station, with the states of the runs at all stations of the stage."""
    here = {name: mine[where] for name, mine in states.items() if where in mine}
    between, unsettled, contradictory = set[str](), set[str](), set[str]()
    for part in here[SOLVERS[0]]:
        values = {name: state[part] for name, state in here.items()}
        if len(set(values.values())) == 1:
            continue
        paths = ([state[part] for state in states[name].values()] for name in here)
        sequences = {tuple(value for value, _ in groupby(path)) for path in paths}
        if part == BRANCH or (part == PASSED and len(sequences) == 1):
            between.add(part)
        elif len(sequences) == 1 or disagree_within_a_solver(values):
            unsettled.add(part)
        else:
            contradictory.add(part)
    tolerance = event_tolerance(runs.scene, stage)

    def is_near(points: Iterable[Critical]) -> bool:
        return any(one.stage == stage.name and abs(where[1] - one.value) <= tolerance for one in points)

    if is_near(one.end for answer in runs.pair for one in answer.gone_over):
        unsettled.add(PASSED)
    if _on_mirror_images(runs, runs.at(where)):
        unsettled.add(MIRRORED)
    return StationEvents(
        branch=None if BRANCH in between else here[SOLVERS[0]][BRANCH],
        between=bool(between) or is_near(one for answer in runs.pair for one in answer.critical),
        unsettled=frozenset(unsettled),
        contradictory=frozenset(contradictory - unsettled),
    )


def _on_mirror_images(runs: Runs, here: Mapping[str, StationAnswer]) -> bool:
    """Whether a compared run has met a bifurcation, and beams of some runs lie far from the compared CPRBM's."""
    points_met = (
        one
        for answer, name in zip(runs.pair, SOLVERS, strict=True)
        for one in (*answer.critical[: here[name].branch], *(each.end for each in answer.gone_over))
    )
    if not any(one.loss is Loss.BIFURCATION for one in points_met):
        return False
    first = here[SOLVERS[0]].shapes
    beams = runs.scene.beams
    bent = max(deflection(beam, first[name]) for name, beam in beams.items())
    apart = max(_distance(first[name], station.shapes[name]) for station in here.values() for name in beams)
    return apart > MIRROR_DISTANCE * bent


def _distance(one: Shape, other: Shape) -> float:
    """Largest distance of nine places of a beam in two shapes, m."""
    first, second = (
        np.stack([np.interp(np.linspace(0.0, shape.s[-1], 9), shape.s, along) for along in (shape.x, shape.y)])
        for shape in (one, other)
    )
    return float(np.max(np.hypot(*(first - second))))
