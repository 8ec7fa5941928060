"""The difference of a row as a sum of steps, on which no word of the verdict rests.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM, v_a in the formulation ``auto``, v_p in ``paper``
v_b     value of the finite elements in ``bending``, v_s in ``stretch``, v_f in the chosen theory
======  ==========================================================================================

    v_c − v_f = (v_c − v_a) + (v_a − v_b) + (v_b − v_s) + (v_s − v_f)

A step is shown as its component along v_c − v_f.  The distance |v_p − v_a| shows the contact model's part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from comparisons.choices import KINEMATICS
from comparisons.pairing import Runs
from comparisons.quantities import direction, norm
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from cprbm_scene import Answer
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Steps:
    """Components of the difference along itself, in the probe's unit.

    ``contact`` leads from the formulation ``paper`` to ``auto``, ``own`` from there to the finite elements in
    ``bending``, ``stretch`` and ``shear`` to each further theory.
    """

    contact: float
    own: float
    stretch: float
    shear: float


def steps_of(runs: Runs, row: Row) -> Steps | None:
    """Steps of a row's difference; None without one, or where a run between lacks the value."""
    if row.counts is None or row.bounds is None or len(runs.fea) <= KINEMATICS.index(runs.kinematics):
        return None
    theories = [runs.fea[theory][0] for theory in KINEMATICS[: KINEMATICS.index(runs.kinematics) + 1]]
    ladder = [_value(answer, row) for answer in (runs.cprbm[0], runs.auto or runs.cprbm[0], *theories)]
    values = [value[row.counts] for value in ladder if value is not None and value.shape == row.fea.shape]
    if len(values) < len(ladder):
        return None
    along = direction(row.probe.quantity, values[0] - values[-1])
    parts = [float(np.dot(one - other, along)) for one, other in pairwise(values)]
    return Steps(*parts, *(0.0,) * (4 - len(parts))) if along.any() else None


def contact_model(runs: Runs, row: Row) -> float | None:
    """Distance |v_p − v_a| in the probe's unit; None where one is missing or on another branch."""
    if runs.formulations is None or row.counts is None:
        return None
    paper, auto = (_value(answer, row) for answer in runs.formulations)
    if paper is None or auto is None or not paper.shape == auto.shape == row.fea.shape:
        return None
    return norm(row.probe.quantity, (paper - auto)[row.counts])


def largest_difference(row: Row) -> float:
    """Difference of the largest stresses, Pa; NaN of other quantities and without a difference."""
    if row.arc_length is None or row.counts is None:
        return math.nan
    return abs(norm(row.probe.quantity, row.cprbm) - norm(row.probe.quantity, row.fea))


def _value(answer: Answer, row: Row) -> Array | None:
    """Value (k,) of an answer on the row's branch."""
    try:
        station = station_of(answer, row.stage, row.station)
    except KeyError:
        return None
    return station.values[row.probe.name] if station.branch == row.branch else None
