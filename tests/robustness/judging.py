"""The outcome of a scene: both solvers and the verdict, from coarse to fine sizes until the verdict decides.

The first size decides most scenes: from 20 to 160 links the time grows by a quarter, and a repetition costs the whole
time again.  Without a decision, or after an early end, the solver with the larger uncertainty runs at twice its size.
The sizes grow as often as the effort allows if smaller errors promise a decision, once for any other reason.  The
finer runs of a size are the coarser runs of the next size: no run is solved twice.  The verdict compares the stations
that both solvers reached, also where the answers end early at every size.

All runs have one theory, the scene's or the theory of the choices; no step of theory leaves a scene undecided.

A certified answer is *wrong* if

* a row of the verdict differs, also in a scene without its other stations, or a complete answer lacks a part; or
* a value is farther from the finest value than F times the stated error; or
* a value is farther from the exact answer, where the exact answer is known, than F times the stated error,

with the F of :mod:`comparisons.verdict.judge`: a stated uncertainty holds in 95 % of the rows, not in all rows.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from comparisons.case import Comparison, compare
from comparisons.choices import Choices
from comparisons.formats import number
from comparisons.pairing import Solvers, paired
from comparisons.quantities import norm
from comparisons.stations import ends_at_critical, problems, station_of
from comparisons.verdict import Word
from comparisons.verdict.judge import EXACT_FACTOR, true_errors
from comparisons.verdict.rows import Row
from comparisons.verdict.runs import Bounds, Runs
from cprbm_scene import Answer, Scene, SceneError
from tests.robustness.auditing import Auditing
from tests.robustness.outcomes import Outcome, Way
from tests.robustness.strata import met, stated

DOMINANT = 2.0
"""Ratio of the stated errors from which the solver with the larger error alone is refined."""

PROMISING = 2.0
"""Allowed excess of the error that the second order predicts for a finer size: many errors fall faster."""


@dataclass(frozen=True, slots=True)
class Effort:
    """Largest effort for a scene.

    Attributes:
        first: the coarsest choices.
        sizes: largest number of sizes; every size has twice the links or elements, or both, of the size before.
    """

    first: Choices = field(default_factory=lambda: Choices(links=80, elements=40))
    sizes: int = 3


@dataclass(frozen=True, slots=True)
class _Finding:
    """Result of a size.

    Attributes:
        way, sentence, choices, runs: outcome and reason at the size, and the runs.
        rows: on which the outcome rests.
        ending: of an answer that ended early.
        reached: number of reached stations.
        early: solvers whose answers ended early.
        doubts: whether an audit doubts an answer.
        over: whether the branch ends in all answers, or was left where the branch ends in other answers.
    """

    way: Way
    sentence: str
    choices: Choices
    runs: Runs | None = None
    rows: tuple[Row, ...] = ()
    ending: str = ""
    reached: int = 0
    early: frozenset[str] = frozenset()
    doubts: bool = False
    over: bool = False


def judged(scene: Scene, solvers: Solvers, effort: Effort) -> Outcome:
    """How a scene ends."""
    begun = time.process_time()
    # the exact answer is computed once, at the size of the decision
    memory = Auditing(solvers=replace(solvers, exact=None))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            finding = _found(scene, solvers, effort, memory)
        except SceneError as error:
            outcome = Outcome(scene.name, Way.REFUSED, "; ".join(map(str, error.mistakes)))
        else:
            outcome = _outcome(scene, finding)
    return replace(
        outcome,
        seconds=time.process_time() - begun,
        iterations=sum(_iterations(memory.known.values())),
        stated=tuple(sorted(stated(scene))),
        warnings=tuple(dict.fromkeys(str(each.message) for each in caught)),
    )


def _found(scene: Scene, solvers: Solvers, effort: Effort, memory: Auditing) -> _Finding:
    """The finding of the first size with a decision, or of the finest size.

    Raises:
        SceneError: a solver refuses the scene.
    """
    finding, left = _at_one_size(scene, effort.first, memory), effort.sizes - 1
    while finding.way in (Way.UNDECIDED, Way.ENDED):
        worth = left > 0 and _worth_while(scene, finding, left, first=left == effort.sizes - 1)
        if not worth:
            break
        finer = _at_one_size(scene, _finer(scene, finding, left), memory)
        finding, left = finer if finer.way is Way.WRONG else _beside(scene, finding, finer), left - 1
    if finding.runs is None:
        return _as_far_as_it_goes(scene, finding, memory)
    in_bending = finding.choices.theory_of(scene) == "bending"  # as the exact answer
    if solvers.exact is None or not in_bending or finding.way not in (Way.AGREE, Way.UNDECIDED):
        return finding
    exact = solvers.exact(scene, finding.choices)
    if not exact.stations:
        return finding
    comparison = compare(replace(finding.runs, answers={**finding.runs.answers, "exact": exact}), memory.audit)
    return _of_comparison(finding.choices, comparison)


def _at_one_size(scene: Scene, choices: Choices, memory: Auditing) -> _Finding:
    """Result of a size; no further run where one of both compared answers ends early.

    Raises:
        SceneError: a solver refuses the scene.
    """
    solvers = memory.solvers
    two = memory.answers([(solvers.cprbm, scene, choices), (solvers.fea, scene, choices)])
    if any(not answer.completed and not ends_at_critical(answer) for answer in two):
        early = [(answer.solver, answer) for answer in two if not answer.completed]
        reached = min(len(answer.stations) for answer in two)
        return _Finding(
            Way.ENDED, _why(early), choices, ending=early[0][1].ending.name, reached=reached, early=_whose(early)
        )
    return _of_comparison(choices, compare(paired(scene, choices, solvers, memory, bare=True), memory.audit))


def _as_far_as_it_goes(scene: Scene, finding: _Finding, memory: Auditing) -> _Finding:
    """The finding of answers that ended early, or a wrong part before the end.

    Raises:
        SceneError: a solver refuses the scene.
    """
    if finding.reached == 0:
        return finding
    runs = paired(scene, finding.choices, memory.solvers, memory, bare=True)
    part = _of_comparison(finding.choices, compare(runs, memory.audit))
    return part if part.way is Way.WRONG else replace(finding, rows=part.rows, runs=part.runs)


def _of_comparison(choices: Choices, comparison: Comparison) -> _Finding:
    """The finding from a comparison."""
    verdict, runs = comparison.verdict, comparison.runs
    early = [(name, answer) for name, answer in runs.same_theory.items() if not answer.completed]
    sentence, ending = verdict.sentence, ""
    untrue = [answer for answer in runs.same_theory.values() if answer.completed and problems(comparison.scene, answer)]
    if verdict.word is Word.DIFFER or untrue:
        way = Way.WRONG
    elif verdict.word is Word.AGREE:
        way = Way.AGREE
    elif early:
        way = Way.ENDED
        ending = early[0][1].ending.name
        sentence = _why(early)
    else:
        way = Way.UNDECIDED
    doubts = any(audit.complaints for audit in comparison.audits.values())
    gone = {name for row in comparison.criticals for name in row.turned}
    over = all(ends_at_critical(answer) or name in gone for name, answer in runs.same_theory.items())
    return _Finding(
        way, sentence, choices, runs, comparison.rows, ending, early=_whose(early), doubts=doubts, over=over
    )


def _finer(scene: Scene, finding: _Finding, left: int) -> Choices:
    """Choices with twice the links or elements of the solver whose runs ended early, or whose errors dominate.

    Errors dominate above ``DOMINANT`` times the other solver's errors in the undecided rows, if the other solver's
    errors leave room in the ``left`` sizes.  Otherwise both solvers have twice the size.
    """
    choices, finer = finding.choices, finding.choices.finer()
    found = [(row.bounds, scene.limit(row.probe) * row.scale) for row in finding.rows if row.bounds is not None]
    vague = [(bounds, allowed) for bounds, allowed in found if bounds.total > allowed > 0.0]
    cprbm, fea = (sum(getattr(bounds, solver) / allowed for bounds, allowed in vague) for solver in ("cprbm", "fea"))

    def room(mine: str) -> bool:
        smaller = 1.0 - 0.25**left
        return all(bounds.total - smaller * getattr(bounds, mine) <= allowed for bounds, allowed in vague)

    if finding.early == {"cprbm"} or (not finding.early and cprbm > DOMINANT * fea and room("cprbm")):
        return replace(choices, links=finer.links)
    if finding.early == {"fea"} or (not finding.early and fea > DOMINANT * cprbm and room("fea")):
        return replace(finer, links=choices.links)
    return finer


def _worth_while(scene: Scene, finding: _Finding, left: int, *, first: bool) -> bool:
    """Whether the ``left`` further sizes may decide the scene; after an early end or a doubt, whether the next may.

    Not where the branch ends in all runs, or was left there: a finer run would say so again.
    """
    if finding.over:
        return False
    found = [(row.bounds, scene.limit(row.probe) * row.scale) for row in finding.rows if row.bounds is not None]
    vague = [(bounds, allowed) for bounds, allowed in found if bounds.total > allowed]
    if finding.way is Way.ENDED or finding.doubts or not vague:
        return first
    smaller = PROMISING * 4.0**left
    return all(bounds.total / smaller <= allowed for bounds, allowed in vague if allowed > 0.0)


def _why(early: Iterable[tuple[str, Answer]]) -> str:
    """Names, endings and sentences of the answers that ended early."""
    return "; ".join(f"{name}: {answer.ending.name}, {answer.sentence}" for name, answer in early)


def _whose(early: Iterable[tuple[str, Answer]]) -> frozenset[str]:
    """The solvers whose answers ended early, by the names of their runs."""
    return frozenset(name.split()[0] for name, _ in early)


def _beside(scene: Scene, coarser: _Finding, finding: _Finding) -> _Finding:
    """The finding of a size, or a wrong value of the coarser size: too far from the refined value."""
    worst, said = 1.0, ""
    if finding.runs is None or coarser.runs is None:
        return finding
    for row in coarser.rows:
        if _depends_on_the_mesh(row):
            continue
        for solver, off, allowed in _from_refinement(row, finding.runs):
            if off > worst * allowed:
                worst = off / allowed
                said = (
                    f"{solver}: {row.probe.name} at {row.stage} {row.station:g} is {number(EXACT_FACTOR * worst)} "
                    f"times as far from its value at a finer size as is stated of it."
                )
    return finding if not said else replace(finding, way=Way.WRONG, sentence=said, ending="")


def _depends_on_the_mesh(row: Row) -> bool:
    """Whether a row is a stress, the force of a contact that shares it, or between the runs' loads of one event."""
    if row.arc_length is not None or row.events.unsettled or row.events.contradictory:
        return True
    return row.shared is not None


def _from_refinement(row: Row, finer: Runs) -> Iterator[tuple[str, float, float]]:
    """Solver, distance of a row's value from the finest value, and allowed distance."""
    if row.bounds is None:
        return
    for solver, mine, answer, own in (
        ("cprbm", row.cprbm, finer.answers["cprbm finer"], row.bounds.cprbm),
        ("fea", row.fea, finer.answers["fea finer"], row.bounds.fea),
    ):
        try:
            station = station_of(answer, row.stage, row.station)
        except KeyError:
            continue
        its = station.values[row.probe.name]
        if mine.shape == its.shape and station.branch == row.branch:
            yield solver, norm(row.probe.quantity, mine - its), EXACT_FACTOR * (own + row.bounds.round_off)


def _outcome(scene: Scene, finding: _Finding) -> Outcome:
    """The outcome of a finding, without seconds and iterations."""
    rows = [(row, row.bounds) for row in finding.rows if row.bounds is not None]
    links, elements = finding.choices.links, finding.choices.elements
    assert isinstance(links, int)
    assert isinstance(elements, int)
    return Outcome(
        scene.name,
        finding.way,
        finding.sentence,
        finding.ending,
        difference=max((_pressure(row, bounds) for row, bounds in rows), default=None),
        uncertainty=max((bounds.total / row.scale for row, bounds in rows), default=None),
        beyond=max((each.ratio for row, _ in rows for each in true_errors(row)), default=None),
        links=links,
        elements=elements,
        met=() if finding.runs is None else tuple(sorted(met(scene, finding.runs.answers["fea"]))),
    )


def _pressure(row: Row, bounds: Bounds) -> float:
    """A row's difference over the stated error."""
    if bounds.total > 0.0:
        return row.difference / bounds.total
    return float("inf") if row.difference else 0.0


def _iterations(answers: Iterable[Answer]) -> Iterator[int]:
    for answer in answers:
        yield from (station.certificate.iterations for station in answer.stations)
