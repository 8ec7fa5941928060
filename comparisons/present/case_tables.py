"""Sections of a comparison with their tables: claims, reactions, certificates, run times, and the tables of rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from comparisons.case import Comparison
from comparisons.formats import at_station, display_unit, number, percent
from comparisons.opinions import Standing, solid_sentence, standings
from comparisons.present import row_tables
from comparisons.present.answer_tables import branch_table, critical_table, search_table
from comparisons.present.columns import Column, Figure, Section, Table, follow, table_of
from comparisons.present.json_document import solver
from comparisons.reactions import MESH_ALLOWANCE, PERTURBATION, WorkEnergyReaction, is_long
from comparisons.stations import kept
from cprbm_scene import Answer, Scene

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
        "Reactions of the drives": reaction_tables(compared),
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
    columns = [
        Column[Standing]("claim", lambda at: at.claim.text or at.claim.probe),
        Column(
            "source",
            lambda at: ("" if at.claim.value is None else f"{number(at.claim.value)} ± ") + percent(at.claim.bound),
        ),
        Column("largest here", "difference", percent),
        Column("at", lambda at: at_station(compared.scene, at.worst.stage, at.worst.station)),
        Column("met at", lambda at: f"{at.met} of {at.stations}"),
        Column("", lambda at: "met" if at.holds else "not met"),
    ]
    return table_of(
        "Claims of the source",
        columns,
        standings(compared.scene, compared.rows, compared.criticals),
        "Claims take no part in the verdict. The difference of a force or a moment is here a fraction of the value at "
        "the station; the difference from a claimed value is the CPRBM's distance.",
    )


def reaction_tables(compared: Comparison) -> tuple[Table, ...]:
    """A table for every moved drive: the multiplier, the work–energy reaction and the finite elements' reaction."""
    return tuple(_reaction_table(compared, drive, found) for drive, found in by_drive(compared.reactions).items())


def _reaction_table(compared: Comparison, drive: str, found: Sequence[WorkEnergyReaction]) -> Table:
    """Reactions of a drive at the stations that tables show."""
    scene, run = compared.scene, compared.runs.perturbed
    ended = "" if run is None or run.completed else f" The perturbed run ended early: {run.ending.value}."
    stations = {stage.name: kept(stage) if is_long(stage) else stage.stations for stage in scene.stages}
    factor, unit = display_unit(scene, found[0].unit, max(abs(each.multiplier) for each in found))

    def force(value: float) -> str:
        return number(value / factor, 5)

    columns = [
        Column[WorkEnergyReaction]("station", lambda at: at_station(scene, at.stage, at.station)),
        Column("multiplier", "multiplier", force),
        Column("work–energy", "work_energy", force),
        Column("from it", "difference", percent),
        Column("FEA", "fea", force),
        Column("multiplier from it", "from_fea", percent),
        Column("no value because", lambda at: ": ".join((at.absence.value, *filter(None, [", ".join(at.changes)])))
               if at.absence else ""),
    ]  # fmt: skip
    rows = [each for each in found if each.station in stations[each.stage]]
    return table_of(f"Reaction at the drive {drive}, {unit}", columns, rows, summary(scene, found) + ended)


def by_drive(found: Sequence[WorkEnergyReaction]) -> dict[str, tuple[WorkEnergyReaction, ...]]:
    """The reactions of every drive, in the order of stages and stations."""
    drives = dict.fromkeys(reaction.drive for reaction in found)
    return {drive: tuple(reaction for reaction in found if reaction.drive == drive) for drive in drives}


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
    runs, solid = compared.runs, compared.runs.solid or ()
    answers = dict(zip(("cprbm", "fea", "solid"), (runs.cprbm[0], runs.reference, *solid[-1:]), strict=False))
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
    answers = {
        f"CPRBM ({runs.theory})": runs.cprbm[0],
        f"FEA ({runs.theory})": runs.reference,
        f"CPRBM ({runs.other_theory})": runs.other,
        "exact (bending)": runs.exact,
        **{f"solid, {one.settings['elements']} along": one for one in runs.solid or ()},
    }
    columns = [
        Column[tuple[str, Answer]]("answer", lambda at: at[0]),
        Column("stations", lambda at: len(at[1].stations)),
        Column("seconds", lambda at: at[1].seconds, number),
    ]
    found = [(name, answer) for name, answer in answers.items() if answer is not None]
    return table_of("Seconds", columns, found, "From the scene to certified answers, by each solver's own clock.")
