"""What a scene's source claims, beside our rows: met or not, station by station and as a whole.

A source's relative difference of a force or a moment is one of the value there, and not of the largest in the stage by
which our rows measure it.  A claim is therefore held against the difference over the reference's own norm, as long
as that does not vanish.  Where a claim states a value, it is held against the CPRBM's distance from that.  Claims have
no part in the verdict.
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
"""Quantities whose rows are measured by the stage's largest, and claims by the value itself."""


@dataclass(frozen=True, slots=True)
class Standing:
    """How a claim stands over all its stations.

    Attributes:
        claim: what is claimed.
        worst: the row, or the critical value, with our largest difference.
        difference: that difference, as a fraction.
        met: stations at which the claim is met.
        stations: all at which both sides have a value.
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


def claim_of(scene: Scene, row: Row) -> Claim | None:
    """What is claimed of a row: at its own station, or else at every station of its probe; None if nothing is."""
    about = [claim for claim in scene.claims if _is_about(claim, row)]
    own = [claim for claim in about if claim.station is not None]
    return next(iter((*own, *about)), None)


def as_claimed(row: Row) -> Row:
    """The row with its fractions taken as a claim takes them."""
    own = norm(row.probe.quantity, row.fea)
    of_the_value = row.probe.quantity in _OF_THE_VALUE and own >= VANISHING * row.scale
    return replace(row, denominator=own) if of_the_value else row


def claim_difference(row: Row) -> float | None:
    """Our difference as a claim takes it, a fraction; None where there is none."""
    return as_claimed(row).fraction(row.difference)


def claimed_difference(claim: Claim, row: Row) -> float | None:
    """Our difference from what a claim says: from its value, or between the solvers; None where there is none."""
    if claim.value is None:
        return claim_difference(row)
    if row.cprbm.size != 1:
        return None
    return abs(float(row.cprbm[0]) - claim.value) / (abs(claim.value) or row.scale)


def claim_met(claim: Claim | None, row: Row) -> bool | None:
    """Whether our difference stays below the claimed bound; None where either is missing."""
    found = None if claim is None else claimed_difference(claim, row)
    return None if claim is None or found is None else found <= claim.bound


def standings(scene: Scene, rows: Sequence[Row], criticals: Sequence[CriticalRow] = ()) -> tuple[Standing, ...]:
    """Every claim that some row or critical value can be held against, in the scene's order."""
    found = []
    for claim in scene.claims:
        mine: list[tuple[float, Row | CriticalRow]] = []
        if claim.probe == CRITICAL:
            of_stages = [each for each in criticals if _is_about_critical(claim, each)]
            mine += [(off, each) for each in of_stages if (off := critical_difference(claim, each)) is not None]
        else:
            mine += [
                (off, row)
                for row in rows
                if _is_about(claim, row) and (off := claimed_difference(claim, row)) is not None
            ]
        if mine:
            off, worst = max(mine, key=lambda each: each[0])
            found.append(Standing(claim, worst, off, sum(each <= claim.bound for each, _ in mine), len(mine)))
    return tuple(found)


def claim_of_critical(scene: Scene, found: CriticalRow) -> Claim | None:
    """What is claimed of a critical value, in its stage or else in all; None if nothing is."""
    about = [claim for claim in scene.claims if claim.probe == CRITICAL and _is_about_critical(claim, found)]
    own = [claim for claim in about if claim.stage is not None]
    return next(iter((*own, *about)), None)


def critical_difference(claim: Claim, found: CriticalRow) -> float | None:
    """Of the CPRBM's critical value from the claimed one, or else from the finite elements', a fraction."""
    reference = found.fea.value if claim.value is None and found.fea is not None else claim.value
    if found.cprbm is None or reference is None:
        return None
    return abs(found.cprbm.value - reference) / (abs(reference) or found.span)


def _is_about_critical(claim: Claim, found: CriticalRow) -> bool:
    return found.place == 0 and claim.in_stage(found.stage)


def _is_about(claim: Claim, row: Row) -> bool:
    """Whether a claim is about a row; without a station it is about all of its probe."""
    return claim.probe == row.probe.name and claim.speaks_of(row.stage, row.station)
