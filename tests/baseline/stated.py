"""The stated uncertainty u of a solver's value v_n at size n, from a record.

A row of the comparison states u₀ at the comparison's size n₀; then u = (n₀/n)² u₀. Where no row states an uncertainty,
two recorded sizes n and m give u = S |v_n − v_m| / |1 − (n/m)²|, with the safety factor S = 1.25 (Roache). The larger
size is at least twice the smaller.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tests.baseline.measuring import Entry
from tests.baseline.runs import DEFAULT_SIZES
from tests.baseline.scales import norm

SAFETY = 1.25
"""Roache's factor for an error estimated from two grids of known order."""

ORDER = 2
"""Least order of convergence of both solvers."""

Place = tuple[str, float, str]
"""Stage, load and probe; the probe is empty for a station."""


def by_place(rows: Iterable[Entry]) -> dict[Place, Entry]:
    """Rows or stations by stage, load (to ten digits) and probe."""
    return {(row["stage"], float(f"{row['load']:.10g}"), row.get("probe", "")): row for row in rows}


class StatedUncertainty:
    """The stated uncertainties of one solver's run.

    Args:
        entry: the run.
        alike: the other entries of the same scene in the same record.
    """

    def __init__(self, entry: Entry, alike: Iterable[Entry]) -> None:
        self._solver: str = entry["solver"]
        self._size: int = entry["size"]
        self._rows: Mapping[Place, Entry] = {}
        self._other: Mapping[Place, Entry] = {}
        self._ratio = 1.0
        for other in alike:
            if other["solver"] == "comparison":
                self._rows = by_place(other.get("rows", ()))
            elif other["solver"] == self._solver and _apart(other["size"], self._size):
                self._other = by_place(other.get("stations", ()))
                self._ratio = (self._size / other["size"]) ** ORDER

    def of(self, place: Place, values: list[float]) -> float:
        """The stated uncertainty of ``values`` (k,) at a place, in the probe's unit; 0 where nothing is known."""
        stage, load, probe = place
        bound = self._rows[place]["uncertainty"].get(self._solver) if place in self._rows else None
        if bound is not None:
            return float(bound * (DEFAULT_SIZES[self._solver] / self._size) ** ORDER)
        station = self._other.get((stage, load, ""))
        others = [] if station is None else station["values"].get(probe, [])
        if len(others) != len(values):
            return 0.0
        change = norm(probe, [a - b for a, b in zip(values, others, strict=True)])
        return SAFETY * change / abs(1.0 - self._ratio)


def _apart(size: int, other: int) -> bool:
    """True if one of two sizes is at least twice the other."""
    return max(size, other) >= 2 * min(size, other)
