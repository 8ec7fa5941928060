"""The same loads by other steps."""

from __future__ import annotations

from math import isclose

from tests.relations.image import Data, Image, copied

SHARE = 0.381
"""Where between two stations a further one is put: no half, which a solver's own cutting would find by itself."""


def finer(data: Data) -> Image:
    """A station more on the way to every station."""
    new = copied(data)
    reached: dict[str, float] = {}
    for stage in new["stages"]:
        stations: list[float] = []
        before = reached.get(stage["steps"], 0.0)
        for value in stage["stations"]:
            between = before + SHARE * (value - before)
            if not any(isclose(between, other, rel_tol=1e-9) for other in (*stage["stations"], *stations)):
                stations.append(between)
            stations.append(value)
            before = value
        stage["stations"] = stations
        reached[stage["steps"]] = before
    return Image("a station more before each", new)


def coarser(data: Data) -> Image:
    """Every stage straight to its last station."""
    new = copied(data)
    for stage in new["stages"]:
        stage["stations"] = stage["stations"][-1:]
        stage.pop("shown", None)
    return Image("straight to the last station", new)
