"""What a scene's source claims, beside our rows: met or not, station by station and as a whole.

Claims have no part in the verdict.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.measures import Row
from scene import Claim, Scene


@dataclass(frozen=True, slots=True)
class Standing:
    """How a claim stands over all its stations.

    Attributes:
        claim: what is claimed.
        worst: the row with our largest difference, as a fraction.
        met: stations at which that claim is met.
        stations: all at which both sides have something to say.
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
    return next(
        (claim for own in (True, False) for claim in scene.claims if (claim.station is not None) is own
         and _is_about(claim, row)),
        None,
    )  # fmt: skip


def claim_met(claim: Claim | None, row: Row) -> bool | None:
    """Whether our difference stays below the claimed bound; None where either is missing."""
    fraction = row.fraction(row.difference)
    return None if claim is None or fraction is None else fraction <= claim.bound


def standings(scene: Scene, rows: Sequence[Row]) -> tuple[Standing, ...]:
    """Every claim that some row can be held against, in the scene's order."""
    found = []
    for claim in scene.claims:
        mine = [(fraction, row) for row in rows if _is_about(claim, row)
                and (fraction := row.fraction(row.difference)) is not None]  # fmt: skip
        if mine:
            worst = max(mine, key=lambda each: each[0])[1]
            met = sum(fraction <= claim.bound for fraction, _ in mine)
            found.append(Standing(claim, worst, met, len(mine)))
    return tuple(found)


def _is_about(claim: Claim, row: Row) -> bool:
    """Whether a claim is about a row; without a station it is about all of its probe."""
    if claim.probe != row.probe.name:
        return False
    return claim.station is None or math.isclose(claim.station, row.station, rel_tol=1e-12)
