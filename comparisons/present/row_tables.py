"""Tables of judged rows: errors by quantity, values, stated uncertainties, and true errors."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from comparisons.case import Comparison
from comparisons.display_units import at_station, display_units
from comparisons.formats import number, percent, vector
from comparisons.geometry import bentness
from comparisons.present.columns import Column, Table, table_of
from comparisons.quantities import norm
from comparisons.verdict.calibration import EXACT_FACTOR, ErrorRatio, error_ratios, tally, true_errors
from comparisons.verdict.rows import ROUND_OFF, Row
from comparisons.verdict.runs import SOLVERS
from comparisons.verdict.station_events import Place
from comparisons.verdict.words import Reason, Word
from cprbm_scene import Scene
from cprbm_scene.statement import STRESSES, Quantity

Judged: TypeAlias = tuple[Row, Word | None, Reason | None]
"""Row, word and reason."""

Units: TypeAlias = Mapping[str, tuple[float, str]]
"""Size and name of displayed units by SI unit."""

GROUPS: tuple[tuple[str, frozenset[Quantity]], ...] = (
    ("Errors in displacement", frozenset({"displacement", "rotation", "angle", "centre", "ends"})),
    ("Errors in stress", STRESSES),
    ("Errors in force and reaction", frozenset({"force", "moment", "reaction", "reaction_moment", "closing_load"})),
    ("Error in energy", frozenset({"potential_energy"})),
)
"""Tables of errors by quantity, in the manner of the paper."""

_VALUES = {"cprbm": "CPRBM", "fea": "FEA", "exact": "exact"}


def judged_rows(compared: Comparison) -> tuple[Judged, ...]:
    """All rows with words and reasons."""
    return tuple(zip(compared.rows, compared.verdict.words, compared.verdict.reasons, strict=True))


def shown_stations(compared: Comparison) -> tuple[tuple[Judged, ...], ...]:
    """Rows of the shown stations and of the last station, in order."""
    by_station: dict[tuple[str, float], list[Judged]] = {}
    for judged in judged_rows(compared):
        by_station.setdefault(judged[0].where, []).append(judged)
    shown = {(stage.name, value) for stage in compared.scene.stages for value in stage.shown}
    return tuple(tuple(rows) for where, rows in by_station.items() if where in shown or where == [*by_station][-1])


def row_units(scene: Scene, rows: Iterable[Row]) -> Units:
    """Displayed units of the values of rows, by SI unit; round-off counts as zero."""
    sizes = ((row, norm(row.probe.quantity, value)) for row in rows for value in (row.cprbm, row.fea))
    return display_units(scene, ((row.unit, 0.0 if size < ROUND_OFF * row.scale else size) for row, size in sizes))


def share(row: Row, value: float | None, digits: int = 3) -> str | None:
    """A size in the row's unit as a share of the row's denominator; round-off is 0; None without a size."""
    if value is None or math.isnan(value):
        return None
    return percent(row.fraction(0.0 if abs(value) < ROUND_OFF * row.scale else value), digits)


def judgement(judged: Judged) -> str:
    """Word and reason of a row, or the cause why the row takes no part."""
    row, word, reason = judged
    if word is None:
        return "takes no part" if row.place is Place.COMPARED else row.place.value
    return word.value if reason is None else f"{word.value} ({reason.value})"


def _share_column(header: str, size: object, digits: int = 3) -> Column[Judged]:
    """Column of a size of rows: the name of an attribute of the row, or of the bounds after ``bounds.``."""
    owner, _, name = str(size).rpartition(".")

    def value(judged: Judged) -> str | None:
        record = judged[0].bounds if owner else judged[0]
        return None if record is None else share(judged[0], getattr(record, name), digits)

    return Column(header, value)


def _value_columns(units: Units, headers: Mapping[str, str]) -> list[Column[Judged]]:
    """Probe, unit, and values of a row by the name of the row's attribute, with their headers."""

    def value(name: str, header: str) -> Column[Judged]:
        def text(at: Judged) -> str | None:
            row, values = at[0], getattr(at[0], name)
            return None if values is None else vector(values, units[row.unit][0], ROUND_OFF * row.scale)

        return Column(header, text)

    return [
        Column("probe", lambda at: at[0].probe.name),
        Column("unit", lambda at: units[at[0].unit][1]),
        *(value(name, header) for name, header in headers.items()),
    ]


def value_table(compared: Comparison, rows: Sequence[Judged]) -> Table:
    """Values of one station."""
    units = row_units(compared.scene, [row for row, *_ in rows])
    title = at_station(compared.scene, *rows[0][0].where)
    columns = [*_value_columns(units, _VALUES), _share_column("error", "difference"), Column("word", judgement)]
    return table_of(f"Values at {title}", columns, rows)


def error_tables(compared: Comparison, last: Sequence[Judged]) -> tuple[Table, ...]:
    """Tables of the last station by quantity, with the largest error over all stations."""
    if not last:
        return ()
    where = at_station(compared.scene, *last[0][0].where)
    runs, tables = compared.runs, list[Table]()
    units = row_units(compared.scene, [row for row, *_ in last])
    worst = _largest_errors(compared)
    absence = f" No exact values: {runs.exact_absence}" if runs.exact_absence else ""
    notes = (
        f"CPRBM beside the finite elements, both in the theory {runs.theory}. Errors are fractions of the FEA's value, "
        f"or of the probe's largest value where the value may vanish. Exact values are those in bending.{absence}",
        "Largest magnitudes along the beam. The error is the largest difference anywhere a thickness or more from held "
        "ends and from ends of contacts. A beam of initial radius R has a true stress at its inner edge that is larger "
        "by about t/(3R).",
    )
    for title, quantities in GROUPS:
        rows = [judged for judged in last if judged[0].probe.quantity in quantities]
        columns = [
            *_value_columns(units, _VALUES),
            _share_column("error", "difference"),
            Column("error of max", lambda at: share(at[0], at[0].largest_difference)),
            Column("t/(3R)", lambda at: _edge_factor(compared.scene, at[0])),
            Column("largest error", lambda at: share(*worst[at[0].probe.name]) if at[0].probe.name in worst else None),
            Column("at", lambda at: _where(compared.scene, worst.get(at[0].probe.name))),
            Column("word", judgement),
        ]
        note = notes[1] if quantities is STRESSES else "" if tables else notes[0]
        if rows:
            tables.append(table_of(f"{title} at {where}", columns, rows, note))
    return tuple(tables)


def _largest_errors(compared: Comparison) -> dict[str, tuple[Row, float]]:
    """Row with the largest fraction of its difference, by probe, over all rows with a word."""
    found: dict[str, tuple[Row, float]] = {}
    for row, word, _ in judged_rows(compared):
        size = None if word is None else row.fraction(row.difference)
        known = found.get(row.probe.name)
        if size is not None and (known is None or size > (known[0].fraction(known[1]) or 0.0)):
            found[row.probe.name] = row, row.difference
    return found


def _where(scene: Scene, found: tuple[Row, float] | None) -> str | None:
    return None if found is None else at_station(scene, *found[0].where)


def _edge_factor(scene: Scene, row: Row) -> str | None:
    return percent(bentness(scene.beams[row.probe.of]) / 3.0) if row.probe.quantity in STRESSES else None


def verdict_table(rows: Sequence[Judged]) -> Table:
    """Differences of one station beside the stated uncertainties."""
    columns = [
        Column[Judged]("probe", lambda at: at[0].probe.name),
        _share_column("difference", "difference"),
        _share_column("stated", "bounds.total"),
        _share_column("u CPRBM", "bounds.cprbm"),
        _share_column("u FEA", "bounds.fea"),
        _share_column("round-off", "bounds.round_off"),
        _share_column("theory", "theory"),
        Column("word", judgement),
    ]
    note = (
        "The difference must stay within the stated uncertainty, which follows from further discretisations of each "
        "solver. Theory: the step of the CPRBM to the other theory. Fractions as in the tables of errors."
    )
    return table_of("Differences and stated uncertainties", columns, rows, note)


def theory_table(compared: Comparison, rows: Sequence[Judged]) -> Table:
    """Values of one station in both theories; without rows where the CPRBM has no value in the other theory."""
    runs = compared.runs
    units = row_units(compared.scene, [row for row, *_ in rows])
    chain = (("other", runs.other_theory), ("cprbm", runs.theory))
    headers = {name: f"CPRBM in {theory}" for name, theory in chain} | {"fea": f"FEA in {runs.theory}"}
    columns = [*_value_columns(units, headers), _share_column("theory", "theory")]
    note = "Theory: distance of the CPRBM's values in both theories, in the formulation auto."
    return table_of("Both theories", columns, [at for at in rows if at[0].other is not None], note)


def exact_table(compared: Comparison, rows: Sequence[Judged]) -> Table:
    """True errors of one station beside the stated uncertainties, and counts over all stations."""
    found = {row.probe.name: tuple(true_errors(row)) for row, *_ in rows}
    items = [(name, errors) for name, errors in found.items() if errors]

    def columns(place: int, solver: str) -> list[Column[tuple[str, tuple[ErrorRatio, ...]]]]:
        return [
            Column(f"error {solver}", lambda at: share(at[1][place].row, at[1][place].true)),
            Column(f"stated {solver}", lambda at: share(at[1][place].row, at[1][place].stated)),
            Column(f"ratio {solver}", lambda at: at[1][place].ratio, number),
            Column(f"position {solver}", lambda at: at[1][place].word),
        ]

    ratios, counts = error_ratios(compared.rows), []
    for solver, name in zip(SOLVERS, ("CPRBM", "FEA"), strict=True):
        mine = tally(ratios, solver)
        over = "" if mine.over is None else f", median of stated over true {number(mine.over)}"
        counts.append(f"{name} within the stated error in {mine.within} of {mine.rows} rows{over}")
    return table_of(
        "True errors in bending, beside the exact answer",
        [Column("probe", lambda at: at[0]), *columns(0, "CPRBM"), *columns(1, "FEA")],
        items,
        f"Over all stations: {'; '.join(counts)}. A ratio is the true error over the stated error with round-off. A "
        f"ratio above 1 is beyond the statement; above {EXACT_FACTOR:g} the row differs.",
    )
