"""The third opinion: the beam theories beside the mechanism as a solid.

The solid's value x is extrapolated from its meshes, and u is its stated uncertainty, the largest over the probe's
stations in the stage (:mod:`comparisons.solid_limits`).  The distances of the beam theories from x are their errors, as
far as u and their own uncertainties allow.  Nothing of
the verdict rests on them: a beam theory that is as far from the solid as it must be is not wrong.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from comparisons.case import Comparison
from comparisons.formats import percent
from comparisons.quantities import norm
from comparisons.solid_limits import solid_limit
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from comparisons.verdict.uncertainty import largest
from cprbm_scene.answer import Array, Flags


@dataclass(frozen=True, slots=True)
class Third:
    """One row and what the solid says of it.

    ``solid`` is x (k,); ``uncertainty`` u, and ``cprbm``, ``fea`` and ``other`` the distances from x of the CPRBM, of
    the finite elements, and of the CPRBM in the other theory, in the probe's unit; NaN without a value.
    """

    row: Row
    solid: Array
    uncertainty: float
    cprbm: float
    fea: float
    other: float


def thirds_of(compared: Comparison) -> tuple[Third, ...]:
    """The rows at which all answers have a value; none where the solid was not asked or did not arrive."""
    scene, runs = compared.scene, compared.runs
    if runs.solid is None or not all(answer.completed for answer in runs.solid):
        return ()
    found = []
    for row in compared.rows:
        if row.bounds is None:
            continue
        limited = solid_limit(scene, row, runs.solid, (station_of(runs.reference, row.stage, row.station),))
        if limited is None or not limited[1].any():
            continue
        (x, u), counts = (limited[0].value, limited[0].uncertainty), limited[1]

        def size(difference: Array, row: Row = row, counts: Flags = counts) -> float:
            return norm(row.probe.quantity, difference[counts])

        other = math.nan if math.isnan(row.theory) or row.other is None else size(row.other - x)
        found.append(Third(row, x, size(u), size(row.cprbm - x), size(row.fea - x), other))
    widest = largest(((one.row.probe.name, one.row.stage), one.uncertainty) for one in found)
    return tuple(replace(one, uncertainty=widest[one.row.probe.name, one.row.stage]) for one in found)


def sentence(compared: Comparison) -> str:
    """What the beam theories miss together, at the last station at which all have a displacement or rotation."""
    runs = compared.runs
    if runs.solid is None:
        return ""
    for answer in runs.solid:
        if not answer.completed:
            return f"The solid says nothing: {answer.ending.value}. {answer.sentence}"
    moved = [one for one in thirds_of(compared) if one.row.probe.quantity in ("displacement", "rotation")]
    if not moved:
        return "The solid has no displacement or rotation to hold the beam theories against."
    last = [one for one in moved if (one.row.stage, one.row.station) == (moved[-1].row.stage, moved[-1].row.station)]

    def largest(values: list[float | None]) -> str:
        return percent(max((value for value in values if value is not None), default=None))

    return (
        f"Beside the solid, displacements and rotations at the last station are off by at most "
        f"{largest([one.row.fraction(one.fea) for one in last])} in {runs.theory} (finite elements) and "
        f"{largest([one.row.fraction(one.other) for one in last])} in {runs.other_theory} (CPRBM); the solid is "
        f"uncertain by {largest([one.row.fraction(one.uncertainty) for one in last])}."
    )
