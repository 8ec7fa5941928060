"""Word and reason of a row, and of all rows of a case.

A row differs if |v_c − v_f| exceeds its stated uncertainty (:mod:`comparisons.verdict.runs`), or if a true error
beside the exact value exceeds twice the stated error.  A row is undecided if the stated uncertainty exceeds the scene's
limit: such an uncertainty would excuse a wrong answer, and θ may be an error of discretisation (COARSE).  All other
rows in ``bending`` are undecided if the step of theory θ exceeds the limit (THEORY): both solvers then agree on a
number that the mechanism's stretch and shear change.  The rest agrees.

A contradiction is no evidence against a solver, and the row is undecided, in four cases:

* A contact presses in some runs only, and closes or opens in all runs of the stage (EVENT): the station lies between
  the runs' loads of one event.
* A clamp or another contact shares the contact's force, and the sums of the shared forces agree (NOT_UNIQUE).
* Runs are on mirror images of one branch, or a run has passed a critical point near by (BRANCH).
* A contact presses in one solver only, and neither its force nor another probe differs notably (EVENT).

Rows with the reason NOT_UNIQUE take no case down.  Rows with the reasons COARSE and EVENT take no case down if the
probe agrees at most of its stations.  A COARSE row takes the case down if its solvers differ by more than the row's
limit.  The sentence of the verdict counts such rows.

*Calibration*: true errors beside the exact answer against stated uncertainties.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
e       true error |v − x| of the CPRBM or of the finite elements, both in ``bending``
u       stated uncertainty of the solver, with round-off and q
q       uncertainty of the exact value (:mod:`comparisons.verdict.rows`)
F       2, the factor beyond which a row differs
======  ==========================================================================================

e ≤ u shall hold in at least 95 % of the rows, and the median of u/e shall be at most 10.  A solver states one u per
probe, stage and branch.  This u covers the largest e of its rows, and u/e counts once, with the largest e.  A row with
e ≤ q tells nothing about u.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparisons.stations import ABSENT_WHILE_OPEN
from comparisons.verdict.events import MIRRORED, PASSED
from comparisons.verdict.rows import ROUND_OFF, Row
from comparisons.verdict.runs import SOLVERS, Runs, Solver
from comparisons.verdict.words import Reason, Word, first_met
from cprbm_scene import Array, PointForces, Scene

Judged = tuple[Word | None, Reason | None]
"""Word and reason; no word where a row takes no part."""

RESOLVABLE = frozenset({Reason.COARSE, Reason.EVENT})
"""Reasons that a finer mesh or another station removes."""


def judge_rows(runs: Runs, rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows with words and reasons; no word where a row takes no part."""
    notable = {row.where for row in rows if row.events.contradictory and _is_notable(runs, row)}
    judged = ((row, *_judge(runs, row, faint=row.where not in notable)) for row in rows)
    return tuple(replace(row, word=word, reason=reason) for row, word, reason in judged)


def _judge(runs: Runs, row: Row, *, faint: bool) -> Judged:
    """Word and reason of a row; ``faint`` tells that a contact in one solver only has no notable effect."""
    scene, bounds = runs.scene, row.bounds
    if row.events.between:
        return None, None
    if row.absent or (row.exact is not None and row.exact.shape != row.fea.shape):
        return _without_value(scene, row)
    if bounds is None:
        return (None, None) if np.isnan(row.difference) else (Word.UNDECIDED, Reason.RUN_ENDED)
    limit, beyond = scene.limit(row.probe) * row.scale, row.difference > bounds.total
    by_theory, unsettled = runs.theory == "bending" and row.theory > limit, bool(row.events.unsettled)
    event = Reason.BRANCH if row.events.unsettled & {PASSED, MIRRORED} else Reason.EVENT
    rules: tuple[tuple[bool, Judged], ...] = (
        (any(each.pressure > 1.0 for each in true_errors(row)), (Word.DIFFER, Reason.EXACT)),
        (beyond and _same_resultant(runs, row), (Word.UNDECIDED, Reason.NOT_UNIQUE)),
        (beyond and unsettled, (Word.UNDECIDED, event)),
        (beyond and not row.events.contradictory, (Word.DIFFER, Reason.VALUES)),
        (beyond and not faint, (Word.DIFFER, Reason.EVENTS)),
        (beyond, (Word.UNDECIDED, Reason.EVENT)),
        (bounds.total <= limit and not by_theory, (Word.AGREE, None)),
        (row.shared is not None, (Word.UNDECIDED, Reason.NOT_UNIQUE)),
        (unsettled, (Word.UNDECIDED, event)),
        (bounds.total > limit, (Word.UNDECIDED, Reason.COARSE)),
    )
    return first_met(rules, (Word.UNDECIDED, Reason.THEORY))


def judge_case(scene: Scene, rows: Sequence[Row]) -> tuple[Word, Reason | None]:
    """Word and reason of all rows together."""
    for word in (Word.DIFFER, Word.UNDECIDED):
        reasons = {row.reason for row in rows if row.word is word}
        for reason in (each for each in Reason if each in reasons):
            if word is Word.DIFFER or _decides(scene, rows, reason):
                return word, reason
    if not any(row.word is Word.AGREE for row in rows):
        return Word.UNDECIDED, next((row.reason for row in rows if row.reason is not None), Reason.RUN_ENDED)
    return Word.AGREE, None


def _without_value(scene: Scene, row: Row) -> Judged:
    """Judgement of a row without a value in some run: an open contact has no place, and its force decides."""
    everywhere = row.cprbm.size == 0 and row.fea.size == 0 and (row.exact is None or row.exact.size == 0)
    asked = any(probe.of == row.probe.of and probe.quantity == "force" for probe in scene.probes)
    decided = row.probe.quantity in ABSENT_WHILE_OPEN and (everywhere or asked)
    return (None, None) if decided else (Word.UNDECIDED, Reason.EVENT)


def _is_notable(runs: Runs, row: Row) -> bool:
    """Whether a contact in one solver only has an effect: by its force, or by another probe's difference."""
    if row.probe.of not in row.events.contradictory or row.probe.quantity != "force":
        return row.bounds is not None and row.difference > row.bounds.total + 10.0 * ROUND_OFF * row.scale
    stations = [runs.stations[name][row.where] for name in SOLVERS]
    forces = [np.hypot(*station.forces.force.T).max(initial=0.0) for station in stations]
    moments = [np.abs(beam.M).max() / beam.s[-1] for station in stations for beam in station.beams.values()]
    return row.difference > runs.scene.limit(row.probe) * float(max(*forces, *moments))


def _same_resultant(runs: Runs, row: Row) -> bool:
    """Whether the row's contact or joint shares its force, and the sums of the shared forces do not contradict."""
    if row.shared is None:
        return False
    beam, others = row.shared
    sums = {
        name: _resultant(station.forces, {row.probe.of, *others}, beam) for name, station in runs.at(row.where).items()
    }
    bounds = runs.bounds(sums, lambda difference: float(np.linalg.norm(difference)))
    v_c, v_f = (sums[name] for name in SOLVERS)
    return bounds is not None and float(np.linalg.norm(v_c - v_f)) <= bounds.total


def _resultant(forces: PointForces, sources: Iterable[str], beam: str) -> Array:
    """Sum of the forces of some ``sources`` on a beam, (2,), N."""
    mine = np.any([forces.chosen(source, beam) for source in sources], axis=0)
    return np.asarray(forces.force[mine].sum(axis=0))


def _decides(scene: Scene, rows: Sequence[Row], reason: Reason) -> bool:
    """Whether undecided rows of a reason make the case undecided."""
    agreeing = Counter(row.probe.name for row in rows if row.word is Word.AGREE)
    if reason is Reason.NOT_UNIQUE:
        return not agreeing
    if reason not in RESOLVABLE:
        return True
    coarse = (row for row in rows if reason is Reason.COARSE and row.reason is reason)
    if any(row.difference > scene.limit(row.probe) * row.scale for row in coarse):
        return True
    unresolved = Counter(row.probe.name for row in rows if row.reason in RESOLVABLE)
    return any(count >= agreeing[name] for name, count in unresolved.items())


SHARE_WITHIN = 0.95
LARGEST_MEDIAN = 10.0
EXACT_FACTOR = 2.0
"""A true error beyond this multiple of the stated uncertainty is no chance of where a mesh stands."""


@dataclass(frozen=True, slots=True)
class ErrorRatio:
    """True error e and stated uncertainty u of one row, in the probe's unit, both positive."""

    solver: Solver
    row: Row
    true: float
    stated: float

    @property
    def ratio(self) -> float:
        """e/u: above 1 the statement is not true."""
        return self.true / self.stated

    @property
    def pressure(self) -> float:
        """e/(F u): above 1 the row differs."""
        return self.ratio / EXACT_FACTOR

    @property
    def word(self) -> str:
        """Position of the true error: ``within``, ``beyond`` or ``far beyond`` the stated uncertainty."""
        return first_met([(self.ratio <= 1.0, "within"), (self.pressure <= 1.0, "beyond")], "far beyond")


@dataclass(frozen=True, slots=True)
class Tally:
    """Error ratios of one solver together.

    Attributes:
        rows: number of rows with an error above q; within: rows with e ≤ u.
        over: median of u/e over the statements; None without rows.
        worst: rows with the largest e/u, largest first.
    """

    solver: Solver
    rows: int
    within: int
    over: float | None
    worst: tuple[ErrorRatio, ...]

    @property
    def share(self) -> float | None:
        """within/rows; None without rows."""
        return self.within / self.rows if self.rows else None

    @property
    def holds(self) -> bool:
        """Whether both conditions hold; true without rows."""
        return self.share is None or self.over is None or (self.share >= SHARE_WITHIN and self.over <= LARGEST_MEDIAN)


def true_errors(row: Row) -> Iterator[ErrorRatio]:
    """Error ratios of a row by solver; none without an exact value."""
    if row.true_errors is None or row.bounds is None:
        return
    bounds, true = row.bounds, row.true_errors
    floor = bounds.round_off + true.allowance
    yield ErrorRatio("cprbm", row, true.cprbm, bounds.cprbm + floor)
    yield ErrorRatio("fea", row, true.fea, bounds.fea + floor)


def error_ratios(rows: Iterable[Row]) -> tuple[ErrorRatio, ...]:
    """Error ratios with a true error above q; of a closing load, repeated at later stations, one ratio per stage."""
    known = [(row, row.true_errors.allowance) for row in rows if row.true_errors is not None]
    firsts = {(row.probe.name, row.stage): row for row, _ in reversed(known)}
    return tuple(
        each
        for row, allowance in known
        if row.probe.quantity != "closing_load" or firsts[row.probe.name, row.stage] is row
        for each in true_errors(row)
        if each.true > allowance
    )


def tally(ratios: Sequence[ErrorRatio], solver: Solver, *, worst: int = 3) -> Tally:
    """The error ratios of one solver together."""
    mine = sorted((each for each in ratios if each.solver == solver), key=lambda each: -each.ratio)
    # the largest e/u of a statement stays
    statements = {(each.row.probe.name, each.row.stage, each.row.branch): 1.0 / each.ratio for each in mine[::-1]}
    return Tally(
        solver=solver,
        rows=len(mine),
        within=sum(each.ratio <= 1.0 for each in mine),
        over=float(np.median(list(statements.values()))) if statements else None,
        worst=tuple(mine[:worst]),
    )
