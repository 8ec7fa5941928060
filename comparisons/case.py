"""The verdict on a case: two answers, their rows and events, the audits, and the sentences."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from comparisons import sentences as said
from comparisons.audit import Audit, audit
from comparisons.reactions import WorkEnergyReaction, perturbed_scene, reactions
from comparisons.stations import complete_part, ends_at_critical
from comparisons.tolerances import Tolerance
from comparisons.verdict import (
    SEVERITY,
    SOLVERS,
    CriticalRow,
    Reason,
    Row,
    Runs,
    Word,
    critical_rows,
    far_closings,
    judge_case,
    judge_rows,
    rows_of,
    worst_of,
)
from cprbm_scene import Answer, Scene, frozendict


@dataclass(frozen=True, slots=True)
class BranchVerdict:
    """Word of the rows of a branch in a stage.

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
        completed: whether both compared runs reached the last station, or agree on the critical point where they end.
        branches: words by branch.
    """

    word: Word
    sentences: tuple[str, ...]
    completed: bool
    branches: tuple[BranchVerdict, ...] = ()
    reason: Reason | None = None

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
    """All runs of a scene, rows, events, the verdict, reactions by two ways, searches for N, and audits by solver."""

    runs: Runs
    rows: tuple[Row, ...]
    verdict: Verdict
    criticals: tuple[CriticalRow, ...] = ()
    reactions: tuple[WorkEnergyReaction, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    audits: Mapping[str, Audit] = frozendict()

    @property
    def scene(self) -> Scene:
        """The question."""
        return self.runs.scene

    question = scene

    @property
    def pressures(self) -> list[float]:
        """Differences of the rows over their stated uncertainties."""
        return [said.pressure(row) for row in self.rows if row.bounds is not None]

    @property
    def seconds(self) -> Mapping[str, float]:
        """Seconds of the compared runs, of the run in the other theory and of the exact reference, by name."""
        left_out = ("cprbm paper", "cprbm perturbed")
        return {name: answer.seconds for name, answer in self.runs.answers.items() if name not in left_out}


def compare(runs: Runs, look: Callable[[Scene, Answer], Audit] = audit) -> Comparison:
    """The comparison of all ``runs`` of a scene, with the function ``look`` for the audits of answers."""
    scene, criticals, rows = runs.scene, critical_rows(runs), judge_rows(runs, rows_of(runs))
    audits = {
        answer.solver: look(scene, replace(answer, stations=tuple(runs.stations[name].values())))
        for name, answer in zip(SOLVERS, runs.pair, strict=True)
    }
    lacking = any(name in runs.problems for name in SOLVERS)
    completed = not lacking or (
        all(map(ends_at_critical, runs.pair)) and bool(criticals) and criticals[-1].word is Word.AGREE
    )
    verdict = _verdict(runs, rows, criticals, audits, completed=completed)
    return Comparison(runs, rows, verdict, criticals, reactions=() if lacking else _reactions(runs), audits=audits)


def _verdict(
    runs: Runs,
    rows: Sequence[Row],
    criticals: Sequence[CriticalRow],
    audits: Mapping[str, Audit],
    *,
    completed: bool,
) -> Verdict:
    """All findings with their sentences; the worst decides, and its sentence comes first."""
    scene, of_rows = runs.scene, judge_case(runs.scene, rows)
    crossings = next((found.crossings for found in audits.values() if found.crossings), ())
    findings: list[tuple[Word, Reason | None, str]] = [
        *((Word.DIFFER, Reason.EVENTS, said.closing_sentence(scene, closing)) for closing in far_closings(runs)),
        *((*row.judged, said.critical_sentence(runs, row)) for row in criticals),
        *(
            (Word.UNDECIDED, Reason.AUDIT, said.audit_sentence(name, found.complaints))
            for name, found in audits.items()
            if found.complaints
        ),
        *((Word.UNDECIDED, Reason.UNDECLARED_CONTACT, sentence) for sentence in crossings),
    ]
    others = [name for name in runs.problems if not ends_at_critical(runs.same_theory[name])]
    explained = not others and all(map(ends_at_critical, runs.pair)) and bool(criticals)  # by the row of the last point
    if runs.problems and not completed and not explained:
        findings.append((Word.UNDECIDED, Reason.RUN_ENDED, said.ended_sentence(runs, runs.problems)))
    if rows or completed:
        findings.append((*of_rows, said.headline(runs, rows, of_rows)))
    reasons_in_order = [None, *Reason]  # DIFFER comes first, then UNDECIDED, and of these the reasons
    findings.sort(key=lambda finding: (SEVERITY.index(finding[0]), reasons_in_order.index(finding[1])))
    word, reason, _ = findings[0]
    sentences = (
        *(sentence for *_, sentence in findings),
        said.ended_sentence(runs, others) if completed and others else "",
        said.unreached_sentence(runs) if completed else "",
        *said.passed_sentences(runs, rows),
        said.calibration_sentence(scene, rows),
        said.theory_sentence(runs, rows),
        *dict.fromkeys(map(said.remedy_sentence, runs.pair)),
        said.wider_limits(scene) if word is Word.AGREE else "",
    )
    return Verdict(word, tuple(filter(None, sentences)), completed, tuple(_branch_verdicts(rows)), reason)


def _branch_verdicts(rows: Sequence[Row]) -> Iterator[BranchVerdict]:
    """Word of every branch, in the order of the path."""
    for branch in dict.fromkeys((row.stage, row.branch) for row in rows if row.branch is not None):
        mine = [row for row in rows if (row.stage, row.branch) == branch]
        between = {row.station: row.events.between for row in mine}
        yield BranchVerdict(
            *branch,
            first=mine[0].station,
            last=mine[-1].station,
            stations=len(between),
            near=sum(between.values()),
            word=worst_of(row.word for row in mine),
        )


def _reactions(runs: Runs) -> tuple[WorkEnergyReaction, ...]:
    """Reactions of drives by two ways, of two complete answers."""
    asked, perturbed = perturbed_scene(runs.scene), runs.answers.get("cprbm perturbed")
    if asked is None:
        return reactions(runs.scene, *runs.pair, None)
    return () if perturbed is None else reactions(runs.scene, *runs.pair, complete_part(asked, perturbed))
