"""Tables of answers and comparisons: stations, critical points, branches, claims, reactions, certificates, seconds."""

from collections import Counter
from collections.abc import Sequence
from itertools import groupby
from typing import Any

from comparisons.case import BranchVerdict, Comparison
from comparisons.formats import (
    at_station,
    component_names,
    components,
    display_unit,
    display_units,
    distance_text,
    load_column,
    load_text,
    number,
    percent,
    with_unit,
)
from comparisons.opinions import Standing, solid_sentence, standings
from comparisons.present import row_tables
from comparisons.present.columns import Column, Figure, Section, Table, columns_of, follow, table_of
from comparisons.present.json_document import solver
from comparisons.quantities import load_unit, norm, probe_scales, unit_of
from comparisons.reactions import MESH_ALLOWANCE, PERTURBATION, WorkEnergyReaction, by_drive, is_long
from comparisons.stations import kept
from comparisons.tolerances import Tolerance
from comparisons.verdict import ROUND_OFF, CriticalRow, mechanism, other_theory, released
from cprbm_scene import Answer, Critical, Event, Scene, Stage

CRITICAL_TITLE = "Critical values: where a branch ends"
_BETWEEN = -1
"""Number of a row for stations between events, beside the numbers of branches."""

_CERTIFICATE = {
    "ending": "ending",
    "stations": "stations",
    "residual": "certificate.residual",
    "round-off floor of the residual": "certificate.residual_floor",
    "violation of joints": "certificate.violation",
    "penetration / thickness": "certificate.penetration",
    "gap × force": "certificate.complementarity",
    "|ΣF|": "certificate.force_balance",
    "|ΣM|": "certificate.moment_balance",
    "smallest curvature of the energy": "certificate.smallest_curvature",
    "audit": "audit.complaints",
    "stated moments less the moments of the forces beyond": "audit.scaled_unbalance",
    "iterations": "certificate.iterations",
}
"""Paths in the documented JSON of a solver, by label."""


_FIGURES = {
    "path": "Curves",
    "stress": "Stress along the beams",
    "contact": "Contact zones and forces",
    "reaction": "Reactions of the drives",
}
"""Headings of the sections with figures, by the first word of the figure's name; other figures stand in no section."""


def answer_tables(scene: Scene, answer: Answer, tolerances: Sequence[Tolerance] = ()) -> tuple[Table, ...]:
    """Search for N, all stations of every stage, critical points and events; tables without rows are left out."""
    events = [
        Column[Event]("stage", "stage"),
        Column("contact", "contact"),
        Column("event", "kind"),
        Column[Event](
            "at",
            lambda event: " to ".join(load_text(scene, event.stage, at) for at in event.interval or (event.value,)),
        ),
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
    sizes = (
        (unit_of(scene, at, stage.name), norm(at.quantity, each.values[at.name])) for at in probes for each in stations
    )
    units, columns = display_units(scene, sizes), dict([load_column(scene, stage, [at.value for at in stations])])
    for probe in probes if stations else ():
        factor, unit = units[unit_of(scene, probe, stage.name)]
        floor = ROUND_OFF * scales[stage.name, probe.name]
        texts = [dict(components(probe.quantity, at.values[probe.name], factor, floor)) for at in stations]
        columns |= {
            f"{f'{probe.name} {name}'.rstrip()}, {unit}": tuple(each.get(name, "open") for each in texts)
            for name in component_names(probe.quantity)
        }
    ended = (
        f"{answer.ending.name}: {answer.sentence or answer.ending.value}",
        # the table of events states the loads at which contacts close
        *(f"Note: {note}." for note in answer.notes if ": closed at " not in note),
    )
    return Table(
        title=f"{scene.title or scene.name}: {stage.name}, {answer.solver}",
        headers=tuple(columns),
        rows=tuple(zip(*columns.values(), strict=True)),
        note="\n".join(ended) if stations and stations[-1] is answer.stations[-1] else "",
    )


def search_table(scene: Scene, found: Sequence[Tolerance]) -> Table:
    """N by solver, with the largest uncertainty at that N."""
    return table_of(
        f"N for a tolerance of {percent(found[0].asked)}" if found else "",
        columns=[
            Column[Tolerance]("solver", "solver"),
            Column("N", "n"),
            Column("extrapolated from", lambda one: ", ".join(map(str, one.extrapolated)) or None),
            Column("largest u", lambda one: one.worst and one.fraction, percent),
            Column("of", "worst", lambda row: f"{row.probe.name} at {load_text(scene, row.stage, row.station)}"),
            Column("met", lambda one: "yes" if one.met else "no"),
            Column("solved", lambda one: ", ".join(map(str, one.solved))),
        ],
        items=found,
        note="N: links or elements per beam; the finer N of an extrapolated answer.",
    )


def critical_table(compared: Comparison) -> Table:
    """Critical points of both answers."""
    scene = compared.scene
    sizes = {"apart": "difference", "u CPRBM": "bounds.cprbm", "u FEA": "bounds.fea", "allowed": "allowed"}
    return table_of(
        CRITICAL_TITLE,
        columns=[
            Column[CriticalRow]("stage", lambda row: row.stage if row.place == 0 else f"{row.stage}, {row.place + 1}"),
            *columns_of(
                lambda row, found: f"{with_unit(scene, found.value, row.unit, 5)}, {mechanism(found)}",
                {"CPRBM": "cprbm", "FEA": "fea"},
            ),
            *columns_of(lambda row, size: distance_text(scene, size, row.unit), sizes | {"theory": "theory"}),
            *columns_of(lambda _, found: _release(scene, found), {"releases CPRBM": "cprbm", "releases FEA": "fea"}),
            Column("word", "word.value"),
        ],
        items=compared.criticals,
        note="Values of the stepped load or drive, and the mechanism of the instability; uncertainties from further "
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

    return table_of(
        "Branch by branch",
        columns=[
            Column[BranchVerdict](
                "branch",
                lambda at: f"{at.stage}, {'between events' if at.number == _BETWEEN else f'branch {at.number}'}",
            ),
            Column("stations", span),
            Column("compared", lambda at: at.stations - at.near),
            Column("between events", lambda at: None if at.number == _BETWEEN else at.near),
            Column("word", lambda at: "takes no part" if at.word is None else at.word.value),
        ],
        items=[*(branches if compared.criticals or len(branches) > 1 else ()), *between],
        note="A branch is compared with the same branch. Stations between the runs' loads of an event take no part.",
    )


def _answer_critical_table(scene: Scene, answer: Answer) -> Table:
    """Critical points of an answer, passed points first."""
    passed = {id(one.end): f", passed: turned by {number(one.turned, 3)} rad" for one in answer.gone_over}
    return table_of(
        CRITICAL_TITLE,
        columns=[
            Column[Critical]("stage", "stage"),
            Column("at", lambda one: with_unit(scene, one.value, load_unit(scene, one.stage), 5)),
            Column("±", lambda one: distance_text(scene, one.uncertainty, load_unit(scene, one.stage))),
            Column("mechanism", lambda one: f"{mechanism(one)}{passed.get(id(one), '')}"),
            Column("smallest curvature", "curvature", number),
            Column("curvature left", "left", number),
            Column("releases", lambda one: _release(scene, one)),
        ],
        items=(*(one.end for one in answer.gone_over), *answer.critical),
        note="The smallest curvature of the energy on the feasible directions at the end of the branch, and the "
        "curvature that is left after a contact or stop lets go. ±: on this discretisation.",
    )


def _release(scene: Scene, critical: Critical) -> str | None:
    """Released energy of a critical point with its unit; None without a release."""
    energy = released(critical)
    return None if energy is None else with_unit(scene, energy, "J", 4)


def case_sections(compared: Comparison, figures: Sequence[Figure] = ()) -> tuple[Section, ...]:
    """All sections of a comparison with their ``figures``, in the order of reading; empty sections are left out."""
    stations = row_tables.shown_stations(compared)
    last = stations[-1] if stations else ()
    beside = (row_tables.theory_table(compared, last), row_tables.paper_table(compared))
    contents: dict[str, tuple[Table, ...]] = {
        "Curves": (),
        "Search for N": (search_table(compared.scene, compared.tolerances),),
        "Errors in displacement, stress and force": row_tables.error_tables(compared, last),
        "Stress along the beams": (),
        "Contact zones and forces": (),
        "Critical points and branches": (critical_table(compared), branch_table(compared)),
        "Values at further stations": tuple(row_tables.value_table(compared, rows) for rows in stations[:-1]),
        "What the verdict rests on": (row_tables.verdict_table(last), row_tables.exact_table(compared, last)),
        "What the source claims": (claims_table(compared),),
        "Reactions of the drives": tuple(
            _reaction_table(compared, drive, found) for drive, found in by_drive(compared.reactions).items()
        ),
        "Other theories and formulations": (*beside, row_tables.solid_table(compared)),
        "Certificates and audit": (_certificate_table(compared),),
        "Run time": (_seconds_table(compared),),
    }
    sections = (
        Section(
            heading,
            (said,) if heading.startswith("Other") and (said := solid_sentence(compared)) else (),
            tuple(figure for figure in figures if _FIGURES.get(figure.name.partition("-")[0]) == heading),
            tuple(table for table in tables if table.rows),
        )
        for heading, tables in contents.items()
    )
    return tuple(section for section in sections if not section.empty)


def claims_table(compared: Comparison) -> Table:
    """Claims of the source beside the differences found here."""
    return table_of(
        "Claims of the source",
        columns=[
            Column[Standing]("claim", lambda at: at.claim.text or at.claim.probe),
            Column(
                "source",
                lambda at: ("" if at.claim.value is None else f"{number(at.claim.value)} ± ") + percent(at.claim.bound),
            ),
            Column("largest here", "difference", percent),
            Column("at", lambda at: at_station(compared.scene, at.worst.stage, at.worst.station)),
            Column("met at", lambda at: f"{at.met} of {at.stations}"),
            Column("", lambda at: "met" if at.holds else "not met"),
        ],
        items=standings(compared.scene, compared.rows, compared.criticals),
        note="Claims take no part in the verdict. The difference of a force or a moment is here a fraction of the "
        "value at the station; the difference from a claimed value is the CPRBM's distance.",
    )


def _reaction_table(compared: Comparison, drive: str, found: Sequence[WorkEnergyReaction]) -> Table:
    """Multiplier, work–energy reaction and the finite elements' reaction of a drive at the stations of tables."""
    scene, run = compared.scene, compared.runs.answers.get("cprbm perturbed")
    ended = "" if run is None or run.completed else f" The perturbed run ended early: {run.ending.value}."
    stations = {stage.name: kept(stage) if is_long(stage) else stage.stations for stage in scene.stages}
    factor, unit = display_unit(scene, found[0].unit, max(abs(each.multiplier) for each in found))

    def force(value: float) -> str:
        return number(value / factor, 5)

    rows = [each for each in found if each.station in stations[each.stage]]
    return table_of(
        f"Reaction at the drive {drive}, {unit}",
        columns=[
            Column[WorkEnergyReaction]("station", lambda at: at_station(scene, at.stage, at.station)),
            Column("multiplier", "multiplier", force),
            Column("work–energy", "work_energy", force),
            Column("less multiplier", "difference", percent),
            Column("FEA", "fea", force),
            Column("multiplier less FEA", "from_fea", percent),
            Column(
                "no value because",
                lambda at: ": ".join((at.absence.value, *filter(None, [", ".join(at.changes)]))) if at.absence else "",
            ),
        ],
        items=rows,
        note=summary(scene, found) + ended,
    )


def summary(scene: Scene, found: Sequence[WorkEnergyReaction]) -> str:
    """Number of stations within the allowance, largest difference, stated errors, and absent values."""
    known = [reaction for reaction in found if reaction.difference is not None]
    beyond = [f"{at_station(scene, at.stage, at.station)} ({percent(at.difference)})" for at in known if at.apart]
    text = f"Work–energy by a central difference with ρ = {percent(PERTURBATION)}: within the allowance at "
    text += f"{len(known) - len(beyond)} of {len(known)} stations."
    text += f" Beyond the allowance: {', '.join(beyond)}." if beyond else ""
    if known:
        worst = max(known, key=lambda reaction: abs(reaction.difference or 0.0))
        truncation, round_off = (
            percent(max(reaction.share(getattr(reaction, size)) or 0.0 for reaction in known))
            for size in ("truncation", "round_off")
        )
        text += (
            f" Largest difference: {percent(worst.difference)} at {at_station(scene, worst.stage, worst.station)}. "
            f"Truncation is at most {truncation}, round-off at most {round_off}. Where contacts are closed, the motion "
            f"of the mesh is allowed {percent(MESH_ALLOWANCE)} more."
        )
    absent = Counter(reaction.absence for reaction in found if reaction.absence)
    return text + "".join(f" No value at {count} stations: {reason.value}." for reason, count in absent.items())


def _certificate_table(compared: Comparison) -> Table:
    """Facts of the documented JSON of every solver."""
    solid = compared.runs.solids
    answers = dict(zip(("cprbm", "fea", "solid"), (*compared.runs.pair, *solid[-1:]), strict=False))
    facts = {name: solver(answer, compared.audits.get(name)) for name, answer in answers.items()}
    rows = ((label, *(_fact(follow(of, path)) for of in facts.values())) for label, path in _CERTIFICATE.items())
    note = "All numbers but iterations are relative to a scale of the problem; see docs/certificate.md."
    note += f" The solid is {solid[-1].notes[0]}." if solid and solid[-1].notes else ""
    return Table("Certificates", ("worst of all stations", *answers), tuple(rows), note)


def _fact(value: Any) -> str:  # noqa: ANN401 - all types of JSON
    """Text of a fact: of an audit's complaints their number."""
    if isinstance(value, list):
        return f"{len(value)} complaints" if value else "holds"
    return number(value) if isinstance(value, float | None) else str(value)


def _seconds_table(compared: Comparison) -> Table:
    """Seconds stand alone, since every run has others."""
    runs = compared.runs
    labels = {
        "cprbm": f"CPRBM ({runs.theory})",
        "fea": f"FEA ({runs.theory})",
        f"cprbm {other_theory(runs.theory)}": f"CPRBM ({other_theory(runs.theory)})",
        "exact": "exact (bending)",
    }
    answers = [(label, runs.answers[name]) for name, label in labels.items() if name in runs.answers]
    answers += [(f"solid, {one.settings['elements']} along", one) for one in runs.solids]
    return table_of(
        "Seconds",
        columns=[
            Column[tuple[str, Answer]]("answer", lambda at: at[0]),
            Column("stations", lambda at: len(at[1].stations)),
            Column("seconds", lambda at: at[1].seconds, number),
        ],
        items=answers,
        note="From the scene to certified answers, by each solver's own clock.",
    )
