"""Opinions beside rows, on which no word of the verdict rests: claims of the source, a solid, another formulation.

*Claims* of the scene's source are met or not, station by station and as a whole.  A source divides a difference of a
force or a moment by the value at the station; a row divides by the largest value of the stage.  A claim is therefore
compared with the difference over the reference's own norm, unless this norm vanishes.  A claim with a value is compared
with the distance of the CPRBM from this value.

*Solid.*

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
x       value of the solid, extrapolated from meshes that double
u       stated uncertainty of x, the largest over the probe's stations in the stage
======  ==========================================================================================

The distance of a beam theory from x is the error of the theory, as far as u and the uncertainties of the solvers allow.
Away from corners quadrilaterals of second order converge with the fourth power of the element's size.  At the corner of
a face that is held the stress has no bound, and displacements converge with an order of about 1.5 (M. L. Williams,
Stress singularities resulting from various boundary conditions in angular corners of plates in extension, J. Appl.
Mech. 19 (1952) 526).  Three meshes show the order.  Two meshes do not, and their uncertainty reaches the limit of
order 1.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparisons.case import Comparison
from comparisons.formats import percent
from comparisons.quantities import VANISHING, norm
from comparisons.stations import find_station, station_of
from comparisons.verdict import (
    GRIDS,
    CriticalRow,
    Limit,
    Row,
    Runs,
    Third,
    away_from_point_forces,
    largest,
    limit,
    other_theory,
)
from cprbm_scene import CRITICAL, STRESSES, Answer, Claim, Flags, Scene, StationAnswer

_OF_THE_VALUE = frozenset({"force", "reaction", "reaction_moment"})
"""Quantities with claims on the share of the value itself."""


@dataclass(frozen=True, slots=True)
class Standing:
    """A claim beside all its stations.

    Attributes:
        claim: the claim.
        worst: the row, or the critical value, with the largest difference.
        difference: the largest difference, a fraction.
        met: stations with a smaller difference than the claimed bound.
        stations: all stations with a value of both sides.
    """

    claim: Claim
    worst: Row | CriticalRow
    difference: float
    met: int
    stations: int

    @property
    def holds(self) -> bool:
        """Whether the claim is met at every station."""
        return self.met == self.stations


def claim_of(scene: Scene, row: Row | CriticalRow) -> Claim | None:
    """The claim about a station, or about a stage with a critical value, otherwise about all; None without a claim."""
    place = "stage" if isinstance(row, CriticalRow) else "station"
    about = [claim for claim in scene.claims if _is_about(claim, row)]
    return min(about, key=lambda claim: getattr(claim, place) is None, default=None)


def _is_about(claim: Claim, row: Row | CriticalRow) -> bool:
    """Whether a claim is about a row; without a station the claim is about all stations of the probe."""
    if isinstance(row, CriticalRow):
        return claim.probe == CRITICAL and row.place == 0 and claim.in_stage(row.stage)
    return claim.probe == row.probe.name and claim.speaks_of(row.stage, row.station)


def claim_difference(row: Row) -> float | None:
    """Difference of the solvers as a source states differences, a fraction; None without a divisor."""
    own = norm(row.probe.quantity, row.fea)
    of_the_value = row.probe.quantity in _OF_THE_VALUE and own >= VANISHING * row.scale
    return (replace(row, denominator=own) if of_the_value else row).fraction(row.difference)


def claimed_difference(claim: Claim, row: Row | CriticalRow) -> float | None:
    """Difference from a claimed value, otherwise between the solvers, a fraction; None without such a difference."""
    if isinstance(row, CriticalRow):
        reference = row.fea.value if claim.value is None and row.fea is not None else claim.value
        if row.cprbm is None or reference is None:
            return None
        return abs(row.cprbm.value - reference) / (abs(reference) or row.span)
    if claim.value is None:
        return claim_difference(row)
    return abs(float(row.cprbm[0]) - claim.value) / (abs(claim.value) or row.scale) if row.cprbm.size == 1 else None


def claim_met(claim: Claim | None, row: Row | CriticalRow) -> bool | None:
    """Whether the difference stays below the claimed bound; None without a claim or a difference."""
    found = None if claim is None else claimed_difference(claim, row)
    return None if claim is None or found is None else found <= claim.bound


def standings(scene: Scene, rows: Sequence[Row], criticals: Sequence[CriticalRow] = ()) -> tuple[Standing, ...]:
    """Every claim with a row or critical value, in the scene's order."""
    found: list[Standing] = []
    for claim in scene.claims:
        about: list[Row | CriticalRow] = [row for row in rows if _is_about(claim, row)]
        about += (row for row in criticals if _is_about(claim, row))
        mine = [(off, row) for row in about if (off := claimed_difference(claim, row)) is not None]
        if mine:
            off, worst = max(mine, key=lambda each: each[0])
            found.append(Standing(claim, worst, off, sum(each <= claim.bound for each, _ in mine), len(mine)))
    return tuple(found)


def solid_limit(
    scene: Scene, row: Row, answers: Sequence[Answer], beside: Sequence[StationAnswer] = ()
) -> tuple[Limit, Flags] | None:
    """Limit (k,) of the solid at a row, and the components that count; None if the two finest meshes lack such values.

    Args:
        scene: the question.
        row: of a comparison.
        answers: the solid's, on meshes each twice as fine as the mesh before; all complete.
        beside: other answers to the row. A stress does not count near held ends and near their contacts.
    """
    stations = [station_of(answer, row.stage, row.station) for answer in answers[-GRIDS:]]
    values = [station.values[row.probe.name] for station in stations]
    alike = [value.shape == row.fea.shape for value in values]
    if len(values) < 2 or not all(alike[-2:]):
        return None
    first = max((place + 1 for place, same in enumerate(alike) if not same), default=0)
    counts = np.ones(row.fea.shape, dtype=bool)
    if row.probe.quantity in STRESSES and row.arc_length is not None:
        counts = away_from_point_forces(scene, row.probe.of, row.arc_length, (*stations[-2:], *beside))
    return limit([2.0**place for place in range(first, len(values))], values[first:]), counts


def contact_model(runs: Runs, row: Row) -> float | None:
    """Distance |v_p − v_a| of the values in ``paper`` and ``auto``, in the probe's unit and in one beam theory.

    None where a value is missing, has another shape, or lies on another branch.
    """
    answers = [runs.answers[name] for name in runs.formulations if name in runs.answers]
    stations = [find_station(answer, *row.where) for answer in answers]
    found = [at.values[row.probe.name] for at in stations if at is not None and at.branch == row.branch]
    known = row.counts is not None and [value.shape for value in found] == [row.fea.shape] * 2
    return norm(row.probe.quantity, (found[0] - found[1])[row.counts]) if known else None


def thirds_of(compared: Comparison) -> tuple[Row, ...]:
    """Rows with values of all answers; none without a solid that reached the last station."""
    scene, runs, found = compared.scene, compared.runs, list[tuple[Row, Third]]()
    if not all(answer.completed for answer in runs.solids):
        return ()
    for row in (row for row in compared.rows if row.bounds is not None):
        limited = solid_limit(scene, row, runs.solids, (station_of(runs.answers["fea"], *row.where),))
        if limited is not None and limited[1].any():
            x, counts, quantity = limited[0].value, limited[1], row.probe.quantity
            beside = (row.cprbm, row.fea, None if math.isnan(row.theory) else row.other)
            off = (math.nan if value is None else norm(quantity, (value - x)[counts]) for value in beside)
            found.append((row, Third(x, norm(quantity, limited[0].uncertainty[counts]), *off)))
    widest = largest(((row.probe.name, row.stage), third.uncertainty) for row, third in found)
    pairs = ((row, replace(third, uncertainty=widest[row.probe.name, row.stage])) for row, third in found)
    return tuple(replace(row, third=third) for row, third in pairs)


def solid_sentence(compared: Comparison) -> str:
    """Largest distances from the solid at the last station with a displacement or a rotation; empty without a solid."""
    runs = compared.runs
    if not runs.solids:
        return ""
    for answer in runs.solids:
        if not answer.completed:
            return f"The solid has no complete answer: {answer.ending.value}. {answer.sentence}"
    moved = [row for row in thirds_of(compared) if row.probe.quantity in ("displacement", "rotation")]
    if not moved:
        return "The solid has no displacement or rotation beside the beam theories."
    last = [row for row in moved if row.where == moved[-1].where]
    return (
        f"Beside the solid, displacements and rotations at the last station are off by at most "
        f"{_largest(last, 'fea')} in {runs.theory} (finite elements) and {_largest(last, 'other')} in "
        f"{other_theory(runs.theory)} (CPRBM); the solid is uncertain by {_largest(last, 'uncertainty')}."
    )


def _largest(found: Sequence[Row], size: str) -> str:
    """Largest fraction of the sizes of a name."""
    fractions = (row.fraction(getattr(row.third, size)) for row in found)
    return percent(max((fraction for fraction in fractions if fraction is not None), default=None))
