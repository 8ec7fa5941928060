"""Held sections beside which a beam may lie on something: there its line leans from them by degrees.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
s       arc length from the held section
γ       angle of shear, by which the line leans from its sections
Q, GA   shear force, shear stiffness
κ       curvature by which the beam peels off what it lies on
a       √(EI/GA), half a thickness: t √((1 + ν)/5) of a rectangle with a shear factor of 5/6
f, z    γ = f Q/GA, f = tanh² z, z = s/(√2 a)
======  =====================================================================================

A section that is held tangent to a circle, to a curved edge, or beside another beam that is clamped with it, stands
upright on that.  Were γ Q/GA at once, the line would lean into what it lies on as far as 2γ/κ: a contact of that width,
which goes with the square of the thickness, would take all of Q from the joint however little it is, where in bending
it takes none until the curvatures are equal.  No mesh resolves it, and the share would be as the elements fall.

A joint that holds a whole section keeps it from warping, which shear needs, so that γ grows from zero.  Of which form f
is, the theory of beams does not tell; two things are asked of it.  Where the curvatures are equal, the beam parts from
what it lies on by Q s³/(6 EI), and leans back by ∫γ: with f ≤ s²/(2 a²), tanh² z ≤ z², that is less for every s, and
the contact begins when it does in bending.  And where the beam lies on it, M' = −Q gives (f Q)'' = Q/a²: were f of a
higher order than s², shear that has all but died out along the zone would grow beside the joint without bound.  With
tanh² z, a well of Pöschl and Teller's, the solution is

    Q = A [√2 cosh √2 z − coth z sinh √2 z] coth² z,

√2 A/3 at the joint and A (√2 − 1)/2 e^(s/a) far from it.  So f is of the order s², and has the factor that both allow.
In all the beam gives way less by √2 a Q/GA, which is of the third order in the thickness.

What lies at rest farther from the joint than a tenth of a is reached by no lean of the line beside it.  On a straight
edge the joint takes over what presses within a (:mod:`fea_reference.face`): axial forces do not press there.
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
from fea_reference.own_pins import held_on, own_frame
from fea_reference.section import SHEAR_FACTOR
from fea_reference.staying import frame_of

Which = Literal["start", "end"]
_REACHED = 0.1  # rad: of shear, which no material bears


def upright(scene: Scene, beam: str) -> tuple[float, float]:
    """a of a beam's start and end, where they are held on what it may touch, m; zero where they are not."""
    found = {which for contact in scene.contacts.values() for which in _held(scene, beam, contact)}
    start, end = (_layer(scene, beam, which) if which in found else 0.0 for which in ("start", "end"))
    return start, end


def _layer(scene: Scene, beam: str, which: str) -> float:
    """a at an end, m."""
    ratio = 2.0 * (1.0 + scene.materials[scene.beams[beam].material].poisson_ratio) / (12.0 * SHEAR_FACTOR)
    return math.sqrt(ratio) * _thickness(scene, beam, which)


def _thickness(scene: Scene, beam: str, which: str) -> float:
    return float(scene.beams[beam].thickness_at(np.array([0.0 if which == "start" else 1.0]))[0])


def _held(scene: Scene, beam: str, contact: Contact) -> Iterator[Which]:
    """Ends of a beam that are held on what it may touch in a contact; of straight edges none."""
    if isinstance(contact, CircleContact) and contact.beam == beam:
        for which, place, holder in _welded(scene, beam):
            half = 0.5 * _thickness(scene, beam, which) if contact.thick else 0.0
            gap = math.dist(place, contact.center) - contact.radius - half
            if holder == frame_of(scene, contact.body) and _reached(scene, gap, (beam, which)):
                yield which
    elif isinstance(contact, EdgeContact) and contact.beam == beam:
        outline, own = held_on(scene, contact, *own_frame(scene.beams[beam]))
        if not outline.straight:
            yield from own
    elif isinstance(contact, BeamContact) and beam in contact.between:
        (other,) = (name for name in contact.between if name != beam)
        for which, place, holder in _welded(scene, beam):
            for its, at, its_holder in _welded(scene, other):
                ends = (beam, which), (other, its)
                halves = 0.5 * sum(_thickness(scene, *end) for end in ends) if contact.thick else 0.0
                if holder == its_holder and _reached(scene, math.dist(place, at) - halves, *ends):
                    yield which


def _reached(scene: Scene, gap: float, *ends: tuple[str, str]) -> bool:
    """Whether a gap (m) beside held ends is one that their beams might lean over."""
    return abs(gap) <= _REACHED * sum(_layer(scene, *end) for end in ends)


def _welded(scene: Scene, beam: str) -> Iterator[tuple[Which, tuple[float, float], str]]:
    """A beam's welded ends, where they are held, and what holds them moves with."""
    record = scene.beams[beam]
    ends: tuple[tuple[Which, BeamEnd], ...] = (("start", record.start), ("end", record.end))
    for which, end in ends:
        if isinstance(end, WeldedEnd):
            yield which, scene.place_of(end.point), frame_of(scene, scene.body_of(end.point))
