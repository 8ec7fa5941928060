"""The audit of an answer: complaints, remarks, and the largest unbalance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import partial

import numpy as np

from comparisons.audit.balance import CutErrors, cut_errors, cuts, sums
from comparisons.audit.contacts import contacts
from comparisons.audit.crossings import crossing_sentence, crossings
from comparisons.audit.joints import joints
from comparisons.audit.path import path
from comparisons.audit.probes import probes
from comparisons.audit.section_law import section_law
from comparisons.audit.state import StationState, states_of
from cprbm_scene import Answer, Scene


@dataclass(frozen=True, slots=True)
class Audit:
    """Findings of the audit of one answer.

    Attributes:
        complaints: one sentence for every law of statics or geometry that the answer breaks; empty for a right answer.
        crossings: one sentence for every undeclared crossing of beams and edges.
        stations: number of audited stations; 0 of an answer that states no internal forces.
        unbalance: largest difference of a stated moment from the moment of all that acts beyond, N·m, between the ends
            of a beam; near a contact force the lever within an element counts.
        scaled: the same over the largest moment at the station.
    """

    complaints: tuple[str, ...]
    crossings: tuple[str, ...]
    stations: int
    unbalance: float
    scaled: float


def audit(scene: Scene, answer: Answer) -> Audit:
    """Findings of the audit of ``answer`` by the ``scene`` and the answer alone, with nothing of any solver.

    An answer without internal forces of beams is not audited.
    """
    states = list(states_of(scene, answer))
    complaints, worst, scaled = [], 0.0, 0.0
    for state in states:
        where = f"at {state.station.stage} {state.station.value:g}"
        errors = {name: cut_errors(state, name) for name in state.beams}
        complaints += [f"{where} {complaint}" for complaint in _at_station(state, errors)]
        unbalance = max(float(moment[1:-1].max()) for _, (moment, _) in errors.values())
        worst, scaled = max(worst, unbalance), max(scaled, unbalance / state.largest[1])
    complaints += path(answer, states)
    crossing = tuple(crossing_sentence(scene, pair) for pair in crossings(scene, answer))
    return Audit(tuple(complaints), crossing, len(states), worst, scaled)


def _at_station(state: StationState, errors: Mapping[str, CutErrors]) -> Iterator[str]:
    """Complaints at one station; a state with a number that is not finite is not audited further."""
    numbers = [getattr(beam, field.name) for beam in state.station.beams.values() for field in fields(beam)]
    numbers += [state.station.forces.force.ravel(), state.station.forces.moment]
    if not np.isfinite(np.concatenate(numbers)).all():
        yield "states a number that is not finite"
    else:
        for check in (joints, sums, partial(cuts, errors=errors), section_law, contacts, probes):
            yield from check(state)
