"""Result of the relations: the worst violations, the broken relations, and the documented JSON."""

from __future__ import annotations

import math

from comparisons.formats import number
from comparisons.present.columns import Plain, Section, Table
from tests.relations.measured import TARGET
from tests.relations.relations import RELATIONS
from tests.relations.study import Relations, Seen

_NAMES = {"cprbm": "CPRBM", "fea": "FEA"}


def result_of(found: Relations) -> Section:
    """Result of the measurements so far."""
    tables = tuple(table for table in (_worst(found), _broken(found)) if table.rows)
    return Section("What must not change an answer", _words(found), (), tables, "relations", _data(found))


def _words(found: Relations) -> tuple[str, ...]:
    sentences = [f"{case}: the {_NAMES[solver]} does not answer it. {why}" for solver, case, why in found.refused]
    if found.seen:
        broken = len(found.broken)
        sentences.append(
            f"{len(found.seen)} images were solved beside their scenes. "
            + (f"{broken} of them differ by more than they may." if broken else "None differs by more than it may.")
        )
    return tuple(sentences)


def _worst(found: Relations) -> Table:
    body = []
    for relation in RELATIONS:
        for solver, name in _NAMES.items():
            if seen := found.of(relation.name, solver):
                body.append((relation.name, name, str(len(seen)), *_figures(seen[0])))
    return Table(
        "Worst violations",
        ("relation", "solver", "images", "worst", "allowed", "case", "what", "probe", "at"),
        tuple(body),
        f"Shares of the probe's scale. Allowed are {TARGET:g}, or what round-off leaves by the certificate; where an "
        "image is another discretised problem also the uncertainties that two sizes of either state.",
    )


def _broken(found: Relations) -> Table:
    body = [
        (each.violation.relation, _NAMES[each.solver], *_figures(each), each.violation.worst.why)
        for each in found.broken
    ]
    head = ("relation", "solver", "worst", "allowed", "case", "what", "probe", "at", "")
    return Table("More than they may", head, tuple(body), "Images whose answer is another.")


def _figures(seen: Seen) -> tuple[str, ...]:
    worst = seen.violation.worst
    return (
        number(worst.size, 2) if math.isfinite(worst.size) else "wholly",
        number(worst.allowed, 2),
        seen.case,
        seen.violation.what,
        worst.probe,
        f"{worst.stage} {worst.station:g}" if worst.stage else "",
    )


def _data(found: Relations) -> Plain:
    return {
        "study": "relations",
        "target": TARGET,
        "relations": [
            {
                "relation": relation.name,
                "says": relation.says,
                "solvers": {
                    solver: [_violation(each) for each in found.of(relation.name, solver)] for solver in _NAMES
                },
            }
            for relation in RELATIONS
        ],
        "refused": [{"solver": solver, "case": case, "why": why} for solver, case, why in found.refused],
    }


def _violation(seen: Seen) -> Plain:
    worst = seen.violation.worst
    return {
        "case": seen.case,
        "what": seen.violation.what,
        "holds": seen.violation.holds,
        "probe": worst.probe or None,
        "stage": worst.stage or None,
        "station": worst.station if math.isfinite(worst.station) else None,
        "violation": worst.size if math.isfinite(worst.size) else None,
        "allowed": worst.allowed,
        "why": worst.why or None,
    }
