"""What a scene's source claims, beside our rows: met or not, station by station and as a whole.

A source's relative difference of a force or a moment is one of the value there, and not of the largest in the stage by
which our rows measure it.  A claim is therefore held against the difference over the reference's own norm, as long
as that does not vanish.  Claims have no part in the verdict.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from comparisons.measures import Row
from comparisons.scales import VANISHING, norm
from scene import Claim, Scene

_OF_THE_VALUE = frozenset({"force", "reaction", "reaction_moment"})
"""Quantities whose rows are measured by the stage's largest, and claims by the value itself."""


@dataclass(frozen=True, slots=True)
class Standing:
    """How a claim stands over all its stations.

    Attributes:
        claim: what is claimed.
        worst: the row with our largest difference, as a fraction.
        met: stations at which the claim is met.
        stations: all at which both sides have a value.
    """

    claim: Claim
    worst: Row
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


def claim_met(claim: Claim | None, row: Row) -> bool | None:
    """Whether our difference stays below the claimed bound; None where either is missing."""
    found = claim_difference(row)
    return None if claim is None or found is None else found <= claim.bound


def standings(scene: Scene, rows: Sequence[Row]) -> tuple[Standing, ...]:
    """Every claim that some row can be held against, in the scene's order."""
    found = []
    for claim in scene.claims:
        about = [row for row in rows if _is_about(claim, row)]
        mine = [(difference, row) for row in about if (difference := claim_difference(row)) is not None]
        if mine:
            worst = max(mine, key=lambda each: each[0])[1]
            met = sum(claim_met(claim, row) is True for _, row in mine)
            found.append(Standing(claim, worst, met, len(mine)))
    return tuple(found)


def _is_about(claim: Claim, row: Row) -> bool:
    """Whether a claim is about a row; without a station it is about all of its probe."""
    return claim.probe == row.probe.name and claim.speaks_of(row.station)
