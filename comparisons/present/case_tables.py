"""Sections of a comparison with their tables: claims, certificates, run times, and the tables of rows and parts."""

from __future__ import annotations

from comparisons.audit import Audit
from comparisons.case import Comparison
from comparisons.claims import Standing, standings
from comparisons.display_units import at_station
from comparisons.formats import number, percent
from comparisons.present.answer_tables import branch_table, critical_table, search_table
from comparisons.present.columns import Column, Section, Table, table_of
from comparisons.present.difference_tables import paper_table, solid_table
from comparisons.present.json_document import worst_certificate
from comparisons.present.reaction_tables import reaction_tables
from comparisons.present.row_tables import (
    error_tables,
    exact_table,
    shown_stations,
    theory_table,
    value_table,
    verdict_table,
)
from comparisons.third import sentence as solid_sentence
from cprbm_scene import Answer

_CERTIFICATE = {
    "residual": "residual",
    "residual_floor": "round-off floor of the residual",
    "violation": "violation of joints",
    "penetration": "penetration / thickness",
    "complementarity": "gap × force",
    "force_balance": "|ΣF|",
    "moment_balance": "|ΣM|",
    "smallest_curvature": "smallest curvature of the energy",
}


def case_sections(compared: Comparison) -> tuple[Section, ...]:
    """All sections of a comparison without figures, in the order of reading; empty sections are left out."""
    stations = shown_stations(compared)
    last = stations[-1] if stations else ()
    sections = (
        Section("Search for N", tables=(search_table(compared.scene, compared.tolerances),)),
        Section("Errors in displacement, stress and force", tables=error_tables(compared, last)),
        Section("Critical points and branches", tables=(critical_table(compared), branch_table(compared))),
        Section("Values at further stations", tables=tuple(value_table(compared, each) for each in stations[:-1])),
        Section("What the verdict rests on", tables=(verdict_table(last), exact_table(compared, last))),
        Section("What the source claims", tables=(claims_table(compared),)),
        Section("Reactions of the drives", tables=reaction_tables(compared)),
        Section("Other theories and formulations", tuple(filter(None, (solid_sentence(compared),))),
                tables=(theory_table(compared, last), paper_table(compared), solid_table(compared))),
        Section("Certificates and audit", tables=(_certificate_table(compared),)),
        Section("Run time", tables=(_seconds_table(compared),)),
    )  # fmt: skip
    return tuple(kept for each in sections if not (kept := _with_rows(each)).empty)


def _with_rows(section: Section) -> Section:
    tables = tuple(table for table in section.tables if table.rows)
    return Section(section.heading, section.sentences, section.figures, tables)


def claims_table(compared: Comparison) -> Table:
    """Claims of the source beside the differences found here."""
    columns = [
        Column[Standing]("claim", lambda at: at.claim.text or at.claim.probe),
        Column(
            "source",
            lambda at: ("" if at.claim.value is None else f"{number(at.claim.value)} ± ") + percent(at.claim.bound),
        ),
        Column("largest here", lambda at: percent(at.difference)),
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


def _certificate_table(compared: Comparison) -> Table:
    runs = compared.runs
    answers = {"cprbm": runs.cprbm[0], "fea": runs.reference}
    answers |= {} if runs.solid is None else {"solid": runs.solid[-1]}  # its finest mesh
    found = {name: worst_certificate(answer) for name, answer in answers.items()}
    audits = {name: compared.audits.get(answer.solver) for name, answer in answers.items()}

    def numbers(key: str) -> list[str]:
        return [number(cert[key]) if cert is not None else number(None) for cert in found.values()]

    rows = [
        ("ending", *(answer.ending.name for answer in answers.values())),
        ("stations", *(str(len(answer.stations)) for answer in answers.values())),
        *((label, *numbers(key)) for key, label in _CERTIFICATE.items()),
        ("audit", *(_audit_word(each) for each in audits.values())),
        (
            "stated moments less the moments of the forces beyond",
            *(number(each.scaled) if each is not None and each.stations else number(None) for each in audits.values()),
        ),
        ("iterations", *("–" if cert is None else str(cert["iterations"]) for cert in found.values())),
    ]
    note = "All numbers but iterations are relative to a scale of the problem; see docs/certificate.md."
    if runs.solid is not None and runs.solid[-1].notes:
        note += f" The solid is {runs.solid[-1].notes[0]}."
    return Table("Certificates", ("worst of all stations", *answers), tuple(rows), note)


def _audit_word(found: Audit | None) -> str:
    if found is None or not found.stations:
        return "–"
    return "holds" if not found.complaints else f"{len(found.complaints)} complaints"


def _seconds_table(compared: Comparison) -> Table:
    """Seconds stand alone, since every run has others."""
    runs = compared.runs
    answers = {f"CPRBM ({runs.theory})": runs.cprbm[0], f"FEA ({runs.theory})": runs.reference}
    answers |= {} if runs.other is None else {f"CPRBM ({runs.other_theory})": runs.other}
    answers |= {} if runs.exact is None else {"exact (bending)": runs.exact}
    answers |= {f"solid, {one.settings['elements']} along": one for one in runs.solid or ()}
    columns = [
        Column[tuple[str, Answer]]("answer", lambda at: at[0]),
        Column("stations", lambda at: len(at[1].stations)),
        Column("seconds", lambda at: at[1].seconds, number),
    ]
    return table_of(
        "Seconds", columns, answers.items(), "From the scene to certified answers, by each solver's own clock."
    )
