"""Angle stop at a beam's pinned end on its own contact edge: the beam cannot turn into the edge.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
P       the joint, on the edge (half of the thickness from the edge for a thick beam)
τ       along the edge at P, the free side to the left: τ₋ before, τ₊ behind
β       angle from τ₊ to the beam's direction out of the pin, counter-clockwise
======  =====================================================================================

The free side is 0 ≤ β ≤ ∠(τ₊, −τ₋). Where the edge ends at P, only one of both limits holds; for the second limit β
starts at −τ₋ and is not positive. A stop enforces the limits. On any mesh the gap beside the pin depends on the
tangent at the pin. The stop's moment replaces the moment of the pressure there. With shear the stop holds the
section, as any stop; :mod:`fea_reference.face` treats the lean of the line.

Rounded numbers in a scene may place the beam beyond a limit. The stop permits this excess until the edge presses. The
beam then lies along the edge. At an angle δ a straight part would need a force 6 EI δ/h² beside the pin, zero in the
reference configuration and unbounded on short elements.
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
_OPEN = 1.5 * np.pi  # free angle beside an edge that ends at the pin
_SAME = 1e-6  # beam lengths or units: tolerance of coinciding points in a scene


def ends_on_edge(scene: Scene, contact: EdgeContact, origin: Array, unit: float) -> tuple[Outline, dict[Which, Array]]:
    """Outline of an edge, and the beam's ends held on it with their places (2,).

    Args:
        scene: the scene.
        contact: a contact of the scene.
        origin: of the frame, (2,) m.
        unit: unit of length, m.
    """
    beam = scene.beams[contact.beam]
    outline, ends_held = outline_of(contact, origin, unit), dict[Which, Array]()
    half = 0.5 * beam.thickness_at(np.array([0.0, 1.0])) / unit if contact.thick else np.zeros(2)
    ends: tuple[tuple[Which, BeamEnd], ...] = (("start", beam.start), ("end", beam.end))
    for (which, end), T in zip(ends, half, strict=True):
        if isinstance(end, FreeEnd) or not _moves_with(scene, end.point, contact.body):
            continue
        place = (np.array(scene.place_of(end.point)) - origin) / unit
        if abs(float(outline.near(place[:, None]).distance[0]) - T) <= _SAME:
            ends_held[which] = place
    on_it = [] if contact.thick else list(ends_held.values())
    return outline_of(contact, origin, unit, on_it), ends_held


def own_pins(
    scene: Scene, bodies: dict[str, tuple[int, Index | None]], ends: dict[tuple[str, str], tuple[int, float]], row: int
) -> tuple[StopPart, ...]:
    """Stops of pinned ends at contact edges; arguments as for :func:`fea_reference.stops.stops_of`."""
    stops: list[StopPart] = []
    for name, contact in scene.contacts.items():
        if not isinstance(contact, EdgeContact):
            continue
        beam = scene.beams[contact.beam]
        outline, ends_held = ends_on_edge(scene, contact, *beam_frame(beam))
        number, dofs = bodies[contact.body]
        for which, place in ends_held.items():
            end = beam.start if which == "start" else beam.end
            if not isinstance(end, PinnedEnd):
                continue
            ahead, back = ends_at(outline, place, _SAME)
            theta, drawn = ends[contact.beam, which]
            along = drawn if which == "start" else drawn + np.pi  # out of the pin into the beam
            limits: tuple[float | None, float | None]
            if ahead is not None:
                widest = None if back is None else float(np.remainder(_angle(back) - _angle(ahead), 2.0 * np.pi))
                angle = _angle_near(along - _angle(ahead), 0.5 * (_OPEN if widest is None else widest))
                limits = 0.0, widest
            elif back is not None:
                angle, limits = _angle_near(along - _angle(back), -0.5 * _OPEN), (None, 0.0)
            else:
                continue
            least, most = limits
            beyond = max(0.0, 0.0 if least is None else least - angle, 0.0 if most is None else angle - most)
            phi = None if dofs is None else int(dofs[2])
            stops.append(
                StopPart(
                    f"{name}.{which}",
                    end.point,
                    number,
                    theta,
                    phi,
                    row + len(stops),
                    angle - drawn,
                    least,
                    most,
                    (contact.beam, which),
                    name,
                    beyond,
                )
            )
    return tuple(stops)


def beam_frame(beam: Beam) -> tuple[Array, float]:
    """Origin (2,) and unit (m) of a beam's own frame, independent of the scene's units."""
    start = np.array(beam.curve.start)
    return start, float(max(np.hypot(*(np.array(beam.curve.end) - start)), beam.thickest))


def _moves_with(scene: Scene, point: str, body: str) -> bool:
    """True if the point belongs to the body or is pinned to a point of it; all fixed bodies count as one."""
    points = {point}
    for pin in scene.pins.values():
        if point in pin.points:
            points.update(pin.points)
    frame = frame_of(scene, body)
    return any(frame_of(scene, scene.body_of(name)) == frame for name in points)


def _angle(vector: Array) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def _angle_near(angle: float, middle: float) -> float:
    """The angle within π of ``middle``."""
    return middle + math.remainder(angle - middle, 2.0 * np.pi)
