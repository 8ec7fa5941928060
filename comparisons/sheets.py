"""What a comparison's tables say, cell by cell, for the screen and for the page alike."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from enum import Enum

from comparisons.audit import Audit
from comparisons.branch_sheets import of_branches, of_criticals, of_ends
from comparisons.case import Comparison
from comparisons.claims import as_claimed, standings
from comparisons.display_units import at_station, display_units, load_column, load_text
from comparisons.documents import worst
from comparisons.formats import component_names, components, number, percent, vector
from comparisons.geometry import bentness
from comparisons.paper_sheets import of_paper
from comparisons.quantities import norm, unit_of
from comparisons.reaction_sheets import of_reactions
from comparisons.sentences import place
from comparisons.sheet import Sheet
from comparisons.steps import Steps, contact_model, largest_difference, steps_of
from comparisons.third import of_thirds
from comparisons.third import sentence as beside_the_solid
from comparisons.tolerances.search import Tolerance
from comparisons.tolerances.settled import extrapolation_note
from comparisons.verdict.calibration import EXACT_FACTOR, SOLVERS, ErrorRatio, error_ratios, tally, true_errors
from comparisons.verdict.rows import ROUND_OFF, Row
from comparisons.verdict.scales import probe_scales
from comparisons.verdict.station_events import Place
from comparisons.verdict.words import Reason, Word
from cprbm_scene import Answer, Scene, Stage
from cprbm_scene.answer import Array


class Subject(Enum):
    """What a table is about; the value is its heading."""

    VALUES = "What both answer"
    VERDICT = "What the verdict rests on"
    CLAIMS = "What the source claims"
    REACTIONS = "Reactions of the drives"
    STRESS = "Stress along the beams"
    DIFFERENCE = "What the difference is made of"
    CERTIFICATES = "Certificates and audit"
    SECONDS = "Run time"


def of_comparison(compared: Comparison) -> tuple[Sheet, ...]:
    """All tables of a comparison: values at every station that is shown, all else at the last one."""
    return tuple(sheet for sheets in by_subject(compared).values() for sheet in sheets)


def by_subject(compared: Comparison) -> dict[Subject, tuple[Sheet, ...]]:
    """The same, each by what it is about; in the order in which they are read."""
    rows = last_rows(compared)
    found = {
        Subject.VALUES: (
            of_tolerances(compared.scene, compared.tolerances),
            of_criticals(compared),
            of_branches(compared),
            *(_values(compared, each) for each in shown_rows(compared)),
        ),
        Subject.VERDICT: (_verdicts(compared, rows), _true_errors(compared, rows)),
        Subject.CLAIMS: (claims(compared),),
        Subject.REACTIONS: of_reactions(compared),
        Subject.STRESS: (_stresses(compared.scene, rows),),
        Subject.DIFFERENCE: (_steps(compared, rows), of_paper(compared), of_thirds(compared)),
        Subject.CERTIFICATES: (_certificates(compared),),
        Subject.SECONDS: (_seconds(compared),),
    }
    return {subject: tuple(sheet for sheet in sheets if sheet.rows) for subject, sheets in found.items()}


def of_answer(scene: Scene, answer: Answer, tolerances: tuple[Tolerance, ...] = ()) -> tuple[Sheet, ...]:
    """All tables of one solver's answer, and how its N was found."""
    answered = (_answered(scene, answer, stage) for stage in scene.stages)
    found = (of_tolerances(scene, tolerances), *answered, of_ends(scene, answer), _events(scene, answer))
    return tuple(sheet for sheet in found if sheet.rows)


def of_tolerances(scene: Scene, tolerances: tuple[Tolerance, ...]) -> Sheet:
    """How N was found for a tolerance."""
    body = tuple(
        (
            found.solver,
            str(found.n),
            ", ".join(str(n) for n in found.extrapolated) or "–",
            "–" if found.worst is None else percent(found.worst.fraction),
            "–"
            if found.worst is None
            else f"{found.worst.probe} at {load_text(scene, found.worst.stage, found.worst.station)}",
            "yes" if found.met else "no",
            ", ".join(str(n) for n in found.solved),
        )
        for found in tolerances
    )
    asked = percent(tolerances[0].asked) if tolerances else ""
    return Sheet(
        f"N for a tolerance of {asked}",
        ("solver", "N", "extrapolated from", "largest u", "of", "met", "solved"),
        body,
        "N: links or elements per beam; of an extrapolated answer the finest. "
        + " ".join(extrapolation_note(found.extrapolated, found.probes) for found in tolerances if found.extrapolated),
    )


def shown_stations(scene: Scene, reached: Sequence[tuple[str, float]]) -> tuple[tuple[str, float], ...]:
    """Of the stages and stations that were ``reached`` those to show, in order: what the scene names, and the last."""
    named = {(stage.name, value) for stage in scene.stages for value in stage.shown}
    return tuple(station for place, station in enumerate(reached) if station in named or place == len(reached) - 1)


def shown_rows(compared: Comparison) -> tuple[tuple[Row, ...], ...]:
    """The rows of every station that is shown."""
    reached = tuple(dict.fromkeys((row.stage, row.station) for row in compared.rows))
    return tuple(
        tuple(row for row in compared.rows if (row.stage, row.station) == station)
        for station in shown_stations(compared.scene, reached)
    )


def last_rows(compared: Comparison) -> tuple[Row, ...]:
    """The rows of the last station that has any."""
    return (shown_rows(compared) or ((),))[-1]


def explanation(compared: Comparison) -> tuple[str, ...]:
    """For each claim a sentence that says what our difference is made of, at its worst station; what a solid says."""
    sentences = []
    for standing in standings(compared.scene, compared.rows):
        claim = standing.claim
        if not isinstance(standing.worst, Row) or claim.value is not None:
            continue
        row = as_claimed(standing.worst)
        steps = steps_of(compared.runs, row)
        if steps is None:
            continue
        sentences.append(
            f"{place(compared.scene, row)}: our difference of {share(row, row.difference)} is the "
            f"finite elements' own step of theory, {share(row, steps.stretch)} from bending to stretch and "
            f"{share(row, steps.shear)} from stretch to shear, and {_within_one_theory(compared, row, steps)}; "
            f"the source's figure of {percent(claim.bound)} is not ours to approach."
        )
    return tuple(filter(None, (*sentences, beside_the_solid(compared))))


def _within_one_theory(compared: Comparison, row: Row, steps: Steps) -> str:
    """What is left of a difference without the theories' steps, and what the contact's formulation has in it."""
    own, stated = share(row, steps.own), share(row, row.bounds.same_theory if row.bounds else math.nan)
    if compared.runs.auto is not None:
        return (
            f"{own} between the two methods within one theory and {share(row, steps.contact)} in the contact model, "
            f"from paper to auto, for which together the runs state {stated}"
        )
    said = f"{own} between the two methods within one theory, for which the two discretisations state {stated}"
    model = contact_model(compared.runs, row)
    if model is None:
        return said
    return f"{said}; the contact model of paper would put the CPRBM {share(row, model)} away"


def _values(compared: Comparison, rows: tuple[Row, ...]) -> Sheet:
    runs = compared.runs
    known = any(row.exact is not None for row in rows)
    last = not rows or rows[-1] is compared.rows[-1]
    units, body = row_units(compared.scene, rows), []
    for row in rows:
        factor, unit = units[row.unit]
        body.append(
            (
                row.probe.name,
                unit,
                _vector(row, row.cprbm, factor),
                _vector(row, row.fea, factor),
                *(("–" if row.exact is None else _vector(row, row.exact, factor),) if known else ()),
                share(row, row.difference),
                *(
                    (share(row, row.bounds.cprbm), share(row, row.bounds.fea), _in_bending(row, row.bounds.theory))
                    if row.bounds
                    else ("–", "–", "–")
                ),
            )
        )
    where = "no station"
    if rows:
        where = at_station(compared.scene, rows[0].stage, rows[0].station)
    return Sheet(
        f"{compared.scene.title or compared.scene.name}: {where}",
        (
            "probe",
            "unit",
            "CPRBM",
            "FEA",
            *(("exact (bending)",) if known else ()),
            "difference",
            "u CPRBM",
            "u FEA",
            "theory",
        ),
        tuple(body),
        f"FEA: theory {runs.kinematics}. Fractions of the FEA's value, or of the probe's largest value where "
        "that may vanish; uncertainties from further discretisations of each solver."
        + (f" No exact values: {runs.exact_absence}" if runs.exact_absence and last else ""),
    )


def _verdicts(compared: Comparison, rows: tuple[Row, ...]) -> Sheet:
    verdict = compared.verdict
    judged = {
        (row.where, row.probe.name): (word, reason)
        for row, word, reason in zip(compared.rows, verdict.words, verdict.reasons, strict=True)
    }
    body = []
    for row in rows:
        body.append(
            (
                row.probe.name,
                share(row, row.difference),
                share(row, row.bounds.total) if row.bounds else "–",
                _in_bending(row, row.same_theory),
                _in_bending(row, row.bounds.same_theory) if row.bounds else "–",
                share(row, row.bounds.round_off) if row.bounds else "–",
                _judgement(row, *judged[row.where, row.probe.name]),
            )
        )
    return Sheet(
        "What the verdict rests on",
        ("probe", "difference", "may be", "within bending", "may be", "round-off", "says"),
        tuple(body),
        "Both differences must stay within what may be; within bending the FEA shares the CPRBM's theory.",
    )


def _in_bending(row: Row, value: float) -> str:
    """A fraction that needs the finite elements in ``bending``; a dash where that run lacks the value."""
    return "–" if row.bounds is None or row.bounds.bending is None else share(row, value)


def _judgement(row: Row, word: Word | None, reason: Reason | None) -> str:
    """Word and reason of a row, or why the row takes no part."""
    if word is None:
        return "takes no part" if row.place is Place.COMPARED else row.place.value
    return word.value if reason is None else f"{word.value} ({reason.value})"


def _true_errors(compared: Comparison, rows: tuple[Row, ...]) -> Sheet:
    """True errors of both in ``bending``, each beside what is stated of it."""
    body = []
    for row in rows:
        found = tuple(true_errors(row))
        if found:
            cells = ((share(row, each.true), share(row, each.stated), number(each.ratio), each.word) for each in found)
            body.append((row.probe.name, *(cell for four in cells for cell in four)))
    return Sheet(
        "True errors in bending, beside the exact answer",
        ("probe", *(f"{head} {name}" for name in ("CPRBM", "FEA") for head in ("error", "stated", "ratio", "says"))),
        tuple(body),
        f"{_over_all(error_ratios(compared.rows))} A ratio is the true error over the stated one with round-off: above "
        f"1 it is beyond, above {EXACT_FACTOR:g} far beyond, and then the row differs.",
    )


def _over_all(found: tuple[ErrorRatio, ...]) -> str:
    """How many of the rows of all stations have true errors within the stated ones, in a sentence."""
    said = []
    for solver, name in zip(SOLVERS, ("CPRBM", "FEA"), strict=True):
        mine = tally(found, solver)
        over = "" if mine.over is None else f", stated over true {number(mine.over)} in the median"
        said.append(f"{name} within the stated error in {mine.within} of {mine.rows} rows{over}")
    return f"Over all stations: {'; '.join(said)}."


def claims(compared: Comparison) -> Sheet:
    """What the source claims, beside what comes out here."""
    body = tuple(
        (
            standing.claim.text or standing.claim.probe,
            ("" if standing.claim.value is None else f"{number(standing.claim.value)} ± ")
            + percent(standing.claim.bound),
            percent(standing.difference),
            at_station(compared.scene, standing.worst.stage, standing.worst.station),
            f"{standing.met} of {standing.stations}",
            "met" if standing.holds else "not met",
        )
        for standing in standings(compared.scene, compared.rows, compared.criticals)
    )
    return Sheet(
        "Claims of the source",
        ("claim", "theirs", "ours at worst", "at", "met at", ""),
        body,
        "They stand beside our figures and have no part in the verdict. Of a force or a moment the difference is "
        "here a fraction of the value at its station; of a value that is claimed, the CPRBM's distance from it.",
    )


def _stresses(scene: Scene, rows: tuple[Row, ...]) -> Sheet:
    rows = tuple(row for row in rows if row.probe.quantity == "bending_stress")
    units, body = row_units(scene, rows), []
    for row in rows:
        factor, unit = units[row.unit]
        beam = scene.beams[row.probe.of]
        body.append(
            (
                row.probe.name,
                unit,
                _vector(row, row.cprbm, factor),
                _vector(row, row.fea, factor),
                share(row, largest_difference(row)),
                share(row, row.difference),
                percent(bentness(beam) / 3.0),
            )
        )
    return Sheet(
        "Bending stress along the beams",
        ("probe", "unit", "CPRBM", "FEA", "of the largest", "anywhere", "t/(3R)"),
        tuple(body),
        "Anywhere: a thickness or more from held ends and from where contacts end. Both solvers use the straight-beam "
        "formula; in a beam of initial radius R the true stress at the inner edge is larger by about t/(3R).",
    )


def _steps(compared: Comparison, rows: tuple[Row, ...]) -> Sheet:
    runs = compared.runs
    in_paper = runs.auto is not None
    models = [contact_model(runs, row) for row in rows]
    shown = any(model is not None for model in models)
    body = []
    for row, model in zip(rows, models, strict=True):
        steps = steps_of(runs, row)
        if steps is None:
            continue
        contact = steps.contact if in_paper else math.nan if model is None else model
        body.append(
            (
                row.probe.name,
                share(row, row.difference),
                *((share(row, contact),) if shown else ()),
                share(row, steps.own),
                share(row, steps.stretch),
                share(row, steps.shear),
            )
        )
    note = "Components along the difference; each line adds up."
    if shown:
        note += (
            " Contact model: the CPRBM's step from paper to auto."
            if in_paper
            else " Contact model: the CPRBM's distance in paper from auto, which is no part of the sum."
        )
    elif runs.paper is not None and not runs.paper.completed:
        note += f" The formulation paper ended early: {runs.paper.ending.value}."
    return Sheet(
        "What the difference is made of",
        (
            "probe",
            "difference",
            *(("contact model",) if shown else ()),
            "CPRBM to bending",
            "bending to stretch",
            "stretch to shear",
        ),
        tuple(body),
        note,
    )


def _certificates(compared: Comparison) -> Sheet:
    solid = compared.runs.solid[-1:] if compared.runs.solid is not None else ()  # its finest mesh
    names = ("cprbm", f"fea {compared.runs.kinematics}", *("solid" for _ in solid))
    answers = (compared.runs.cprbm[0], compared.runs.reference, *solid)
    found = [worst(tuple(station.certificate for station in answer.stations)) for answer in answers]
    body = [
        ("ending", *(answer.ending.name for answer in answers)),
        ("stations", *(str(len(answer.stations)) for answer in answers)),
    ]
    keys = (
        ("residual", "residual"),
        ("residual_floor", "round-off floor of the residual"),
        ("violation", "violation of joints"),
        ("penetration", "penetration / thickness"),
        ("complementarity", "gap × force"),
        ("force_balance", "|ΣF|"),
        ("moment_balance", "|ΣM|"),
        ("smallest_curvature", "smallest curvature of the energy"),
    )
    body.extend((label, *("–" if cert is None else number(cert[key]) for cert in found)) for key, label in keys)
    audits = [compared.audits.get(answer.solver) for answer in answers]
    body.append(("audit", *(_audited(one) for one in audits)))
    body.append(
        (
            "stated moments less those of all that acts beyond",
            *("–" if one is None or not one.stations else number(one.scaled) for one in audits),
        )
    )
    body.append(("iterations", *("–" if cert is None else str(cert["iterations"]) for cert in found)))
    return Sheet(
        "Certificates",
        ("worst of all stations", *names),
        tuple(body),
        "All numbers but iterations are relative to a scale of the problem; see docs/certificate.md."
        + "".join(f" The solid is {answer.notes[0]}." for answer in solid if answer.notes),
    )


def _seconds(compared: Comparison) -> Sheet:
    """By themselves, since they are others with every run."""
    runs = compared.runs
    answers = {"CPRBM": runs.cprbm[0], f"FEA ({runs.kinematics})": runs.reference}
    answers |= {} if runs.exact is None else {"exact (bending)": runs.exact}
    answers |= {f"solid, {one.settings['elements']} along": one for one in runs.solid or ()}
    return Sheet(
        "Seconds",
        ("answer", "stations", "seconds"),
        tuple((name, str(len(answer.stations)), number(answer.seconds)) for name, answer in answers.items()),
        "From the scene to certified answers, by each solver's own clock.",
    )


def _audited(found: Audit | None) -> str:
    if found is None or not found.stations:
        return "–"
    return "holds" if not found.complaints else f"{len(found.complaints)} complaints"


def _answered(scene: Scene, answer: Answer, stage: Stage) -> Sheet:
    """All stations of a stage, with a column for every component."""
    stations = [station for station in answer.stations if station.stage == stage.name]
    scales = probe_scales(scene, (answer,))
    columns: dict[str, list[str]] = {}
    probes = scene.probes_in(stage.name)
    units = display_units(
        scene,
        (
            (unit_of(scene, probe, stage), max(norm(probe.quantity, at.values[probe.name]) for at in stations))
            for probe in probes
            if stations
        ),
    )
    for probe in probes:
        found = [station.values[probe.name] for station in stations]
        factor, unit = units.get(unit_of(scene, probe, stage), (1.0, ""))
        floor = ROUND_OFF * scales[stage.name, probe.name]
        texts = [dict(components(probe.quantity, values, factor, floor)) for values in found]
        for name in component_names(probe.quantity):
            columns[f"{f'{probe.name} {name}'.rstrip()}, {unit}"] = [each.get(name, "open") for each in texts]
    heading, loads = load_column(scene, stage, [station.value for station in stations])
    return Sheet(
        f"{scene.title or scene.name}: {stage.name}, {answer.solver}",
        (heading, *columns),
        tuple(zip(loads, *columns.values(), strict=True)),
        f"{answer.ending.name}: {answer.sentence or answer.ending.value}"
        if stations and stations[-1] is answer.stations[-1]
        else "",
    )


def _events(scene: Scene, answer: Answer) -> Sheet:
    return Sheet(
        "Events",
        ("stage", "contact", "what", "at"),
        tuple((e.stage, e.contact, e.kind, load_text(scene, e.stage, e.value)) for e in answer.events),
    )


def row_units(scene: Scene, rows: Sequence[Row]) -> Mapping[str, tuple[float, str]]:
    """Displayed units of the values of rows, by SI unit; round-off counts as zero."""
    sizes = ((row, norm(row.probe.quantity, value)) for row in rows for value in (row.cprbm, row.fea))
    return display_units(scene, ((row.unit, 0.0 if size < ROUND_OFF * row.scale else size) for row, size in sizes))


def share(row: Row, value: float, digits: int = 3) -> str:
    """A difference or uncertainty, in the row's unit, as a share of the row's denominator; round-off prints as 0."""
    return percent(row.fraction(0.0 if abs(value) < ROUND_OFF * row.scale else value), digits)


def _vector(row: Row, values: Array, factor: float) -> str:
    return vector(values, factor, ROUND_OFF * row.scale)
