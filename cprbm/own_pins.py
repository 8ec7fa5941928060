"""Where a beam is pinned on the edge that it may touch: between which directions it can leave its pin.

======  ======================================================================================
q       the pin, in the frame of the edge's body
τ, n    of a piece: along it with the free side on the left, and towards that side
f, b    directions along the edge from the pin onwards and backwards; where the edge ends, along the side of what is
        rigid, square to the last piece
β       angle from f to the beam as it leaves the pin; 0 ≤ β ≤ β_b, that of b
======  ======================================================================================
"""

from __future__ import annotations

from math import atan2, pi, remainder, tau

import numpy as np

from cprbm.faces import Face, faces_of
from cprbm.model import Chain, Model
from cprbm.stops import AngleStop
from cprbm_scene import EdgeContact, PinnedEnd, Scene
from cprbm_scene.answer import Array

ON_IT = 1e-6  # of the longest beam: a pin that is as close is on the edge


def own_pins(scene: Scene, model: Model, name: str) -> tuple[AngleStop | None, AngleStop | None]:
    """The stops by which an edge holds the beam's start and end; none at an end that is not pinned on it."""
    contact = scene.contacts[name]
    assert isinstance(contact, EdgeContact)
    chain, beam = model.chain(contact.beam), scene.beams[contact.beam]
    faces = faces_of(contact, model.unit_length, (0.0, 0.0))
    body = model.free_bodies.index(contact.body) if contact.body in model.free_bodies else -1
    found: list[AngleStop | None] = []
    for end, arc, link, back in (
        (beam.start, 0.0, chain.first_link, 0.0),
        (beam.end, chain.line.length, chain.first_link + chain.n, pi),
    ):
        directions = None
        if isinstance(end, PinnedEnd) and carried_by(scene, end.point, contact.body):
            q = np.array(scene.place_of(end.point)) / model.unit_length
            half = 0.5 * _thickness(chain, arc / model.unit_length) if contact.thick else 0.0
            directions = _directions(faces, q, half)
        if directions is None:
            found.append(None)
            continue
        onwards, backwards = (atan2(y, x) for x, y in directions)
        most = (backwards - onwards) % tau
        # as drawn the beam leaves on the free side, or beyond it by the rounding of numbers, and stands free of stress
        leaves = float(chain.line.angle(np.array([arc]))[0]) + back
        beta = 0.5 * most + remainder(leaves - onwards - 0.5 * most, tau)
        found.append(
            AngleStop(
                name=name,
                link=link,
                body=body,
                drawn=beta - float(model.rest[link]),
                limits=np.array([most, 0.0]),
                signs=np.array([1.0, -1.0]),
                arc=arc / model.unit_length,
            )
        )
    return found[0], found[1]


def carried_by(scene: Scene, point: str, body: str) -> bool:
    """Whether a ``point`` is one of the ``body``, or stays at one of its points by pins."""
    together, grown = {point}, True
    while grown:
        more = {name for pin in scene.pins.values() if together & set(pin.points) for name in pin.points}
        grown = not more <= together
        together |= more
    fixed = [name for name, one in scene.bodies.items() if one.motion == "fixed"]
    bodies = fixed if body in fixed else [body]
    return any(name in scene.bodies[each].points for name in together for each in bodies)


def _thickness(chain: Chain, arc: float) -> float:
    return float(chain.section.thickness_at(np.array([arc]))[0])


def _directions(faces: tuple[Face, ...], q: Array, half: float) -> tuple[Array, Array] | None:
    """f and b (2,) of a pin at ``q`` that is ``half`` a thickness from the edge; None where it is not."""
    onwards = backwards = square = None
    for face in faces:
        seen = face.seen(q[None])
        n = seen.normal[0]
        along = np.array([n[1], -n[0]])
        foot = q - half * n
        if abs(float(seen.distance[0]) - half) > ON_IT:
            continue
        at_begin, at_end = (end is not None and np.hypot(*(foot - end)) <= ON_IT for end in face.ends)
        if not (at_begin or at_end or bool(seen.within[0])):
            continue
        square = -n
        onwards = onwards if at_end else along
        backwards = backwards if at_begin else -along
    if square is None:
        return None
    return square if onwards is None else onwards, square if backwards is None else backwards
