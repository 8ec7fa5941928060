"""Tables of answers: stations, critical points, branches, events, and searches for N."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from comparisons.case import BranchVerdict, Comparison
from comparisons.formats import (
    component_names,
    components,
    display_units,
    distance_text,
    load_column,
    load_text,
    number,
    percent,
    with_unit,
)
from comparisons.present.columns import Column, Table, columns_of, table_of
from comparisons.quantities import load_unit, norm, probe_scales, unit_of
from comparisons.tolerances.result import Tolerance
from comparisons.verdict.events import CriticalRow, Place, mechanism, released
from comparisons.verdict.rows import ROUND_OFF
from cprbm_scene import Answer, Critical, Event, Scene, Stage

CRITICAL_TITLE = "Critical values: where a branch ends"
_BETWEEN = -1
"""Number of a row for stations between events, beside the numbers of branches."""


def answer_tables(scene: Scene, answer: Answer, tolerances: Sequence[Tolerance] = ()) -> tuple[Table, ...]:
    """Search for N, all stations of every stage, critical points and events; tables without rows are left out."""
    events = [
        Column[Event]("stage", "stage"),
        Column("contact", "contact"),
        Column("event", "kind"),
        Column("at", lambda event: load_text(scene, event.stage, event.value)),
    ]
    found = (
        search_table(scene, tolerances),
        *(_stage_table(scene, answer, stage) for stage in scene.stages),
        _answer_critical_table(scene, answer),
        table_of("Events", events, answer.events),
    )
    return tuple(table for table in found if table.rows)


def _stage_table(scene: Scene, answer: Answer, stage: Stage) -> Table:
    """All stations of a stage, with a column for every component."""
    stations = [station for station in answer.stations if station.stage == stage.name]
    probes, scales = scene.probes_in(stage.name), probe_scales(scene, (answer,))
    sizes = ((unit_of(scene, at, stage), norm(at.quantity, each.values[at.name])) for at in probes for each in stations)
    units, columns = display_units(scene, sizes), dict([load_column(scene, stage, [at.value for at in stations])])
    for probe in probes if stations else ():
        factor, unit = units[unit_of(scene, probe, stage)]
        floor = ROUND_OFF * scales[stage.name, probe.name]
        texts = [dict(components(probe.quantity, at.values[probe.name], factor, floor)) for at in stations]
        columns |= {
            f"{f'{probe.name} {name}'.rstrip()}, {unit}": tuple(each.get(name, "open") for each in texts)
            for name in component_names(probe.quantity)
        }
    ended = f"{answer.ending.name}: {answer.sentence or answer.ending.value}"
    note = ended if stations and stations[-1] is answer.stations[-1] else ""
    title = f"{scene.title or scene.name}: {stage.name}, {answer.solver}"
    return Table(title, tuple(columns), tuple(zip(*columns.values(), strict=True)), note)


def search_table(scene: Scene, found: Sequence[Tolerance]) -> Table:
    """N by solver, with the largest uncertainty at that N."""
    columns = [
        Column[Tolerance]("solver", "solver"),
        Column("N", "n"),
        Column("extrapolated from", lambda one: ", ".join(map(str, one.extrapolated)) or None),
        Column("largest u", "worst.fraction", percent),
        Column("of", "worst", lambda row: f"{row.probe} at {load_text(scene, row.stage, row.station)}"),
        Column("met", lambda one: "yes" if one.met else "no"),
        Column("solved", lambda one: ", ".join(map(str, one.solved))),
    ]
    note = "N: links or elements per beam; the finer N of an extrapolated answer."
    return table_of(f"N for a tolerance of {percent(found[0].asked)}" if found else "", columns, found, note)


def critical_table(compared: Comparison) -> Table:
    """Critical points of both answers."""
    scene = compared.scene
    sizes = {"apart": "difference", "u CPRBM": "bounds.cprbm", "u FEA": "bounds.fea", "allowed": "allowed"}
    columns = [
        Column[CriticalRow]("stage", lambda row: row.stage if row.place == 0 else f"{row.stage}, {row.place + 1}"),
        *columns_of(
            lambda row, found: f"{with_unit(scene, found.value, row.unit, 5)}, {mechanism(found)}",
            {"CPRBM": "cprbm", "FEA": "fea"},
        ),
        *columns_of(lambda row, size: distance_text(scene, size, row.unit), sizes | {"theory": "theory"}),
        *columns_of(
            lambda _, found: _release(scene, found), {"releases CPRBM": "cprbm", "releases FEA": "fea"}
        ),
        Column("word", "word.value"),
    ]  # fmt: skip
    return table_of(
        CRITICAL_TITLE,
        columns,
        compared.criticals,
        "Values of the stepped load or drive, and the mechanism of the instability; uncertainties from further "
        "discretisations of each solver. Theory: distance of the CPRBM's loads in both theories. Released: the "
        "decrease of the potential energy in the jump.",
    )


def branch_table(compared: Comparison) -> Table:
    """Words by branch; without rows where no branch ends."""
    scene, branches = compared.scene, compared.verdict.branches
    stations = dict.fromkeys((row.stage, row.branch is None, row.station) for row in compared.rows)
    between = [
        BranchVerdict(stage, _BETWEEN, loads[0], loads[-1], len(loads), 0, None)
        for (stage, apart), found in groupby(stations, key=lambda at: at[:2])
        if apart and (loads := [load for *_, load in found])
    ]

    def span(at: BranchVerdict) -> str:
        return " to ".join(load_text(scene, at.stage, value) for value in dict.fromkeys((at.first, at.last)))

    columns = [
        Column[BranchVerdict](
            "branch",
            lambda at: f"{at.stage}, {Place.BETWEEN.value if at.number == _BETWEEN else f'branch {at.number}'}",
        ),
        Column("stations", span),
        Column("compared", lambda at: at.stations - at.near),
        Column("between events", lambda at: None if at.number == _BETWEEN else at.near),
        Column("word", lambda at: "takes no part" if at.word is None else at.word.value),
    ]
    return table_of(
        "Branch by branch",
        columns,
        [*(branches if compared.criticals or len(branches) > 1 else ()), *between],
        "A branch is compared with the same branch. Stations between the runs' loads of an event take no part.",
    )


def _answer_critical_table(scene: Scene, answer: Answer) -> Table:
    """Critical points of an answer, passed points first."""
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    passed = {id(one.end): f", passed: turned by {number(one.turned, 3)} rad" for one in answer.gone_over}
    columns = [
        Column[Critical]("stage", "stage"),
        Column("at", lambda one: with_unit(scene, one.value, units[one.stage], 5)),
        Column("±", lambda one: distance_text(scene, one.uncertainty, units[one.stage])),
        Column("mechanism", lambda one: f"{mechanism(one)}{passed.get(id(one), '')}"),
        Column("smallest curvature", "curvature", number),
        Column("left", "left", number),
        Column("releases", lambda one: _release(scene, one)),
    ]
    return table_of(
        CRITICAL_TITLE,
        columns,
        (*(one.end for one in answer.gone_over), *answer.critical),
        "The smallest curvature of the energy on the feasible directions at the end of the branch, and the curvature "
        "that is left after a contact or stop lets go. ±: on this discretisation.",
    )


def _release(scene: Scene, critical: Critical) -> str | None:
    """Released energy of a critical point with its unit; None without a release."""
    energy = released(critical)
    return None if energy is None else with_unit(scene, energy, "J", 4)
