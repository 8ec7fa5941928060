"""The page of a report, a convergence, or a study, and the folder: a single template with more or fewer chapters.

In the folder: ``index.html``, complete without a network; per case ``comparison.json`` (as documented for ``compare
--json``), ``answers.json.gz`` (all answers, compressed), ``contact-forces.csv`` (of both compared answers), the JSON
files of further sections, and all figures as SVG and PNG.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from errno import EPERM
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote

from comparisons.answer_file import packed
from comparisons.case import Comparison
from comparisons.formats import percent
from comparisons.offset_verdict import OffsetComparison
from comparisons.plain import text_of
from comparisons.present import contact_forces, json_document, offset
from comparisons.present.case_tables import case_sections, claims_table
from comparisons.present.columns import Figure, Section, Table
from comparisons.present.figures import comparison_figures
from comparisons.present.stepper import HEADERS, SHADES, Stepper, stepper
from comparisons.present.table import STYLES, html_cells, word_columns
from comparisons.writing import write
from cprbm_scene import Question

_SHOWN_BY_THE_STEPPER = ("shapes", "stations")
"""Figures that stand in the folder only."""


@dataclass(frozen=True, slots=True)
class Chapter:
    """Part of the page for a question.

    Attributes:
        name, title, source: of the question.
        word, sentence: of the verdict; empty without a verdict.
        largest: largest difference as a share of the probe's scale, and the probe.
        because: the first sentence of the verdict.
        claims: rows of the table of claims.
        stepper: the mechanism station by station; None without a common station.
        sections: the content in order.
        scene: text of the question's file; files: files beside the page, in the chapter's folder.
    """

    name: str
    title: str
    source: str
    sections: tuple[Section, ...]
    word: str = ""
    sentence: str = ""
    because: str = ""
    largest: tuple[str, str] = ("–", "–")
    claims: tuple[tuple[str, ...], ...] = ()
    stepper: Stepper | None = None
    scene: str = ""
    files: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Page:
    """Title and lead of a page, its chapters, further sections, and the machine."""

    title: str
    lead: str
    chapters: Sequence[Chapter] = ()
    further: Sequence[Section] = ()
    machine: Mapping[str, str | int] = field(default_factory=dict)


def report_page(
    chapters: Sequence[Chapter], further: Sequence[Section] = (), machine: Mapping[str, str | int] | None = None
) -> Page:
    """The page of verdicts."""
    lead = (
        "The chained pseudo-rigid-body model and corotational finite elements answer the same questions. Each solver "
        "states its uncertainty; the verdict says whether the answers agree within these uncertainties."
    )
    return Page("CPRBM beside finite elements", lead, chapters, further, machine or {})


def convergence_page(chapters: Sequence[Chapter]) -> Page:
    """The page of errors against N."""
    return Page(
        "Error against N", "Both solvers at a family of sizes: limits, orders and errors of all numbers.", chapters
    )


def figures_of(compared: Comparison | OffsetComparison) -> tuple[Figure, ...]:
    """All figures of a case."""
    if isinstance(compared, OffsetComparison):
        return offset.offset_figures(compared)
    return comparison_figures(compared)


def question_of(compared: Comparison | OffsetComparison) -> Question:
    """The question of a case."""
    return compared.question if isinstance(compared, OffsetComparison) else compared.scene


def case_chapter(
    compared: Comparison | OffsetComparison, figures: Sequence[Figure], further: Sequence[Section] = ()
) -> Chapter:
    """The chapter of a case with figures and further sections."""
    verdict, chapter = compared.verdict, section_chapter(question_of(compared), further)
    if isinstance(compared, OffsetComparison):
        first, *others = offset.offset_sections(compared)
        worst = max(compared.rows, key=lambda row: row.difference)
        claims: list[tuple[str, ...]] = [
            (f"{claim}, spacing {spacing}", source, largest, at, met)
            for claim, spacing, source, largest, at, _, met, *_ in offset.claims_table(compared).rows
        ]
        chapter = replace(
            chapter,
            sections=(replace(first, figures=tuple(figures)), *others, *chapter.sections),
            largest=(percent(worst.difference), f"{worst.spacing}, N = {worst.n}"),
            files=("comparison.json", *chapter.files),
        )
    else:
        table = claims_table(compared)
        claims = [(*row[:4], row[-1]) for row in table.rows]
        chapter = replace(
            chapter,
            sections=(*_with_figures(case_sections(compared), figures), *chapter.sections),
            largest=_largest(compared),
            stepper=stepper(compared),
            files=("comparison.json", "answers.json.gz", f"{contact_forces.NAME}.csv", *chapter.files),
        )
    return replace(
        chapter, word=verdict.word.value, sentence=verdict.sentence, because=verdict.because, claims=tuple(claims)
    )


def section_chapter(question: Question, sections: Sequence[Section]) -> Chapter:
    """The chapter of a question with sections alone."""
    return Chapter(
        name=question.name,
        title=question.title or question.name,
        source=question.source,
        sections=tuple(light(each) for each in sections if not each.empty),
        scene=Path(question.file).read_text("utf-8") if question.file else "",
        files=tuple(f"{each.name}.json" for each in sections if each.name),
    )


def light(section: Section) -> Section:
    """The section for a page: without JSON, and with figures as SVG alone."""
    return replace(section, figures=tuple(replace(each, png=b"") for each in section.figures), data={})


def _with_figures(sections: Sequence[Section], figures: Sequence[Figure]) -> Iterable[Section]:
    """Curves first, and all other figures beside tables; a figure without tables has an own section."""
    shown = [replace(each, png=b"") for each in figures if each.name not in _SHOWN_BY_THE_STEPPER]
    headings = {
        "path": "Curves",
        "reaction": "Reactions of the drives",
        "stress": "Stress along the beams",
        "contact": "Contact zones and forces",
    }
    found: dict[str, list[Figure]] = {"Curves": []}
    for figure in shown:
        found.setdefault(headings[figure.name.partition("-")[0]], []).append(figure)
    names = [each.heading for each in sections]
    alone = [Section(heading, figures=tuple(mine)) for heading, mine in found.items() if mine and heading not in names]
    curves = [each for each in alone if each.heading == "Curves"]
    placed = [replace(each, figures=tuple(found.get(each.heading, ()))) for each in sections]
    return (*curves, *placed[:1], *(each for each in alone if each not in curves), *placed[1:])


def _largest(compared: Comparison) -> tuple[str, str]:
    """The largest difference as a share of the probe's scale, and the probe."""
    rows = [row for row in compared.rows if row.bounds is not None and row.scale > 0.0]
    if not rows:
        return "–", "–"
    worst = max(rows, key=lambda row: row.difference / row.scale)
    return percent(worst.difference / worst.scale), worst.probe.name


def glance_table(chapters: Sequence[Chapter]) -> Table:
    """The first table: a row for every case with a verdict."""
    rows = []
    for each in chapters:
        met = sum(row[-1] == "met" for row in each.claims)
        claims = f"{met} of {len(each.claims)}" if each.claims else "–"
        rows.append((each.name, each.word, *each.largest, claims, each.because))
    headers = ("case", "verdict", "largest difference", "of", "claims met", "because")
    note = (
        "Largest difference: over all compared rows, as a share of the probe's scale. The JSON files beside this page "
        "have every number below."
    )
    return Table(
        "Verdicts at a glance", headers, tuple(rows) if any(each.word for each in chapters) else (), note, linked=True
    )


def all_claims_table(chapters: Sequence[Chapter]) -> Table:
    """Claims of all sources."""
    rows = tuple((each.name, *row) for each in chapters for row in each.claims)
    headers = ("case", "claim", "source", "largest here", "at", "stands")
    note = "Claims take no part in the verdicts. Each case says what its differences are made of."
    return Table("The sources’ figures and ours", headers, rows, note, linked=True)


def html(page: Page) -> str:
    """The page as HTML."""
    firsts = [table for table in (glance_table(page.chapters), all_claims_table(page.chapters)) if table.rows]
    words = [each.word for each in page.chapters if each.word]
    return rendered(
        "page.html",
        {
            "page": page,
            "firsts": firsts,
            "tally": {word: words.count(word) for word in ("AGREE", "UNDECIDED", "DIFFER") if word in words},
            "script": _beside("report.js"),
            "headers": HEADERS,
            "shades": range(SHADES),
        },
    )


def rendered(template: str, context: Mapping[str, object]) -> str:
    """HTML of a template and a context; all texts are escaped.

    Raises:
        jinja2.UndefinedError: the context lacks a name of the template.
    """
    import jinja2

    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, loader=jinja2.PackageLoader("comparisons", "pages")
    )
    environment.filters["cells"] = html_cells
    environment.filters["words"] = word_columns
    environment.filters["embedded"] = _embedded
    # a name may break behind points and underscores; the type of an escaped text marks the escape
    environment.filters["breaking"] = lambda name: type(name)(re.sub(r"(?<=\w[._])(?=[^\W\d])", "<wbr>", name))
    environment.filters["joined"] = lambda sentence: sentence.replace(" %", "\u00a0%")  # on the line of the number
    return (
        environment.get_template(template).render({**context, "style": _beside("style.css"), "marked": STYLES}) + "\n"
    )


def _embedded(svg: bytes) -> str:
    """A picture as an address for a template; as text it is a quarter shorter than in base64."""
    # without quotes and ampersands the text cannot leave an attribute: a template may call it safe
    return "data:image/svg+xml," + quote(svg.decode("utf-8").replace("\n", " "), safe=" !$'()*+,-./:;=?@[]_<>")


def _beside(name: str) -> str:
    return (files("comparisons.pages") / name).read_text("utf-8")


def put_page(folder: Path, page: Page, name: str = "index") -> None:
    """Write a page into a folder.

    Raises:
        OSError: the folder cannot be written to.
    """
    write(folder / f"{name}.html", html(page))


def own_folder(folder: Path, name: str) -> Path:
    """The folder of a case in the folder of a report.

    Raises:
        OSError: a link leads the case's folder out of the report's.
    """
    own = folder / name
    if not own.resolve().is_relative_to(folder.resolve()):
        raise OSError(EPERM, f"this folder is a link to {own.resolve()}, outside the report's folder", str(own))
    return own


def put_case(folder: Path, compared: Comparison | OffsetComparison, figures: Iterable[Figure]) -> None:
    """Write numbers, answers and figures of a case into a folder of a report.

    Raises:
        OSError: the folder cannot be written to.
    """
    own = own_folder(folder, question_of(compared).name)
    write(own / "comparison.json", text_of({"cases": [document_of(compared)]}, None))
    if isinstance(compared, Comparison):
        runs = compared.runs
        answers = {"cprbm paper": runs.paper, "cprbm perturbed": runs.perturbed, "exact": runs.exact}
        answers[f"cprbm {runs.other_theory}"] = runs.other
        found = {**dict(runs.everything()), **{name: each for name, each in answers.items() if each is not None}}
        write(own / "answers.json.gz", packed(found))
        write(
            own / f"{contact_forces.NAME}.csv",
            contact_forces.contact_csv(compared.scene, (runs.cprbm[0], runs.reference)),
        )
    put_section(own, Section("", figures=tuple(figures)))


def put_section(folder: Path, section: Section) -> None:
    """Write the JSON file and the figures of a section into a folder.

    Raises:
        OSError: the folder cannot be written to.
    """
    if section.name:
        write(folder / f"{section.name}.json", text_of(section.data, None))
    for figure in section.figures:
        write(folder / f"{figure.name}.svg", figure.svg)
        write(folder / f"{figure.name}.png", figure.png)


def document_of(compared: Comparison | OffsetComparison) -> dict[str, object]:
    """The documented JSON of a case of ``compare``."""
    if isinstance(compared, OffsetComparison):
        return offset.document(compared)
    return json_document.comparison(compared)
