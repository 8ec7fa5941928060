"""The section of a benchmark: tables, figures and documented JSON of the rows, and results of the rows that count.

Results are the fastest method at an error, ratios of times, and growth of times.  A method reaches an error at a size
if the errors at this size and at all larger sizes are no larger.  Its time lies on the straight line between this size
and the size before, in the logarithms of error and time; without a size before, the time is the time of the size.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from comparisons.bench.measures import MEASURES, Measure, uncertainties
from comparisons.bench.running import FIT_FROM, NO_WORSE, OURS, Clocked, Contender, Session, Timing, trend
from comparisons.choices import Count
from comparisons.formats import number, percent
from comparisons.present.canvas import Line, Panel, chart
from comparisons.present.columns import (
    NOTHING,
    Column,
    Figure,
    Plain,
    Section,
    Table,
    plain,
    records_of,
    table_of,
    without_empty,
)

TARGETS = (1e-2, 1e-3, 1e-4)
_CLOCKED: dict[Clocked, str] = {"both": "set-up and solve", "solve": "solve alone"}
_UNTIMED = ("slsqp_both", "ipopt_both", "ipopt_solve")
"""Ratios of methods that take no part: None."""

_MEASURED: dict[Measure, str] = {"places": "error of displacements and rotations", "forces": "error of forces"}

_OF_CLOCK = {"wall": "", "cpu": " of the processor"}
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

Rows = dict[Contender, Sequence[Timing]]
"""Rows that count, by method."""


def bench_section(measured: Session) -> Section:
    """Times, errors and ratios of a benchmark, with documented JSON and without :func:`pictures`."""
    return Section("Run time against error", (), (), tables_of(measured), "bench", document(measured))


def pictures(measured: Session) -> tuple[Figure, ...]:
    """Error against time, and time against N; without rows that count no figure."""
    every: Rows = {each: [row for row in measured.rows(each.name) if row.counts] for each in measured.methods()}
    rows = {each: mine for each, mine in every.items() if mine}
    known = [name for name in MEASURES if any(name in row.errors for mine in rows.values() for row in mine)]
    return (*((_precision(rows, known),) if known else ()), *((_growth(rows),) if rows else ()))


def _precision(rows: Rows, measures: Sequence[Measure]) -> Figure:
    panels = []
    for measure in measures:
        shown = {method: [row for row in mine if row.errors.get(measure, 0.0) > 0.0] for method, mine in rows.items()}
        points = {method: [(row.median("both"), row.errors[measure]) for row in mine] for method, mine in shown.items()}
        panels.append(
            Panel(
                _MEASURED[measure],
                lines=[_line(method, mine) for method, mine in points.items() if mine],
                texts=[
                    (
                        size_text(mine[place].count),
                        points[method][place],
                        {"xytext": (5.0, below), "color": method.look[0], "fontsize": 8.0},
                    )
                    for method, mine in shown.items()
                    if mine
                    for place, below in {0: 3.0, len(mine) - 1: -10.0}.items()
                ],
            )
        )
    caption, abscissa = "Error against time, each point a number of links or elements.", "seconds of set-up and solve"
    return chart("bench-precision", caption, abscissa, panels, panel=(6.4, 4.0), decades=(), legend=("upper center", 3))


def _growth(rows: Rows) -> Figure:
    exponents = {method: trend(tuple(mine))[1] for method, mine in rows.items()}
    names = {method: "" if e is None else f": exponent {e:.2f}" for method, e in exponents.items()}
    ordinates: dict[str, Callable[[Timing], float]] = {
        "seconds of set-up and solve": lambda row: row.median("both"),
        "iterations, all stations": lambda row: max(row.iterations, 1),
    }
    sizes = sorted({row.n for mine in rows.values() for row in mine})
    caption, abscissa = "Median time and iterations against links or elements.", "links or elements per beam, N"
    return chart(
        "bench",
        caption,
        abscissa,
        panels=[
            Panel(
                name,
                [_line(method, [(row.n, of(row)) for row in mine], names[method]) for method, mine in rows.items()],
            )
            for name, of in ordinates.items()
        ],
        panel=(6.4, 3.2),
        decades=sizes,
        legend=("upper center", 2),
    )


def _line(method: Contender, points: Sequence[tuple[float, float]], name: str = "") -> Line:
    """Points of a method with its colour and marker, and a ``name`` behind the label."""
    colour, marker = method.look
    look = {"linestyle": "-", "marker": marker, "color": colour, "markersize": 5, "linewidth": 1.1}
    xs, ys = zip(*points, strict=True)
    return xs, ys, {**look, "label": f"{method.label}{name}"}


def tables_of(measured: Session) -> tuple[Table, ...]:
    """All tables: times and errors, the fastest methods, ratios, growth, and everything left out."""
    name = measured.scene.title or measured.scene.name
    timings = table_of(f"{name}: time against error", _COLUMNS, measured.rows(), _note(measured))
    fastest = [_fastest(measured, clocked) for clocked in _CLOCKED]
    others = _ratios(measured), _trends(measured), _omissions(measured)
    return tuple(table for table in (timings, *fastest, *others) if table.rows)


def size_text(count: Count) -> str:
    """N in a table."""
    return str(count) if isinstance(count, int) else ", ".join(map(str, count.values()))


def ending_of(timing: Timing) -> str:
    """Name of the ending of a row's runs."""
    return "WORSE" if timing.worse else timing.outcome.ended


def _note(measured: Session) -> str:
    extent = "the whole scene" if measured.whole else "the last load, from the state without stress"
    off = {measure: percent(u) for measure, u in uncertainties(measured.scene, measured.reference).items() if u > 0.0}
    known = f"; itself known to {', '.join(f'{u} ({measure})' for measure, u in off.items())}" if off else ""
    peers = (
        f" A peer has completed with a residual of at most {_tolerance(measured):g}; WORSE: its error is more than "
        f"{NO_WORSE:g} times that of CPRBM paper at this N."
        if any(each.is_peer for each in measured.methods())
        else ""
    )
    return (
        f"Seconds{_OF_CLOCK[measured.clock]} for {extent}: medians of the set-up and of the solve, and the "
        "distance of the solve's quartiles. N: links or elements per beam. Errors: the largest of displacements and "
        "rotations (places), of contacts' and drives' forces (forces), against "
        f"{measured.reference.by}{known}.{peers}"
    )


def _tolerance(measured: Session) -> float | None:
    """Largest residual of a complete solve of a peer; None without a peer."""
    return next((each.tolerance for each in measured.methods() if each.is_peer), None)


def _fastest(measured: Session, clocked: Clocked) -> Table:
    labels = {each.name: each.label for each in measured.methods()}
    return Table(
        f"Fastest at an error, {_CLOCKED[clocked]}",
        headers=("error", "fastest", "times ahead", *labels.values()),
        rows=tuple(
            (
                f"{percent(one['error'])} of {one['measure']}",
                labels.get(one["fastest"], NOTHING),
                number(one["ahead"]),
                *(number(one["seconds"].get(name)) for name in labels),
            )
            for one in standings(measured)
            if one["clocked"] == clocked
        ),
        note="Seconds, between two sizes by the straight line through the logarithms of error and time; a dash where "
        "no measured size reaches the error for good. Times ahead: seconds of the second method over the fastest.",
    )


def _ratios(measured: Session) -> Table:
    labels = {
        _ratio_key(each.name, clocked): each.label if len(each.ratios) == 1 else f"{each.label}, {clocked}"
        for each in measured.methods()
        for clocked in each.ratios
    }
    return without_empty(
        Table(
            "How many times longer than CPRBM paper on the same problem",
            headers=("N", *labels.values(), "iterations per station"),
            rows=tuple(
                (size_text(one["n"]), *(number(one[key]) for key in (*labels, "iterations_per_station")))
                for one in ratios(measured)
            ),
            note="Medians over medians: the solve over our solve, else set-up and solve over ours; a dash where a row "
            "does not count. Set-up begins with the scene for the CPRBM, with the discretised problem for the peers. "
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
    for name, count, why in measured.omissions():
        sizes.setdefault((name, why), []).append("all" if count is None else size_text(count))
    return Table(
        "Left out",
        headers=("method", "N", "why"),
        rows=tuple((name, ", ".join(mine), why) for (name, why), mine in sizes.items()),
    )


def document(measured: Session) -> Plain:
    """``bench``: rows, fastest methods, ratios, trends; times in seconds, errors as fractions."""
    reference = measured.reference
    # the project's own methods first, then peers by their names
    left_out = sorted(measured.omissions(), key=lambda one: (OURS.index(one[0]) if one[0] in OURS else 9, one[0]))
    return {
        "case": measured.scene.name,
        "machine": plain(measured.machine),
        "repeat": measured.repeat,
        "kinematics": measured.kinematics,
        "clock": measured.clock,
        "stations": "all" if measured.whole else "last",
        "tolerance": _tolerance(measured),
        "reference": {"by": reference.by, "uncertainty": plain(uncertainties(measured.scene, reference))},
        "rows": records_of(_KEYS, measured.rows()),
        "fastest": standings(measured),
        "ratios": ratios(measured),
        "trends": trends(measured),
        "left_out": [{"method": name, "n": plain(count), "why": why} for name, count, why in left_out],
    }


def standings(measured: Session) -> list[Plain]:
    """``fastest``: for each measure with errors, by both clocks, at every target."""
    known = [name for name in MEASURES if any(name in timing.errors for timing in measured.rows())]
    asked = ((measure, clocked, target) for measure in known for clocked in _CLOCKED for target in TARGETS)
    return [_standing(measured, *each) for each in asked]


def _standing(measured: Session, measure: Measure, clocked: Clocked, target: float) -> Plain:
    """Seconds by method that reaches the error, the fastest, and the quotient of the second and the first time."""
    counted = [row for row in measured.rows() if row.counts and measure in row.errors]
    points = {
        each.name: [(row.errors[measure], row.median(clocked)) for row in counted if row.contender is each]
        for each in measured.methods()
    }
    found = {name: seconds_at(mine, target) for name, mine in points.items()}
    seconds = {name: each for name, each in found.items() if each is not None}
    first, second, *_ = (*sorted(seconds.values()), 0.0, 0.0)
    return {
        "measure": measure,
        "error": target,
        "clocked": clocked,
        "fastest": min(seconds, key=lambda name: seconds[name], default=None),
        "ahead": second / first if first and second else None,
        "seconds": seconds,
    }


def seconds_at(points: Sequence[tuple[float, float]], target: float) -> float | None:
    """Seconds from which the error is at most the ``target``, of (error, seconds) by ascending size; or None."""
    first = max((place + 1 for place, (error, _) in enumerate(points) if error > target), default=0)
    if first == len(points):
        return None
    around = points[max(first - 1, 0) : first + 1]
    if len(around) == 1 or min(map(min, around)) <= 0.0:
        return points[first][1]
    errors, seconds = np.log(around[::-1]).T
    return float(np.exp(np.interp(math.log(target), errors, seconds)))


def ratios(measured: Session) -> list[Plain]:
    """``ratios``: times over the time of the CPRBM in ``paper``, at every size with another method.

    A row that does not count has None.
    """
    found = []
    for ours in (row for row in measured.rows("paper") if row.counts):
        rows = {row.contender: row for row in measured.rows() if row.count == ours.count and row.counts}
        times: Plain = dict.fromkeys(_UNTIMED) | {
            _ratio_key(method.name, clocked): rows[method].median(clocked) / mine if method in rows and mine else None
            for method in measured.methods() for clocked in method.ratios for mine in (ours.median(clocked),)
        }  # fmt: skip
        if any(method.ratios for method in rows):
            found.append({"n": plain(ours.count), **times, "iterations_per_station": ours.iterations_per_station})
    return found


def _ratio_key(name: str, clocked: Clocked) -> str:
    """Key of a ratio in the JSON."""
    return f"{name.replace('-', '_')}_{clocked}"


def trends(measured: Session) -> list[Plain]:
    """``trends``: growth of time and iterations of every method."""
    omitted = [(name, plain(count)) for name, count, _ in measured.omissions()]
    found = {contender: trend(measured.rows(contender.name)) for contender in measured.methods()}
    return [
        {
            "method": contender.method,
            "formulation": contender.formulation,
            "n": [plain(n) for n in sizes],
            "exponent": exponent,
            "iterations_ratio": iterations,
            "left_out": [count for name, count in omitted if name == contender.name],
        }
        for contender, (sizes, exponent, iterations) in found.items()
    ]
