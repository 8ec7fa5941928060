"""Tables and documented JSON of a benchmark."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

from comparisons.bench.contenders import OURS, Clocked, Contender, Name
from comparisons.bench.errors import uncertainties
from comparisons.bench.running import FIT_FROM, NO_WORSE, Benchmark, Clock, LeftOut, Timing, trend
from comparisons.bench.standings import CLOCKED, Standing, ratio_key, ratios, standings
from comparisons.choices import Count
from comparisons.formats import number, percent
from comparisons.plain import Plain, plain
from comparisons.present.columns import Column, Table, records_of, table_of, without_empty

_OF_CLOCK: dict[Clock, str] = {"wall": "", "cpu": " of the processor"}
_TITLES: dict[Clocked, str] = {"both": "set-up and solve", "solve": "solve alone"}

_COLUMNS: tuple[Column[Timing], ...] = (
    Column("method", lambda row: row.contender.label),
    Column("N", lambda row: sized(row.count)),
    Column("set-up", lambda row: row.median("set-up"), number),
    Column("solve", lambda row: row.median("solve"), number),
    Column("spread", lambda row: row.spread, lambda value: number(value, 2)),
    Column("repeats", lambda row: len(row.seconds)),
    Column("places", lambda row: row.errors.get("places"), percent),
    Column("forces", lambda row: row.errors.get("forces"), percent),
    Column("iterations", lambda row: row.iterations),
    Column("per station", lambda row: row.iterations_per_station, number),
    Column("ended", lambda row: ended(row)),
)

_KEYS: tuple[Column[Timing], ...] = (
    Column("method", lambda row: row.contender.method),
    Column("formulation", lambda row: row.contender.formulation),
    Column("n", lambda row: plain(row.count)),
    Column("setup_seconds", lambda row: row.median("set-up")),
    Column("seconds", lambda row: row.median("solve")),
    Column("spread", lambda row: row.spread),
    Column("error", lambda row: row.errors.get("places")),
    Column("force_error", lambda row: row.errors.get("forces")),
    Column("ended", lambda row: ended(row)),
    Column("why", lambda row: row.outcome.why),
    Column("counts", lambda row: row.counts),
    Column("residual", lambda row: plain(row.outcome.residual)),
    Column("repeats", lambda row: len(row.seconds)),
    Column("iterations", lambda row: row.iterations),
    Column("iterations_by_station", lambda row: list(row.outcome.iterations)),
)


def tables_of(measured: Benchmark) -> tuple[Table, ...]:
    """All tables: times and errors, the fastest methods, ratios, growth, and everything left out."""
    timings = table_of(f"{measured.scene.title or measured.scene.name}: time against error", _COLUMNS,
                       measured.timings, _note(measured))  # fmt: skip
    fastest = [_fastest(measured, clocked) for clocked in CLOCKED]
    found = (timings, *fastest, _ratios(measured), _trends(measured), _left_out(measured.left_out))
    return tuple(table for table in found if table.rows)


def sized(count: Count) -> str:
    """N in a table."""
    return str(count) if isinstance(count, int) else ", ".join(map(str, count.values()))


def ended(timing: Timing) -> str:
    """Name of the ending of a row's runs."""
    return "WORSE" if timing.worse else timing.outcome.ended


def _note(measured: Benchmark) -> str:
    extent = "the whole scene" if measured.plan.whole else "the last load, from the state without stress"
    off = {measure: percent(u) for measure, u in uncertainties(measured.scene, measured.reference).items() if u > 0.0}
    known = f"; itself known to {', '.join(f'{u} ({measure})' for measure, u in off.items())}" if off else ""
    peers = (
        f" A peer has completed with a residual of at most {_tolerance(measured):g}; WORSE: its error is more than "
        f"{NO_WORSE:g} times that of CPRBM paper at this N."
        if any(each.is_peer for each in measured.contenders)
        else ""
    )
    return (
        f"Seconds{_OF_CLOCK[measured.plan.clock]} for {extent}: medians of the set-up and of the solve, and the "
        "distance of the solve's quartiles. N: links or elements per beam. Errors: the largest of displacements and "
        "rotations (places), of contacts' and drives' forces (forces), against "
        f"{measured.reference.by}{known}.{peers}"
    )


def _tolerance(measured: Benchmark) -> float | None:
    """Largest residual of a complete solve of a peer; None without a peer."""
    return next((each.tolerance for each in measured.contenders if each.is_peer), None)


def _fastest(measured: Benchmark, clocked: Clocked) -> Table:
    labels = {each.name: each.label for each in measured.contenders}
    rows = tuple(
        (f"{percent(one.error)} of {one.measure}", labels.get(one.fastest or "", "nobody"), number(one.ahead),
         *(number(one.seconds.get(name)) for name in labels))
        for one in standings(measured) if one.clocked == clocked
    )  # fmt: skip
    return Table(
        f"Fastest at an error, {_TITLES[clocked]}",
        ("error", "fastest", "times ahead", *labels.values()),
        rows,
        "Seconds, between two sizes by the straight line through the logarithms of error and time; a dash where no "
        "measured size reaches the error for good. Times ahead: the next one's seconds over the fastest one's.",
    )


def _ratios(measured: Benchmark) -> Table:
    labels = {
        ratio_key(each.name, clocked): each.label if len(each.ratios) == 1 else f"{each.label}, {clocked}"
        for each in measured.contenders
        for clocked in each.ratios
    }
    body = tuple(
        (sized(one["n"]), *(number(one[key]) for key in (*labels, "iterations_per_station")))
        for one in ratios(measured)
    )
    return without_empty(
        Table(
            "How many times longer than CPRBM paper on the same problem",
            ("N", *labels.values(), "iterations per station"),
            body,
            "Medians over medians: the solve over our solve, else set-up and solve over ours; a dash where a row does "
            "not count. Set-up begins with the scene for the CPRBM, with the discretised problem for the peers. "
            "Iterations are those of CPRBM paper.",
        )
    )


def _trends(measured: Benchmark) -> Table:
    body = []
    for contender in measured.contenders:
        sizes, exponent, iterations = trend(measured.of(contender.name))
        if exponent is not None:
            body.append((contender.label, f"{sizes[0]:g} to {sizes[-1]:g}", number(exponent), number(iterations)))
    machine = measured.machine
    names = {"python": "Python", "numpy": "NumPy", "scipy": "SciPy", "scikit-fem": "scikit-fem", "casadi": "CasADi"}
    libraries = ", ".join(f"{label} {machine[name]}" for name, label in names.items() if name in machine)
    return Table(
        "How it grows",
        ("method", "N", "exponent of time", "iterations, last to first"),
        tuple(body),
        f"The exponent e of seconds = a·N^e by least squares of the logarithms, set-up and solve together, over the "
        f"rows with N of {FIT_FROM} or more that count. {machine['cpu']}, {machine['cores']} cores, BLAS on one "
        f"thread; {libraries}.",
    )


def _left_out(left_out: Sequence[LeftOut]) -> Table:
    sizes = dict[tuple[Name, str], list[str]]()
    for one in left_out:
        sizes.setdefault((one.name, one.why), []).append("all" if one.count is None else sized(one.count))
    rows = tuple((name, ", ".join(mine), why) for (name, why), mine in sizes.items())
    return Table("Left out", ("method", "N", "why"), rows)


def document(measured: Benchmark) -> Plain:
    """``bench``: rows, fastest methods, ratios, trends; times in seconds, errors as fractions."""
    plan, reference = measured.plan, measured.reference
    left_out = sorted(measured.left_out, key=lambda one: _place(one.name))
    return {
        "case": measured.scene.name,
        "machine": plain(measured.machine),
        "repeat": plan.repeat,
        "kinematics": plan.kinematics,
        "clock": plan.clock,
        "stations": "all" if plan.whole else "last",
        "tolerance": _tolerance(measured),
        "reference": {"by": reference.by, "uncertainty": plain(uncertainties(measured.scene, reference))},
        "rows": records_of(_KEYS, measured.timings),
        "fastest": [_standing(one) for one in standings(measured)],
        "ratios": ratios(measured),
        "trends": [_trend(measured, each) for each in measured.contenders],
        "left_out": [{"method": one.name, "n": plain(one.count), "why": one.why} for one in left_out],
    }


def _standing(one: Standing) -> Plain:
    return {field.name: plain(getattr(one, field.name)) for field in fields(one)}


def _trend(measured: Benchmark, contender: Contender) -> Plain:
    sizes, exponent, iterations = trend(measured.of(contender.name))
    left_out = [plain(one.count) for one in measured.left_out if one.name == contender.name]
    names = {"method": contender.method, "formulation": contender.formulation, "n": [plain(n) for n in sizes]}
    return {**names, "exponent": exponent, "iterations_ratio": iterations, "left_out": left_out}


def _place(name: Name) -> tuple[int, str]:
    """Key that sorts the project's own methods first, in their order, and peers by their names."""
    return OURS.index(name) if name in OURS else len(OURS), name
