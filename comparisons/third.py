"""The third opinion: values of the beam theories beside the mechanism as a solid.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
x       value of the solid, extrapolated from its meshes (:mod:`comparisons.solid_limits`)
u       stated uncertainty of x, the largest over the probe's stations in the stage
======  ==========================================================================================

The distance of a beam theory from x is the error of the theory, as far as u and the uncertainties of the solvers allow.
No word of the verdict rests on these distances: a beam theory has an error of its own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from comparisons.case import Comparison
from comparisons.formats import percent
from comparisons.quantities import norm
from comparisons.solid_limits import solid_limit
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from comparisons.verdict.uncertainty import largest
from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Third:
    """A row beside the solid.

    Attributes:
        row: the row.
        solid: x (k,), in the probe's unit.
        uncertainty: u, in the probe's unit.
        cprbm, fea, other: distances from x of the CPRBM, of the finite elements, and of the CPRBM in the other theory;
            NaN without a value.
    """

    row: Row
    solid: Array
    uncertainty: float
    cprbm: float
    fea: float
    other: float


def thirds_of(compared: Comparison) -> tuple[Third, ...]:
    """Rows with values of all answers; none without a solid that reached the last station."""
    scene, runs, found = compared.scene, compared.runs, list[Third]()
    if runs.solid is None or not all(answer.completed for answer in runs.solid):
        return ()
    for row in (row for row in compared.rows if row.bounds is not None):
        limited = solid_limit(scene, row, runs.solid, (station_of(runs.reference, *row.where),))
        if limited is not None and limited[1].any():
            x, counts, quantity = limited[0].value, limited[1], row.probe.quantity
            beside = (row.cprbm, row.fea, None if math.isnan(row.theory) else row.other)
            off = (math.nan if value is None else norm(quantity, (value - x)[counts]) for value in beside)
            found.append(Third(row, x, norm(quantity, limited[0].uncertainty[counts]), *off))
    widest = largest(((one.row.probe.name, one.row.stage), one.uncertainty) for one in found)
    return tuple(replace(one, uncertainty=widest[one.row.probe.name, one.row.stage]) for one in found)


def sentence(compared: Comparison) -> str:
    """Largest distances from the solid at the last station with a displacement or a rotation; empty without a solid."""
    runs = compared.runs
    if runs.solid is None:
        return ""
    for answer in runs.solid:
        if not answer.completed:
            return f"The solid has no complete answer: {answer.ending.value}. {answer.sentence}"
    moved = [one for one in thirds_of(compared) if one.row.probe.quantity in ("displacement", "rotation")]
    if not moved:
        return "The solid has no displacement or rotation beside the beam theories."
    last = [one for one in moved if one.row.where == moved[-1].row.where]
    return (
        f"Beside the solid, displacements and rotations at the last station are off by at most "
        f"{_largest(last, 'fea')} in {runs.theory} (finite elements) and {_largest(last, 'other')} in "
        f"{runs.other_theory} (CPRBM); the solid is uncertain by {_largest(last, 'uncertainty')}."
    )


def _largest(found: Sequence[Third], size: str) -> str:
    """Largest fraction of the sizes of a name."""
    fractions = (one.row.fraction(getattr(one, size)) for one in found)
    return percent(max((fraction for fraction in fractions if fraction is not None), default=None))
