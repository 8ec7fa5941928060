"""Sentences of a verdict: the finding, its place, the solver with the uncertainty, and the next command."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from comparisons.formats import at_station, distance_text, number, percent, with_unit
from comparisons.quantities import load_unit
from comparisons.stations import ends_at_critical, event_tolerance, problems, stations_of
from comparisons.verdict import (
    MIRRORED,
    PASSED,
    SOLVERS,
    Closing,
    CriticalRow,
    Reason,
    Row,
    Runs,
    Word,
    disagree_within_a_solver,
    error_ratios,
    mechanism,
    other_theory,
    passed_by,
    tally,
    true_errors,
)
from cprbm_scene import Answer, Ending, Loss, Scene

NAMES = {"cprbm": "the CPRBM", "fea": "the finite elements"}
_REMEDIES: Mapping[Loss | Ending, str] = {
    Loss.FOLD: 'a drive in place of the load, or `beyond = "jump"` in the stage',
    Loss.BIFURCATION: "a small `imperfection` of a beam, which selects a side",
    **dict.fromkeys((Loss.CONTACT, Loss.STOP, Loss.SLIP), '`beyond = "jump"` in the stage'),
    Ending.STEP_TOO_SMALL: "more links, a smaller last station, or for taut beams in bending the theory `shear`",
    Ending.BEAMS_CROSSED: "a station before the crossing, and a contact for every pair that touches",
    Ending.LEFT_BOUNDARY: "the formulation `auto`",
    Ending.NOT_CERTIFIED: "more links and elements",
}
"""Changes of the scene or the settings by the cause of an early end."""

_OPTIONS = {"cprbm": ("-n", "links"), "fea": ("--elements", "elements")}


def headline(runs: Runs, rows: Sequence[Row], decided: tuple[Word, Reason | None]) -> str:
    """Sentence on all rows: the deciding row, or the closest agreeing row."""
    word, reason = decided
    total = sum(row.word is not None for row in rows)
    mine = [row for row in rows if row.word is word]
    if not mine:
        return "No station has a row that can be compared."
    row = max((row for row in mine if row.reason is reason), key=pressure)
    if word is Word.AGREE:
        counts = f"All {total}" if len(mine) == total else f"{len(mine)} of {total}"
        found = "The only row agrees," if total == 1 else f"{counts} rows agree; the closest is"
        return f"{found} {place(runs.scene, row)}: {_measured(row)}.{_others(rows)}"
    verb = "differ" if word is Word.DIFFER else "are undecided"
    return f"{len(mine)} of {total} rows {verb}, first of all {place(runs.scene, row)}: {_explained(runs, row, reason)}"


def pressure(row: Row) -> float:
    """Largest share of a stated uncertainty that a row's differences use, or of the scale where none is stated."""
    if row.bounds is None:
        return math.inf
    return max(_share(row.difference, row.bounds.total), *(each.pressure for each in true_errors(row)), 0.0)


def place(scene: Scene, row: Row) -> str:
    """Probe, stage and station of a row."""
    return f"{row.probe.name} at {at_station(scene, row.stage, row.station)}"


def calibration_sentence(scene: Scene, rows: Sequence[Row]) -> str:
    """Comparison of true errors with stated ones in a sentence; empty without an exact value."""
    ratios = error_ratios(rows)
    tallies = {NAMES[solver]: tally(ratios, solver, worst=1) for solver in SOLVERS}
    beyond = [
        f"{name} exceed the stated error in {mine.rows - mine.within} of {mine.rows} rows, at most "
        f"{number(mine.worst[0].ratio)} times ({place(scene, mine.worst[0].row)})"
        for name, mine in tallies.items()
        if mine.rows > mine.within
    ]
    if beyond:
        return f"Beside the exact answer {'; '.join(beyond)}."
    return "All true errors beside the exact answer in bending are within the stated ones." if ratios else ""


def wider_limits(scene: Scene) -> str:
    """Probes with a wider limit than the scene's in a sentence; empty without any."""
    limits = {probe.name: scene.limit(probe) for probe in scene.probes}
    wider = ", ".join(f"{percent(limit)} for {name}" for name, limit in limits.items() if limit > scene.verdict_limit)
    allowed = f"The scene allows stated uncertainties of {percent(scene.verdict_limit)} of the scale; {wider}."
    return allowed if wider else ""


def theory_sentence(runs: Runs, rows: Sequence[Row]) -> str:
    """The largest step of theory, or why the CPRBM has no value in the other theory; empty without this run."""
    scene, other, own = runs.scene, runs.other, runs.answers["cprbm"]
    if other is None:
        refused = runs.absences.get(f"cprbm {other_theory(runs.theory)}")
        return f"The CPRBM does not answer in {other_theory(runs.theory)}: {refused}." if refused else ""
    parts, inside = [], f"In {other_theory(runs.theory)} the CPRBM"
    steps = [(row.theory / row.scale, row) for row in rows if math.isfinite(row.theory)]
    if steps:
        largest, row = max(steps, key=lambda step: step[0])
        parts.append(f"{inside}'s values are at most {percent(largest)} of the scale away ({place(scene, row)}).")
    if other.completed and not own.completed:
        parts.append(f"{inside} has a complete answer: `--theory {other_theory(runs.theory)}`.")
    elif own.completed and not other.completed:
        parts.append(f"{inside} has no complete answer: {_first(problem_sentences(scene, other))}.")
    return " ".join(parts)


def problem_sentences(scene: Scene, answer: Answer) -> tuple[str, ...]:
    """Problems of an answer in sentences, with stations in the units of the scene's file; empty if complete."""
    return problems(scene, answer, lambda stage, value: at_station(scene, stage, value))


def ended_sentence(runs: Runs, names: Iterable[str]) -> str:
    """The incomplete runs of some ``names``, and their problems; each problem once, and the compared runs first."""
    first = {
        name: _first(problem_sentences(runs.scene, runs.same_theory[name]))
        for name in sorted(names, key=lambda name: name not in SOLVERS)
    }
    parts = "; ".join(f"{', '.join(mine)}: {problem}" for problem, mine in _names_by_text(first).items())
    return f"Runs without a complete answer: {parts}."


def unreached_sentence(runs: Runs) -> str:
    """Number of the stations that the compared runs do not reach, and the critical point there; empty without any."""
    asked, reached, critical = len(stations_of(runs.scene)), len(runs.reached), runs.pair[0].critical
    if asked == reached:
        return ""
    end = critical[-1] if critical and all(map(ends_at_critical, runs.pair)) else None
    place = f", at {at_station(runs.scene, end.stage, end.value)} ({mechanism(end)})" if end else ""
    return f"The case ends early{place}: {asked - reached} of {asked} stations are not reached."


def remedy_sentence(answer: Answer) -> str:
    """Changes that may continue an answer beyond its early end; empty without advice."""
    cause = answer.critical[-1].loss if ends_at_critical(answer) else answer.ending
    return f"To go on: {_REMEDIES[cause]}." if cause in _REMEDIES else ""


def audit_sentence(solver: str, complaints: Sequence[str]) -> str:
    """The first complaint of an audit, and the number of further complaints."""
    return f"The audit of {solver}'s answer fails: {_first(complaints)}."


def critical_sentence(runs: Runs, row: CriticalRow) -> str:
    """Loads and mechanisms of a critical point in both solvers, and its word."""
    scene, places = runs.scene, []
    for (solver, name), one in zip(NAMES.items(), (row.cprbm, row.fea), strict=True):
        others = [each.end for each in runs.same_theory[solver].gone_over if each.end.stage == row.stage]
        points = others if one is None else [one]
        texts = " and ".join(f"{with_unit(scene, each.value, row.unit, 5)} ({mechanism(each)})" for each in points)
        beside = f", which passed {texts} and went on," if texts else ""
        places.append(f"nowhere in {name}{beside}" if one is None else f"{texts} in {name}")
    found = _names_by_text({run: found or "no such point" for run, found in row.mechanisms.items()})
    listed = "; ".join(f"{text} in {', '.join(names)}" for text, names in found.items())
    known, total = row.bounds is not None, math.nan if row.bounds is None else row.bounds.total
    sizes = (row.difference, total, row.allowed, row.theory)
    apart, stated, allowed, theories = (distance_text(scene, size, row.unit) for size in sizes)
    most, disagree = number(max(row.turned.values(), default=0.0), 3), disagree_within_a_solver(row.mechanisms)
    clauses = {
        f", {apart} apart against a stated {stated}, {allowed} allowed": known,
        f"; the theories are {theories} apart": known and math.isfinite(row.theory),
        "; the CPRBM has no such point in the other theory": known and row.theory == math.inf > row.largest,
        "; the loads agree, the mechanisms do not": row.kind_open,
        ", a fold that releases less than 0.1 % of the energy": row.is_faint,
        ", and the run without it ended before that load": not known and row.ended_before,
        f", and runs of one solver disagree ({listed}); refine both: `-n` and `--elements` twice as large":
            disagree and (known or not row.ended_before),
        f". {', '.join(row.turned)} passed it and went on along a state turned by {most} rad": bool(row.turned),
    }  # fmt: skip
    parts = " and ".join(places) + "".join(text for text, holds in clauses.items() if holds)
    return f"The branch ends in {row.stage} at {parts}: {row.word.value}."


def closing_sentence(scene: Scene, closing: Closing) -> str:
    """Loads at which a contact closes in both solvers."""
    stage, contact, pair, bounds = closing
    unit = load_unit(scene, stage.name)
    loads = " and ".join(
        f"{with_unit(scene, value, unit, 5)} in {name}" for value, name in zip(pair, NAMES.values(), strict=True)
    )
    stated, allowed = (distance_text(scene, size, unit) for size in (bounds.total, event_tolerance(scene, stage)))
    return f"{contact} closes in {stage.name} at {loads}, against a stated {stated}, {allowed} allowed: DIFFER."


def passed_sentences(runs: Runs, rows: Sequence[Row]) -> Iterator[str]:
    """Passed critical points of both compared runs before the first differing row."""
    differing = [row for row in rows if row.word is Word.DIFFER]
    if not differing:
        return
    stages = {stage.name: stage for stage in runs.scene.stages}
    stage = stages[differing[0].stage]
    before, index = [*stages][: [*stages].index(stage.name)], stage.stations.index(differing[0].station)
    for name, answer in zip(NAMES.values(), runs.pair, strict=True):
        earlier = [one for one in answer.gone_over if one.end.stage in before]
        mine = [one for one in answer.gone_over if one.end.stage == stage.name]
        for one in (*earlier, *mine[: passed_by(runs.scene, stage, answer, index)])[-1:]:
            yield (
                f"Before that {name} passed a critical point ({mechanism(one.end)}) at "
                f"{at_station(runs.scene, one.end.stage, one.end.value)} and went on along a state turned by "
                f"{number(one.turned, 3)} rad."
            )


def _explained(runs: Runs, row: Row, reason: Reason | None) -> str:
    """Why the row does not agree, and the next command."""
    contacts = " and ".join(sorted((row.events.unsettled | row.events.contradictory) - {PASSED, MIRRORED}))
    match reason:
        case Reason.VALUES:
            return f"{_measured(row)} ({_parts(row)}). A third opinion: `--solver cprbm,fea,solid`."
        case Reason.EXACT:
            worst = max(true_errors(row), key=lambda each: each.ratio)
            return (
                f"{NAMES[worst.solver]} lie {_of_scale(worst.true, row)} of the scale from the exact answer, "
                f"{number(worst.ratio)} times the stated {_of_scale(worst.stated, row)}."
            )
        case Reason.EVENTS:
            cause = (
                f"{contacts} presses in one solver and is open in the other"
                if contacts
                else ("one solver alone has passed a critical point")
            )
            return f"{cause}, and {_measured(row)}. `solve --solver fea -v` lists the events of one."
        case Reason.RUN_ENDED:
            names = ", ".join(row.missing)
            return f"{_measured(row)}, and the uncertainty is not known there: no answer of {names}."
        case Reason.BRANCH:
            return "the runs are on different branches or mirror images there. An imperfection would choose one."
        case Reason.EVENT:
            cause = f"{contacts} presses in some of the runs only" if contacts else "some runs have no such value"
            return (
                f"{cause}: the station lies between their loads of one event. Ask for a station beside it, or refine."
            )
        case Reason.THEORY:
            return (
                f"bending and shear differ by {_of_scale(row.theory, row)} of the scale, more than "
                f"{percent(runs.scene.limit(row.probe))}; in bending the solvers agree to "
                f"{_of_scale(row.difference, row)}. Use the value in shear: `--theory shear`."
            )
        case Reason.NOT_UNIQUE:
            return f"{row.probe.of} shares its force with a joint or contact beside it, and the sums agree."
        case _:
            return _coarse(runs, row)


def _names_by_text(texts: Mapping[str, str]) -> dict[str, list[str]]:
    """Names with the same text, by the text; ``texts`` by name."""
    return {text: [name for name, own in texts.items() if own == text] for text in texts.values()}


def _first(sentences: Sequence[str]) -> str:
    """The first sentence without its full stop, and the number of further sentences."""
    more = f" (and {len(sentences) - 1} more)" if len(sentences) > 1 else ""
    return sentences[0].rstrip(".") + more


def _coarse(runs: Runs, row: Row) -> str:
    """The solver with too large an uncertainty, and a sufficient size."""
    assert row.bounds is not None
    limit = runs.scene.limit(row.probe)
    needed, room = [], 0.4 * limit * row.scale
    for solver, (option, key) in _OPTIONS.items():
        size, stated = runs.same_theory[solver].settings.get(key), getattr(row.bounds, solver)
        if isinstance(size, int) and stated > room:
            needed.append(f"{option} {math.ceil(size * math.sqrt(stated / room) / 10.0) * 10}")
    hint = f" `{' '.join(needed)}` would do." if needed else " Refine both solvers."
    whose = NAMES["cprbm" if row.bounds.cprbm >= row.bounds.fea else "fea"]
    return (
        f"the stated uncertainty is {_of_scale(row.bounds.total, row)} of the scale, more than {percent(limit)}, most "
        f"of it of {whose} ({_parts(row)}).{hint}"
    )


def _others(rows: Sequence[Row]) -> str:
    """Undecided rows of a case that agrees, by probe and reason."""
    found = Counter((row.probe.name, row.reason.value) for row in rows if row.word is Word.UNDECIDED and row.reason)
    parts = ", ".join(f"{count} of {name} ({reason})" for (name, reason), count in found.items())
    return f" Undecided rows: {parts}." if parts else ""


def _measured(row: Row) -> str:
    """The difference and its stated uncertainty as shares of the scale."""
    if row.bounds is None:
        return f"the values differ by {_of_scale(row.difference, row)} of the scale"
    return f"{_of_scale(row.difference, row)} of the scale against a stated {_of_scale(row.bounds.total, row)}"


def _parts(row: Row) -> str:
    assert row.bounds is not None
    return f"CPRBM {_of_scale(row.bounds.cprbm, row)}, FEA {_of_scale(row.bounds.fea, row)}"


def _of_scale(value: float, row: Row) -> str:
    return percent(_share(value, row.scale))


def _share(part: float, whole: float) -> float:
    if whole > 0.0:
        return part / whole
    return 0.0 if part == 0.0 else math.inf
