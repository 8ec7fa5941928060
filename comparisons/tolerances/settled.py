"""Values settled on the grids N/2, N and 2N: the finest values or their limits, with stated uncertainties.

:mod:`comparisons.verdict.uncertainty` gives limits and uncertainties.  Where the error may be uneven in N,
the value at N + N/7
takes part.

Shapes, places of contact, events and certificates are the finest answer's.  Where a contact is open on one grid and
closed on another, or the branches are different, values follow no common law: the finest value is kept.  The
uncertainty then follows from the grids with the finest answer's contacts and branch.  The ends of a contact zone are
kept as well if the limits would change places: the zone is then no longer than the ends are uncertain.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from comparisons.pairing import Uncertainties
from comparisons.stations import station_of
from comparisons.verdict.uncertainty import Error, error, limit
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array, frozen_array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Settled:
    """Settled values.

    Attributes:
        answer: the finest with the settled values.
        coarse: the answer at N.
        uncertainties: of the values at which N and 2N follow one law.
    """

    answer: Answer
    coarse: Answer
    uncertainties: Uncertainties


def settled(scene: Scene, answers: Mapping[int, Answer], probes: Collection[str]) -> Settled:
    """The settled answer with its uncertainties.

    Args:
        scene: the question.
        answers: complete answers by N: at N/2, N and 2N, and at N + N/7 where the error may be uneven.
        probes: names of the probes whose values are extrapolated; all others are kept.
    """
    finest = max(answers)
    fine = answers[finest]
    stations, uncertainties = [], {}
    for station in fine.stations:
        by_size = {n: station_of(answers[n], station.stage, station.value) for n in sorted(answers)}
        values = {}
        for probe in scene.probes:
            value, stated = _value(probe, by_size, extrapolate=probe.name in probes)
            values[probe.name] = frozen_array(value)
            if stated is not None:
                uncertainties[station.stage, station.value, probe.name] = stated
        # a limit belongs to no state: no forces in it balance
        stations.append(replace(station, values=frozendict(values), beams={}))
    answer = replace(fine, stations=tuple(stations), seconds=sum(each.seconds for each in answers.values()))
    if probes:
        sizes = (finest // 2, finest)
        settings = frozendict({**answer.settings, "extrapolated_from": list(sizes)})
        answer = replace(answer, settings=settings, notes=(*answer.notes, extrapolation_note(sizes, probes)))
    return Settled(answer, answers[finest // 2], frozendict(uncertainties))


def extrapolation_note(sizes: tuple[int, ...], probes: Collection[str]) -> str:
    """Note about the values that are extrapolated from two ``sizes``, and the grid of all other values."""
    coarse, fine = sizes
    which = ", ".join(sorted(probes))
    return (
        f"Extrapolated from N = {coarse}, {fine}: {which}; all other values, shapes and certificates are of N = {fine}."
    )


def _value(probe: Probe, by_size: Mapping[int, StationAnswer], *, extrapolate: bool) -> tuple[Array, Error | None]:
    """Value (k,) at a station and its uncertainty; None for this if N has no such value."""
    finest = max(by_size)
    fine = by_size[finest]
    value = fine.values[probe.name]
    sizes = [n for n, station in by_size.items() if _one_law(probe, station, fine)]
    if value.size == 0 or finest // 2 not in sizes:
        return value, None
    values = [by_size[n].values[probe.name] for n in sizes]
    if extrapolate and len(sizes) == len(by_size):
        found = limit(sizes, values)
        if probe.quantity != "ends" or np.all(np.diff(found.value) >= 0.0):
            return found.value, Error(found.uncertainty, np.zeros_like(found.uncertainty))
    return value, error(sizes, values, at=len(sizes) - 1)


def _one_law(probe: Probe, station: StationAnswer, fine: StationAnswer) -> bool:
    """Whether the values at two grids may follow one law: one branch, the same contacts, as many numbers."""
    alike = station.branch == fine.branch and station.touching.keys() == fine.touching.keys()
    return alike and station.values[probe.name].shape == fine.values[probe.name].shape
