"""Curves of a scene's contacts, and pairs of curves.

A place lies on the first curve of a pair, the foot on the second; the ends of a second beam and the corners of a rigid
curve are places too.
A beam lies on the side +1 (left) or −1 (right) of a rigid curve, as the scene says.  The side of two beams is 0 here;
the state as drawn decides, :mod:`cprbm.contact.candidates`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.chain import Mechanism
from cprbm.contact.corners import Corner, corner_curve, part_of, sharp_bends, sharp_corners, sides_behind, with_marks
from cprbm.contact.curve import NO_SIDES, Curve, Frames, beam_curve
from cprbm.contact.own_pin import pin_rows
from cprbm_scene import BeamContact, CircleContact, FunctionContact, HalfPlaneContact, LineContact, SelfContact
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import EllipseContact, RigidContact, SplineContact

PIECES = 256
"""Pieces of a smooth edge.  The error is κ³ h⁴/384: 2e-7 of the longer axis at the tip of an ellipse of 3 to 1."""

REACH = 10.0
"""Half length of a half-plane's edge, and length of a solid's sides, over the longest beam."""


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
    """Curve of a rigid shape, and the side of the beam."""
    name, place = f"contact {contact_name}", m.units.place
    match contact:
        case CircleContact(side="outside"):
            return frames.circle(name, contact.body, place(contact.center), contact.radius / m.units.length), 1
        case CircleContact():
            angle = np.linspace(0.0, 2.0 * np.pi, PIECES + 1)
            around = np.column_stack([np.cos(angle), np.sin(angle)])
            tangents = np.column_stack([-around[:, 1], around[:, 0]])
            points, length = place(contact.center + contact.radius * around), 2.0 * np.pi * contact.radius
            return frames.smooth_edge(name, contact.body, points, tangents, length / m.units.length), 1
        case HalfPlaneContact():
            normal = np.array(contact.normal) / np.hypot(*contact.normal)
            along = REACH * np.array([normal[1], -normal[0]])
            points, side = place(contact.point) + np.array([-along, along]), 1
            m.rows.extend(pin_rows(m, contact_name, contact, points, side))
            return frames.polyline(name, contact.body, points), side
        case LineContact():
            points, side = place(contact.points), 1 if contact.side == "left" else -1
            m.rows.extend(pin_rows(m, contact_name, contact, points, side))
            if not contact.closed:
                begin, end = sides_behind(points, side, REACH)
                points = np.concatenate([begin, points, end])
            return frames.polyline(name, contact.body, points), side
        case FunctionContact():
            ascends = contact.range[1] > contact.range[0]
            left = (contact.side == "above") == (ascends == (contact.axis == "x"))
            side = 1 if left else -1
            points = place(shape_of(contact.curve).point(np.linspace(0.0, 1.0, PIECES + 1)))
            m.rows.extend(pin_rows(m, contact_name, contact, points, side))
            return _smooth(m, frames, name, contact, side), side
        case SplineContact():
            side = 1 if contact.side == "left" else -1
            return _smooth(m, frames, name, contact, side), side
        case EllipseContact():
            side = 1 if contact.side == "inside" else -1
            return _smooth(m, frames, name, contact, side), side
    raise TypeError(f"found a rigid contact of the class {type(contact).__name__}")


def _smooth(
    m: Mechanism, frames: Frames, name: str, contact: FunctionContact | SplineContact | EllipseContact, side: int
) -> Curve:
    """Smooth edge of a body, at even arc lengths, and the sides of the solid behind an open edge."""
    u = np.linspace(0.0, 1.0, PIECES + 1)
    points, tangents = m.units.place(shape_of(contact.curve).point(u)), shape_of(contact.curve).tangent(u)
    sides = NO_SIDES if isinstance(contact, EllipseContact) else sides_behind(points, side, REACH)
    return frames.smooth_edge(
        name, contact.body, points, tangents, shape_of(contact.curve).length / m.units.length, sides
    )
