"""The documented JSON: plain data with stable keys, SI units, and null where there is no value."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from comparisons.audit import Audit
from comparisons.case import Comparison
from comparisons.claims import claim_met, claim_of, claim_of_critical, claimed_difference, critical_difference
from comparisons.quantities import arc_lengths, unit_of
from comparisons.reactions import WorkEnergyReaction
from comparisons.steps import contact_model, largest_difference, steps_of
from comparisons.third import Third, thirds_of
from comparisons.tolerances.search import Tolerance
from comparisons.verdict.completeness import CERTIFICATE_NUMBERS
from comparisons.verdict.events import CriticalRow, released
from comparisons.verdict.rows import Row
from comparisons.verdict.words import Reason, Word
from cprbm_scene import Answer, Certificate, Critical, Probe, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES

Plain = dict[str, Any]


def text(data: Plain) -> str:
    """``data`` as JSON with a line end.

    Raises:
        ValueError: a number in it is not finite.
    """
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def comparison(compared: Comparison) -> Plain:
    """One case of ``compare``."""
    return {
        "case": compared.scene.name,
        "verdict": compared.verdict.word.value,
        "reason": name_of(compared.verdict.reason),
        "sentence": compared.verdict.sentence,
        "solvers": {
            "cprbm": {
                **solver(compared.runs.cprbm[0], compared.audits.get("cprbm")),
                **_tolerance(compared.tolerances, "cprbm"),
            },
            "fea": {
                **solver(compared.runs.reference, compared.audits.get("fea")),
                **_tolerance(compared.tolerances, "fea"),
            },
            **({} if compared.runs.exact is None else {"exact": solver(compared.runs.exact)}),
            **({} if compared.runs.solid is None else {"solid": _solid(compared, compared.runs.solid[-1])}),
        },
        "rows": [
            {**_row(compared, row), "verdict": name_of(word), "reason": name_of(reason)}
            for row, word, reason in zip(compared.rows, compared.verdict.words, compared.verdict.reasons, strict=True)
        ],
        "critical": [_critical_row(compared.scene, each) for each in compared.criticals],
        "branches": [
            {
                "stage": each.stage,
                "branch": each.number,
                "from": each.first,
                "to": each.last,
                "stations": each.stations,
                "near_critical": each.near,
                "verdict": name_of(each.word),
            }
            for each in compared.verdict.branches
        ],
        "work_energy": [_reaction(each) for each in compared.reactions],
        **({} if compared.runs.solid is None else {"solid": [_third(each) for each in thirds_of(compared)]}),
    }


def name_of(value: Word | Reason | None) -> str | None:
    """Name of a word or a reason; None without one."""
    return None if value is None else value.value


def _solid(compared: Comparison, finest: Answer) -> Plain:
    """How the solid fared on its finest mesh."""
    return {**solver(finest), **_tolerance(compared.tolerances, "solid")}


def solution(
    scene: Scene, answer: Answer, tolerances: tuple[Tolerance, ...] = (), audited: Audit | None = None
) -> Plain:
    """One case of ``solve``: the same shape with one solver's column and no verdict."""
    stages = {stage.name: stage for stage in scene.stages}
    return {
        "case": scene.name,
        "solvers": {answer.solver: {**solver(answer, audited), **_tolerance(tolerances, answer.solver)}},
        "rows": [
            {
                "probe": probe.name,
                "stage": station.stage,
                "station": station.value,
                "branch": station.branch,
                "unit": unit_of(scene, probe, stages[station.stage]),
                answer.solver: values(probe, station.values[probe.name]),
                **_places(scene, probe),
            }
            for station in answer.stations
            for probe in scene.probes_in(station.stage)
        ],
    }


def solver(answer: Answer, audited: Audit | None = None) -> Plain:
    """How a solver fared; the certificate is the worst over its stations, the audit null where there was none."""
    return {
        "ending": answer.ending.name,
        "sentence": answer.sentence,
        "seconds": plain(answer.seconds),
        "settings": plain(answer.settings),
        "certificate": worst(tuple(station.certificate for station in answer.stations)),
        "audit": None if audited is None else _audit(audited),
        "stations": len(answer.stations),
        "events": [
            {"stage": event.stage, "contact": event.contact, "kind": event.kind, "value": plain(event.value)}
            for event in answer.events
        ],
        "critical": [critical(each) for each in answer.critical],
        "gone_over": [{**critical(each.end), "turned": plain(each.turned)} for each in answer.gone_over],
        "notes": list(answer.notes),
    }


def _audit(found: Audit) -> Plain | None:
    if not found.stations:
        return None
    return {
        "holds": not found.complaints,
        "complaints": list(found.complaints),
        "remarks": list(found.crossings),
        "stations": found.stations,
        "unbalance": plain(found.unbalance),
        "scaled_unbalance": plain(found.scaled),
        "smallest_curvature": None,
    }


def critical(found: Critical) -> Plain:
    """Where a branch ends in one answer."""
    return {
        "stage": found.stage,
        "value": plain(found.value),
        "uncertainty": plain(found.uncertainty),
        "loss": found.loss.value,
        "what": found.what or None,
        "curvature": plain(found.curvature),
        "left": plain(found.left),
        "energy": plain(found.energy),
        "after": plain(found.after),
        "released": plain(released(found)),
    }


def _tolerance(tolerances: tuple[Tolerance, ...], name: str) -> Plain:
    """How a solver's N was found, where it was."""
    for found in tolerances:
        if found.solver == name:
            return {"tolerance": _found(found)}
    return {}


def _found(found: Tolerance) -> Plain:
    row = found.worst
    return {
        "asked": found.asked,
        "met": found.met,
        "links": found.n if found.solver == "cprbm" else None,
        "elements": None if found.solver == "cprbm" else found.n,
        "estimate": None if row is None else plain(row.fraction),
        "probe": None if row is None else row.probe,
        "stage": None if row is None else row.stage,
        "station": None if row is None else row.station,
        "extrapolated": list(found.extrapolated) or None,
        "extrapolated_probes": list(found.probes),
        "solved": list(found.solved),
    }


def worst(certificates: tuple[Certificate, ...]) -> Plain | None:
    """Of every number of the certificates the least reassuring one; None if there is no certificate."""
    if not certificates:
        return None
    return {
        "holds": all(certificate.holds for certificate in certificates),
        **{key: plain(max(getattr(certificate, key) for certificate in certificates)) for key in CERTIFICATE_NUMBERS},
        "smallest_curvature": plain(min(certificate.smallest_curvature for certificate in certificates)),
        "iterations": sum(certificate.iterations for certificate in certificates),
        "failures": [failure for certificate in certificates for failure in certificate.failures],
    }


def values(probe: Probe, found: Array) -> Any:  # noqa: ANN401 - a number, a list or nothing
    """A probe's values: a number, a list where it has several, None where there is none."""
    if found.size == 0:
        return None
    if found.size == 1 and probe.quantity not in STRESSES:
        return plain(float(found[0]))
    return [plain(float(value)) for value in found]


def plain(value: object) -> Any:  # noqa: ANN401 - whatever JSON holds
    """``value`` in JSON's own types; a number that is not finite becomes None."""
    match value:
        case Mapping():
            return {str(key): plain(item) for key, item in value.items()}
        case list() | tuple():
            return [plain(item) for item in value]
        case np.ndarray():
            whole = value.dtype.kind != "f" or bool(np.isfinite(value).all())
            return value.tolist() if whole else plain(value.tolist())
        case bool() | int() | str() | None:
            return value
        case float() | np.floating():
            return float(value) if math.isfinite(value) else None
        case _:
            return str(value)


def _row(compared: Comparison, row: Row) -> Plain:
    scene, runs = compared.scene, compared.runs
    claim = claim_of(scene, row)
    bounds = row.bounds
    steps, model = steps_of(runs, row), contact_model(runs, row)
    true = row.true_errors
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "branch": row.branch,
        "place": row.place.value,
        "unit": row.unit,
        "cprbm": values(row.probe, row.cprbm),
        "fea": values(row.probe, row.fea),
        "difference": row.fraction(row.difference),
        "uncertainty": {
            "cprbm": None if bounds is None else row.fraction(bounds.cprbm),
            "fea": None if bounds is None else row.fraction(bounds.fea),
            "theory": None if bounds is None or bounds.bending is None else row.fraction(bounds.theory),
            "fea_bending": None if bounds is None or bounds.bending is None else row.fraction(bounds.bending),
            "round_off": None if bounds is None else row.fraction(bounds.round_off),
        },
        "claim": None if claim is None else claim.bound,
        "claim_value": None if claim is None else claim.value,
        "claim_met": claim_met(claim, row),
        "claim_difference": None if claim is None else claimed_difference(claim, row),
        "difference_same_theory": row.fraction(row.same_theory),
        "steps": None
        if steps is None
        else {
            "contact": row.fraction(steps.contact),
            "own": row.fraction(steps.own),
            "stretch": row.fraction(steps.stretch),
            "shear": row.fraction(steps.shear),
        },
        "contact_model": None if model is None else row.fraction(model),
        "difference_largest": row.fraction(largest_difference(row)),
        "exact": None if row.exact is None else values(row.probe, row.exact),
        "true_error": {
            "cprbm": None if true is None else row.fraction(true.cprbm),
            "fea_bending": None if true is None else row.fraction(true.bending),
        },
        "scale": row.scale,
        "denominator": row.denominator,
        **_places(scene, row.probe),
    }


def _third(found: Third) -> Plain:
    """A row beside the solid: its extrapolated value, and by which fractions it is uncertain and others are off."""
    row = found.row
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "unit": row.unit,
        "solid": values(row.probe, found.solid),
        "uncertainty": row.fraction(found.uncertainty),
        "off": {
            "cprbm": row.fraction(found.cprbm),
            "fea_bending": row.fraction(found.bending),
            "fea": row.fraction(found.chosen),
        },
    }


def _critical_row(scene: Scene, row: CriticalRow) -> Plain:
    bounds = row.bounds
    claim = claim_of_critical(scene, row)
    off = None if claim is None else critical_difference(claim, row)
    both = {"cprbm": row.cprbm, "fea": row.fea}
    return {
        "probe": "critical",
        "stage": row.stage,
        "place": row.place,
        "unit": row.unit,
        **{name: None if found is None else plain(found.value) for name, found in both.items()},
        "loss": {name: None if found is None else found.loss.value for name, found in both.items()},
        "what": {name: None if found is None else found.what or None for name, found in both.items()},
        "released": {name: None if found is None else plain(released(found)) for name, found in both.items()},
        "gone_over": {name: plain(turned) for name, turned in row.turned.items()},
        "difference": plain(row.difference),
        "difference_same_theory": plain(row.same_theory),
        "uncertainty": {
            "cprbm": None if bounds is None else plain(bounds.cprbm),
            "fea": None if bounds is None else plain(bounds.fea),
            "theory": None if bounds is None else plain(bounds.theory),
            "fea_bending": None if bounds is None else plain(bounds.bending),
            "round_off": None if bounds is None else plain(bounds.round_off),
        },
        "claim": None if claim is None else claim.bound,
        "claim_value": None if claim is None else claim.value,
        "claim_met": None if claim is None or off is None else off <= claim.bound,
        "claim_difference": off,
        "allowed": row.allowed,
        "span": row.span,
        "verdict": row.word.value,
        "reason": name_of(row.judged[1]),
    }


def _reaction(found: WorkEnergyReaction) -> Plain:
    """The entry of ``work_energy`` for one station."""
    without = found.work_energy is None
    return {
        "stage": found.stage,
        "station": found.station,
        "branch": found.branch,
        "drive": found.drive,
        "unit": found.unit,
        "multiplier": found.multiplier,
        "work_energy": found.work_energy,
        "difference": found.difference,
        "allowed": None if without else found.allowed,
        "round_off": None if without else found.share(found.round_off),
        "truncation": None if without else found.share(found.truncation),
        "energies": None,  # all energies are those at perturbed stations
        "fea": found.fea,
        "difference_fea": found.from_fea,
        "changes_nearby": list(found.changes),
        "absence": None if found.absence is None else found.absence.name,
    }


def _places(scene: Scene, probe: Probe) -> Plain:
    return {"arc_length": arc_lengths(scene, probe).tolist()} if probe.quantity in STRESSES else {}
