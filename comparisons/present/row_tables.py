"""Tables of judged rows: columns of values and of shares, by the paths of the sizes in a row."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from comparisons.case import Comparison
from comparisons.formats import at_station, display_units, number, percent, vector, with_unit
from comparisons.geometry import bentness
from comparisons.opinions import contact_model, thirds_of
from comparisons.present.columns import Column, Table, columns_of, table_of
from comparisons.quantities import norm
from comparisons.verdict import (
    EXACT_FACTOR,
    ROUND_OFF,
    SOLVERS,
    Row,
    error_ratios,
    other_theory,
    tally,
    true_errors,
)
from cprbm_scene import STRESSES, Answer, Array, Quantity, Scene

STRESS = "Errors in stress"
GROUPS: Mapping[str, frozenset[Quantity]] = {
    "Errors in displacement": frozenset({"displacement", "rotation", "angle", "centre", "ends"}),
    STRESS: STRESSES,
    "Errors in force and reaction": frozenset({"force", "moment", "reaction", "reaction_moment", "closing_load"}),
    "Error in energy": frozenset({"potential_energy"}),
}
"""Quantities of the tables of errors by title, in the manner of the paper."""

_OF_STRESSES = (
    "Largest magnitudes along the beam. The error is the largest difference anywhere a thickness or more from held "
    "ends and from ends of contacts. A beam of initial radius R has a true stress at its inner edge that is larger by "
    "about t/(3R)."
)

MANY_TIMES = 10.0
"""Fraction above which a distance prints with its unit."""

_SOLVERS = ("CPRBM", "FEA")
BOTH = {"CPRBM": "cprbm", "FEA": "fea"}
"""Paths of the values of both solvers, by header."""

ERROR = {"error": "difference"}
"""Path of the difference."""

_VALUES = {**BOTH, "exact": "exact"}


def shown_stations(compared: Comparison) -> tuple[tuple[Row, ...], ...]:
    """Rows of the shown stations and of the last station, in order."""
    rows = compared.rows
    shown = {(stage.name, value) for stage in compared.scene.stages for value in stage.shown}
    shown |= {row.where for row in rows[-1:]}
    places = dict.fromkeys(row.where for row in rows if row.where in shown)
    return tuple(tuple(row for row in rows if row.where == where) for where in places)


def row_units(scene: Scene, rows: Iterable[Row]) -> Mapping[str, tuple[float, str]]:
    """Size and name of the displayed units of rows, by SI unit; round-off counts as zero."""
    sizes = ((row, norm(row.probe.quantity, value)) for row in rows for value in (row.cprbm, row.fea))
    return display_units(scene, ((row.unit, 0.0 if size < ROUND_OFF * row.scale else size) for row, size in sizes))


def share(row: Row, size: float, digits: int = 3) -> str | None:
    """A size in the row's unit as a share of the row's denominator; round-off is 0; None without a size."""
    floored = 0.0 if abs(size) < ROUND_OFF * row.scale else size
    return None if math.isnan(size) else percent(row.fraction(floored), digits)


def judgement(row: Row) -> str:
    """Word and reason of a row, or the cause why the row takes no part."""
    if row.word is None:
        return "between events" if row.events.between else "takes no part"
    return row.word.value if row.reason is None else f"{row.word.value} ({row.reason.value})"


_PROBE = Column[Row]("probe", "probe.name")
_WORD = Column("word", judgement)


def value_columns(scene: Scene, rows: Sequence[Row], paths: Mapping[str, str]) -> list[Column[Row]]:
    """Probe, unit, and columns of values by header and path."""
    units = row_units(scene, rows)

    def text(row: Row, values: Array) -> str:
        return vector(values, units[row.unit][0], ROUND_OFF * row.scale)

    return [_PROBE, Column("unit", lambda row: units[row.unit][1]), *columns_of(text, paths)]


def value_table(compared: Comparison, rows: Sequence[Row]) -> Table:
    """Values of one station."""
    return table_of(
        f"Values at {at_station(compared.scene, *rows[0].where)}",
        columns=[*value_columns(compared.scene, rows, _VALUES), *columns_of(share, ERROR), _WORD],
        items=rows,
    )


def error_tables(compared: Comparison, last: Sequence[Row]) -> tuple[Table, ...]:
    """Tables of the last station by quantity, with the largest error over all stations."""
    scene, runs = compared.scene, compared.runs
    worst = _largest_by_probe((row, row.difference) for row in compared.rows if row.word is not None)
    absence = f" No exact values: {runs.absences['exact']}" if "exact" in runs.absences else ""
    columns = [
        *value_columns(scene, last, _VALUES),
        *columns_of(share, {**ERROR, "error of max": "largest_difference"}),
        Column("t/(3R)", lambda row: percent(bentness(scene.beams[row.probe.of]) / 3.0)
               if row.probe.quantity in STRESSES else None),
        Column("largest error", lambda row: worst.get(row.probe.name), lambda found: share(*found) or ""),
        Column("at", lambda row: worst.get(row.probe.name), lambda found: at_station(scene, *found[0].where)),
        _WORD,
    ]  # fmt: skip
    groups = {title: [row for row in last if row.probe.quantity in quantities] for title, quantities in GROUPS.items()}
    titles = [title for title, rows in groups.items() if rows]
    first = (
        f"CPRBM beside the finite elements, both in the theory {runs.theory}. Errors are fractions of the FEA's value, "
        f"or of the probe's largest value where the value may vanish. Exact values are those in bending.{absence}"
    )
    notes = dict.fromkeys(titles[:1], first) | {STRESS: _OF_STRESSES}
    where = at_station(scene, *last[0].where) if last else ""
    return tuple(table_of(f"{title} at {where}", columns, groups[title], notes.get(title, "")) for title in titles)


def _largest_by_probe(sizes: Iterable[tuple[Row, float]]) -> dict[str, tuple[Row, float]]:
    """Row and size with the largest fraction, by probe; of equal fractions the first."""
    known = [(fraction, row, size) for row, size in sizes if (fraction := row.fraction(size)) is not None]
    descending = sorted(known, key=lambda at: at[0], reverse=True)
    return {row.probe.name: (row, size) for _, row, size in descending[::-1]}


def verdict_table(rows: Sequence[Row]) -> Table:
    """Differences of one station beside the stated uncertainties."""
    paths = {
        "difference": "difference",
        "stated": "bounds.total",
        "u CPRBM": "bounds.cprbm",
        "u FEA": "bounds.fea",
        "round-off": "bounds.round_off",
        "theory": "theory",
    }
    return table_of(
        "Differences and stated uncertainties",
        [_PROBE, *columns_of(share, paths), _WORD],
        rows,
        note=(
            "The difference must stay within the stated uncertainty, which follows from further discretisations of "
            "each solver. Theory: the step of the CPRBM to the other theory. Fractions as in the tables of errors."
        ),
    )


def theory_table(compared: Comparison, rows: Sequence[Row]) -> Table:
    """Values of one station in both theories; without rows where the CPRBM has no value in the other theory."""
    runs = compared.runs
    paths = {
        f"CPRBM in {other_theory(runs.theory)}": "other",
        f"CPRBM in {runs.theory}": "cprbm",
        f"FEA in {runs.theory}": "fea",
    }
    return table_of(
        "Both theories",
        columns=[*value_columns(compared.scene, rows, paths), *columns_of(share, {"theory": "theory"})],
        items=[row for row in rows if row.other is not None],
        note="Theory: distance of the CPRBM's values in both theories, in the formulation auto.",
    )


def exact_table(compared: Comparison, rows: Sequence[Row]) -> Table:
    """True errors of one station beside the stated uncertainties, and counts over all stations."""
    columns, ratios, counts = [Column[Any]("probe", "CPRBM.row.probe.name")], error_ratios(compared.rows), []
    for solver, name in zip(SOLVERS, _SOLVERS, strict=True):
        mine = tally(ratios, solver)
        over = "" if mine.over is None else f", median of stated over true {number(mine.over)}"
        counts.append(f"{name} within the stated error in {mine.within} of {mine.rows} rows{over}")
        sizes = {f"error {name}": f"{name}.true", f"stated {name}": f"{name}.stated"}
        columns += columns_of(lambda found, size: share(found["CPRBM"].row, size), sizes)
        columns += [Column(f"ratio {name}", f"{name}.ratio", number), Column(f"position {name}", f"{name}.word")]
    return table_of(
        "True errors in bending, beside the exact answer",
        columns,
        [errors for row in rows if (errors := dict(zip(_SOLVERS, true_errors(row), strict=False)))],
        f"Over all stations: {'; '.join(counts)}. A ratio is the true error over the stated error with round-off. A "
        f"ratio above 1 is beyond the statement; above {EXACT_FACTOR:g} the row differs.",
    )


def paper_table(compared: Comparison) -> Table:
    """Distances of the CPRBM's values in ``paper`` from the values in ``auto`` at the same N, over all stations."""
    scene, runs = compared.scene, compared.runs
    found = [(row, size) for row in compared.rows if (size := contact_model(runs, row)) is not None]
    last = found[-1][0].where if found else ("", 0.0)
    worst = _largest_by_probe(found)
    at_last = {row.probe.name: (row, size) for row, size in found if row.where == last}

    def text(distance: tuple[Row, float]) -> str:
        row, fraction = distance[0], distance[0].fraction(distance[1]) or 0.0
        return with_unit(scene, distance[1], row.unit, 3) if fraction > MANY_TIMES else percent(fraction)

    columns = [
        Column[str]("probe", str),
        Column("largest distance", worst.get, text),
        Column("at", worst.get, lambda distance: at_station(scene, *distance[0].where)),
        Column(f"at {at_station(scene, *last)}" if found else "", at_last.get, text),
    ]
    paper = runs.answers.get(runs.formulations[0])
    note = (
        "Distances of the CPRBM's values at the same N; they take no part in the verdict. Fractions above tenfold "
        f"stand as distances.{'' if paper is None else _paper_note(scene, paper)}"
    )
    return table_of(
        "The formulation paper beside auto", columns, dict.fromkeys(row.probe.name for row, _ in found), note
    )


def _paper_note(scene: Scene, paper: Answer) -> str:
    """Notes and end of the answer in ``paper``."""
    note = f" In paper: {'; '.join(paper.notes)}." if paper.notes else ""
    asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    if not paper.completed and len(paper.stations) < len(asked):
        before = at_station(scene, *asked[len(paper.stations)])
        note += f" It ended before {before}: {paper.sentence or paper.ending.value}."
    return note


def solid_table(compared: Comparison) -> Table:
    """Rows of the last station beside the solid."""
    thirds = thirds_of(compared)
    last = [row for row in thirds if row.where == thirds[-1].where]
    off = {
        "u solid": "third.uncertainty",
        "CPRBM off": "third.cprbm",
        "FEA off": "third.fea",
        f"CPRBM in {other_theory(compared.runs.theory)} off": "third.other",
    }
    values = {**BOTH, "solid": "third.solid"}
    return table_of(
        "The beam theories beside a solid, at the last station",
        [*value_columns(compared.scene, last, values), *columns_of(share, off)],
        last,
        "The solid's values are extrapolated from its meshes; distances are measured from these values.",
    )
