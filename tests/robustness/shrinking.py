"""A scene made smaller for as long as it ends alike: what is left of it is what it takes.

It is shrunk as plain data, by steps from the largest to the smallest: whole stages, things that have a name with all
that speaks of them, stations, probes; then curves and sections made simple; then numbers rounded.  A step is taken if
the smaller scene ends in the same way (with the same ending), and then all are tried again, until none helps or so
many have been tried, or so many seconds have passed.
"""

from __future__ import annotations

import copy
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any

from comparisons.present.columns import Plain

_NAMED = ("contacts", "loads", "drives", "stops", "pins", "beams", "bodies")
_REFERENCES = ("beam", "body", "point", "towards", "steps", "of", "between", "points")


@dataclass(frozen=True, slots=True)
class Patience:
    """With how many attempts, and in how many seconds of the clock, a scene is to be shrunk."""

    attempts: int = 120
    seconds: float = 60.0


def shrunk(data: Plain, alike: Callable[[Plain], bool], patience: Patience) -> Plain:
    """The smallest scene that was found.

    Args:
        data: a scene as plain data, which is left as it is.
        alike: whether a scene is one and ends as this one does.
        patience: how long to try.
    """
    end = time.monotonic() + patience.seconds
    left = patience.attempts
    tried: set[str] = set()
    found = True
    while found:
        found = False
        for smaller in steps(data):
            key = repr(smaller)
            if key in tried:
                continue
            tried.add(key)
            if left == 0 or time.monotonic() > end:
                return data
            left -= 1
            if alike(smaller):
                data, found = smaller, True
                break
    return data


def steps(data: Plain) -> Iterator[Plain]:
    """Smaller scenes, each by one step, the largest steps first; none is the same."""
    every = chain(
        _without(data, "claims"),
        _fewer(data, "stages"),
        _without_names(data),
        _without(data, "assembly"),
        _fewer_stations(data),
        _fewer(data, "probes"),
        _without_keys(data),
        _simpler_beams(data),
        _rounded(data),
    )
    return (each for each in every if each != data)


def _without(data: Plain, key: str) -> Iterator[Plain]:
    """What need not be there, left out as a whole."""
    if key in data:
        yield {other: value for other, value in data.items() if other != key}


def _fewer(data: Plain, key: str) -> Iterator[Plain]:
    """A list by halves, and then without each of its items; something is always left."""
    items = list(data.get(key, ()))
    half = len(items) // 2
    if half > 1:
        yield _whole({**data, key: items[:half]})
        yield _whole({**data, key: items[half:]})
    if len(items) > 1:
        for place in reversed(range(len(items))):
            yield _whole({**data, key: items[:place] + items[place + 1 :]})


def _fewer_stations(data: Plain) -> Iterator[Plain]:
    for place, stage in enumerate(data["stages"]):
        for fewer in _fewer({"stations": stage["stations"]}, "stations"):
            smaller = {**stage, **fewer}
            if "shown" in stage:
                smaller["shown"] = [value for value in stage["shown"] if value in fewer["stations"]]
            yield {**data, "stages": [*data["stages"][:place], smaller, *data["stages"][place + 1 :]]}


def _without_names(data: Plain) -> Iterator[Plain]:
    for table in _NAMED:
        for name in data.get(table, {}):
            rest = {other: each for other, each in data[table].items() if other != name}
            yield _whole({**data, table: rest})


def _without_keys(data: Plain) -> Iterator[Plain]:
    """Without what a record need not say."""
    for place, stage in enumerate(data["stages"]):
        for key in ("beyond", "shown", "critical_limit"):
            if key in stage:
                less = {other: value for other, value in stage.items() if other != key}
                yield {**data, "stages": [*data["stages"][:place], less, *data["stages"][place + 1 :]]}
    for table, keys in (("contacts", ("paper", "thick")), ("beams", ("paper",)), ("stops", ("least", "most"))):
        for name, record in data.get(table, {}).items():
            for key in keys:
                if key in record:
                    less = {other: value for other, value in record.items() if other != key}
                    yield {**data, table: {**data[table], name: less}}


def _simpler_beams(data: Plain) -> Iterator[Plain]:
    for name, beam in data["beams"].items():
        for simpler in chain(_simpler_curves(beam["curve"]), _even(beam)):
            yield {**data, "beams": {**data["beams"], name: {**beam, **simpler}}}


def _even(beam: Plain) -> Iterator[Plain]:
    """A section that varies made one that does not."""
    for key in ("thickness", "width"):
        if isinstance(beam[key], Mapping):
            yield {key: max(beam[key]["values"])}


def _simpler_curves(curve: Plain) -> Iterator[Plain]:
    """A line between the same ends; a spline through fewer points; a polynomial of a lower degree."""
    ends = _ends(curve)
    if curve["kind"] != "line" and ends is not None:
        yield {"curve": {"kind": "line", "start": ends[0], "end": ends[1]}}
    points = curve.get("points", [])
    for place in range(1, len(points) - 1):
        if len(points) > 3:
            yield {"curve": {**curve, "points": points[:place] + points[place + 1 :]}}


def _ends(curve: Plain) -> tuple[list[float], list[float]] | None:
    """Where a curve begins and ends; None of a polynomial, whose ends are computed numbers."""
    match curve["kind"]:
        case "spline":
            return curve["points"][0], curve["points"][-1]
        case "arc":
            return curve["start"], curve["end"]
    return None


def _rounded(data: Plain) -> Iterator[Plain]:
    for digits in (1, 2, 3, 4, 6):
        yield _with_numbers(data, digits)


def _with_numbers(value: Any, digits: int) -> Any:
    """The same with all its numbers rounded to so many digits."""
    match value:
        case bool() | str() | int():
            return value
        case float():
            return float(f"{value:.{digits}g}")
        case Mapping():
            return {key: _with_numbers(each, digits) for key, each in value.items()}
        case list():
            return [_with_numbers(each, digits) for each in value]
    return copy.copy(value)


def _whole(data: Plain) -> Plain:
    """The scene without all that speaks of what it has not; to that belong points that nobody speaks of."""
    while True:
        names = _names(data)
        smaller = {key: _spoken_for(value, names) if key not in ("materials", "bodies") else value
                   for key, value in data.items()}  # fmt: skip
        if smaller == data:
            return {key: value for key, value in data.items() if value not in ({}, [])}
        data = smaller


def _names(data: Plain) -> set[str]:
    points = {point for body in data.get("bodies", {}).values() for point in body["points"]}
    named = {name for table in (*_NAMED, "materials") for name in data.get(table, {})}
    return {"scene", *points, *named}


def _spoken_for(value: Any, names: set[str]) -> Any:
    """Of a table or a list of records those that speak of nothing that is missing."""
    match value:
        case Mapping():
            return {key: each for key, each in value.items() if not _speaks_of_missing(each, names)}
        case list():
            return [each for each in value if not _speaks_of_missing(each, names)]
    return value


def _speaks_of_missing(record: object, names: set[str]) -> bool:
    if not isinstance(record, Mapping):
        return False
    spoken = [record[key] for key in _REFERENCES if key in record]
    texts = [text for each in spoken for text in (each if isinstance(each, list) else [each]) if isinstance(text, str)]
    return any(text not in names for text in texts)
