"""Where a stress along a beam is compared, and where it is only shown.

Next to a held end, to a moment on the beam, to a contact in a point and to either end of a zone of contact the methods
spread what is concentrated over lengths of their own: over a link there, over an element and the contact's own width
here.  By Saint-Venant's principle that is a matter of about one thickness, and so far these places take no part
in the difference.  Inside a zone the pressure is spread over the beam, the stress is smooth, and it is compared.

An answer says where a contact touches at as many places as its discretisation has there, and need not press at
each of them.  So the places of all answers at a station are put together: those that follow each other along the
beam within a few steps of the coarsest one are one zone, and each answer's first and last place in it is where
that answer's zone ends.  What one answer takes for a point is compared if another has a zone round it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from comparisons.geometry import length, nearest, nearest_of_two_laps
from cprbm_scene import Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.statement import BeamMoment, FreeEnd, SelfContact

_STEPS_APART = 3.0
"""Largest distance of neighbours in a zone, in steps of the coarsest line that an answer draws of the beam."""

_NOWHERE = np.empty((0, 2))


def clear_of_spots(
    scene: Scene, beam: str, arc_length: Array, stations: tuple[StationAnswer, ...]
) -> NDArray[np.bool_]:
    """Which places (k,) of a beam lie at least one thickness from its held ends, from moments and where contacts end.

    Args:
        scene: the question.
        beam: name of the beam.
        arc_length: the places, (k,), m from the beam's start.
        stations: the answers at one station; a contact in any of them counts.
    """
    record = scene.beams[beam]
    spots: list[float] = []
    if not isinstance(record.start, FreeEnd):
        spots.append(0.0)
    if not isinstance(record.end, FreeEnd):
        spots.append(length(record.curve))
    moments = [load for load in scene.loads.values() if isinstance(load, BeamMoment) and load.beam == beam]
    spots += [load.at * length(record.curve) for load in moments]
    coarsest = max(float(np.max(np.diff(station.shapes[beam].s))) for station in stations)
    for name, contact in scene.contacts.items():
        if beam in contact.beams:
            near = nearest_of_two_laps if isinstance(contact, SelfContact) else nearest
            places = [near(station.shapes[beam], station.touching.get(name, _NOWHERE)).ravel() for station in stations]
            spots += ends_of_zones(places, _STEPS_APART * coarsest)
    if not spots:
        return np.ones(arc_length.shape, dtype=bool)
    distance = np.min(np.abs(arc_length[:, None] - np.array(spots)), axis=1)
    # by Saint-Venant's principle, of the thickness that is there
    here = record.thickness_at(arc_length / length(record.curve))
    return np.asarray(distance >= here * (1.0 - 1e-9))


def ends_of_zones(places: Sequence[Array], apart: float) -> list[float]:
    """Every answer's first and last place in every zone, m.

    Args:
        places: by answer, where a contact touches along a beam, (k,), m; empty where it is open.
        apart: largest distance of neighbours in a zone, m.
    """
    together = np.sort(np.concatenate(places))
    borders = 0.5 * (together[:-1] + together[1:])[np.diff(together) > apart]
    found: list[float] = []
    for own in places:
        zone = np.searchsorted(borders, own)
        for number in np.unique(zone):
            found += [float(own[zone == number].min()), float(own[zone == number].max())]
    return found
