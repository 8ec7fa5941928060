"""The order of convergence that an error estimate may assume, probe by probe.

Two for all but one thing: where a beam lies on a circle up to a held end, the pressure on the first element and
the shear of the support can be told apart to one element and no better, unless a method takes care of it.  Their
sum converges with the second order, each alone with the first, and so do the place of the contact's resultant
and the ends of the zone.  Of a method that does better the first order only makes the stated uncertainty larger.
"""

from __future__ import annotations

from scene import CircleContact, Probe, Scene
from scene.statement import FreeEnd

USUAL, BESIDE_A_HELD_END = 2, 1


def order_of(scene: Scene, probe: Probe) -> int:
    """p of the probe's values in both solvers."""
    if probe.quantity in ("force", "centre", "ends"):
        contact = scene.contacts.get(probe.of)
        first = isinstance(contact, CircleContact)
    elif probe.quantity == "reaction":
        first = any(
            isinstance(contact, CircleContact) and probe.of in _held_at(scene, contact.beam)
            for contact in scene.contacts.values()
        )
    else:
        first = False
    return BESIDE_A_HELD_END if first else USUAL


def _held_at(scene: Scene, beam: str) -> set[str]:
    """Points at which a beam's ends are held."""
    record = scene.beams[beam]
    return {end.point for end in (record.start, record.end) if not isinstance(end, FreeEnd)}


def richardson(order: int) -> float:
    """2^p/(2^p − 1): the error at N over its change from N to 2N."""
    return 2.0**order / (2.0**order - 1.0)
