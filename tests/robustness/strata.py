"""What kinds of things stand in a scene, and what its answers met: the names under which a run counts them.

The names are those of ``docs/features.md``, each behind the part of the scene that it belongs to.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from cprbm_scene import (
    Answer,
    BeamContact,
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    PinnedEnd,
    Profile,
    RigidContact,
    Scene,
    SelfContact,
)
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import SlidingBody

FAR_TURN = pi / 3.0  # rad; beyond this a rotation is large
SLENDER, THICK = 1.0 / 100.0, 1.0 / 30.0  # mean thickness over length

KINDS = frozenset(
    {
        "beams: line",
        "beams: circular arc",
        "beams: polynomial y = f(x)",
        "beams: polynomial x = f(y)",
        "beams: spline through points",
        "beams: thickness that varies",
        "beams: width that varies",
        "joints: weld",
        "joints: pin",
        "joints: free end",
        "joints: pin between two bodies",
        "bodies: free in the plane",
        "bodies: on a pivot",
        "bodies: slide",
        "bodies: slide with rotation",
        "bodies: stop at a pin",
        "loads: force on a body",
        "loads: moment on a body",
        "loads: force at a point of a beam",
        "loads: moment at a point of a beam",
        "loads: distributed load",
        "drives: displacement",
        "drives: rotation",
        "contacts: two beams",
        "contacts: two beams, of thickness that varies",
        "contacts: circle",
        "contacts: half-plane",
        "contacts: line",
        "contacts: polyline with a corner that stands out",
        "contacts: polyline that goes round",
        "contacts: function",
        "contacts: on a body that moves",
        "contacts: beam pinned to what it touches",
        "contacts: beam with itself",
        "kinematics: by edges",
        "kinematics: as lines",
        "stages: one",
        "stages: several",
        "stages: several stations",
        "stages: assembly first",
    }
)
"""Every kind of curve, joint, body, load, drive, contact and stage, of which each is to stand in some scenes."""


def stated(scene: Scene) -> frozenset[str]:
    """What is in a scene: those of :data:`KINDS`, and how many beams and contacts, and how slender beams are."""
    found = {*_of_beams(scene), *_of_bodies(scene), *_of_contacts(scene), *_of_stages(scene)}
    found |= {f"loads: {_LOADS[load.kind]}" for load in scene.loads.values()}
    found |= {f"drives: {drive.kind}" for drive in scene.drives.values()}
    if scene.stops:
        found.add("bodies: stop at a pin")
    if scene.pins:
        found.add("joints: pin between two bodies")
    return frozenset(found)


def met(scene: Scene, answer: Answer) -> frozenset[str]:
    """What an answer met at some station: a closed contact, a rotation beyond 60° of a body or along a beam."""
    found: set[str] = set()
    closed = {name for station in answer.stations for name in station.touching}
    if closed:
        found.add("met: closed contact")
    if len(closed) > 1:
        found.add("met: several closed contacts")
    rest = {
        name: _directions(shape_of(beam.curve).point(np.linspace(0.0, 1.0, 81))) for name, beam in scene.beams.items()
    }
    for station in answer.stations:
        for name, shape in station.shapes.items():
            u = shape.s / shape.s[-1]
            at = 0.5 * (u[1:] + u[:-1])
            before = np.interp(at, (np.arange(80) + 0.5) / 80.0, rest[name])
            turned = _directions(np.column_stack((shape.x, shape.y))) - before
            # a direction is known up to full turns: the least along the beam that is consistent with the first one
            turned = np.abs(turned - 2.0 * pi * np.round(turned[0] / (2.0 * pi)))
            if turned.max() > FAR_TURN:
                found.add("met: rotation beyond 60°")
    if answer.critical:
        found.add("met: branch that ends")
    return frozenset(found)


_LOADS = {
    "force": "force on a body",
    "moment": "moment on a body",
    "beam_force": "force at a point of a beam",
    "beam_moment": "moment at a point of a beam",
    "distributed": "distributed load",
}
_CURVES = {"line": "line", "arc": "circular arc", "spline": "spline through points"}
_GRAPHS = {"x": "polynomial y = f(x)", "y": "polynomial x = f(y)"}
_JOINTS = {"weld": "weld", "pin": "pin", "free": "free end"}


def _of_beams(scene: Scene) -> Iterator[str]:
    yield f"beams: {len(scene.beams)}"
    for beam in scene.beams.values():
        kind = beam.curve.kind
        yield f"beams: {_GRAPHS[beam.curve.axis] if beam.curve.kind == 'polynomial' else _CURVES[kind]}"
        if isinstance(beam.thickness, Profile):
            yield "beams: thickness that varies"
        if isinstance(beam.width, Profile):
            yield "beams: width that varies"
        for end in (beam.start, beam.end):
            yield f"joints: {_JOINTS[end.joint]}"
        ratio = 0.5 * (beam.thinnest + beam.thickest) / shape_of(beam.curve).length
        if ratio < SLENDER:
            yield "beams: slender"
        if ratio > THICK:
            yield "beams: thick"


def _of_bodies(scene: Scene) -> Iterator[str]:
    for body in scene.bodies.values():
        if isinstance(body, SlidingBody):
            yield "bodies: slide with rotation" if body.turns else "bodies: slide"
        elif body.motion != "fixed":
            yield {"free": "bodies: free in the plane", "turns": "bodies: on a pivot"}[body.motion]


def _of_contacts(scene: Scene) -> Iterator[str]:
    yield f"contacts: {len(scene.contacts)}"
    for contact in scene.contacts.values():
        yield "kinematics: by edges" if contact.thick else "kinematics: as lines"
        match contact:
            case BeamContact():
                tapered = any(scene.beams[beam].tapered for beam in contact.between)
                yield "contacts: two beams"
                if tapered and contact.thick:
                    yield "contacts: two beams, of thickness that varies"
            case SelfContact():
                yield "contacts: beam with itself"
            case CircleContact():
                yield "contacts: circle"
            case HalfPlaneContact():
                yield "contacts: half-plane"
            case FunctionContact():
                yield "contacts: function"
            case LineContact(closed=True):
                yield "contacts: polyline that goes round"
            case LineContact():
                cornered = len(contact.points) > 2
                yield "contacts: polyline with a corner that stands out" if cornered else "contacts: line"
        if isinstance(contact, RigidContact):
            yield from _of_rigid(scene, contact)


def _of_rigid(scene: Scene, contact: RigidContact) -> Iterator[str]:
    body = scene.bodies[contact.body]
    if body.motion != "fixed":
        yield "contacts: on a body that moves"
    beam = scene.beams[contact.beam]
    own = any(isinstance(end, PinnedEnd) and end.point in body.points for end in (beam.start, beam.end))
    if own and not isinstance(contact, CircleContact):
        yield "contacts: beam pinned to what it touches"


def _of_stages(scene: Scene) -> Iterator[str]:
    yield "stages: several" if len(scene.stages) > 1 else "stages: one"
    if any(len(stage.stations) > 1 for stage in scene.stages):
        yield "stages: several stations"
    if scene.assembly is not None:
        yield "stages: assembly first"
    for stage in scene.stages:
        if stage.beyond is not None:
            yield f"stages: beyond an end, {stage.beyond}"


def _directions(points: np.ndarray) -> np.ndarray:
    """Angles (n − 1,) along a line of points (n, 2), rad, without jumps."""
    along = np.diff(points, axis=0)
    return np.asarray(np.unwrap(np.arctan2(along[:, 1], along[:, 0])))
