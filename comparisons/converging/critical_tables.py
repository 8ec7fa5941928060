"""Table, sentences and entries of the documented JSON for critical values at a family of sizes."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.converging.critical import CriticalFamily
from comparisons.display_units import distance_text, with_unit
from comparisons.documents import Plain, plain
from comparisons.formats import number
from comparisons.sheet import Sheet
from cprbm_scene import Scene

_NAMES = {"cprbm": "CPRBM", "fea": "FEA"}


def entry(sizes: Sequence[int], family: CriticalFamily) -> Plain:
    """One entry of ``families``; the probe is ``critical``, its component the stage's name."""
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
        "order": plain(limit.order) if limit is not None else None,
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


def sheet_of(scene: Scene, title: str, sizes: Sequence[int], families: Sequence[CriticalFamily]) -> Sheet:
    """Critical values against N, and their limits."""
    body = tuple(
        (
            family.stage if family.place == 0 else f"{family.stage}, {family.place + 1}",
            f"{_NAMES[family.series.method]} ({family.series.variant})",
            family.mechanism,
            *(
                with_unit(scene, family.critical[n].value, family.unit, 6) if n in family.critical else "–"
                for n in sizes
            ),
            "–" if family.found is None else number(family.found.order),
            "–" if family.found is None else with_unit(scene, float(family.found.value[0]), family.unit, 5),
            "–" if family.found is None else distance_text(scene, float(family.found.uncertainty[0]), family.unit),
        )
        for family in families
    )
    return Sheet(
        f"{title}: critical values against N",
        ("stage", "solver", "how", *(str(n) for n in sizes), "order", "limit", "±"),
        body,
        "Of the load or drive that the stage steps. The order is observed at the three finest sizes that count.",
    )


def sentences_of(scene: Scene, families: Sequence[CriticalFamily]) -> tuple[str, ...]:
    """How far the limits of the CPRBM and of the finite elements in ``bending`` are apart."""
    found = []
    fea = {(each.stage, each.place): each for each in families if each.series.variant == "bending"}
    for one in families:
        other = fea.get((one.stage, one.place))
        if one.series.method != "cprbm" or other is None or one.found is None or other.found is None:
            continue
        apart = abs(float(one.found.value[0] - other.found.value[0]))
        may = float(one.found.uncertainty[0] + other.found.uncertainty[0])
        same = "by the same mechanism" if one.mechanism == other.mechanism else "by different mechanisms"
        found.append(
            f"The limits of the critical value in {one.stage} are {distance_text(scene, apart, one.unit)} apart within "
            f"bending, where {distance_text(scene, may, one.unit)} are stated, {same}: {one.mechanism} in the CPRBM, "
            f"{other.mechanism} in the finite elements."
        )
    return tuple(found)
