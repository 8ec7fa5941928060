"""Which edition answers a scene.

The second edition answers every scene without contacts, contacts between beams, of a beam with itself, and on even edges.
A rigid edge with a corner, an end or a feature smaller than a link keeps the first edition.
"""

from __future__ import annotations

from collections.abc import Callable

from cprbm_scene import BeamContact, CircleContact, HalfPlaneContact, LineContact, Scene, SelfContact
from cprbm_scene.geometry import arc_length, largest_curvature
from cprbm_scene.statement import Contact, EllipseContact, PinnedEnd


def by_second_edition(scene: Scene, formulation: str, links_of: Callable[[str], int]) -> bool:
    """True if the second edition answers a scene in a formulation with some links of the beams."""
    if formulation == "paper" or not scene.contacts:
        return True
    return all(_is_even(scene, contact, links_of) for contact in scene.contacts.values())


def _is_even(scene: Scene, contact: Contact, links_of: Callable[[str], int]) -> bool:
    """True if all features of a contact's rigid edge are longer than a link, and no corner or end can press."""
    if isinstance(contact, BeamContact | SelfContact | HalfPlaneContact):
        return True
    link = arc_length(scene.beams[contact.beam].curve) / links_of(contact.beam)
    if isinstance(contact, CircleContact):
        return contact.radius >= link
    if isinstance(contact, EllipseContact):
        return largest_curvature(contact.curve) * link <= 1.0
    # an end of an edge may press on the beam; the edge under an own pin has the beam at its end
    return isinstance(contact, LineContact) and len(contact.points) == 2 and _is_pinned(scene, contact)


def _is_pinned(scene: Scene, contact: LineContact) -> bool:
    """True if a joint pins the beam on the body of the edge."""
    ends = scene.beams[contact.beam].start, scene.beams[contact.beam].end
    return any(isinstance(end, PinnedEnd) and scene.body_of(end.point) == contact.body for end in ends)
