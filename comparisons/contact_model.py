"""Distance of the CPRBM's contact formulations ``paper`` and ``auto``, on which no word of the verdict rests."""

from __future__ import annotations

from comparisons.quantities import norm
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from comparisons.verdict.runs import Runs
from cprbm_scene import Answer
from cprbm_scene.answer import Array


def contact_model(runs: Runs, row: Row) -> float | None:
    """Distance |v_p − v_a| of the values in ``paper`` and ``auto``, in the probe's unit and in one beam theory.

    None where a value is missing, has another shape, or lies on another branch.
    """
    if runs.formulations is None or row.counts is None:
        return None
    paper, auto = (_value(answer, row) for answer in runs.formulations)
    if paper is None or auto is None or not paper.shape == auto.shape == row.fea.shape:
        return None
    return norm(row.probe.quantity, (paper - auto)[row.counts])


def _value(answer: Answer, row: Row) -> Array | None:
    """Value (k,) of an answer on the row's branch."""
    try:
        station = station_of(answer, row.stage, row.station)
    except KeyError:
        return None
    return station.values[row.probe.name] if station.branch == row.branch else None
