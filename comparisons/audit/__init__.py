"""The audit of an answer: complaints, remarks, and the largest unbalance."""

from dataclasses import dataclass, fields

import numpy as np

from comparisons.audit.contacts import contacts, crossings
from comparisons.audit.laws import cuts, joints, path, probes, section_law, sums
from comparisons.audit.state import states_of
from comparisons.formats import at_station
from cprbm_scene import Answer, Scene

CHECKS = (joints, sums, cuts, section_law, contacts, probes)
"""Laws of one station."""


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
    complaints, sound, unbalances = [], [], [(0.0, 0.0)]
    states = list(states_of(scene, answer))
    for state in states:
        where, forces = f"at {at_station(scene, state.stage.name, state.station.value)}", state.station.forces
        numbers = [getattr(beam, field.name) for beam in state.station.beams.values() for field in fields(beam)]
        if np.isfinite(np.concatenate([*numbers, forces.force.ravel(), forces.moment, forces.place.ravel()])).all():
            sound.append(state)
            complaints += [f"{where} {said}" for check in CHECKS for excess, said in check(state) if not excess <= 0.0]
            unbalance = max(float(np.abs(state.unbalance(name)[1:-1]).max(initial=0.0)) for name in state.beams)
            unbalances.append((unbalance, unbalance / state.largest[1]))
        else:
            complaints.append(f"{where} a number is not finite")
    complaints += [said for excess, said in path(scene, answer, sound) if not excess <= 0.0]
    worst, scaled = np.max(unbalances, axis=0)
    return Audit(tuple(complaints), tuple(crossings(scene, sound)), len(states), float(worst), float(scaled))
