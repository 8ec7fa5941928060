"""Curves of a scene's contacts, and pairs of curves.

A place lies on the first curve of a pair, the foot on the second; the ends of a second beam are places too.
A beam lies on the side +1 (left) or −1 (right) of a rigid curve, as the scene says.  The side of two beams is 0 here;
the state as drawn decides, :mod:`cprbm.contact.candidates`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import assert_never

import numpy as np

from cprbm.chain import Mechanism
from cprbm.contact.curve import Curve, Frames, beam_curve
from cprbm.contact.own_pin import pin_rows
from cprbm_scene import BeamContact, CircleContact, FunctionContact, HalfPlaneContact, LineContact, SelfContact
from cprbm_scene.answer import Array
from cprbm_scene.geometry import arc_length, points_on, tangents_on
from cprbm_scene.statement import EdgeContact

PIECES_OF_A_GRAPH = 64
"""Pieces of a graph's spline: the error is of fourth order, 1e-7 of the bend that a piece resolves."""

REACH = 10.0
"""Half length of a half-plane's edge, over the longest beam."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two curves of the contact ``name`` by number, and the ``side`` of the first over the second."""

    name: str
    first: int
    second: int
    side: int

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
        match contact:
            case BeamContact() | SelfContact():
                pairs.append(Pair(name, own[0], own[-1], 0))
            case CircleContact():
                radius = contact.radius / m.units.length
                circle = frames.circle(f"contact {name}", contact.body, m.units.place(contact.center), radius)
                pairs.append(Pair(name, own[0], number(circle), 1))
            case LineContact() | HalfPlaneContact() | FunctionContact():
                edge, side, points = _edge(m, frames, f"contact {name}", contact)
                m.rows.extend(pin_rows(m, name, contact, points, side))
                pairs.append(Pair(name, own[0], number(edge), side))
            case _:
                assert_never(contact)
    return list(curves.values()), pairs


def _edge(m: Mechanism, frames: Frames, name: str, contact: EdgeContact) -> tuple[Curve, int, Array]:
    """Curve of a rigid edge, the side of the beam, and points on the edge (k, 2)."""
    match contact:
        case HalfPlaneContact():
            normal = np.array(contact.normal) / np.hypot(*contact.normal)
            along = REACH * np.array([normal[1], -normal[0]])
            points = m.units.place(contact.point) + np.array([-along, along])
            return frames.polyline(name, contact.body, points), 1, points
        case LineContact():
            points = m.units.place(contact.points)
            return frames.polyline(name, contact.body, points), 1 if contact.side == "left" else -1, points
        case FunctionContact():
            u = np.linspace(0.0, 1.0, PIECES_OF_A_GRAPH + 1)
            points = m.units.place(points_on(contact.curve, u))
            length = arc_length(contact.curve) / m.units.length
            edge = frames.smooth_edge(name, contact.body, points, tangents_on(contact.curve, u), length)
            ascends = contact.range[1] > contact.range[0]
            left = (contact.side == "above") == (ascends == (contact.axis == "x"))
            return edge, 1 if left else -1, points
        case _:
            assert_never(contact)
