"""States of contacts by their forces, and openings of contacts between stations.

A contact is active where its forces exceed a floor: round-off leaves forces of 1e-15 N in contacts that only touch.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

import numpy as np

from cprbm_scene.answer import Array, ContactState, Event, PointForces, StationAnswer, frozen_array
from cprbm_scene.statement import Scene

ACTIVE = 1e-9
"""Floor of an active contact's force, over the largest force at the station: round-off leaves far less."""

UNLOADED = 1e-12
"""The same over the natural force, the largest E·I over the square of the longest beam: no load acts below."""


def contact_states(
    names: Iterable[str], forces: PointForces, touching: Mapping[str, Array], natural: tuple[float, float]
) -> Mapping[str, ContactState]:
    """States of the contacts ``names`` by their forces; ``natural`` are the scene's length (m) and force (N).

    A moment counts as a force at the natural length.  Without any forces a contact that touches is active.
    """
    size = np.hypot(forces.force[:, 0], forces.force[:, 1]) + np.abs(forces.moment) / natural[0]
    floor = max(ACTIVE * float(np.max(size, initial=0.0)), UNLOADED * natural[1])
    source, nowhere = np.array(forces.source, dtype=str), frozen_array(np.zeros((0, 2)))
    return {
        name: ContactState(
            bool(size[source == name].sum() > floor) if len(size) else name in touching, touching.get(name, nowhere)
        )
        for name in names
    }


def openings(scene: Scene, stations: Sequence[StationAnswer]) -> tuple[Event, ...]:
    """Events of contacts with forces at a station and without forces at the next station of the same branch.

    Between two stages the interval begins where the stepped load or drive stands before the later stage.
    """
    found, reached = [], dict.fromkeys((*scene.loads, *scene.drives), 0.0)
    steps = {stage.name: stage.steps for stage in scene.stages}
    for before, after in pairwise(stations):
        reached[steps[before.stage]] = before.value
        if before.branch == after.branch:
            low, high = sorted((reached[steps[after.stage]], after.value))
            found += [
                Event(after.stage, name, "opens", 0.5 * (low + high), (low, high))
                for name, contact in before.contacts.items()
                if contact.active and not after.contacts[name].active
            ]
    return tuple(found)
