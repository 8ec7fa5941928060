"""The documented JSON: plain data with stable keys, SI units, and null for a missing value."""

from typing import Any

from comparisons.audit import Audit
from comparisons.case import Comparison
from comparisons.opinions import claim_met, claim_of, claimed_difference, contact_model, thirds_of
from comparisons.present.columns import Plain, follow, plain
from comparisons.quantities import arc_lengths, unit_of
from comparisons.reactions import WorkEnergyReaction
from comparisons.stations import CERTIFICATE_NUMBERS
from comparisons.tolerances import Tolerance
from comparisons.verdict import CriticalRow, Row, released
from cprbm_scene import STRESSES, Answer, Array, Critical, Probe, Scene


def comparison(compared: Comparison) -> Plain:
    """One case of ``compare``."""
    scene, runs, verdict = compared.scene, compared.runs, compared.verdict
    answers = {name: runs.answers[name] for name in ("cprbm", "fea", "exact") if name in runs.answers}
    if runs.solids:
        answers["solid"] = runs.solids[-1]  # the finest mesh
    return {
        "case": scene.name,
        "verdict": verdict.word.value,
        "reason": follow(verdict, "reason.value"),
        "sentence": verdict.sentence,
        "theory": runs.theory,
        "other_theory": None if runs.other is None else solver(runs.other),
        "solvers": {
            name: {**solver(answer, compared.audits.get(name)), **_search(compared.tolerances, name)}
            for name, answer in answers.items()
        },
        "rows": [_row(compared, row) for row in compared.rows],
        "critical": [_critical_row(scene, each) for each in compared.criticals],
        "branches": [
            {
                "stage": each.stage,
                "branch": each.number,
                "from": each.first,
                "to": each.last,
                "stations": each.stations,
                "near_critical": each.near,
                "verdict": follow(each, "word.value"),
            }
            for each in verdict.branches
        ],
        "work_energy": [_reaction(each) for each in compared.reactions],
        **({} if not runs.solids else {"solid": [_third(each) for each in thirds_of(compared)]}),
    }


def solution(
    scene: Scene, answer: Answer, tolerances: tuple[Tolerance, ...] = (), audited: Audit | None = None
) -> Plain:
    """One case of ``solve``: the shape of ``compare`` with the column of one solver and no verdict."""
    return {
        "case": scene.name,
        "solvers": {answer.solver: {**solver(answer, audited), **_search(tolerances, answer.solver)}},
        "rows": [
            {
                "probe": probe.name,
                "stage": station.stage,
                "station": station.value,
                "branch": station.branch,
                "unit": unit_of(scene, probe, station.stage),
                answer.solver: values(probe, station.values[probe.name]),
                **_places(scene, probe),
            }
            for station in answer.stations
            for probe in scene.probes_in(station.stage)
        ],
    }


def solver(answer: Answer, audited: Audit | None = None) -> Plain:
    """Ending, settings, worst certificate, audit and events of an answer; the audit is null without an audit."""
    return {
        "ending": answer.ending.name,
        "sentence": answer.sentence,
        "seconds": plain(answer.seconds),
        "settings": plain(answer.settings),
        "certificate": worst_certificate(answer),
        "audit": None
        if audited is None or not audited.stations
        else {
            "holds": not audited.complaints,
            "complaints": list(audited.complaints),
            "remarks": list(audited.crossings),
            "stations": audited.stations,
            "unbalance": plain(audited.unbalance),
            "scaled_unbalance": plain(audited.scaled),
            "smallest_curvature": None,
        },
        "stations": len(answer.stations),
        "events": [
            {"stage": event.stage, "contact": event.contact, "kind": event.kind, "value": plain(event.value)}
            for event in answer.events
        ],
        "critical": [critical(each) for each in answer.critical],
        "gone_over": [{**critical(each.end), "turned": plain(each.turned)} for each in answer.gone_over],
        "notes": list(answer.notes),
    }


def worst_certificate(answer: Answer) -> Plain | None:
    """The least reassuring value of every number over the stations; None without a station."""
    found = [station.certificate for station in answer.stations]
    if not found:
        return None
    return {
        "holds": all(each.holds for each in found),
        **{key: plain(max(getattr(each, key) for each in found)) for key in CERTIFICATE_NUMBERS},
        "smallest_curvature": plain(min(each.smallest_curvature for each in found)),
        "iterations": sum(each.iterations for each in found),
        "failures": [failure for each in found for failure in each.failures],
    }


def critical(found: Critical) -> Plain:
    """Critical point of an answer."""
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


def values(probe: Probe, found: Array) -> Any:  # noqa: ANN401 - a number, a list or None
    """Values of a probe: a number, a list of several numbers, None without a value."""
    numbers = plain(found)
    return (numbers or None) if found.size > 1 or probe.quantity in STRESSES else next(iter(numbers), None)


def _search(tolerances: tuple[Tolerance, ...], name: str) -> Plain:
    """The search for N of a solver; empty without a search."""
    found = next((each for each in tolerances if each.solver == name), None)
    if found is None:
        return {}
    row, links = found.worst, found.solver == "cprbm"
    return {
        "tolerance": {
            "asked": found.asked,
            "met": found.met,
            "links": found.n if links else None,
            "elements": None if links else found.n,
            "estimate": None if row is None else plain(found.fraction),
            "probe": follow(row, "probe.name"),
            "stage": follow(row, "stage"),
            "station": follow(row, "station"),
            "extrapolated": list(found.extrapolated) or None,
            "extrapolated_probes": list(found.probes),
            "solved": list(found.solved),
        }
    }


def _row(compared: Comparison, row: Row) -> Plain:
    scene, runs, bounds, true = compared.scene, compared.runs, row.bounds, row.true_errors
    claim, model = claim_of(scene, row), contact_model(runs, row)
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "branch": row.branch,
        "place": "between events" if row.events.between else "compared",
        "unit": row.unit,
        "cprbm": values(row.probe, row.cprbm),
        "fea": values(row.probe, row.fea),
        "difference": row.fraction(row.difference),
        "uncertainty": {
            "cprbm": None if bounds is None else row.fraction(bounds.cprbm),
            "fea": None if bounds is None else row.fraction(bounds.fea),
            "theory": row.fraction(row.theory),
            "round_off": None if bounds is None else row.fraction(bounds.round_off),
        },
        "other_theory": None if row.other is None else values(row.probe, row.other),
        "claim": None if claim is None else claim.bound,
        "claim_value": None if claim is None else claim.value,
        "claim_met": claim_met(claim, row),
        "claim_difference": None if claim is None else claimed_difference(claim, row),
        "contact_model": None if model is None else row.fraction(model),
        "difference_largest": row.fraction(row.largest_difference),
        "exact": None if row.exact is None else values(row.probe, row.exact),
        "true_error": {
            "cprbm": None if true is None else row.fraction(true.cprbm),
            "fea_bending": None if true is None else row.fraction(true.fea),
        },
        "scale": row.scale,
        "denominator": row.denominator,
        **_places(scene, row.probe),
        "verdict": follow(row, "word.value"),
        "reason": follow(row, "reason.value"),
    }


def _third(row: Row) -> Plain:
    """A row beside the solid: the extrapolated value, its uncertainty, and distances from it as fractions."""
    found = row.third
    assert found is not None
    off = {"cprbm": found.cprbm, "fea": found.fea, "other_theory": found.other}
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "unit": row.unit,
        "solid": values(row.probe, found.solid),
        "uncertainty": row.fraction(found.uncertainty),
        "off": {name: row.fraction(size) for name, size in off.items()},
    }


def _critical_row(scene: Scene, row: CriticalRow) -> Plain:
    claim = claim_of(scene, row)
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
        "uncertainty": {
            name: plain(follow(row, path))
            for name, path in (
                ("cprbm", "bounds.cprbm"),
                ("fea", "bounds.fea"),
                ("round_off", "bounds.round_off"),
                ("theory", "theory"),
            )
        },
        "claim": None if claim is None else claim.bound,
        "claim_value": None if claim is None else claim.value,
        "claim_met": claim_met(claim, row),
        "claim_difference": None if claim is None else claimed_difference(claim, row),
        "allowed": row.allowed,
        "span": row.span,
        "verdict": row.word.value,
        "reason": follow(row.judged[1], "value"),
    }


def _reaction(found: WorkEnergyReaction) -> Plain:
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
