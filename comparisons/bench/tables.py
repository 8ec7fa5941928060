"""Tables and documented JSON of a benchmark."""

from __future__ import annotations

from comparisons.bench.contenders import OURS, Clocked, Contender, Name
from comparisons.bench.errors import uncertainties
from comparisons.bench.question import MEASURES
from comparisons.bench.running import FIT_FROM, NO_WORSE, Benchmark, Clock, LeftOut, Timing, trend
from comparisons.bench.standings import Ratios, Standing, ratios, standings
from comparisons.choices import Count
from comparisons.formats import number, percent
from comparisons.plain import Plain, plain
from comparisons.present.columns import Table, without_empty

_OF_CLOCK: dict[Clock, str] = {"wall": "", "cpu": " of the processor"}
_CLOCKED: dict[Clocked, str] = {"both": "set-up and solve", "solve": "solve alone"}


def tables_of(measured: Benchmark) -> tuple[Table, ...]:
    """All tables: times and errors, who is fastest, ratios, growth, and what was left out."""
    ratio = without_empty(_ratios(measured))
    found = [_timings(measured), *_fastest(measured), ratio, _trends(measured), _left_out(measured)]
    return tuple(table for table in found if table.rows)


def sized(count: Count) -> str:
    """N as a table has it."""
    return str(count) if isinstance(count, int) else ", ".join(map(str, count.values()))


def ended(timing: Timing) -> str:
    """How a row's runs ended."""
    return "WORSE" if timing.worse else timing.outcome.ended


def _timings(measured: Benchmark) -> Table:
    body = tuple(
        (
            timing.contender.label,
            sized(timing.count),
            number(timing.setup),
            number(timing.solve),
            number(timing.spread, 2),
            str(len(timing.solves)),
            *(percent(timing.errors.get(measure)) for measure in MEASURES),
            str(timing.total_iterations),
            number(timing.iterations_per_station),
            ended(timing),
        )
        for timing in measured.timings
    )
    tolerance = _tolerance(measured)
    what = "the whole scene" if measured.plan.whole else "the last load, from the state without stress"
    off = {measure: percent(u) for measure, u in uncertainties(measured.scene, measured.reference).items() if u > 0.0}
    known = f"; itself known to {', '.join(f'{u} ({measure})' for measure, u in off.items())}" if off else ""
    return Table(
        f"{measured.scene.title or measured.scene.name}: time against error",
        ("method", "N", "set-up", "solve", "spread", "repeats", *MEASURES, "iterations", "per station", "ended"),
        body,
        f"Seconds{_OF_CLOCK[measured.plan.clock]} for {what}: medians of the set-up and of the solve, and the distance "
        "of the solve's quartiles. N: links or elements per beam. Errors: the largest of displacements and rotations "
        f"(places), of contacts' and drives' forces (forces), against {measured.reference.by}{known}."
        + (f" {_of_peers(tolerance)}" if tolerance is not None else ""),
    )


def _tolerance(measured: Benchmark) -> float | None:
    """Largest residual with which a peer's solve counts as completed; None if no peer takes part."""
    return next((each.tolerance for each in measured.contenders if each.is_peer), None)


def _of_peers(tolerance: float) -> str:
    return (
        f"A peer has completed with a residual of at most {tolerance:g}; WORSE: its error is more than {NO_WORSE:g} "
        "times that of CPRBM paper at this N."
    )


def _fastest(measured: Benchmark) -> tuple[Table, ...]:
    found = standings(measured)
    taking_part = measured.contenders
    return tuple(
        Table(
            f"Fastest at an error, {_CLOCKED[clocked]}",
            ("error", "fastest", "times ahead", *(contender.label for contender in taking_part)),
            tuple(
                (
                    f"{percent(one.target)} of {one.measure}",
                    next((each.label for each in taking_part if each.name == one.fastest), "nobody"),
                    number(one.ahead),
                    *(number(one.seconds.get(contender.name)) for contender in taking_part),
                )
                for one in found
                if one.clocked == clocked
            ),
            "Seconds, between two sizes by the straight line through the logarithms of error and time; a dash where no "
            "measured size reaches the error for good. Times ahead: the next one's seconds over the fastest one's.",
        )
        for clocked in _CLOCKED
    )


def _ratios(measured: Benchmark) -> Table:
    labels = [_ratio_label(method, clocked) for method in measured.contenders for clocked in method.ratios]
    return Table(
        "How many times longer than CPRBM paper on the same problem",
        ("N", *labels, "iterations per station"),
        tuple(
            (sized(one.count), *(number(ratio) for ratio in one.of.values()), number(one.iterations))
            for one in ratios(measured)
        ),
        "Medians over medians: the solve over our solve, else set-up and solve over ours; a dash where a row does not "
        "count. Set-up begins with the scene for the CPRBM, with the discretised problem for the peers. Iterations are "
        "those of CPRBM paper.",
    )


def _ratio_label(method: Contender, clocked: Clocked) -> str:
    return method.label if len(method.ratios) == 1 else f"{method.label}, {clocked}"


def _trends(measured: Benchmark) -> Table:
    body = []
    for contender in measured.contenders:
        found = trend(measured.of(contender.name))
        if found.exponent is not None:
            body.append(
                (
                    contender.label,
                    f"{found.sizes[0]:g} to {found.sizes[-1]:g}",
                    number(found.exponent),
                    number(found.iterations),
                )
            )
    machine = measured.machine
    libraries = ", ".join(
        f"{label} {machine[name]}"
        for name, label in (
            ("python", "Python"),
            ("numpy", "NumPy"),
            ("scipy", "SciPy"),
            ("scikit-fem", "scikit-fem"),
            ("casadi", "CasADi"),
        )
        if name in machine
    )
    return Table(
        "How it grows",
        ("method", "N", "exponent of time", "iterations, last to first"),
        tuple(body),
        f"The exponent e of seconds = a·N^e by least squares of the logarithms, set-up and solve together, over the "
        f"rows with N of {FIT_FROM} or more that count. {machine['cpu']}, {machine['cores']} cores, BLAS on one "
        f"thread; {libraries}.",
    )


def _left_out(measured: Benchmark) -> Table:
    by_reason: dict[tuple[Name, str], list[LeftOut]] = {}
    for one in measured.left_out:
        by_reason.setdefault((one.name, one.why), []).append(one)
    return Table(
        "Left out",
        ("method", "N", "why"),
        tuple(
            (name, ", ".join(sized(one.count) for one in found if one.count is not None) or "all", why)
            for (name, why), found in by_reason.items()
        ),
    )


def document(measured: Benchmark) -> Plain:
    """``bench``: rows, who is fastest, ratios, trends; times in seconds, errors as fractions."""
    return {
        "case": measured.scene.name,
        "machine": plain(measured.machine),
        "repeat": measured.plan.repeat,
        "kinematics": measured.plan.kinematics,
        "clock": measured.plan.clock,
        "stations": "all" if measured.plan.whole else "last",
        "tolerance": _tolerance(measured),
        "reference": {
            "by": measured.reference.by,
            "uncertainty": plain(uncertainties(measured.scene, measured.reference)),
        },
        "rows": [_row(timing) for timing in measured.timings],
        "fastest": [_standing(one) for one in standings(measured)],
        "ratios": [_ratio(one) for one in ratios(measured)],
        "trends": [
            {
                "method": contender.method,
                "formulation": contender.formulation,
                "n": [plain(n) for n in found.sizes],
                "exponent": found.exponent,
                "iterations_ratio": found.iterations,
                "left_out": [plain(one.count) for one in measured.left_out if one.name == contender.name],
            }
            for contender, found in ((one, trend(measured.of(one.name))) for one in measured.contenders)
        ],
        "left_out": [
            {"method": one.name, "n": plain(one.count), "why": one.why}
            for one in sorted(measured.left_out, key=lambda one: _place(one.name))
        ],
    }


def _row(timing: Timing) -> Plain:
    return {
        "method": timing.contender.method,
        "formulation": timing.contender.formulation,
        "n": plain(timing.count),
        "setup_seconds": timing.setup,
        "seconds": timing.solve,
        "spread": timing.spread,
        "error": timing.errors.get("places"),
        "force_error": timing.errors.get("forces"),
        "ended": ended(timing),
        "why": timing.outcome.why,
        "counts": timing.counts,
        "residual": plain(timing.outcome.residual),
        "repeats": len(timing.solves),
        "iterations": timing.total_iterations,
        "iterations_by_station": list(timing.outcome.iterations),
    }


def _standing(one: Standing) -> Plain:
    return {
        "measure": one.measure,
        "error": one.target,
        "clocked": one.clocked,
        "fastest": one.fastest,
        "ahead": one.ahead,
        "seconds": plain(one.seconds),
    }


def _ratio(one: Ratios) -> Plain:
    return {
        "n": plain(one.count),
        **dict.fromkeys(("slsqp_both", "ipopt_both", "ipopt_solve")),  # documented: null for an untimed method
        **{f"{name.replace('-', '_')}_{clocked}": ratio for (name, clocked), ratio in one.of.items()},
        "iterations_per_station": one.iterations,
    }


def _place(name: Name) -> tuple[int, str]:
    """Sorts the project's own methods first, in their order, and peers by their names."""
    return OURS.index(name) if name in OURS else len(OURS), name
