"""The page of a report, a convergence, or a study, and the folder: a single template with more or fewer chapters.

In the folder: ``index.html``, complete without a network; per case ``comparison.json`` (as documented for ``compare
--json``), ``answers.json.gz`` (all answers, compressed), ``contact-forces.csv`` (of both compared answers), the JSON
files of further sections, and all figures as SVG and PNG.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from errno import EPERM
from functools import cache
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote

from comparisons.answer_file import packed
from comparisons.case import Comparison
from comparisons.formats import percent
from comparisons.present import json_document, offset
from comparisons.present.case_tables import case_sections, claims_table
from comparisons.present.columns import Figure, Plain, Section, Table
from comparisons.present.csv_table import contact_csv
from comparisons.present.figures import comparison_figures
from comparisons.present.offset import Compared, OffsetComparison
from comparisons.present.stepper import HEADERS, SHADES, stations_json, stepper
from comparisons.present.table import STYLES, html_cells
from comparisons.writing import text_of, write
from cprbm_scene import Question

_CONTACT_FORCES = "contact-forces.csv"


@dataclass(frozen=True, slots=True)
class Chapter:
    """Part of the page for a question.

    Attributes:
        name, title, source: of the question.
        sections: the content in order.
        word, sentence: of the verdict; empty without a verdict.
        glance: cells of the first table behind name and word.
        claims: rows of the table of claims.
        stepper: the mechanism station by station; None without a common station.
        scene: text of the question's file; files: files beside the page, in the chapter's folder.
    """

    name: str
    title: str
    source: str
    sections: tuple[Section, ...]
    word: str = ""
    sentence: str = ""
    glance: tuple[str, ...] = ()
    claims: tuple[tuple[str, ...], ...] = ()
    stepper: Plain | None = None
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

    @property
    def firsts(self) -> tuple[Table, ...]:
        """The tables with a row for every verdict, and for every claim of a source; none without rows."""
        glance = Table(
            "Verdicts at a glance",
            headers=("case", "verdict", "largest difference", "of", "claims met", "because"),
            rows=tuple((each.name, each.word, *each.glance) for each in self.chapters if each.word),
            note="Largest difference: over all compared rows, as a share of the probe's scale. The JSON files beside "
            "this page have every number below.",
            linked=True,
        )
        sources = Table(
            "The sources’ figures and ours",
            headers=("case", "claim", "source", "largest here", "at", "stands"),
            rows=tuple((each.name, *row) for each in self.chapters for row in each.claims),
            note="Claims take no part in the verdicts. Each case says what its differences are made of.",
            linked=True,
        )
        return tuple(table for table in (glance, sources) if table.rows)


def report_page(
    chapters: Sequence[Chapter], further: Sequence[Section] = (), machine: Mapping[str, str | int] | None = None
) -> Page:
    """The page of verdicts."""
    return Page(
        "CPRBM beside finite elements",
        "The chained pseudo-rigid-body model and corotational finite elements answer the same questions. Each solver "
        "states its uncertainty; the verdict says whether the answers agree within these uncertainties.",
        chapters,
        further,
        machine or {},
    )


def figures_of(compared: Compared) -> tuple[Figure, ...]:
    """All figures of a case."""
    return offset.offset_figures(compared) if isinstance(compared, OffsetComparison) else comparison_figures(compared)


def document_of(compared: Compared) -> Plain:
    """The documented JSON of a case of ``compare``."""
    return offset.document(compared) if isinstance(compared, OffsetComparison) else json_document.comparison(compared)


def sections_of(compared: Compared, figures: Sequence[Figure] = ()) -> tuple[Section, ...]:
    """All tables of a case with its figures, by sections."""
    return (
        offset.offset_sections(compared, figures)
        if isinstance(compared, OffsetComparison)
        else case_sections(compared, figures)
    )


def case_chapter(compared: Compared, figures: Sequence[Figure], further: Sequence[Section] = ()) -> Chapter:
    """The chapter of a case with figures and further sections."""
    verdict, chapter = compared.verdict, section_chapter(compared.question, further)
    if isinstance(compared, OffsetComparison):
        claims, steps, names = offset.claim_rows(compared), None, ["comparison.json"]
        worst = max(compared.rows, key=lambda row: row.difference)
        largest = percent(worst.difference), f"{worst.spacing}, N = {worst.n}"
    else:
        names = ["comparison.json", "answers.json.gz", _CONTACT_FORCES]
        claims, steps = [(*row[:4], row[-1]) for row in claims_table(compared).rows], stepper(compared)
        shares = [
            (row.difference / row.scale, row.probe.name)
            for row in compared.rows
            if row.bounds is not None and row.scale > 0.0
        ]
        share, probe = max(shares, key=lambda each: each[0], default=(None, "–"))
        largest = percent(share), probe
    met = f"{sum(row[-1] == 'met' for row in claims)} of {len(claims)}" if claims else "–"
    return replace(
        chapter,
        sections=(*map(light, sections_of(compared, figures)), *chapter.sections),
        word=verdict.word.value,
        sentence=verdict.sentence,
        glance=(*largest, met, verdict.because),
        claims=tuple(claims),
        stepper=steps,
        files=(*names, *chapter.files),
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


def html(page: Page) -> str:
    """The page as HTML."""
    return rendered(
        "page.html", {"page": page, "script": _beside("report.js"), "headers": HEADERS, "shades": range(SHADES)}
    )


def rendered(template: str, context: Mapping[str, object]) -> str:
    """HTML of a template and a context; all texts are escaped.

    Raises:
        jinja2.UndefinedError: the context lacks a name of the template.
    """
    return renderer(template)(context, style=_beside("style.css"), marked=STYLES) + "\n"


@cache
def renderer(template: str) -> Callable[..., str]:
    """Function that fills a template in; the template is compiled once."""
    import jinja2

    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, loader=jinja2.PackageLoader("comparisons", "pages")
    )
    environment.filters |= {
        "anchor": lambda name: name.replace(" ", "+"),  # an identifier has no spaces, and a name no plus
        "cells": html_cells,
        # as text a picture is a quarter shorter than in base64; without quotes and ampersands the text cannot leave an
        # attribute: a template may call it safe
        "embedded": lambda svg: (
            "data:image/svg+xml," + quote(svg.decode("utf-8").replace("\n", " "), safe=" !$'()*+,-./:;=?@[]_<>")
        ),
        "stations_json": stations_json,
        # a name may break behind points and underscores; the type of an escaped text marks the escape
        "breaking": lambda name: type(name)(re.sub(r"(?<=\w[._])(?=[^\W\d])", "<wbr>", name)),
        # commands of an escaped text
        "coded": lambda text: type(text)(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(text))),
        "joined": lambda sentence: sentence.replace(" %", "\u00a0%"),  # on the line of the number
    }
    return environment.get_template(template).render


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


def put_case(folder: Path, compared: Compared, further: Sequence[Section] = ()) -> Chapter:
    """The chapter of a case, with numbers, answers, figures and further sections written into a folder of a report.

    Raises:
        OSError: the folder cannot be written to.
    """
    own, figures = own_folder(folder, compared.question.name), figures_of(compared)
    numbers = Section("", figures=figures, name="comparison", data={"cases": [document_of(compared)]})
    for section in (numbers, *further):
        put_section(own, section)
    if isinstance(compared, Comparison):
        write(own / "answers.json.gz", packed(compared.runs.answers))
        write(own / _CONTACT_FORCES, contact_csv(compared.scene, compared.runs.pair))
    return case_chapter(compared, figures, further)


def put_chapter(folder: Path, question: Question, section: Section) -> Chapter:
    """The chapter of a question with a single section, written into the question's folder in the folder of a report.

    Raises:
        OSError: the folder cannot be written to.
    """
    put_section(own_folder(folder, question.name), section)
    return section_chapter(question, [section])


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
