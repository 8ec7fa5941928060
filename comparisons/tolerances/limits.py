"""Values of an answer at several N: limits by Richardson's extrapolation, or the finest values.

:mod:`comparisons.verdict.uncertainty` gives limits and uncertainties; of a limit and a finest value the value with the
smaller uncertainty is taken, and of two grids the limit.  A coarser N takes part where the branch, the closed contacts
and the number of values are those of the finest answer.  Shapes, events and certificates are the finest answer's.  The
ends of a zone keep the finest values where the limits would change places: the zone is then no longer than the ends are
uncertain.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from comparisons.stations import station_of
from comparisons.verdict.runs import Uncertainties
from comparisons.verdict.uncertainty import Error, error, limit
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Limits:
    """The finest answer with limits as values.

    Attributes:
        answer: the answer; coarse: the answer at half the finest N.
        uncertainties: of all values at which both follow one law.
        probes: names of the probes with a limit.
    """

    answer: Answer
    coarse: Answer
    uncertainties: Uncertainties
    probes: tuple[str, ...]


def limits_of(scene: Scene, answers: Mapping[int, Answer]) -> Limits:
    """Limits of answers by N: complete answers at the finest N, at half of it, and at any further N."""
    n = max(answers)
    fine, stations, uncertainties, names = answers[n], list[StationAnswer](), {}, set[str]()
    for station in fine.stations:
        by_size = {size: station_of(answers[size], station.stage, station.value) for size in sorted(answers)}
        values = {}
        for probe in scene.probes_in(station.stage):
            values[probe.name], stated, extrapolated = _value(probe, by_size)
            names |= {probe.name} if extrapolated else set()
            if stated is not None:
                uncertainties[station.stage, station.value, probe.name] = stated
        # limits belong to no state: no forces are in balance with them
        stations.append(replace(station, values=frozendict(values), beams={}, forces=PointForces()))
    answer = replace(fine, stations=tuple(stations), seconds=sum(each.seconds for each in answers.values()))
    if names:
        answer = replace(
            answer,
            settings=frozendict({**fine.settings, "extrapolated_from": [n // 2, n]}),
            notes=(
                *fine.notes,
                f"Extrapolated from N = {n // 2}, {n}: {', '.join(sorted(names))}; all other values, shapes and "
                f"certificates are of N = {n}.",
            ),
        )
    probes = tuple(probe.name for probe in scene.probes if probe.name in names)
    return Limits(answer, answers[n // 2], frozendict(uncertainties), probes)


def _value(probe: Probe, by_size: Mapping[int, StationAnswer]) -> tuple[Array, Error | None, bool]:
    """Value (k,) at a station, its uncertainty (None without a law), and whether the value is a limit."""
    fine = by_size[n := max(by_size)]
    value = fine.values[probe.name]
    values = {
        size: station.values[probe.name]
        for size, station in by_size.items()
        if station.branch == fine.branch
        and station.touching.keys() == fine.touching.keys()
        and station.values[probe.name].shape == value.shape
    }
    if value.size == 0 or n // 2 not in values:
        return value, None, False
    sizes, series = list(values), list(values.values())
    own, found = error(sizes, series, at=len(sizes) - 1), limit(sizes, series)
    ordered = probe.quantity != "ends" or bool(np.all(np.diff(found.value) >= 0.0))
    surer = len(sizes) < 3 or found.uncertainty.sum() <= (own.even + own.uneven).sum()  # two grids show no order
    if not (ordered and surer):
        return value, own, False
    return frozen_array(found.value), Error(found.uncertainty, np.zeros_like(found.uncertainty)), True
