"""The verdict on a case: two answers, their rows and events, the audits, and the sentences."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from comparisons import sentences as said
from comparisons.audit import Audit, audit
from comparisons.reactions import WorkEnergyReaction, perturbed_scene, reactions
from comparisons.stations import complete_part, ends_at_critical
from comparisons.tolerances import Tolerance
from comparisons.verdict import SEVERITY, Reason, Word, worst_of
from comparisons.verdict.events import CriticalRow, Place, critical_rows, far_closings, station_events
from comparisons.verdict.judge import Judged, judge_case, judge_rows
from comparisons.verdict.rows import Row, build_rows
from comparisons.verdict.runs import SOLVERS, Runs, RunsTable
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict

Finding = tuple[Word, Reason | None, str]
"""Word, reason and sentence."""

Auditor = Callable[[Scene, Answer], Audit]
"""Function that finds the faults of an answer to a scene."""


@dataclass(frozen=True, slots=True)
class BranchVerdict:
    """Word of the rows of one branch in a stage.

    Attributes:
        stage: name; number: of critical points before; first, last: stations; stations: their number.
        near: stations between events, which take no part.
        word: None without a row that takes part.
    """

    stage: str
    number: int
    first: float
    last: float
    stations: int
    near: int
    word: Word | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a case.

    Attributes:
        word: of the case; reason: None where the case agrees.
        sentences: the sentence on what decides first.
        words, reasons: by row; a word is None where the row takes no part, a reason unless the word has one.
        completed: whether both compared runs reached the last station, or agree on the critical point where they end.
        branches: words by branch.
    """

    word: Word
    sentences: tuple[str, ...]
    words: tuple[Word | None, ...]
    completed: bool
    branches: tuple[BranchVerdict, ...] = ()
    reason: Reason | None = None
    reasons: tuple[Reason | None, ...] = ()

    @property
    def sentence(self) -> str:
        """All sentences."""
        return " ".join(self.sentences)

    @property
    def because(self) -> str:
        """The first sentence: what decides."""
        return next(iter(self.sentences), "")


@dataclass(frozen=True, slots=True)
class Comparison:
    """A scene, all runs, rows, events, the verdict, reactions by two ways, searches for N, and audits by solver."""

    scene: Scene
    runs: Runs
    rows: tuple[Row, ...]
    verdict: Verdict
    criticals: tuple[CriticalRow, ...] = ()
    reactions: tuple[WorkEnergyReaction, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    audits: Mapping[str, Audit] = frozendict()

    @property
    def question(self) -> Scene:
        """The scene."""
        return self.scene

    @property
    def pressures(self) -> list[float]:
        """Differences of the rows over their stated uncertainties."""
        return [said.pressure(row) for row in self.rows if row.bounds is not None]

    @property
    def seconds(self) -> Mapping[str, float]:
        """Seconds of the compared runs, of the run in the other theory and of the exact reference, by name."""
        answers = {**dict(self.runs.everything()), "other": self.runs.other, "exact": self.runs.exact}
        return {name: answer.seconds for name, answer in answers.items() if answer is not None}


def compare(scene: Scene, runs: Runs, look: Auditor = audit) -> Comparison:
    """The comparison of all runs of a scene.

    Args:
        scene: the question.
        runs: the answers.
        look: the audit.
    """
    exact, other = (None if each is None else complete_part(scene, each) for each in (runs.exact, runs.other))
    table = RunsTable(scene, replace(runs, exact=exact, other=other))
    criticals, rows = critical_rows(table), build_rows(table, station_events(table))
    judged = judge_rows(table, rows)
    audits = {
        answer.solver: look(scene, replace(answer, stations=tuple(table.stations[name].values())))
        for name, answer in zip(SOLVERS, table.pair, strict=True)
    }
    lacking = any(name in table.problems for name in SOLVERS)
    completed = not lacking or (
        all(map(ends_at_critical, table.pair)) and bool(criticals) and criticals[-1].word is Word.AGREE
    )
    verdict = _verdict(table, rows, judged, criticals, audits, completed=completed)
    found = () if lacking else _reactions(table)
    return Comparison(scene, runs, rows, verdict, criticals, found, audits=audits)


def _verdict(
    table: RunsTable,
    rows: Sequence[Row],
    judged: Sequence[Judged],
    criticals: Sequence[CriticalRow],
    audits: Mapping[str, Audit],
    *,
    completed: bool,
) -> Verdict:
    """All findings with their sentences; the worst decides, and its sentence comes first."""
    scene, of_rows = table.scene, judge_case(rows, judged)
    crossings = next((found.crossings for found in audits.values() if found.crossings), ())
    findings: list[Finding] = [
        *((Word.DIFFER, Reason.EVENTS, said.closing_sentence(scene, closing)) for closing in far_closings(table)),
        *((*row.judged, said.critical_sentence(table, row)) for row in criticals),
        *(
            (Word.UNDECIDED, Reason.AUDIT, said.audit_sentence(name, found.complaints))
            for name, found in audits.items()
            if found.complaints
        ),
        *((Word.UNDECIDED, Reason.UNDECLARED_CONTACT, sentence) for sentence in crossings),
    ]
    others = [name for name in table.problems if not ends_at_critical(table.answers[name])]
    explained = (
        not others and all(map(ends_at_critical, table.pair)) and bool(criticals)
    )  # by the row of the last point
    if table.problems and not completed and not explained:
        findings.append((Word.UNDECIDED, Reason.RUN_ENDED, said.ended_sentence(table, table.problems)))
    if rows or completed:
        findings.append((*of_rows, said.headline(table, rows, judged, of_rows)))
    reasons_in_order = [None, *Reason]  # DIFFER comes first, then UNDECIDED, and of these the reasons
    findings.sort(key=lambda finding: (SEVERITY.index(finding[0]), reasons_in_order.index(finding[1])))
    word, reason, _ = findings[0]
    sentences = (
        *(sentence for *_, sentence in findings),
        said.ended_sentence(table, others) if completed and others else "",
        *said.passed_sentences(table, rows, judged),
        said.calibration_sentence(scene, rows),
        said.theory_sentence(scene, table.runs, rows),
        said.wider_limits(scene) if word is Word.AGREE else "",
    )
    words = tuple(found for found, _ in judged)
    reasons = tuple(why for _, why in judged)
    shown = tuple(sentence for sentence in sentences if sentence)
    return Verdict(word, shown, words, completed, _branch_verdicts(rows, words), reason, reasons)


def _branch_verdicts(rows: Sequence[Row], words: Sequence[Word | None]) -> tuple[BranchVerdict, ...]:
    """Word of every branch, in the order of the path."""
    found: dict[tuple[str, int], list[tuple[Row, Word | None]]] = {}
    for row, word in zip(rows, words, strict=True):
        if row.branch is not None:
            found.setdefault((row.stage, row.branch), []).append((row, word))
    return tuple(_branch_verdict(*branch, mine) for branch, mine in found.items())


def _branch_verdict(stage: str, number: int, mine: Sequence[tuple[Row, Word | None]]) -> BranchVerdict:
    """Word of the rows of a branch."""
    places = {row.station: row.place for row, _ in mine}
    near, word = sum(place is Place.BETWEEN for place in places.values()), worst_of(word for _, word in mine)
    return BranchVerdict(stage, number, next(iter(places)), next(reversed(places)), len(places), near, word)


def _reactions(table: RunsTable) -> tuple[WorkEnergyReaction, ...]:
    """Reactions of drives by two ways, of two complete answers."""
    asked, perturbed = perturbed_scene(table.scene), table.runs.perturbed
    if asked is None:
        return reactions(table.scene, *table.pair, None)
    return () if perturbed is None else reactions(table.scene, *table.pair, complete_part(asked, perturbed))
