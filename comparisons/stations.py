"""Finding one station in an answer."""

from __future__ import annotations

import math

from cprbm_scene import Answer, StationAnswer


def station_of(answer: Answer, stage: str, value: float) -> StationAnswer:
    """An answer's station of a stage at a value of its load or drive.

    Raises:
        KeyError: the answer has none.
    """
    for station in answer.stations:  # mostly the very number, which is found sooner
        if station.value == value and station.stage == stage:
            return station
    for station in answer.stations:
        if station.stage == stage and math.isclose(station.value, value, rel_tol=1e-12, abs_tol=0.0):
            return station
    raise KeyError(f"{answer.solver} has no station {stage} {value:g}")
