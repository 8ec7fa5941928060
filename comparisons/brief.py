"""Brief report of a comparison: the verdict, the rows nearest their limits, and the next command."""

from __future__ import annotations

import re
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from comparisons import offset_pages
from comparisons.case import Comparison, Verdict
from comparisons.display_units import at_station
from comparisons.formats import component_names, components, number, percent
from comparisons.offset_verdict import OffsetComparison
from comparisons.sentences import pressure
from comparisons.sheet import Sheet
from comparisons.sheets import row_units, share
from comparisons.tables import fitted
from comparisons.verdict.rows import ROUND_OFF, Row
from comparisons.verdict.words import SEVERITY, Word

LINES = 30
"""Most lines of a brief report, with an empty line below."""

ROWS = 12
"""Most rows of the table of a brief report: of all rows the nearest to their limits."""

WIDTH = 80
"""Columns of the screen that a brief report takes."""

_SENTENCE_LINES = 6
_COMMAND = re.compile(r"`(-[^`]* [^`]*|solve [^`]*)`")
_NEAREST = (*SEVERITY, None)

Judged: TypeAlias = tuple[Row, Word | None]
"""Row and word."""


def brief(compared: Comparison | OffsetComparison, argument: str) -> str:
    """Report of at most ``LINES`` lines of ``WIDTH`` columns, with terminal colours.

    Args:
        compared: the case.
        argument: name or path of the case with its parameters, as the shell takes them.
    """
    name, verdict = name_of(compared), compared.verdict
    first = _wrapped(headline(name, verdict, verdict.because))
    last = _next_step(argument, verdict)
    if isinstance(compared, OffsetComparison):
        errors = offset_pages.errors(compared)
        note = _wrapped(f"{errors.title}. {errors.note}")
        return "\n".join((*first, "", *fitted(errors, width=WIDTH), *note, *last))
    last = (*_found_sizes(compared), *last)
    rows = last_rows_of_stages(compared)
    table: list[str] = []
    for count in range(min(ROWS, len(rows)), 0, -1):
        sheet = nearest_rows(compared, rows, count)
        table = ["", *fitted(sheet, width=WIDTH), *filter(None, (sheet.note,))]
        if len(first) + len(table) + len(last) < LINES:
            break
    return "\n".join((*first, *table, *last))


def headline(name: str, verdict: Verdict, sentence: str) -> str:
    """Name of a case, word, reason and ``sentence``."""
    reason = "" if verdict.reason is None else f" ({verdict.reason.value})"
    return f"{name}: {verdict.word.value}{reason}. {sentence}".rstrip()


def name_of(compared: Comparison | OffsetComparison) -> str:
    """Name of a case."""
    return compared.question.name if isinstance(compared, OffsetComparison) else compared.scene.name


def last_rows_of_stages(compared: Comparison) -> tuple[Judged, ...]:
    """Rows of the last station of every stage, with their words."""
    last = {row.stage: row.station for row in compared.rows}
    pairs = zip(compared.rows, compared.verdict.words, strict=True)
    return tuple((row, word) for row, word in pairs if row.station == last[row.stage])


def nearest_rows(compared: Comparison, rows: Sequence[Judged], count: int) -> Sheet:
    """Table of the rows nearest their limits, in the order of stages and probes; the note counts the other rows."""
    order = sorted(range(len(rows)), key=lambda place: _nearness(*rows[place]))
    units = row_units(compared.scene, [rows[place][0] for place in order[:count]])
    body: list[tuple[str, ...]] = []
    stage = ""
    for row, word in (rows[place] for place in sorted(order[:count])):
        if row.stage != stage:
            stage = row.stage
            body.append((at_station(compared.scene, row.stage, row.station), *[""] * 6))
        body += _lines(row, word, units[row.unit])
    others = Counter(word.value if word else "without a word" for _, word in (rows[place] for place in order[count:]))
    note = ", ".join(f"{times} more {'row' if times == 1 else 'rows'} {word}" for word, times in others.items())
    headers = ("probe", "unit", "CPRBM", "FEA", "difference", "stated", "word")
    return Sheet("", headers, tuple(body), f"{note} (-v)" if note else "")


def summary(finished: Sequence[Comparison | OffsetComparison]) -> Sheet:
    """Table with a row for every case."""
    body = []
    for compared in finished:
        verdict = compared.verdict
        if isinstance(compared, OffsetComparison):
            pressures = [row.pressure for row in compared.rows]
            seconds = sum(compared.seconds.values())
        else:
            pressures = [pressure(row) for row in compared.rows if row.bounds is not None]
            answers = [*dict(compared.runs.everything()).values(), compared.runs.exact]
            seconds = sum(answer.seconds for answer in answers if answer is not None)
        judged = [word for word in verdict.words if word is not None]
        body.append(
            (
                name_of(compared),
                verdict.word.value,
                "" if verdict.reason is None else verdict.reason.value,
                f"{judged.count(Word.AGREE)} of {len(judged)}",
                number(max(pressures, default=None), 2),
                number(seconds, 2),
            )
        )
    return Sheet(
        "Summary",
        ("case", "word", "reason", "rows agreeing", "largest difference over stated", "seconds"),
        tuple(body),
        "Seconds: of all runs, by the solvers' own clocks.",
    )


def _nearness(row: Row, word: Word | None) -> tuple[int, float]:
    """Sorting key: the worst word first, and for one word the largest share of the stated uncertainty."""
    return _NEAREST.index(word), 0.0 if word is None else -pressure(row)


def _lines(row: Row, word: Word | None, shown: tuple[float, str]) -> list[tuple[str, ...]]:
    """A line for every component of a row in the ``shown`` unit; the first has difference, stated uncertainty and word.

    The value of a stress is the largest magnitude along the beam.
    """
    factor, unit = shown
    floor = ROUND_OFF * row.scale
    found = [dict(components(row.probe.quantity, values, factor, floor)) for values in (row.cprbm, row.fea)]
    measured = (
        share(row, row.difference, digits=2),
        share(row, row.bounds.total, digits=2) if row.bounds else "–",
        "–" if word is None else word.value,
    )
    names = component_names(row.probe.quantity) if any(found) else ("",)
    return [
        (
            f"{row.probe.name} {name}".removesuffix("max").rstrip(),
            unit,
            *(values.get(name, "open") for values in found),
            *(measured if place == 0 else ("", "", "")),
        )
        for place, name in enumerate(names)
    ]


def _wrapped(sentence: str) -> list[str]:
    return textwrap.wrap(sentence, WIDTH, max_lines=_SENTENCE_LINES, placeholder=" … (-v)", break_on_hyphens=False)


def _found_sizes(compared: Comparison) -> Iterator[str]:
    """Links and elements that ``--tol`` has found, and the solvers for which no size is sufficient."""
    sizes = ", ".join(f"{found.solver} {found.n}" for found in compared.tolerances)
    if sizes:
        yield f"N for {percent(compared.tolerances[0].asked)}: {sizes}."
    for found in compared.tolerances:
        if not found.met:
            yield from _wrapped(found.sentence(compared.scene))


def _next_step(argument: str, verdict: Verdict) -> tuple[str, ...]:
    """The next command in a line, where the first sentence has a command or the case agrees."""
    hint = _COMMAND.search(verdict.because)
    if hint is not None:
        command, options = ("compare", hint[1]) if hint[1].startswith("-") else hint[1].split(" ", 1)
        return (f"next: cprbm {command} {argument} {options}",)
    return (f"next: cprbm compare {argument} --out DIR",) if verdict.word is Word.AGREE else ()
