"""What the page shows of one question: plain texts, figures and numbers, which can be kept and read again."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from comparisons import offset_pages, sheets
from comparisons.bench import drawn as bench_drawn
from comparisons.bench import tables as bench_tables
from comparisons.bench.running import Benchmark
from comparisons.case import Comparison
from comparisons.converging.report import ConvergenceResult
from comparisons.documents import plain
from comparisons.figures import Picture
from comparisons.formats import percent
from comparisons.offset_verdict import OffsetComparison
from comparisons.reporting.inlined import Inline, inlined
from comparisons.reporting.stepping import Stepper, stepper
from comparisons.sheet import Sheet
from comparisons.sheets import Subject
from comparisons.studies.result import StudyResult
from cprbm_scene import Answer, Question


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a chapter: its heading, what it says in sentences, its figures and tables."""

    heading: str
    sentences: tuple[str, ...]
    figures: tuple[Inline, ...]
    sheets: tuple[Sheet, ...]


@dataclass(frozen=True, slots=True)
class Glance:
    """A line of the page's first table.

    Attributes:
        largest: the largest difference, in per cent of its probe's scale.
        of: that probe.
        met: claims of the source that are met.
        claims: all of them.
        because: what decided the verdict, in a sentence; the chapter says the rest.
    """

    largest: str
    of: str
    met: int
    claims: int
    because: str


@dataclass(frozen=True, slots=True)
class Claimed:
    """A line of the table of all claims, as texts."""

    claim: str
    theirs: str
    ours: str
    at: str
    stands: str


@dataclass(frozen=True, slots=True)
class Chapter:
    """What the page shows of one question.

    Attributes:
        name, title, source: of the question.
        word, sentence: of the verdict.
        completed: whether every run gave a whole answer.
        glance: its line of the first table.
        claims: its lines of the table of claims.
        stepper: the mechanism station by station; None where there is none.
        sections: the rest, in order.
        scene: the text of the question's file.
        files: that stand beside the page, in the chapter's folder.
    """

    name: str
    title: str
    source: str
    word: str
    sentence: str
    completed: bool
    glance: Glance
    claims: tuple[Claimed, ...]
    stepper: Stepper | None
    sections: tuple[Section, ...]
    scene: str
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Found:
    """All that is known of a question.

    Attributes:
        compared: both answers and the verdict.
        pictures: of these.
        convergence: at a family of sizes; None where that is left out, or where a solver refuses it.
        unconverged: a sentence on why it refuses; empty if it does not.
        benchmark: run times; None likewise.
        untimed: likewise.
    """

    compared: Comparison | OffsetComparison
    pictures: tuple[Picture, ...]
    convergence: ConvergenceResult | None = None
    unconverged: str = ""
    benchmark: Benchmark | None = None
    untimed: str = ""


_SHAPES = ("stations",)
_STRESS = ("stress",)
_SOLVED = ("shapes",)
"""Figures by their names: what the stepper shows as well is left to the files beside the page."""


def section_of(study: StudyResult) -> Section:
    """Section of a study."""
    figures = tuple(inlined(picture, study.name) for picture in study.pictures)
    return Section(study.title, study.words, figures, study.sheets)


def chapter(found: Found) -> Chapter:
    """The chapter of a question."""
    compared = found.compared
    if isinstance(compared, OffsetComparison):
        return _of_offset(found, compared)
    tables = sheets.by_subject(compared)
    names = {picture.name: inlined(picture, compared.scene.name) for picture in found.pictures}
    curves = tuple(figure for name, figure in names.items() if name not in (*_SHAPES, *_STRESS, *_SOLVED))
    sections = (
        _section(Subject.VALUES, tables, tuple(names[name] for name in _SHAPES if name in names)),
        _section(Subject.VERDICT, tables),
        Section(Subject.CLAIMS.value, sheets.explanation(compared), (), tables[Subject.CLAIMS]),
        Section("Curves", (), curves, tables[Subject.REACTIONS]),
        _section(Subject.STRESS, tables, tuple(names[name] for name in _STRESS if name in names)),
        Section(Subject.DIFFERENCE.value, (), (), tables[Subject.DIFFERENCE]),
        *_convergence(found),
        *_times(found, tables[Subject.SECONDS]),
        _section(Subject.CERTIFICATES, tables),
        Section("Settings", (), (), (_settings(compared),)),
    )
    claims = tuple(
        Claimed(claim, theirs, ours, at, stands)
        for sheet in tables[Subject.CLAIMS]
        for claim, theirs, ours, at, _, stands in sheet.rows
    )
    return _chapter(found, compared.scene, _glance(compared, claims), claims, stepper(compared), sections)


def _chapter(
    found: Found,
    question: Question,
    glance: Glance,
    claims: tuple[Claimed, ...],
    steps: Stepper | None,
    sections: tuple[Section, ...],
) -> Chapter:
    verdict = found.compared.verdict
    answers = () if isinstance(found.compared, OffsetComparison) else ("answers.json.gz",)
    return Chapter(
        name=question.name,
        title=question.title or question.name,
        source=question.source,
        word=verdict.word.value,
        sentence=verdict.sentence,
        completed=verdict.completed,
        glance=glance,
        claims=claims,
        stepper=steps,
        sections=tuple(each for each in sections if each.sentences or each.figures or each.sheets),
        scene=Path(question.file).read_text("utf-8") if question.file else "",
        files=(
            "comparison.json",
            *answers,
            *(("convergence.json",) if found.convergence is not None else ()),
            *(("bench.json",) if found.benchmark is not None else ()),
        ),
    )


def _of_offset(found: Found, compared: OffsetComparison) -> Chapter:
    question = compared.question
    figures = tuple(inlined(picture, question.name) for picture in found.pictures)
    table = offset_pages.claims(compared)
    claims = tuple(
        Claimed(f"{claim}, spacing {spacing}", theirs, ours, f"N, t = {at}", stands)
        for claim, spacing, theirs, ours, at, _, stands, _ in table.rows
    )
    largest = max(compared.rows, key=lambda row: row.difference)
    seconds = Sheet(
        "Seconds",
        ("answer", "seconds"),
        tuple((name, f"{value:.2g}") for name, value in compared.seconds.items()),
        "From the question to all points, by this machine's clock.",
    )
    sections = (
        Section(Subject.VALUES.value, (), figures, (offset_pages.errors(compared),)),
        Section(Subject.CLAIMS.value, (), (), (table,)),
        *_convergence(found),
        *_times(found, (seconds,)),
    )
    worst = f"{largest.spacing}, N = {largest.n}"
    glance = Glance(percent(largest.difference), worst, _met(claims), len(claims), compared.verdict.because)
    return _chapter(found, question, glance, claims, None, sections)


def _section(subject: Subject, tables: dict[Subject, tuple[Sheet, ...]], figures: tuple[Inline, ...] = ()) -> Section:
    return Section(subject.value, (), figures, tables[subject])


def _convergence(found: Found) -> tuple[Section, ...]:
    result, heading = found.convergence, "Error against N, and the error budget"
    if result is None:
        return (Section(heading, _sentences(found.unconverged), (), ()),)
    figures = tuple(inlined(picture, result.asked.name) for picture in result.pictures)
    return (Section(heading, result.sentences, figures, result.sheets),)


def _times(found: Found, seconds: tuple[Sheet, ...]) -> tuple[Section, ...]:
    """Whatever is another number with every run stands here, and nowhere else."""
    measured = found.benchmark
    if measured is None:
        return (Section(Subject.SECONDS.value, _sentences(found.untimed), (), seconds),)
    figures = tuple(inlined(picture, measured.scene.name) for picture in bench_drawn.pictures(measured))
    return (Section("Run time against error", (), figures, (*bench_tables.sheets(measured), *seconds)),)


def _sentences(text: str) -> tuple[str, ...]:
    return (text,) if text else ()


def _glance(compared: Comparison, claims: tuple[Claimed, ...]) -> Glance:
    rows = [row for row in compared.rows if row.bounds is not None and row.scale > 0.0]
    because = compared.verdict.because
    if not rows:
        return Glance("–", "–", _met(claims), len(claims), because)
    worst = max(rows, key=lambda row: row.difference / row.scale)
    return Glance(percent(worst.difference / worst.scale), worst.probe.name, _met(claims), len(claims), because)


def _met(claims: tuple[Claimed, ...]) -> int:
    return sum(each.stands == "met" for each in claims)


def _settings(compared: Comparison) -> Sheet:
    """What was chosen for each of the answers, setting by setting."""
    runs = compared.runs
    answers: dict[str, Answer] = {"CPRBM": runs.cprbm[0], f"FEA ({runs.kinematics})": runs.reference}
    if runs.exact is not None:
        answers["exact (bending)"] = runs.exact
    keys = dict.fromkeys(key for answer in answers.values() for key in answer.settings)
    body = tuple((key, *(_setting(answer.settings.get(key)) for answer in answers.values())) for key in keys)
    others = ", ".join(name for name, _ in runs.everything())
    return Sheet(
        "Settings of the answers",
        ("setting", *answers),
        body,
        f"Further runs, for uncertainties and theories: {others}.",
    )


def _setting(value: object) -> str:
    found = plain(value)
    if isinstance(found, dict):
        return ", ".join(f"{key} {each}" for key, each in found.items())
    return "–" if found is None else f"{found:g}" if isinstance(found, float) else str(found)
