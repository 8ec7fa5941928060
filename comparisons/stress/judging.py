"""One scene judged: both solvers, the ordinary verdict, from coarse to fine until it can be told.

It is the verdict of ``compare`` on the runs on which it rests, at few links and elements first.  Where that cannot be
told, or a run ended early, everything is done once more at twice the size, as often as the effort allows.  The finer
runs of one size are then the coarser ones of the next, and nothing is solved twice.

An answer is *wrong* if it is certified and

* a row of the verdict differs, also of a scene whose other stations were not reached, or an answer that calls itself
  complete is not whole; or
* a value is further from that at four times the links or elements than F times what is stated of it; or
* it is further from the exact answer, where one is known, than F times what is stated of it,

with the F of :mod:`comparisons.calibration`: a stated uncertainty is to hold in 95 % of the rows and not in all.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from comparisons.calibration import FAR, every
from comparisons.choices import Choices
from comparisons.formats import number
from comparisons.measures import Bounds, Row
from comparisons.memory import Remembering
from comparisons.pairing import Runs, Solvers, paired
from comparisons.reach import up_to
from comparisons.scales import norm
from comparisons.stations import station_of
from comparisons.stress.outcomes import Outcome, Way
from comparisons.stress.strata import met, stated
from comparisons.verdict import Comparison, compared
from comparisons.words import Word
from scene import Answer, Scene, SceneError


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is done for one scene.

    Attributes:
        first: the coarsest choices.
        sizes: how many there are, each of twice the links and elements of the one before.
    """

    first: Choices = field(default_factory=lambda: Choices(links=40, elements=20, penetration=1.6e-3))
    sizes: int = 2

    def each(self) -> Iterator[Choices]:
        """The choices, from coarse to fine."""
        choices = self.first
        for _ in range(self.sizes):
            yield choices
            choices = choices.finer()


@dataclass(frozen=True, slots=True)
class _Finding:
    """What one size says: a way, why, and the rows on which it rests."""

    way: Way
    sentence: str
    choices: Choices
    runs: Runs
    rows: tuple[Row, ...] = ()
    ending: str = ""


def judged(scene: Scene, solvers: Solvers, effort: Effort) -> Outcome:
    """How a scene ends."""
    begun = time.process_time()
    # those who know the exact answer are asked once, when the size is found
    memory = Remembering(solvers=replace(solvers, exact=None))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            finding = _found(scene, solvers, effort, memory)
        except SceneError as error:
            outcome = Outcome(scene.name, Way.REFUSED, "; ".join(map(str, error.mistakes)))
        else:
            outcome = _told(scene, finding)
    return replace(
        outcome,
        seconds=time.process_time() - begun,
        iterations=sum(_iterations(memory.known.values())),
        stated=tuple(sorted(stated(scene))),
        warnings=tuple(dict.fromkeys(str(each.message) for each in caught)),
    )


def _found(scene: Scene, solvers: Solvers, effort: Effort, memory: Remembering) -> _Finding:
    """What the first size says that says something, or the finest.

    Raises:
        SceneError: a solver refuses the scene.
    """
    coarser: _Finding | None = None
    finding: _Finding | None = None
    for choices in effort.each():
        finding = _at_one_size(scene, choices, memory)
        if coarser is not None and finding.way is not Way.WRONG:
            finding = _beside(coarser, finding)
        if finding.way not in (Way.UNDECIDED, Way.ENDED):
            break
        coarser = finding
    assert finding is not None
    if solvers.exact is None or finding.way not in (Way.AGREE, Way.UNDECIDED):
        return finding
    exact = solvers.exact(scene, finding.choices)
    if not exact.stations:
        return finding
    return _of_comparison(finding.choices, compared(scene, replace(finding.runs, exact=exact)))


def _at_one_size(scene: Scene, choices: Choices, memory: Remembering) -> _Finding:
    """What one size says.

    Raises:
        SceneError: a solver refuses the scene.
    """
    runs = paired(scene, choices, memory.solvers, memory, bare=True)
    finding = _of_comparison(choices, compared(scene, runs))
    if finding.way is not Way.ENDED or finding.rows:
        return finding
    reached = min(len(answer.stations) for _, answer in runs.everything())
    if reached == 0:
        return finding
    part = compared(*up_to(scene, runs, reached))
    if part.verdict.word is Word.DIFFER:
        return replace(finding, way=Way.WRONG, sentence=part.verdict.sentence, rows=part.rows, ending="")
    return replace(finding, rows=part.rows)


def _of_comparison(choices: Choices, comparison: Comparison) -> _Finding:
    """The way in which a verdict is one of the seven."""
    verdict, runs = comparison.verdict, comparison.runs
    early = [(name, answer) for name, answer in runs.everything() if not answer.completed]
    sentence, ending = verdict.sentence, ""
    if verdict.word is Word.DIFFER:
        way = Way.WRONG
    elif early:
        way = Way.ENDED
        ending = early[0][1].ending.name
        sentence = "; ".join(f"{name}: {answer.ending.name}, {answer.sentence}" for name, answer in early)
    elif not verdict.completed:
        way = Way.WRONG
    else:
        way = Way.AGREE if verdict.word is Word.AGREE else Way.UNDECIDED
    return _Finding(way, sentence, choices, runs, comparison.rows, ending)


def _beside(coarser: _Finding, finding: _Finding) -> _Finding:
    """The finding of a size with what it says of half of it: wrong where a value is too far from its refinement."""
    worst, said = 1.0, ""
    for row in coarser.rows:
        for solver, off, allowed in _from_refinement(row, finding.runs):
            if off > worst * allowed:
                worst = off / allowed
                said = (
                    f"{solver}: {row.probe.name} at {row.stage} {row.station:g} is {number(FAR * worst)} times as far "
                    f"from its value at four times the size as is stated of it."
                )
    return finding if not said else replace(finding, way=Way.WRONG, sentence=said, ending="")


def _from_refinement(row: Row, finer: Runs) -> Iterator[tuple[str, float, float]]:
    """By solver the distance of a row's value from the finest of the finer runs, and what it may be.

    Of stresses, whose places next to contacts do not count, and of rows that are not compared nothing is said.
    """
    if row.bounds is None or row.arc_length is not None:
        return
    for solver, mine, answer, own in (
        ("cprbm", row.cprbm, finer.cprbm[1], row.bounds.cprbm),
        ("fea", row.fea, finer.fea[finer.kinematics][1], row.bounds.fea),
    ):
        try:
            station = station_of(answer, row.stage, row.station)
        except KeyError:
            continue
        its = station.values[row.probe.name]
        if mine.shape == its.shape and station.branch == row.branch:
            yield solver, norm(row.probe.quantity, mine - its), FAR * (own + row.bounds.round_off)


def _told(scene: Scene, finding: _Finding) -> Outcome:
    """The outcome that a finding is, without what the whole effort took."""
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
        uncertainty=max((max(bounds.total, bounds.same_theory) / row.scale for row, bounds in rows), default=None),
        beyond=max((each.ratio for row, _ in rows for each in every(row)), default=None),
        links=links,
        elements=elements,
        met=tuple(sorted(met(scene, finding.runs.reference))),
    )


def _pressure(row: Row, bounds: Bounds) -> float:
    """The larger of a row's two differences over what is stated of each."""
    pairs = ((row.difference, bounds.total), (row.same_theory, bounds.same_theory))
    return max(off / allowed if allowed > 0.0 else (float("inf") if off else 0.0) for off, allowed in pairs)


def _iterations(answers: Iterable[Answer]) -> Iterator[int]:
    for answer in answers:
        yield from (station.certificate.iterations for station in answer.stations)
