"""Shear boundary layer at held sections beside which a beam may lie on a surface.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
s       arc length from the held section
γ       shear angle between the neutral line and its sections
Q, GA   shear force, shear stiffness
κ       curvature by which the beam peels off the surface
a       √(EI/GA), half a thickness: t √((1 + ν)/5) of a rectangle with a shear factor of 5/6
f, z    γ = f Q/GA, f = tanh² z, z = s/(√2 a)
======  =====================================================================================

Problem: a section held tangent to a circle or curved edge, or beside a beam clamped with it, is normal to the
surface. With γ = Q/GA at once, the line would lean into the surface over a length 2γ/κ. A contact of this width, of
second order in the thickness, would take the whole shear force Q from the joint, however small Q is. In bending the
contact takes nothing until the curvatures are equal. No mesh resolves this width, and the distribution would depend
on the mesh.

Model: a joint holds the whole section and prevents the warping of shear, so that γ grows from zero. Beam theory does
not give f; two conditions do. First, at equal curvatures the beam leaves the surface by Q s³/(6 EI) and leans back by
∫γ. With f ≤ s²/(2 a²), as tanh² z ≤ z², the latter is smaller for every s, and contact begins as in bending. Second,
where the beam lies on the surface, M' = −Q gives (f Q)'' = Q/a². With f of higher order than s², shear would grow
without bound towards the joint. With tanh² z, a Pöschl–Teller well, the solution is

    Q = A [√2 cosh √2 z − coth z sinh √2 z] coth² z,

with √2 A/3 at the joint and A (√2 − 1)/2 e^(s/a) far away. Thus f is of order s² with the factor of both conditions.
The total deflection decreases by √2 a Q/GA, of third order in the thickness.

A surface farther than a tenth of a in the reference configuration is out of reach of the leaning line. On a straight
edge the joint takes the pressure within a (:mod:`fea_reference.face`), as axial forces do not press there.
"""

import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from cprbm_scene.statement import (
    BeamContact,
    BeamEnd,
    CircleContact,
    Contact,
    EdgeContact,
    Scene,
    WeldedEnd,
)
from fea_reference.own_pins import beam_frame, ends_on_edge
from fea_reference.section import SHEAR_FACTOR
from fea_reference.staying import frame_of

Which = Literal["start", "end"]
_REACHED = 0.1  # rad: shear angle beyond any material


def shear_layers(scene: Scene, beam: str) -> tuple[float, float]:
    """Layer widths a (m) at a beam's start and end, where held on a surface in contact; zero elsewhere."""
    held_ends = {which for contact in scene.contacts.values() for which in _held_ends(scene, beam, contact)}
    start, end = (_layer(scene, beam, which) if which in held_ends else 0.0 for which in ("start", "end"))
    return start, end


def _layer(scene: Scene, beam: str, which: str) -> float:
    """Layer width a (m) at an end."""
    ratio = 2.0 * (1.0 + scene.materials[scene.beams[beam].material].poisson_ratio) / (12.0 * SHEAR_FACTOR)
    return math.sqrt(ratio) * _thickness(scene, beam, which)


def _thickness(scene: Scene, beam: str, which: str) -> float:
    return float(scene.beams[beam].thickness_at(np.array([0.0 if which == "start" else 1.0]))[0])


def _held_ends(scene: Scene, beam: str, contact: Contact) -> Iterator[Which]:
    """Ends of a beam held on the surface of a contact; none for straight edges."""
    if isinstance(contact, CircleContact) and contact.beam == beam:
        for which, place, holder in _welded_ends(scene, beam):
            half = 0.5 * _thickness(scene, beam, which) if contact.thick else 0.0
            gap = math.dist(place, contact.center) - contact.radius - half
            if holder == frame_of(scene, contact.body) and _within_reach(scene, gap, (beam, which)):
                yield which
    elif isinstance(contact, EdgeContact) and contact.beam == beam:
        outline, own = ends_on_edge(scene, contact, *beam_frame(scene.beams[beam]))
        if not outline.straight:
            yield from own
    elif isinstance(contact, BeamContact) and beam in contact.between:
        (other,) = (name for name in contact.between if name != beam)
        for which, place, holder in _welded_ends(scene, beam):
            for other_end, at, its_holder in _welded_ends(scene, other):
                ends = (beam, which), (other, other_end)
                halves = 0.5 * sum(_thickness(scene, *end) for end in ends) if contact.thick else 0.0
                if holder == its_holder and _within_reach(scene, math.dist(place, at) - halves, *ends):
                    yield which


def _within_reach(scene: Scene, gap: float, *ends: tuple[str, str]) -> bool:
    """True if the gap (m) beside held ends is small enough for their beams to lean over."""
    return abs(gap) <= _REACHED * sum(_layer(scene, *end) for end in ends)


def _welded_ends(scene: Scene, beam: str) -> Iterator[tuple[Which, tuple[float, float], str]]:
    """A beam's welded ends, with place and frame."""
    record = scene.beams[beam]
    ends: tuple[tuple[Which, BeamEnd], ...] = (("start", record.start), ("end", record.end))
    for which, end in ends:
        if isinstance(end, WeldedEnd):
            yield which, scene.place_of(end.point), frame_of(scene, scene.body_of(end.point))
