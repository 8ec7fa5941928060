"""Tables and documented JSON of a benchmark."""

from __future__ import annotations

from comparisons.bench.contenders import OURS, Clocked
from comparisons.bench.measures import uncertainties
from comparisons.bench.running import FIT_FROM, NO_WORSE, Session, Timing
from comparisons.bench.standings import CLOCKED, ratio_key, ratios, standings, trends
from comparisons.choices import Count
from comparisons.formats import number, percent
from comparisons.present.columns import Column, Table, records_of, table_of, without_empty
from comparisons.writing import Plain, plain

_OF_CLOCK = {"wall": "", "cpu": " of the processor"}
_TITLES: dict[Clocked, str] = {"both": "set-up and solve", "solve": "solve alone"}
_LIBRARIES = {"python": "Python", "numpy": "NumPy", "scipy": "SciPy", "scikit-fem": "scikit-fem", "casadi": "CasADi"}

_COLUMNS: tuple[Column[Timing], ...] = (
    Column("method", lambda row: row.contender.label),
    Column("N", lambda row: size_text(row.count)),
    Column("set-up", lambda row: row.median("set-up"), number),
    Column("solve", lambda row: row.median("solve"), number),
    Column("spread", lambda row: row.spread("solve"), lambda value: number(value, 2)),
    Column("repeats", lambda row: len(row.seconds)),
    Column("places", lambda row: row.errors.get("places"), percent),
    Column("forces", lambda row: row.errors.get("forces"), percent),
    Column("iterations", lambda row: row.iterations),
    Column("per station", lambda row: row.iterations_per_station, number),
    Column("ended", lambda row: ending_of(row)),
)

_KEYS: tuple[Column[Timing], ...] = (
    Column("method", lambda row: row.contender.method),
    Column("formulation", lambda row: row.contender.formulation),
    Column("n", lambda row: plain(row.count)),
    Column("setup_seconds", lambda row: row.median("set-up")),
    Column("seconds", lambda row: row.median("solve")),
    Column("spread", lambda row: row.spread("solve")),
    Column("error", lambda row: row.errors.get("places")),
    Column("force_error", lambda row: row.errors.get("forces")),
    Column("ended", lambda row: ending_of(row)),
    Column("why", lambda row: row.outcome.why),
    Column("counts", lambda row: row.counts),
    Column("residual", lambda row: plain(row.outcome.residual)),
    Column("repeats", lambda row: len(row.seconds)),
    Column("iterations", lambda row: row.iterations),
    Column("iterations_by_station", lambda row: list(row.outcome.iterations)),
)


def tables_of(measured: Session) -> tuple[Table, ...]:
    """All tables: times and errors, the fastest methods, ratios, growth, and everything left out."""
    name = measured.scene.title or measured.scene.name
    timings = table_of(f"{name}: time against error", _COLUMNS, measured.rows(), _note(measured))
    fastest = [_fastest(measured, clocked) for clocked in CLOCKED]
    found = (timings, *fastest, _ratios(measured), _trends(measured), _omissions(measured))
    return tuple(table for table in found if table.rows)


def size_text(count: Count) -> str:
    """N in a table."""
    return str(count) if isinstance(count, int) else ", ".join(map(str, count.values()))


def ending_of(timing: Timing) -> str:
    """Name of the ending of a row's runs."""
    return "WORSE" if timing.worse else timing.outcome.ended


def _note(measured: Session) -> str:
    extent = "the whole scene" if measured.plan.whole else "the last load, from the state without stress"
    off = {measure: percent(u) for measure, u in uncertainties(measured.scene, measured.reference).items() if u > 0.0}
    known = f"; itself known to {', '.join(f'{u} ({measure})' for measure, u in off.items())}" if off else ""
    peers = (
        f" A peer has completed with a residual of at most {_tolerance(measured):g}; WORSE: its error is more than "
        f"{NO_WORSE:g} times that of CPRBM paper at this N."
        if any(each.is_peer for each in measured.methods())
        else ""
    )
    return (
        f"Seconds{_OF_CLOCK[measured.plan.clock]} for {extent}: medians of the set-up and of the solve, and the "
        "distance of the solve's quartiles. N: links or elements per beam. Errors: the largest of displacements and "
        "rotations (places), of contacts' and drives' forces (forces), against "
        f"{measured.reference.by}{known}.{peers}"
    )


def _tolerance(measured: Session) -> float | None:
    """Largest residual of a complete solve of a peer; None without a peer."""
    return next((each.tolerance for each in measured.methods() if each.is_peer), None)


def _fastest(measured: Session, clocked: Clocked) -> Table:
    labels = {each.name: each.label for each in measured.methods()}
    rows = tuple(
        (f"{percent(one['error'])} of {one['measure']}", labels.get(one["fastest"], "nobody"), number(one["ahead"]),
         *(number(one["seconds"].get(name)) for name in labels))
        for one in standings(measured) if one["clocked"] == clocked
    )  # fmt: skip
    return Table(
        f"Fastest at an error, {_TITLES[clocked]}",
        ("error", "fastest", "times ahead", *labels.values()),
        rows,
        "Seconds, between two sizes by the straight line through the logarithms of error and time; a dash where no "
        "measured size reaches the error for good. Times ahead: the next one's seconds over the fastest one's.",
    )


def _ratios(measured: Session) -> Table:
    labels = {
        ratio_key(each.name, clocked): each.label if len(each.ratios) == 1 else f"{each.label}, {clocked}"
        for each in measured.methods()
        for clocked in each.ratios
    }
    rows = [
        (size_text(one["n"]), *(number(one[key]) for key in (*labels, "iterations_per_station")))
        for one in ratios(measured)
    ]
    return without_empty(
        Table(
            "How many times longer than CPRBM paper on the same problem",
            ("N", *labels.values(), "iterations per station"),
            tuple(rows),
            "Medians over medians: the solve over our solve, else set-up and solve over ours; a dash where a row does "
            "not count. Set-up begins with the scene for the CPRBM, with the discretised problem for the peers. "
            "Iterations are those of CPRBM paper.",
        )
    )


def _trends(measured: Session) -> Table:
    machine = measured.machine
    libraries = ", ".join(f"{label} {machine[name]}" for name, label in _LIBRARIES.items() if name in machine)
    rows = [
        (method.label, f"{one['n'][0]:g} to {one['n'][-1]:g}", number(one["exponent"]), number(one["iterations_ratio"]))
        for method, one in zip(measured.methods(), trends(measured), strict=True)
        if one["exponent"] is not None
    ]
    return Table(
        "How it grows",
        ("method", "N", "exponent of time", "iterations, last to first"),
        tuple(rows),
        f"The exponent e of seconds = a·N^e by least squares of the logarithms, set-up and solve together, over the "
        f"rows with N of {FIT_FROM} or more that count. {machine['cpu']}, {machine['cores']} cores, BLAS on one "
        f"thread; {libraries}.",
    )


def _omissions(measured: Session) -> Table:
    sizes = dict[tuple[str, str], list[str]]()
    for one in measured.omissions():
        sizes.setdefault((one.name, one.why), []).append("all" if one.count is None else size_text(one.count))
    rows = tuple((name, ", ".join(mine), why) for (name, why), mine in sizes.items())
    return Table("Left out", ("method", "N", "why"), rows)


def document(measured: Session) -> Plain:
    """``bench``: rows, fastest methods, ratios, trends; times in seconds, errors as fractions."""
    plan, reference = measured.plan, measured.reference
    # the project's own methods first, then peers by their names
    left_out = sorted(measured.omissions(), key=lambda one: (OURS.index(one.name) if one.name in OURS else 9, one.name))
    return {
        "case": measured.scene.name,
        "machine": plain(measured.machine),
        "repeat": plan.repeat,
        "kinematics": plan.kinematics,
        "clock": plan.clock,
        "stations": "all" if plan.whole else "last",
        "tolerance": _tolerance(measured),
        "reference": {"by": reference.by, "uncertainty": plain(uncertainties(measured.scene, reference))},
        "rows": records_of(_KEYS, measured.rows()),
        "fastest": standings(measured),
        "ratios": ratios(measured),
        "trends": trends(measured),
        "left_out": [{"method": one.name, "n": plain(one.count), "why": one.why} for one in left_out],
    }
