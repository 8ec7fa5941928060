"""Brief report of a comparison: the verdict, the rows nearest their limits, and the next command."""

import re
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from comparisons.case import Comparison, Verdict
from comparisons.formats import at_station, component_names, components, number, percent
from comparisons.opinions import solid_sentence
from comparisons.present import offset
from comparisons.present.columns import NOTHING, Column, Table, follow, table_of
from comparisons.present.offset import Compared, OffsetComparison
from comparisons.present.row_tables import row_units, share
from comparisons.present.table import brief_lines
from comparisons.sentences import pressure, remedy_sentence, theory_sentence, unreached_sentence
from comparisons.verdict import ROUND_OFF, SEVERITY, Row, Word

LINES, WIDTH = 30, 80
"""Most lines of a brief report, with an empty line below, and most columns."""

ROWS = 12
"""Most rows of the table: of all rows the nearest to their limits."""

NARROWEST = 60
"""Least width, columns: a narrower table would cut numbers."""

_wrap = partial(textwrap.wrap, max_lines=6, placeholder=" … (-v)", break_on_hyphens=False)
_COMMAND = re.compile(r"`(-[^`]* [^`]*|solve [^`]*)`")


def brief(compared: Compared, argument: str, page: Path | None = None, width: int = WIDTH) -> str:
    """Report of at most ``LINES`` lines of ``width`` columns, with terminal colours.

    Args:
        compared: the case.
        argument: name or path of the case with its parameters, as the shell takes them.
        page: written page of the case; None without a report.
        width: of the terminal; ``NARROWEST`` and ``WIDTH`` are the limits.
    """
    verdict, width = compared.verdict, min(max(width, NARROWEST), WIDTH)
    wrapped = partial(_wrap, width=width)
    first = wrapped(headline(compared.question.name, verdict, verdict.because if compared.rows else verdict.sentence))
    last = _next_step(argument, verdict, page)
    if isinstance(compared, OffsetComparison):
        errors = offset.error_table(compared)
        lines = *brief_lines(errors, width=width), *wrapped(f"{errors.title}. {errors.note}")
        return "\n".join((*first, "", *lines, *last))
    rest = [
        unreached_sentence(compared.runs),
        theory_sentence(compared.runs, compared.rows),
        solid_sentence(compared),
        *dict.fromkeys(map(remedy_sentence, compared.runs.pair)),
    ]
    rest = [*_found_sizes(compared), *(rest if compared.rows else ())]
    last = [*(line for sentence in rest for line in wrapped(sentence)), *last]
    rows = last_rows_of_stages(compared)
    tables = (nearest_rows(compared, rows, count) for count in range(min(ROWS, len(rows)), 0, -1))
    reports = ([*first, "", *brief_lines(table, width=width), *filter(None, (table.note,)), *last] for table in tables)
    return "\n".join(next((report for report in reports if len(report) < LINES), [*first, *last]))


def headline(name: str, verdict: Verdict, sentence: str) -> str:
    """Name of a case, word, reason and ``sentence``."""
    reason = "" if verdict.reason is None else f" ({verdict.reason.value})"
    return f"{name}: {verdict.word.value}{reason}. {sentence}".rstrip()


def last_rows_of_stages(compared: Comparison) -> tuple[Row, ...]:
    """Rows of the last station of every stage."""
    last = {row.stage: row.station for row in compared.rows}
    return tuple(row for row in compared.rows if row.station == last[row.stage])


def nearest_rows(compared: Comparison, rows: Sequence[Row], count: int) -> Table:
    """Table of the rows nearest their limits, in the order of stages and probes; the note counts the other rows.

    A row has a line for every component.  The first line has difference, stated uncertainty and word.
    """
    # the worst word first, and for one word the largest share of the stated uncertainty
    nearness = [((*SEVERITY, None).index(row.word), 0.0 if row.word is None else -pressure(row)) for row in rows]
    order, body, stage = sorted(range(len(rows)), key=nearness.__getitem__), list[tuple[str, ...]](), ""
    units = row_units(compared.scene, [rows[place] for place in order[:count]])
    for row in (rows[place] for place in sorted(order[:count])):
        if row.stage != stage:
            stage = row.stage
            body.append((at_station(compared.scene, *row.where), *[""] * 6))
        body += _lines(row, *units[row.unit])
    farther = (row.bounds and row.largest_difference > row.bounds.total for row in (rows[at] for at in order[:count]))
    others = Counter(row.word.value if row.word else "without a word" for row in (rows[at] for at in order[count:]))
    more = ", ".join(f"{times} more {'row' if times == 1 else 'rows'} {word}" for word, times in others.items())
    return Table(
        "",
        ("probe", "unit", "CPRBM", "FEA", "difference", "stated", "word"),
        tuple(body),
        "\n".join(
            [f"{more} (-v)"] * bool(more)
            + ["Stresses are maxima; differences leave out held ends and ends of contacts."] * any(farther)
        ),
    )


def summary(finished: Sequence[Compared]) -> Table:
    """Table with a row for every case."""
    return table_of(
        "Summary",
        columns=[
            Column[Compared]("case", "question.name"),
            Column("word", "verdict.word.value"),
            Column("reason", lambda compared: follow(compared, "verdict.reason.value") or ""),
            Column("rows agreeing", _agreeing),
            Column(
                "largest difference over stated",
                lambda compared: max(compared.pressures, default=None),
                lambda value: number(value, 2),
            ),
            Column("seconds", lambda compared: sum(compared.seconds.values()), lambda value: number(value, 2)),
        ],
        items=finished,
        note="Seconds: of all runs, by the solvers' own clocks.",
    )


def _agreeing(compared: Compared) -> str:
    words = [row.word for row in compared.rows if row.word is not None]
    return f"{words.count(Word.AGREE)} of {len(words)}"


def _lines(row: Row, factor: float, unit: str) -> list[tuple[str, ...]]:
    """Lines of a row; the value of a stress is the largest magnitude along the beam."""
    measured = (
        share(row, row.difference, digits=2),
        share(row, row.bounds.total, digits=2) if row.bounds else None,
        row.word and row.word.value,
    )
    found = [
        dict(components(row.probe.quantity, values, factor, ROUND_OFF * row.scale)) for values in (row.cprbm, row.fea)
    ]
    return [
        (
            f"{row.probe.name} {name}".removesuffix("max").rstrip(),
            unit,
            *(values.get(name, "open") for values in found),
            *(("", "", "") if place else (text or NOTHING for text in measured)),
        )
        for place, name in enumerate(component_names(row.probe.quantity) if any(found) else ("",))
    ]


def _found_sizes(compared: Comparison) -> Iterator[str]:
    """Links and elements that ``--tol`` has found, and the solvers without a sufficient size."""
    found = compared.tolerances
    if found:
        yield f"N for {percent(found[0].asked)}: {', '.join(f'{each.solver} {each.n}' for each in found)}."
    yield from (each.sentence(compared.scene) for each in found if not each.met)


def _next_step(argument: str, verdict: Verdict, page: Path | None) -> list[str]:
    """The next command in a line, where the first sentence has a command or the case agrees without a report."""
    hint = _COMMAND.search(verdict.because)
    if hint is not None:
        command, options = ("compare", hint[1]) if hint[1].startswith("-") else hint[1].split(" ", 1)
        return [f"next: cprbm {command} {argument} {options}"]
    return [f"next: cprbm compare {argument} --out DIR"] if verdict.word is Word.AGREE and page is None else []
