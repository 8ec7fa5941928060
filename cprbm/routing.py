"""Which edition answers a scene.

The second edition has places of contact on beams alone.  A rigid edge with a feature smaller than a link may lie
between two places without contact: such scenes, and contacts in the formulation ``paper``, keep the first edition.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cprbm_scene import BeamContact, CircleContact, HalfPlaneContact, LineContact, Scene, SelfContact
from cprbm_scene.geometry import arc_length, largest_curvature
from cprbm_scene.statement import Contact

SHORTEST_EDGE = 4.0
"""Length of an edge, in links of the beam: shorter edges lie between places."""


def by_second_edition(scene: Scene, formulation: str, links_of: Callable[[str], int]) -> bool:
    """True if the second edition answers a scene in a formulation with some links of the beams."""
    if formulation == "paper":
        return not scene.contacts
    return all(_is_even(scene, contact, links_of) for contact in scene.contacts.values())


def _is_even(scene: Scene, contact: Contact, links_of: Callable[[str], int]) -> bool:
    """True if all features of a contact's rigid edge are longer than a link."""
    if isinstance(contact, BeamContact | SelfContact | HalfPlaneContact):
        return True
    link = arc_length(scene.beams[contact.beam].curve) / links_of(contact.beam)
    if isinstance(contact, CircleContact):
        return contact.radius >= link
    if isinstance(contact, LineContact):
        first, *inner, last = contact.points
        return not inner and float(np.hypot(*np.subtract(last, first))) >= SHORTEST_EDGE * link
    smooth = largest_curvature(contact.curve) * link <= 1.0
    return smooth and arc_length(contact.curve) >= SHORTEST_EDGE * link
