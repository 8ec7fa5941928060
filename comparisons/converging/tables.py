"""Tables, sentences and documented JSON of a scene at a family of sizes."""

from __future__ import annotations

from collections.abc import Iterable
from statistics import median

from comparisons import documents
from comparisons.converging import critical_tables
from comparisons.converging.critical import critical_families
from comparisons.converging.families import STANDARD_AT, Convergence, Family
from comparisons.display_units import at_station, display_unit
from comparisons.documents import Plain, plain
from comparisons.formats import number, percent, vector
from comparisons.sheet import Sheet

_NAMES = {"cprbm": "CPRBM", "fea": "FEA"}


def document(found: Convergence) -> Plain:
    """One case of ``converge``: ``families`` has one entry per solver, probe, component, stage and station."""
    return {
        "case": found.scene.name,
        "families": [
            *(entry for family in found.families for entry in _entries(found, family)),
            *(critical_tables.entry(found.sizes, family) for family in critical_families(found.scene, found.series)),
        ],
        "runs": [
            {"n": n, **documents.solver(answer), "complaint": series.why.get(n)}
            for series in found.series
            for n, answer in series.answers.items()
        ],
    }


def _entries(found: Convergence, family: Family) -> Iterable[Plain]:
    limit = family.found
    errors = {n: family.error(n) for n in found.sizes}
    for place, component in enumerate(family.components):
        values = [family.values.get(n) for n in found.sizes]
        exact = None if family.exact is None else plain(float(family.exact[place]))
        yield {
            "solver": family.series.method,
            "settings": plain(family.series.settings),
            "probe": family.probe.name,
            "component": component,
            "stage": family.stage,
            "station": family.station,
            "unit": family.unit,
            "n": list(found.sizes),
            "values": [None if v is None or v.size <= place else plain(float(v[place])) for v in values],
            "errors": [None if e is None else plain(float(e[place])) for e in errors.values()],
            "order": plain(family.component_order(place)),
            "order_assumed": None if limit is None else limit.assumed,
            "order_of_probe": None if limit is None else plain(limit.order),
            "orders_of_probe": [plain(order) for order in family.orders],
            "limit": None if limit is None else plain(float(limit.value[place])),
            "limit_uncertainty": None if limit is None else plain(float(limit.uncertainty[place])),
            "used": list(family.used),
            "why": family.why or None,
            "exact": exact,
            "scale": family.scale,
        }


def sheets_of(found: Convergence) -> tuple[Sheet, ...]:
    """Critical values, the limits at the last station, and over all stations orders and how far limits are apart."""
    title = found.scene.title or found.scene.name
    critical = critical_tables.sheet_of(found.scene, title, found.sizes, critical_families(found.scene, found.series))
    of_probes = (_limits(found), _orders(found)) if found.families else ()
    return (*((critical,) if critical.rows else ()), *of_probes)


def sentences_of(found: Convergence) -> tuple[str, ...]:
    """What did not complete, and how critical values compare."""
    ended = (
        f"{_label(series.method, series.variant)} at N = {n} gave no whole answer: {why}."
        for series in found.series
        for n, why in series.why.items()
    )
    return (*ended, *critical_tables.sentences_of(found.scene, critical_families(found.scene, found.series)))


def shown_size(found: Convergence) -> int:
    """The size whose values the table shows: the standard one where it was solved, else the middle one."""
    return STANDARD_AT if STANDARD_AT in found.sizes else found.sizes[(len(found.sizes) - 1) // 2]


def beside(found: Convergence) -> tuple[tuple[Family, Family], ...]:
    """The CPRBM's families, each with the finite elements' in ``bending``."""
    other = {_asked(family): family for family in found.families if family.series.variant == "bending"}
    return tuple(
        (family, other[_asked(family)])
        for family in found.families
        if family.series.method == "cprbm" and _asked(family) in other
    )


def between(cprbm: Family, fea: Family) -> tuple[float, float] | None:
    """Norms of the distance of two limits and of what may lie between them, in the unit; None where one is missing."""
    one, two = cprbm.found, fea.found
    if one is None or two is None or one.value.shape != two.value.shape:
        return None
    return cprbm.size(one.value - two.value), cprbm.size(one.uncertainty + two.uncertainty)


def _limits(found: Convergence) -> Sheet:
    n = shown_size(found)
    stage = found.scene.stages[-1]
    exact = any(family.exact is not None for family in found.families)
    body = []
    for cprbm, fea in beside(found):
        if (cprbm.stage, cprbm.station) != (stage.name, stage.stations[-1]):
            continue
        if cprbm.found is None:
            body.append((cprbm.probe.name, "", *(["–"] * (7 if exact else 6)), cprbm.why))
            continue
        factor, unit = display_unit(found.scene, cprbm.unit, cprbm.size(cprbm.found.value))
        apart = between(cprbm, fea)
        body.append(
            (
                _named(cprbm),
                unit,
                vector(cprbm.values[n], factor) if n in cprbm.values else "–",
                _share(cprbm, cprbm.apart(n)),
                *_limit(cprbm, factor),
                *_limit(fea, factor),
                "–" if apart is None else _share(cprbm, apart[0]),
                *((_share(cprbm, _from_exact(cprbm)),) if exact else ()),
            )
        )
    return Sheet(
        f"{found.scene.title or found.scene.name}: limits at {at_station(found.scene, stage.name, stage.stations[-1])}",
        (
            "probe",
            "unit",
            f"CPRBM at {n}",
            "from its limit",
            "CPRBM limit",
            "±",
            "FEA limit",
            "±",
            "limits apart",
            *(("CPRBM limit from exact",) if exact else ()),
        ),
        tuple(body),
        "FEA in bending, the CPRBM's own theory. Limits by Richardson's extrapolation; fractions of the probe's "
        "largest value in the stage. Of a stress one place is followed."
        + (f" No exact values: {found.exact_absence}" if found.exact_absence else ""),
    )


def _limit(family: Family, factor: float) -> tuple[str, str]:
    if family.found is None:
        return "–", "–"
    value = vector(family.found.value, factor)
    return value, _share(family, family.size(family.found.uncertainty))


def _orders(found: Convergence) -> Sheet:
    pairs = beside(found)
    n = shown_size(found)
    body = []
    for probe in found.scene.probes:
        mine = [(cprbm, fea) for cprbm, fea in pairs if cprbm.probe.name == probe.name]
        # an open contact has no limit
        compared = [
            (pair, apart) for pair in mine if pair[0].why != "the contact is open" and (apart := between(*pair))
        ]
        if not compared:
            continue
        within = sum(apart[0] <= apart[1] for _, apart in compared)
        (worst, _), (far, may) = max(compared, key=lambda entry: entry[1][0] / entry[0][0].scale)
        errors = [family.apart(n) for (family, _), _ in compared]
        body.append(
            (
                probe.name,
                _range([family for (family, _), _ in compared]),
                _range([family for (_, family), _ in compared]),
                percent(max((error / worst.scale for error in errors if error is not None), default=None)),
                _share(worst, far),
                _share(worst, may),
                at_station(found.scene, worst.stage, worst.station),
                f"{within} of {len(compared)}",
            )
        )
    return Sheet(
        "Orders and limits over all stations",
        (
            "probe",
            "order CPRBM",
            "order FEA",
            f"CPRBM at {n} from its limit",
            "limits apart",
            "may be",
            "at",
            "within",
        ),
        tuple(body),
        "Orders observed at every three sizes that follow each other, by the norm of the changes: median, and from the "
        "least to the largest; where a change is round-off or turns back there is none. Distances at their worst.",
    )


def _range(families: list[Family]) -> str:
    found = [order for family in families for order in family.orders if order is not None]
    if not found:
        return "–"
    return f"{number(median(found))} ({number(min(found), 2)} to {number(max(found), 2)})"


def _from_exact(family: Family) -> float | None:
    if family.exact is None or family.found is None:
        return None
    return family.size(family.found.value - family.exact)


def _share(family: Family, value: float | None) -> str:
    return "–" if value is None or family.scale == 0.0 else percent(value / family.scale)


def _named(family: Family) -> str:
    place = family.components[0]
    return f"{family.probe.name} at {1e3 * place:.4g} mm" if isinstance(place, float) else family.probe.name


def _asked(family: Family) -> tuple[str, str, float]:
    return family.probe.name, family.stage, family.station


def _label(method: str, variant: str) -> str:
    return f"{_NAMES[method]} ({variant})"
