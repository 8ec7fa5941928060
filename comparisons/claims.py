"""Claims of a scene's source beside the rows of a comparison: met or not, station by station and as a whole.

A source divides a difference of a force or a moment by the value at the station; a row divides by the largest value of
the stage.  A claim is therefore compared with the difference over the reference's own norm, unless this norm vanishes.
A claim with a value is compared with the distance of the CPRBM from this value.  Claims take no part in the verdict.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from comparisons.quantities import VANISHING, norm
from comparisons.verdict.events import CriticalRow
from comparisons.verdict.rows import Row
from cprbm_scene import Claim, Scene
from cprbm_scene.statement import CRITICAL

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
