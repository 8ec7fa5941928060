"""A beam that a joint holds on what it may lie on: if it is pinned there, it cannot turn into the edge.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
P       the joint, on the edge (half of the thickness from it, for a beam that touches by its own edge)
τ       along the edge at P, the free side to the left: τ₋ before, τ₊ behind
β       angle from τ₊ to the direction in which the beam leaves the pin, counter-clockwise
======  =====================================================================================

The free side is 0 ≤ β ≤ ∠(τ₊, −τ₋).  Where the edge ends at P only one of the two holds, and if that is the second, β
is counted from −τ₋ and is not positive.  A stop holds these limits: the tangent at the pin is what the gap beside it
goes by, on however fine a mesh, and the moment of the pressure that would be there is the stop's.  With shear it is
the section that is held, as by any stop; what the line beside it leans is seen to in :mod:`fea_reference.face`.

What is drawn from rounded numbers leaves the pin beyond a limit by their rounding, and may stand there until the edge
presses.  Then it lies along the edge: a flat part that is held at an angle δ to it would ask for a force of 6 EI δ/h²
beside the pin, which is of no size as drawn and of any on short elements.
"""

import math
from typing import Literal

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import Beam, BeamEnd, EdgeContact, FreeEnd, PinnedEnd, Scene
from fea_reference.hermite import Index
from fea_reference.outline import Outline, ends_at, outline_of
from fea_reference.staying import frame_of
from fea_reference.stops import StopPart

Which = Literal["start", "end"]
_OPEN = 1.5 * np.pi  # what is free beside an edge that ends at the pin
_SAME = 1e-6  # of the beam's length or of the unit: as near as a scene's places have to be


def held_on(scene: Scene, contact: EdgeContact, origin: Array, unit: float) -> tuple[Outline, dict[Which, Array]]:
    """The outline of what a beam may touch, and which of its ends are held on it, and where (2,).

    Args:
        scene: the scene.
        contact: one of its contacts.
        origin: of the frame, (2,) m.
        unit: of its lengths, m.
    """
    beam = scene.beams[contact.beam]
    outline, held = outline_of(contact, origin, unit), dict[Which, Array]()
    half = 0.5 * beam.thickness_at(np.array([0.0, 1.0])) / unit if contact.thick else np.zeros(2)
    ends: tuple[tuple[Which, BeamEnd], ...] = (("start", beam.start), ("end", beam.end))
    for (which, end), T in zip(ends, half, strict=True):
        if isinstance(end, FreeEnd) or not _moves_with(scene, end.point, contact.body):
            continue
        place = (np.array(scene.place_of(end.point)) - origin) / unit
        if abs(float(outline.near(place[:, None]).distance[0]) - T) <= _SAME:
            held[which] = place
    on_it = [] if contact.thick else list(held.values())
    return outline_of(contact, origin, unit, on_it), held


def own_pins(
    scene: Scene, bodies: dict[str, tuple[int, Index | None]], ends: dict[tuple[str, str], tuple[int, float]], row: int
) -> tuple[StopPart, ...]:
    """The stops by which contacts hold pinned ends; arguments as of :func:`fea_reference.stops.stops_of`."""
    found: list[StopPart] = []
    for name, contact in scene.contacts.items():
        if not isinstance(contact, EdgeContact):
            continue
        beam = scene.beams[contact.beam]
        outline, held = held_on(scene, contact, *own_frame(beam))
        number, dofs = bodies[contact.body]
        for which, place in held.items():
            end = beam.start if which == "start" else beam.end
            if not isinstance(end, PinnedEnd):
                continue
            ahead, back = ends_at(outline, place, _SAME)
            theta, drawn = ends[contact.beam, which]
            along = drawn if which == "start" else drawn + np.pi  # out of the pin into the beam
            limits: tuple[float | None, float | None]
            if ahead is not None:
                widest = None if back is None else float(np.remainder(_angle(back) - _angle(ahead), 2.0 * np.pi))
                angle = _about(along - _angle(ahead), 0.5 * (_OPEN if widest is None else widest))
                limits = 0.0, widest
            elif back is not None:
                angle, limits = _about(along - _angle(back), -0.5 * _OPEN), (None, 0.0)
            else:
                continue
            least, most = limits
            beyond = max(0.0, 0.0 if least is None else least - angle, 0.0 if most is None else angle - most)
            phi = None if dofs is None else int(dofs[2])
            found.append(
                StopPart(
                    f"{name}.{which}",
                    end.point,
                    number,
                    theta,
                    phi,
                    row + len(found),
                    angle - drawn,
                    least,
                    most,
                    (contact.beam, which),
                    name,
                    beyond,
                )
            )
    return tuple(found)


def own_frame(beam: Beam) -> tuple[Array, float]:
    """Origin (2,) and unit, m, by which places of a beam are known in whatever units a scene is drawn: its own."""
    start = np.array(beam.curve.start)
    return start, float(max(np.hypot(*(np.array(beam.curve.end) - start)), beam.thickest))


def _moves_with(scene: Scene, point: str, body: str) -> bool:
    """Whether a point is the body's, or pinned to one of its own; bodies that stay are one."""
    points = {point}
    for pin in scene.pins.values():
        if point in pin.points:
            points.update(pin.points)
    frame = frame_of(scene, body)
    return any(frame_of(scene, scene.body_of(each)) == frame for each in points)


def _angle(vector: Array) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def _about(angle: float, middle: float) -> float:
    """An angle, in the turn about ``middle``."""
    return middle + math.remainder(angle - middle, 2.0 * np.pi)
