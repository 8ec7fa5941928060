"""Where a stress along a beam is compared, and where it is only shown.

Next to a held end and next to a contact the two methods spread a concentrated force over lengths of their
own: over a link there, over an element and the contact's own width here.  By Saint-Venant's principle that is
a matter of about one thickness, and so far these places take no part in the difference.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from comparisons.geometry import length, nearest
from scene import Scene, StationAnswer
from scene.answer import Array
from scene.statement import FreeEnd


def clear_of_spots(
    scene: Scene, beam: str, arc_length: Array, stations: tuple[StationAnswer, ...]
) -> NDArray[np.bool_]:
    """Which places (k,) of a beam lie at least one thickness from its held ends and from every contact.

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
    for station in stations:
        for contact, places in station.touching.items():
            if beam in scene.contacts[contact].beams:
                spots.extend(nearest(station.shapes[beam], place) for place in places)
    if not spots:
        return np.ones(arc_length.shape, dtype=bool)
    distance = np.min(np.abs(arc_length[:, None] - np.array(spots)), axis=1)
    return np.asarray(distance >= record.thickness * (1.0 - 1e-9))
