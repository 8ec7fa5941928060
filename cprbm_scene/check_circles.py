"""Rigid circles that beams may touch: each pair once, in proportion, no beam inside a circle where it starts.

======  =====================================================================
symbol  meaning
======  =====================================================================
r       radius of the circle, m
L       length of the beam, m
t       thickness of the beam, m; without meaning for a beam that is a line
d       distance of the neutral line from the circle's center, m
======  =====================================================================

The beam's edge lies outside the circle where d ≥ r + t/2, with t of the place; for a line, where d ≥ r.  Bounds
stand on dimensionless numbers only: 1e-6 ≤ r/L ≤ 1e6, and L ≥ 1e-6 of the center's coordinates, since positions lose
the digits that a gap is made of in a circle far larger, or farther away, than the beam.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cprbm_scene.check_overlaps import OVERLAP
from cprbm_scene.check_shapes import SHORTEST, is_beam
from cprbm_scene.geometry import Array, arc_length, distance_to, points_on, scaled
from cprbm_scene.mistakes import Mistake
from cprbm_scene.sampling import least
from cprbm_scene.statement import Beam, CircleContact, Curve, Point, Scene

_SAMPLES = 2001  # of a beam whose thickness varies


def wrong_circles(scene: Scene) -> Iterator[Mistake]:
    """Circles that one beam meets in two contacts, or out of proportion to their beam."""
    seen: dict[tuple[str, str, Point, float], str] = {}
    for name, contact in scene.contacts.items():
        if not isinstance(contact, CircleContact):
            continue
        pair = (contact.beam, contact.body, contact.center, contact.radius)
        if pair in seen:
            found = f"the beam and the circle of contacts.{seen[pair]} again"
            yield Mistake(f"contacts.{name}", found, "each beam and circle once")
        seen.setdefault(pair, name)
        beam = scene.beams.get(contact.beam)
        if beam is not None and is_beam(beam) and (mistake := _out_of_proportion(name, contact, beam)) is not None:
            yield mistake


def circle_overlaps(scene: Scene) -> Iterator[Mistake]:
    """Beams that overlap a circle, or lie in it, where they start."""
    for name, contact in scene.contacts.items():
        if not isinstance(contact, CircleContact):
            continue
        beam = scene.beams.get(contact.beam)
        if beam is None or not is_beam(beam) or _out_of_proportion(name, contact, beam) is not None:
            continue
        length = arc_length(beam.curve)
        # what is compared is in beam's lengths: neither squares nor sums leave the range of floating point
        curve = scaled(beam.curve, length)
        center = (contact.center[0] / length, contact.center[1] / length)
        thickness = beam.thinnest / length if contact.thick else 0.0
        varies = contact.thick and beam.tapered
        apart = _edge_from(beam, curve, center, length) if varies else distance_to(curve, center)
        depth = contact.radius / length + 0.5 * thickness - apart
        measure, of = (thickness, "its thickness") if contact.thick else (1.0, "its length")
        if depth > OVERLAP * measure:
            yield Mistake(
                f"contacts.{name}",
                f"the beam {contact.beam!r} that overlaps the circle at the start by {depth * length:.3g} m, "
                f"{depth / measure:.3g} of {of}",
                f"a beam that touches the circle from outside or is apart (overlap at most {OVERLAP:g} of {of})",
            )


def _edge_from(beam: Beam, curve: Curve, center: Point, length: float) -> float:
    """The least of d − (t − t₀)/2 along a beam whose thickness t varies, t₀ where it is thinnest; in beam's lengths."""

    def apart(u: Array) -> Array:
        distance = np.hypot(*(points_on(curve, u) - np.array(center)).T)
        return np.asarray(distance - 0.5 * (beam.thickness_at(u) - beam.thinnest) / length)

    return least(apart, np.union1d(np.linspace(0.0, 1.0, _SAMPLES), beam.knots))


def _out_of_proportion(name: str, contact: CircleContact, beam: Beam) -> Mistake | None:
    length = arc_length(beam.curve)
    if not SHORTEST * length <= contact.radius <= length / SHORTEST:
        return Mistake(
            f"contacts.{name}.radius",
            f"{contact.radius:g} m, which is {contact.radius / length:.3g} of the beam's length",
            f"a radius between {SHORTEST:g} and {1.0 / SHORTEST:g} of the beam's length",
        )
    largest = max(abs(coordinate) for coordinate in contact.center)
    if not SHORTEST * largest <= length:
        return Mistake(
            f"contacts.{name}.center",
            f"coordinates up to {largest:.3g} m beside a beam of {length:.3g} m",
            f"coordinates of which the beam's length is at least {SHORTEST:g}",
        )
    return None
