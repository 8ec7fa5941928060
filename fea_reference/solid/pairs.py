"""Contact pairs of a scene.

A contact of two beams pairs every edge of the first with every edge of the second; a contact with a rigid body pairs
every edge with the body's shape. In self-contact every edge is paired with every edge, seen from the later place
along the beam. Point contacts are added: convex rigid corners against edges, and corners of beams' ends against edges
and rigid shapes.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from cprbm_scene.statement import (
    BeamContact,
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Scene,
    SelfContact,
    WeldedEnd,
)
from fea_reference.solid import edges
from fea_reference.solid.bodies import BodyPart
from fea_reference.solid.edges import Corner
from fea_reference.solid.model import Model
from fea_reference.solid.rigid import Half, Round, Shape, in_body_frame
from fea_reference.solid.skin import Skin

RigidContacts = CircleContact | HalfPlaneContact | LineContact | FunctionContact

_INSIDE = 1e-9  # lengths of the longest beam: depth above which an end's corner starts inside the opposite body


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """An edge that carries the contact integral, and an opposite edge, shape or corner on body number ``body``.

    Also the corner of an end with its opposite. ``name`` is the contact's; ``measure`` the mean thickness. In
    self-contact ``way`` is −1 to search earlier places along the beam and 1 for later ones; for different beams 0.
    """

    name: str
    skin: Skin
    other: Skin | Shape | Corner | CornerOnEdge | CornerOnShape
    body: int
    measure: float
    way: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class CornerOnEdge:
    """The corner of an end: the ``last`` or first place of an edge, opposite to the other edge of a pair.

    With ``own`` the corner belongs to the pair's edge and ``skin`` is the opposite edge, else conversely.
    """

    skin: Skin
    own: bool
    last: bool

    def roles(self, pair: Pair) -> tuple[Skin, Skin]:
        """The edge with the corner, and the opposite edge."""
        return (pair.skin, self.skin) if self.own else (self.skin, pair.skin)


@dataclass(frozen=True, slots=True, eq=False)
class CornerOnShape:
    """The corner of an end, the ``last`` or first place of the pair's edge, against a rigid ``shape``."""

    shape: Shape
    last: bool


def pairs_of(scene: Scene, model: Model) -> tuple[Pair, ...]:
    """The pairs of a scene's contacts."""
    pairs: list[Pair] = []
    number = {body.name: i for i, body in enumerate(model.bodies)}
    for name, contact in scene.contacts.items():
        match contact:
            case BeamContact():
                first, second = (_skins(scene, model, beam) for beam in contact.between)
                for a, b in product(first, second):
                    measure = 0.5 * (a.thickness + b.thickness)
                    pairs.append(Pair(name, a, b, -1, measure))
                    pairs += [
                        Pair(name, a, CornerOnEdge(b, own, last), -1, measure)
                        for own, last in product((True, False), (False, True))
                    ]
            case SelfContact():
                own_edges = _skins(scene, model, contact.beam)
                for a, b in product(own_edges, own_edges):
                    pairs.append(Pair(name, a, b, -1, a.thickness, -1))
                    pairs += [
                        Pair(name, a, CornerOnEdge(b, own=True, last=last), -1, a.thickness, way)
                        for last, way in ((False, 1), (True, -1))
                    ]
            case CircleContact() | HalfPlaneContact() | LineContact() | FunctionContact():
                body = model.bodies[number[contact.body]]
                for shape, skin in product(_shapes(contact, body, model), _skins(scene, model, contact.beam)):
                    pairs.append(Pair(name, skin, shape, number[contact.body], skin.thickness))
                    if not isinstance(shape, Corner):
                        pairs += [
                            Pair(name, skin, butt, number[contact.body], skin.thickness)
                            for butt in (CornerOnShape(shape, last=False), CornerOnShape(shape, last=True))
                            if _may_touch_from_outside(scene, contact, model, skin, butt)
                        ]
    return tuple(pairs)


def _may_touch_from_outside(
    scene: Scene, contact: RigidContacts, model: Model, skin: Skin, butt: CornerOnShape
) -> bool:
    """True if an end's corner may touch a shape: neither part of the shape's body nor inside the shape at rest."""
    beam = scene.beams[contact.beam]
    end = beam.end if butt.last else beam.start
    if isinstance(end, WeldedEnd) and scene.body_of(end.point) == contact.body:
        return False
    body = next(body for body in model.bodies if body.name == contact.body)
    there = in_body_frame(body, skin.places[[-1 if butt.last else 0]], np.zeros(model.size))
    return float(butt.shape.measured(there)[0][0]) > -_INSIDE


def _skins(scene: Scene, model: Model, name: str) -> tuple[Skin, Skin]:
    beam, i, mesh = scene.beams[name], model.mesh.names.index(name), model.mesh
    E = scene.materials[beam.material].youngs_modulus * model.units.width * model.units.length / model.units.force
    skins = []
    for side in (1.0, -1.0):
        nodes = mesh.line(i, side)
        places = mesh.places[nodes]
        apart = np.hypot(*np.diff(places, axis=0).T)
        h = apart[0::2] + apart[1::2]  # lengths of elements
        u = mesh.u[nodes]
        skins.append(
            Skin(
                i,
                side,
                nodes,
                places,
                u,
                beam.width_at(u) / model.units.width,
                beam.thinnest / model.units.length,
                np.concatenate([np.repeat(E / h, 2), [E / h[-1]]]),
            )
        )
    return skins[0], skins[1]


def _shapes(contact: RigidContacts, body: BodyPart, model: Model) -> tuple[Shape | Corner, ...]:
    """Shapes and corners of a rigid contact, in the frame of the body with the origin at its centre."""
    unit = model.units.length
    origin = model.units.origin + body.centre * unit
    match contact:
        case CircleContact():
            return (Round((np.array(contact.center) - origin) / unit, contact.radius / unit),)
        case HalfPlaneContact():
            normal = np.array(contact.normal) / np.hypot(*contact.normal)
            return (Half((np.array(contact.point) - origin) / unit, normal),)
        case LineContact():
            sides, corners = edges.broken(contact, origin, unit)
            return (sides, *corners)
        case FunctionContact():
            bent, corners = edges.graph(contact, origin, unit)
            return (bent, *corners)
