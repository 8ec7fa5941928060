"""Tables, sentences and documented JSON of a scene at a family of sizes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from statistics import median
from typing import NamedTuple

from comparisons.display_units import at_station, display_unit, distance_text, with_unit
from comparisons.formats import number, percent, vector
from comparisons.plain import Plain, plain
from comparisons.present import json_document
from comparisons.present.columns import Column, Table, table_of
from comparisons.studies.critical_families import CriticalFamily, critical_families
from comparisons.studies.families import STANDARD_AT, Convergence, Family
from cprbm_scene import Scene

NAMES = {"cprbm": "CPRBM", "fea": "FEA"}


class Pair(NamedTuple):
    """A family of the CPRBM, and the family of the finite elements in ``bending``."""

    cprbm: Family
    fea: Family

    @property
    def apart(self) -> tuple[float, float] | None:
        """Norms of the distance of both limits and of the uncertainties, in the unit; None without a limit."""
        one, two = self.cprbm.found, self.fea.found
        if one is None or two is None or one.value.shape != two.value.shape:
            return None
        return self.cprbm.size(one.value - two.value), self.cprbm.size(one.uncertainty + two.uncertainty)


def document(found: Convergence) -> Plain:
    """One case of ``converge``: ``families`` has an entry per solver, probe, component, stage and station."""
    return {
        "case": found.scene.name,
        "families": [
            *(entry for family in found.families for entry in _entries(found, family)),
            *(critical_entry(found.sizes, family) for family in critical_families(found.scene, found.series)),
        ],
        "runs": [
            {"n": n, **json_document.solver(answer), "complaint": series.why.get(n)}
            for series in found.series
            for n, answer in series.answers.items()
        ],
    }


def _entries(found: Convergence, family: Family) -> Iterable[Plain]:
    limit = family.found
    errors = {n: family.error(n) for n in found.sizes}
    for place, component in enumerate(family.components):
        values = [family.values.get(n) for n in found.sizes]
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
            "exact": None if family.exact is None else plain(float(family.exact[place])),
            "scale": family.scale,
        }


def critical_entry(sizes: Sequence[int], family: CriticalFamily) -> Plain:
    """Entry of ``families``; the probe is ``critical``, the component the stage's name."""
    limit = family.found
    last = family.critical[max(family.critical)]
    return {
        "solver": family.series.method,
        "settings": plain(family.series.settings),
        "probe": "critical",
        "component": family.stage,
        "stage": family.stage,
        "station": None,
        "place": family.place,
        "loss": last.loss.value,
        "what": last.what or None,
        "unit": family.unit,
        "n": list(sizes),
        "values": [plain(family.critical[n].value) if n in family.critical else None for n in sizes],
        "errors": [plain(family.error(n)) for n in sizes],
        "order": None if limit is None else plain(limit.order),
        "order_assumed": None if limit is None else limit.assumed,
        "order_of_probe": None if limit is None else plain(limit.order),
        "orders_of_probe": [plain(order) for order in family.orders],
        "limit": None if limit is None else plain(float(limit.value[0])),
        "limit_uncertainty": None if limit is None else plain(float(limit.uncertainty[0])),
        "used": list(family.used),
        "why": family.why or None,
        "exact": None,
        "scale": family.span,
    }


def convergence_tables(found: Convergence) -> tuple[Table, ...]:
    """Critical values, limits at the last station, and orders over all stations; tables without rows are left out."""
    critical = critical_table(found.scene, found.sizes, critical_families(found.scene, found.series))
    return tuple(table for table in (critical, _limits(found), _orders(found)) if table.rows)


def sentences_of(found: Convergence) -> tuple[str, ...]:
    """Incomplete runs, and distances of the limits of critical values."""
    ended = (
        f"{NAMES[series.method]} ({series.variant}) at N = {n} gave no complete answer: {why}."
        for series in found.series
        for n, why in series.why.items()
    )
    return (*ended, *_critical_sentences(found.scene, critical_families(found.scene, found.series)))


def shown_size(found: Convergence) -> int:
    """The size in the table: the standard size, or else the middle size."""
    return STANDARD_AT if STANDARD_AT in found.sizes else found.sizes[(len(found.sizes) - 1) // 2]


def pairs_of(found: Convergence) -> tuple[Pair, ...]:
    """The CPRBM's families beside the finite elements'."""
    other = {_question(family): family for family in found.families if family.series.method == "fea"}
    return tuple(
        Pair(family, other[_question(family)])
        for family in found.families
        if family.series.method == "cprbm" and _question(family) in other
    )


def _limits(found: Convergence) -> Table:
    n, stage, scene = shown_size(found), found.scene.stages[-1], found.scene
    last = [pair for pair in pairs_of(found) if _question(pair.cprbm)[1:] == (stage.name, stage.stations[-1])]

    def unit(pair: Pair) -> tuple[float, str]:
        limit = pair.cprbm.found
        return (1.0, "") if limit is None else display_unit(scene, pair.cprbm.unit, pair.cprbm.size(limit.value))

    def limit(solver: int, header: str) -> list[Column[Pair]]:
        """Limit and uncertainty of a solver's family."""

        def text(at: Pair) -> str | None:
            known = at[solver].found
            return None if known is None else vector(known.value, unit(at)[0])

        def stated(at: Pair) -> str | None:
            known = at[solver].found
            return None if known is None else _share(at.cprbm, at[solver].size(known.uncertainty))

        return [Column(header, text), Column("±", stated)]

    columns = [
        Column[Pair]("probe", lambda at: _place(scene, at.cprbm)),
        Column("unit", lambda at: unit(at)[1]),
        Column(
            f"CPRBM at {n}",
            lambda at: vector(at.cprbm.values[n], unit(at)[0]) if at.cprbm.found and n in at.cprbm.values else None,
        ),
        Column("from its limit", lambda at: _share(at.cprbm, at.cprbm.apart(n))),
        *limit(0, "CPRBM limit"),
        *limit(1, "FEA limit"),
        Column("limits apart", lambda at: at.apart and _share(at.cprbm, at.apart[0])),
        Column("CPRBM limit from exact", lambda at: _share(at.cprbm, _from_exact(at.cprbm))),
        Column("no limit because", lambda at: "" if at.cprbm.found else at.cprbm.why),
    ]
    note = (
        f"Both solvers in {found.series[0].theory}. Limits by Richardson's extrapolation; fractions of the probe's "
        "largest value in the stage. Stresses at one place."
    )
    absence = f" No exact values: {found.exact_absence}" if found.exact_absence else ""
    title = f"{scene.title or scene.name}: limits at {at_station(scene, stage.name, stage.stations[-1])}"
    return table_of(title, columns, last, note + absence)


def _orders(found: Convergence) -> Table:
    n, compared = shown_size(found), dict[str, list[Pair]]()
    for pair in pairs_of(found):
        if pair.apart is not None and pair.cprbm.why != "the contact is open":  # an open contact has no limit
            compared.setdefault(pair.cprbm.probe.name, []).append(pair)
    worst = {name: max(mine, key=_distance_share) for name, mine in compared.items()}
    names = [probe.name for probe in found.scene.probes if probe.name in compared]

    def from_limit(name: str) -> str:
        shares = [apart / at.cprbm.scale for at in compared[name] if (apart := at.cprbm.apart(n)) is not None]
        return percent(max(shares, default=None))

    def distance(place: int) -> Callable[[str], str | None]:
        return lambda name: (apart := worst[name].apart) and _share(worst[name].cprbm, apart[place])

    columns = [
        Column[str]("probe", str),
        Column("order CPRBM", lambda name: spread([order for at in compared[name] for order in at.cprbm.orders])),
        Column("order FEA", lambda name: spread([order for at in compared[name] for order in at.fea.orders])),
        Column(f"CPRBM at {n} from its limit", from_limit),
        Column("limits apart", distance(0)),
        Column("stated", distance(1)),
        Column("at", lambda name: at_station(found.scene, *_question(worst[name].cprbm)[1:])),
        Column("within", lambda name: _within(compared[name])),
    ]
    return table_of(
        "Orders and limits over all stations",
        columns,
        names,
        "Orders observed at every three consecutive sizes, by the norm of the changes: median, least and largest; a "
        "change that is round-off or turns back has no order. Distances at their worst.",
    )


def _distance_share(pair: Pair) -> float:
    """Distance of both limits over the probe's scale."""
    return 0.0 if pair.apart is None else pair.apart[0] / pair.cprbm.scale


def _within(pairs: Sequence[Pair]) -> str:
    """Number of pairs whose limits are within their uncertainties."""
    distances = [apart for pair in pairs if (apart := pair.apart) is not None]
    return f"{sum(far <= stated for far, stated in distances)} of {len(distances)}"


def spread(orders: Iterable[float | None]) -> str:
    """Median, least and largest of the known orders."""
    known = [order for order in orders if order is not None]
    return f"{number(median(known))} ({number(min(known), 2)} to {number(max(known), 2)})" if known else "–"


def _from_exact(family: Family) -> float | None:
    if family.exact is None or family.found is None:
        return None
    return family.size(family.found.value - family.exact)


def _share(family: Family, value: float | None) -> str | None:
    return None if value is None or family.scale == 0.0 else percent(value / family.scale)


def _place(scene: Scene, family: Family) -> str:
    """Name of the probe, of a stress with its place."""
    place = family.components[0]
    at = f" at {with_unit(scene, place, 'm', 4)}" if isinstance(place, float) else ""
    return f"{family.probe.name}{at}"


def _question(family: Family) -> tuple[str, str, float]:
    return family.probe.name, family.stage, family.station


def critical_table(scene: Scene, sizes: Sequence[int], families: Sequence[CriticalFamily]) -> Table:
    """Critical values against N, and their limits."""

    def at(n: int) -> Column[CriticalFamily]:
        return Column(
            str(n), lambda one: with_unit(scene, one.critical[n].value, one.unit, 6) if n in one.critical else None
        )

    columns = [
        Column[CriticalFamily]("stage", lambda one: one.stage if one.place == 0 else f"{one.stage}, {one.place + 1}"),
        Column("solver", lambda one: f"{NAMES[one.series.method]} ({one.series.variant})"),
        Column("mechanism", lambda one: one.mechanism),
        *map(at, sizes),
        Column("order", lambda one: one.found and number(one.found.order)),
        Column("limit", lambda one: one.found and with_unit(scene, float(one.found.value[0]), one.unit, 5)),
        Column("±", lambda one: one.found and distance_text(scene, float(one.found.uncertainty[0]), one.unit)),
    ]
    note = "Of the load or drive that the stage steps. The order is observed at the three finest sizes that count."
    return table_of(f"{scene.title or scene.name}: critical values against N", columns, families, note)


def _critical_sentences(scene: Scene, families: Sequence[CriticalFamily]) -> Iterable[str]:
    """Distances of the limits of the CPRBM and of the finite elements."""
    fea = {(each.stage, each.place): each for each in families if each.series.method == "fea"}
    for one in families:
        other = fea.get((one.stage, one.place))
        if one.series.method != "cprbm" or other is None or one.found is None or other.found is None:
            continue
        apart = abs(float(one.found.value[0] - other.found.value[0]))
        stated = float(one.found.uncertainty[0] + other.found.uncertainty[0])
        same = "by the same mechanism" if one.mechanism == other.mechanism else "by different mechanisms"
        yield (
            f"The limits of the critical value in {one.stage} are {distance_text(scene, apart, one.unit)} apart in "
            f"{one.series.theory}, where {distance_text(scene, stated, one.unit)} are stated, {same}: {one.mechanism} "
            f"in the CPRBM, {other.mechanism} in the finite elements."
        )
