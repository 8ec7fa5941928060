"""Curves of a scene's contacts, pairs of curves, and angle stops of beams pinned on an edge.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
β        opening: angle from an edge's direction at the pin to the direction of the beam
=======  ====================================================================================

A place lies on the first curve of a pair, the foot on the second; the ends of a second beam and the corners of a rigid
curve are places too.
A beam lies on the side +1 (left) or −1 (right) of a rigid curve, as the scene says.  The side of two beams is 0 here;
the state as drawn decides, :mod:`cprbm.contact.candidates`.

At an own pin the beam has no gap: the pin lies on the edge, or half the beam's thickness above.  The edge limits the
angle of the beam and holds the beam by a moment, like a stop.  With the edge's direction away from the pin and the beam
on the left, β ≥ 0.  Where the edge runs on behind the pin, the angle from the beam to the rest of the edge is limited
in the same way.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import tau

import numpy as np

from cprbm.chain import END, Form, Mechanism, Row, ends_of
from cprbm.contact.corners import Corner, corner_curve, part_of, sharp_bends, sharp_corners, sides_behind, with_marks
from cprbm.contact.curve import NO_SIDES, Curve, Frames, beam_curve
from cprbm_scene import BeamContact, CircleContact, FunctionContact, HalfPlaneContact, LineContact, SelfContact
from cprbm_scene.answer import Array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import EdgeContact, EllipseContact, PinnedEnd, RigidContact, SplineContact

PIECES = 256
"""Pieces of a smooth edge.  The error is κ³ h⁴/384: 2e-7 of the longer axis at the tip of an ellipse of 3 to 1."""

REACH = 10.0
"""Half length of a half-plane's edge, and length of a solid's sides, over the longest beam."""


ON_EDGE = 1e-6
"""Distance of a pin from the edge, over the beam's length, of a pin on the edge: coordinates are rounded."""

AT_CORNER = 1e-9
"""Distance of a pin from an end of a piece, over the piece's length, below which the piece leads one way only."""

STRAIGHT = 1e-5
"""Opening below 2π, rad, that counts as zero: rounded coordinates of a beam that lies on the edge."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two curves of the contact ``name`` by number, ``side`` of the first over the second, corners of the second."""

    name: str
    first: int
    second: int
    side: int
    corners: tuple[Corner, ...] = ()

    @property
    def itself(self) -> bool:
        """True for self-contact."""
        return self.first == self.second


def contact_pairs(m: Mechanism) -> tuple[list[Curve], list[Pair]]:
    """Curves and pairs of all contacts, in the order of the contacts.

    Adds the nodes of rigid curves and the angle stops of beams pinned on an edge to the mechanism's rows.
    """
    curves: dict[str, Curve] = {}
    frames, pairs = Frames(m), []

    def number(curve: Curve) -> int:
        curves.setdefault(curve.name, curve)
        return list(curves).index(curve.name)

    for name, contact in m.scene.contacts.items():
        own = [number(beam_curve(m, beam, thick=contact.thick)) for beam in contact.beams]
        if isinstance(contact, BeamContact | SelfContact):
            pairs.append(Pair(name, own[0], own[-1], 0))
            continue
        edge, side = _rigid_curve(m, frames, name, contact)
        chain = m.chains[contact.beam]
        link = chain.length / chain.links
        sharp, bends = sharp_corners(edge, side, link), sharp_bends(edge, side, link)
        second = number(with_marks(edge, sharp, bends))
        points = [second if edge.is_point else number(corner_curve(edge, piece)) for piece in sharp]
        starts = [*zip(points, sharp, strict=True), *((number(part_of(edge, run)), int(run[0])) for run in bends)]
        corners = tuple(Corner(curve, (piece - 1) % edge.pieces, piece) for curve, piece in starts)
        pairs.append(Pair(name, own[0], second, side, corners))
    return list(curves.values()), pairs


def _rigid_curve(m: Mechanism, frames: Frames, contact_name: str, contact: RigidContact) -> tuple[Curve, int]:
    """Curve of a rigid shape, at even arc lengths of a smooth edge, and the side of the beam."""
    name, place, u = f"contact {contact_name}", m.units.place, np.linspace(0.0, 1.0, PIECES + 1)
    side = 1 if getattr(contact, "side", "") in ("left", "inside") else -1
    match contact:
        case CircleContact(side="outside"):
            return frames.circle(name, contact.body, place(contact.center), contact.radius / m.units.length), 1
        case HalfPlaneContact():
            normal = np.array(contact.normal) / np.hypot(*contact.normal)
            along = REACH * np.array([normal[1], -normal[0]])
            points, tangents, side = place(contact.point) + np.array([-along, along]), None, 1
        case LineContact():
            points, tangents = place(contact.points), None
        case CircleContact():
            around = np.column_stack([np.cos(2.0 * np.pi * u), np.sin(2.0 * np.pi * u)])
            points, tangents = place(contact.center + contact.radius * around), around[:, ::-1] * [-1.0, 1.0]
            length = 2.0 * np.pi * contact.radius
        case _:
            assert isinstance(contact, FunctionContact | SplineContact | EllipseContact)
            shape = shape_of(contact)
            points, tangents, length = place(shape.point(u)), shape.tangent(u), shape.length
    if isinstance(contact, FunctionContact):
        ascends = contact.range[1] > contact.range[0]
        side = 1 if (contact.side == "above") == (ascends == (contact.axis == "x")) else -1
    if isinstance(contact, EdgeContact):
        m.rows.extend(_pin_rows(m, contact_name, contact, points, side))
    is_open = isinstance(contact, FunctionContact | SplineContact | LineContact) and not getattr(
        contact, "closed", False
    )
    sides = sides_behind(points, side, REACH) if is_open else NO_SIDES
    if tangents is None:
        return frames.polyline(name, contact.body, np.concatenate([sides[0], points, sides[1]])), side
    return frames.smooth_edge(name, contact.body, points, tangents, length / m.units.length, sides), side


def _pin_rows(m: Mechanism, name: str, contact: EdgeContact, points: Array, side: int) -> Iterator[Row]:
    """Rows of the angles between a contact's beam and the edge through ``points`` (k, 2), at pins on the edge."""
    chain = m.chains[contact.beam]
    for end, link, joint in zip(END, (0, -1), ends_of(m.scene, contact.beam), strict=True):
        if not isinstance(joint, PinnedEnd) or m.scene.body_of(joint.point) != contact.body:
            continue
        pin = m.units.place(m.scene.place_of(joint.point))
        turned = m.angle(contact.beam, link) - m.rotation(contact.body)
        above = 0.5 * float(chain.section.thickness(chain.arcs[[link]])[0]) if contact.thick else 0.0
        behind, ahead = _directions(pin, points, side * above, ON_EDGE * chain.length)
        for directions, sign in ((ahead, side), (behind, -side)):
            for direction in directions[-1:]:
                opening = (sign * (chain.leaving_angle(end) - float(np.arctan2(direction[1], direction[0])))) % tau
                opening -= tau if opening > tau - STRAIGHT else 0.0
                yield Row(f"{name}.pin", turned * float(sign) + Form(opening), driven=False, limit=True)


def _directions(pin: Array, points: Array, above: float, near: float) -> tuple[Array, Array]:
    """Directions (k, 2) from a pin back and on along the pieces of an edge below the pin.

    Both are empty for a pin off the edge, and one is empty at an end of the edge.  A beam with thickness lies on the
    edge with the pin half the thickness ``above``, positive on the left.
    """
    chords = np.diff(points, axis=0)
    left = np.column_stack([-chords[:, 1], chords[:, 0]]) / np.hypot(*chords.T)[:, None]
    shares = ((pin - points[:-1]) * chords).sum(axis=1) / (chords**2).sum(axis=1)
    nearest = points[:-1] + np.clip(shares, 0.0, 1.0)[:, None] * chords + above * left
    below = np.hypot(*(nearest - pin).T) < near
    return -chords[below & (shares > AT_CORNER)], chords[below & (shares < 1.0 - AT_CORNER)]
