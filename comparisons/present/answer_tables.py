"""Tables of answers: stations, critical points, branches, events, and searches for N."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.case import Comparison
from comparisons.display_units import display_units, distance_text, load_column, load_text, with_unit
from comparisons.formats import component_names, components, number, percent
from comparisons.present.columns import Column, Table, table_of
from comparisons.quantities import load_unit, norm, unit_of
from comparisons.tolerances.result import Tolerance
from comparisons.verdict.events import CriticalRow, mechanism, released
from comparisons.verdict.rows import ROUND_OFF
from comparisons.verdict.scales import probe_scales
from comparisons.verdict.station_events import Place
from cprbm_scene import Answer, Critical, Event, Scene, Stage


def answer_tables(scene: Scene, answer: Answer, tolerances: Sequence[Tolerance] = ()) -> tuple[Table, ...]:
    """Search for N, all stations of every stage, critical points and events; tables without rows are left out."""
    stages = (_stage_table(scene, answer, stage) for stage in scene.stages)
    found = (
        search_table(scene, tolerances),
        *stages,
        answer_critical_table(scene, answer),
        event_table(scene, answer),
    )
    return tuple(table for table in found if table.rows)


def _stage_table(scene: Scene, answer: Answer, stage: Stage) -> Table:
    """All stations of a stage, with a column for every component."""
    stations = [station for station in answer.stations if station.stage == stage.name]
    probes, scales = scene.probes_in(stage.name), probe_scales(scene, (answer,))
    units = display_units(
        scene,
        (
            (unit_of(scene, probe, stage), norm(probe.quantity, at.values[probe.name]))
            for probe in probes
            for at in stations
        ),
    )
    columns: dict[str, list[str]] = {}
    for probe in probes if stations else ():
        factor, unit = units[unit_of(scene, probe, stage)]
        floor = ROUND_OFF * scales[stage.name, probe.name]
        texts = [dict(components(probe.quantity, at.values[probe.name], factor, floor)) for at in stations]
        for name in component_names(probe.quantity):
            columns[f"{f'{probe.name} {name}'.rstrip()}, {unit}"] = [each.get(name, "open") for each in texts]
    heading, loads = load_column(scene, stage, [station.value for station in stations])
    ended = f"{answer.ending.name}: {answer.sentence or answer.ending.value}"
    return Table(
        f"{scene.title or scene.name}: {stage.name}, {answer.solver}",
        (heading, *columns),
        tuple(zip(loads, *columns.values(), strict=True)),
        ended if stations and stations[-1] is answer.stations[-1] else "",
    )


def search_table(scene: Scene, found: Sequence[Tolerance]) -> Table:
    """N by solver, with the largest uncertainty at that N."""

    def largest(one: Tolerance) -> str | None:
        if one.worst is None:
            return None
        return f"{one.worst.probe} at {load_text(scene, one.worst.stage, one.worst.station)}"

    columns = [
        Column[Tolerance]("solver", lambda one: one.solver),
        Column("N", lambda one: one.n),
        Column("extrapolated from", lambda one: ", ".join(map(str, one.extrapolated)) or None),
        Column("largest u", lambda one: None if one.worst is None else percent(one.worst.fraction)),
        Column("of", largest),
        Column("met", lambda one: "yes" if one.met else "no"),
        Column("solved", lambda one: ", ".join(map(str, one.solved))),
    ]
    note = "N: links or elements per beam; the finer N of an extrapolated answer."
    return table_of(f"N for a tolerance of {percent(found[0].asked)}" if found else "", columns, found, note)


CRITICAL_TITLE = "Critical values: where a branch ends"


def critical_table(compared: Comparison) -> Table:
    """Critical points of both answers."""
    scene = compared.scene

    def load(header: str, solver: str) -> Column[CriticalRow]:
        def text(row: CriticalRow) -> str | None:
            found = getattr(row, solver)
            return None if found is None else f"{with_unit(scene, found.value, row.unit, 5)}, {mechanism(found)}"

        return Column(header, text)

    def distance(header: str, size: str) -> Column[CriticalRow]:
        owner, _, name = size.rpartition(".")

        def text(row: CriticalRow) -> str | None:
            record = row.bounds if owner else row
            return None if record is None else distance_text(scene, getattr(record, name), row.unit)

        return Column(header, text)

    columns = [
        Column[CriticalRow]("stage", lambda row: row.stage if row.place == 0 else f"{row.stage}, {row.place + 1}"),
        load("CPRBM", "cprbm"),
        load("FEA", "fea"),
        distance("apart", "difference"),
        distance("u CPRBM", "bounds.cprbm"),
        distance("u FEA", "bounds.fea"),
        distance("allowed", "allowed"),
        distance("theory", "theory"),
        Column("releases CPRBM", lambda row: _release(scene, row.cprbm)),
        Column("releases FEA", lambda row: _release(scene, row.fea)),
        Column("word", lambda row: row.word.value),
    ]
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
    scene = compared.scene
    branches = compared.verdict.branches if compared.criticals or len(compared.verdict.branches) > 1 else ()
    rows = [
        (
            f"{each.stage}, branch {each.number}",
            " to ".join(load_text(scene, each.stage, value) for value in (each.first, each.last)),
            str(each.stations - each.near),
            str(each.near),
            "takes no part" if each.word is None else each.word.value,
        )
        for each in branches
    ]
    between: dict[str, dict[float, None]] = {}
    for row in compared.rows:
        if row.branch is None:
            between.setdefault(row.stage, {})[row.station] = None
    for stage, values in between.items():
        texts = ", ".join(load_text(scene, stage, value) for value in values)
        rows.append((f"{stage}, {Place.BETWEEN.value}", texts, str(len(values)), "–", "takes no part"))
    return Table(
        "Branch by branch",
        ("branch", "stations", "compared", "between events", "word"),
        tuple(rows),
        "A branch is compared with the same branch. Stations between the runs' loads of an event take no part.",
    )


def answer_critical_table(scene: Scene, answer: Answer) -> Table:
    """Critical points of an answer, passed points first."""
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    passed = {id(one.end): f", passed: turned by {number(one.turned, 3)} rad" for one in answer.gone_over}
    columns = [
        Column[Critical]("stage", lambda one: one.stage),
        Column("at", lambda one: with_unit(scene, one.value, units[one.stage], 5)),
        Column("±", lambda one: distance_text(scene, one.uncertainty, units[one.stage])),
        Column("mechanism", lambda one: f"{mechanism(one)}{passed.get(id(one), '')}"),
        Column("smallest curvature", lambda one: number(one.curvature)),
        Column("left", lambda one: number(one.left)),
        Column("releases", lambda one: _release(scene, one)),
    ]
    return table_of(
        CRITICAL_TITLE,
        columns,
        (*(one.end for one in answer.gone_over), *answer.critical),
        "The smallest curvature of the energy on the feasible directions at the end of the branch, and the curvature "
        "that is left after a contact or stop lets go. ±: on this discretisation.",
    )


def event_table(scene: Scene, answer: Answer) -> Table:
    """Closings and openings of contacts."""
    columns = [
        Column[Event]("stage", lambda event: event.stage),
        Column("contact", lambda event: event.contact),
        Column("event", lambda event: event.kind),
        Column("at", lambda event: load_text(scene, event.stage, event.value)),
    ]
    return table_of("Events", columns, answer.events)


def _release(scene: Scene, critical: Critical | None) -> str | None:
    energy = None if critical is None else released(critical)
    return None if energy is None else with_unit(scene, energy, "J", 4)
