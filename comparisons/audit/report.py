"""The audit of an answer: what does not hold, and how well the rest does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from comparisons.audit.asked import probed
from comparisons.audit.balance import at_nodes, cuts, sums, unbalance
from comparisons.audit.crossings import crossing_sentence, crossings
from comparisons.audit.edges import turned_inside_out
from comparisons.audit.gaps import contacts
from comparisons.audit.joints import held
from comparisons.audit.path import balance
from comparisons.audit.rest import rests_of
from comparisons.audit.second import saddles, smallest_curvature
from comparisons.audit.seen import Seen, seen_of
from cprbm_scene import Answer, Scene

LOOKED_AT = 5  # stations whose second variation is looked at, the last among them


@dataclass(frozen=True, slots=True)
class Audit:
    """What an auditor finds in an answer who knows the scene and the answer and no solver.

    Attributes:
        complaints: a sentence for everything that does not hold; empty if all does.
        remarks: a sentence for every pair of shapes that pass through each other without a contact.
        stations: how many were audited.
        unbalance: largest moment at a cut which the shape does not bear, N·m, where nothing acts near the cut.
        scaled: the same over the largest moment.
        curvature: smallest of the energy on the feasible directions, over the largest E·I over the square of the
            longest beam, at those stations where it was looked at; None where that is not known here.
    """

    complaints: tuple[str, ...]
    remarks: tuple[str, ...]
    stations: int
    unbalance: float
    scaled: float
    curvature: float | None


def audited(scene: Scene, answer: Answer) -> tuple[str, ...]:
    """What does not hold in an answer, in sentences; empty if all does, or if it does not say what acts."""
    return audit(scene, answer).complaints


def audit(scene: Scene, answer: Answer) -> Audit:
    """Look at every station of an answer."""
    stations = list(seen_of(scene, answer, rests_of(scene)))
    complaints: list[str] = []
    worst, scaled = 0.0, 0.0
    for seen in stations:
        where = f"at {seen.station.stage} {seen.station.value:g}"
        complaints += [f"{where} {what}" for what in _at_station(seen)]
        found = unbalance(seen)
        worst, scaled = max(worst, found[0]), max(scaled, found[1])
    curvatures = []
    for seen in stations[:: -max(1, -(-len(stations) // LOOKED_AT))]:
        curvature = smallest_curvature(seen)
        complaints += [f"at {seen.station.stage} {seen.station.value:g} {what}" for what in saddles(seen, curvature)]
        if curvature is not None:
            curvatures.append(curvature)
    complaints += balance(answer, stations)
    remarks = tuple(crossing_sentence(scene, crossing) for crossing in crossings(scene, answer))
    return Audit(tuple(complaints), remarks, len(stations), worst, scaled, min(curvatures, default=None))


def _at_station(seen: Seen) -> Iterator[str]:
    for look in (held, turned_inside_out, sums, cuts, at_nodes, contacts, probed):
        yield from look(seen)
