"""Tables, sentences and documented JSON of values at a family of sizes."""

from collections.abc import Iterable, Iterator, Sequence
from statistics import median
from typing import Literal, NamedTuple

from comparisons.formats import at_station, display_unit, distance_text, number, percent, vector, with_unit
from comparisons.present import json_document
from comparisons.present.columns import Column, Plain, Table, columns_of, plain, table_of
from comparisons.stations import last_station
from comparisons.studies.families import Convergence, Family, size
from comparisons.verdict import mechanism

NAMES = {"cprbm": "CPRBM", "fea": "FEA"}


class Pair(NamedTuple):
    """Families of both solvers for one question, in one beam theory."""

    cprbm: Family
    fea: Family

    @property
    def apart(self) -> tuple[float, float] | None:
        """Norms of the distance of both limits and of their uncertainties, in the unit; None without a limit."""
        one, two = self.cprbm.found, self.fea.found
        if one is None or two is None or one.value.shape != two.value.shape:
            return None
        return size(one.value - two.value), size(one.uncertainty + two.uncertainty)


_Apart = tuple[Pair, float, float]
"""Families with a limit each, the distance of the limits, and their uncertainties."""


def pairs_of(families: Iterable[Family]) -> tuple[Pair, ...]:
    """Families of the CPRBM beside the families of the finite elements."""
    known = {(family.solver, family.question): family for family in families}
    asked = (question for solver, question in known if solver == "cprbm" and ("fea", question) in known)
    return tuple(Pair(known["cprbm", question], known["fea", question]) for question in asked)


def document(found: Convergence) -> Plain:
    """One case of ``converge``: ``families`` has an entry per solver, probe, component, stage and station."""
    families = (*found.families, *found.criticals)
    return {
        "case": found.scene.name,
        "families": [entry for family in families for entry in entries(found.sizes, family)],
        "runs": [
            {"n": n, **json_document.solver(answer), "complaint": series.why.get(n)}
            for series in found.series
            for n, answer in series.answers.items()
        ],
    }


def entries(sizes: Sequence[int], family: Family) -> Iterator[Plain]:
    """Entry of every component of a family; of a critical point with its place and instability."""
    limit, errors = family.found, {n: family.error(n) for n in sizes}
    order = None if limit is None else plain(limit.order)
    for place, component in enumerate(family.components):
        values = {n: value[place] for n, value in family.values.items() if value.size > place}
        entry = {
            "solver": family.solver,
            "settings": plain(family.settings),
            "probe": family.probe,
            "component": component,
            "stage": family.stage,
            "station": family.station,
            "unit": family.unit,
            "n": list(sizes),
            "values": [plain(values.get(n)) for n in sizes],
            "errors": [None if error is None else plain(error[place]) for error in errors.values()],
            "order": plain(family.component_order(place)),
            "order_assumed": None if limit is None else plain(limit.assumed),
            "order_of_probe": order,
            "orders_of_probe": plain(family.orders),
            "limit": None if limit is None else plain(limit.value[place]),
            "limit_uncertainty": None if limit is None else plain(limit.uncertainty[place]),
            "used": list(family.used),
            "why": family.why or None,
            "exact": None if family.exact is None else plain(family.exact[place]),
            "scale": family.scale,
        }
        if family.critical:
            last = family.critical[max(family.critical)]
            entry |= {"place": family.place, "loss": last.loss.value, "what": last.what or None}
        yield entry


def sentences_of(found: Convergence) -> Iterator[str]:
    """Incomplete runs, and distances of the limits of critical values."""
    for series in found.series:
        for n, why in series.why.items():
            yield f"{NAMES[series.method]} ({series.variant}) at N = {n} gave no complete answer: {why}."
    for pair in pairs_of(found.criticals):
        if pair.apart is not None:
            distance, stated = (distance_text(found.scene, each, pair.cprbm.unit) for each in pair.apart)
            one, two = map(_mechanism, pair)
            same = "by the same mechanism" if one == two else "by different mechanisms"
            yield (
                f"The limits of the critical value in {pair.cprbm.stage} are {distance} apart in "
                f"{found.series[0].theory}, where {stated} are stated, {same}: {one} in the CPRBM, {two} in the "
                "finite elements."
            )


def tables_of(found: Convergence) -> tuple[Table, ...]:
    """Critical values, limits at the last station, and orders over all stations; tables without rows are left out."""
    return tuple(table for table in (_criticals(found), _limits(found), _orders(found)) if table.rows)


def _criticals(found: Convergence) -> Table:
    scene = found.scene
    variants = {f"{series.method}": f"{NAMES[series.method]} ({series.variant})" for series in found.series}

    def value(n: int) -> Column[Family]:
        return Column(
            str(n), lambda at: with_unit(scene, at.critical[n].value, at.unit, 6) if n in at.critical else None
        )

    return table_of(
        f"{scene.title or scene.name}: critical values against N",
        columns=[
            Column[Family]("stage", lambda at: f"{at.stage}, {at.place + 1}" if at.place else at.stage),
            Column("solver", lambda at: variants[at.solver]),
            Column("mechanism", _mechanism),
            *map(value, found.sizes),
            Column("order", "found.order", number),
            Column("limit", lambda at: at.found and with_unit(scene, float(at.found.value[0]), at.unit, 5)),
            Column("±", lambda at: at.found and distance_text(scene, float(at.found.uncertainty[0]), at.unit)),
        ],
        items=found.criticals,
        note="Of the load or drive that the stage steps. The order is observed at the three finest sizes that count.",
    )


def _mechanism(family: Family) -> str:
    """Mechanism of the instability at the finest size."""
    return mechanism(family.critical[max(family.critical)])


def _limits(found: Convergence) -> Table:
    scene, n = found.scene, found.shown

    def unit(own: Family) -> tuple[float, str]:
        return (1.0, "") if own.found is None else display_unit(scene, own.unit, size(own.found.value))

    def probe(pair: Pair) -> str:
        place = pair.cprbm.components[0]
        return pair.cprbm.probe + (f" at {with_unit(scene, place, 'm', 4)}" if isinstance(place, float) else "")

    def limit(solver: Literal["cprbm", "fea"]) -> list[Column[Pair]]:
        path = f"{solver}.found"
        return [
            *columns_of(lambda pair, known: vector(known.value, unit(pair.cprbm)[0]), {f"{NAMES[solver]} limit": path}),
            *columns_of(lambda pair, known: _share(pair.cprbm, size(known.uncertainty)), {"±": path}),
        ]

    columns: list[Column[Pair]] = [
        Column("probe", probe),
        Column("unit", lambda pair: unit(pair.cprbm)[1]),
        Column(f"CPRBM at {n}", lambda pair: vector(pair.cprbm.values[n], unit(pair.cprbm)[0])
               if pair.cprbm.found and n in pair.cprbm.values else None),
        Column("from its limit", lambda pair: _share(pair.cprbm, pair.cprbm.apart(n))),
        *limit("cprbm"),
        *limit("fea"),
        Column("limits apart", lambda pair: _share(pair.cprbm, pair.apart and pair.apart[0])),
        Column("CPRBM limit from exact", lambda pair:
               _share(pair.cprbm, size(pair.cprbm.found.value - pair.cprbm.exact))
               if pair.cprbm.found and pair.cprbm.exact is not None else None),
        Column("no limit because", lambda pair: "" if pair.cprbm.found else pair.cprbm.why),
    ]  # fmt: skip
    note = (
        f"Both solvers in {found.series[0].theory}. Limits by Richardson's extrapolation; fractions of the probe's "
        "largest value in the stage. Stresses at one place."
    )
    note += f" No exact values: {found.exact.sentence}" if found.exact and not found.exact.stations else ""
    return table_of(
        title=f"{scene.title or scene.name}: limits at {at_station(scene, *last_station(scene))}",
        columns=columns,
        items=pairs_of(found.last),
        note=note,
    )


def _share(family: Family, value: float | None) -> str:
    """A distance over the scale of a family, in per cent; a dash for None."""
    return percent(None if value is None or family.scale == 0.0 else value / family.scale)


def _orders(found: Convergence) -> Table:
    # an open contact has no limit
    pairs = (pair for pair in pairs_of(found.families) if pair.cprbm.why != "the contact is open")
    known = [(pair, *pair.apart) for pair in pairs if pair.apart is not None]
    groups = [[each for each in known if each[0].cprbm.probe == probe.name] for probe in found.scene.probes]

    def worst(mine: Sequence[_Apart]) -> _Apart:
        return max(mine, key=lambda each: each[1] / (each[0].cprbm.scale or 1.0))

    def order(solver: Literal["cprbm", "fea"]) -> Column[Sequence[_Apart]]:
        return Column(
            f"order {NAMES[solver]}",
            lambda mine: spread(each for pair, *_ in mine for each in getattr(pair, solver).orders),
        )

    columns: list[Column[Sequence[_Apart]]] = [
        Column("probe", lambda mine: mine[0][0].cprbm.probe),
        order("cprbm"),
        order("fea"),
        Column(f"CPRBM at {found.shown} from its limit", lambda mine: max(
            (far / own.scale for (own, _), *_ in mine if (far := own.apart(found.shown)) is not None), default=None
        ), percent),
        Column("limits apart", worst, lambda each: _share(each[0].cprbm, each[1])),
        Column("stated", worst, lambda each: _share(each[0].cprbm, each[2])),
        Column("at", worst, lambda each: at_station(found.scene, each[0].cprbm.stage, each[0].cprbm.station or 0.0)),
        Column("within", lambda mine: f"{sum(apart <= stated for _, apart, stated in mine)} of {len(mine)}"),
    ]  # fmt: skip
    return table_of(
        "Orders and limits over all stations",
        columns,
        [mine for mine in groups if mine],
        note=(
            "Orders observed at every three consecutive sizes, by the norm of the changes: median, least and largest; "
            "a change that is round-off or turns back has no order. Distances at their worst."
        ),
    )


def spread(orders: Iterable[float | None]) -> str:
    """Median, least and largest of the known orders."""
    known = [order for order in orders if order is not None]
    return f"{number(median(known))} ({number(min(known), 2)} to {number(max(known), 2)})" if known else "–"
