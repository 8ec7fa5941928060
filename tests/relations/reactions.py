"""Action and reaction: what rigid things bear is what pushes them, and all that holds a scene balances its loads.

In the image whatever rigid of the ground a beam may touch stands on a body of its own, which three drives hold where
it is.  The answer is to be the same; the force of the drives that hold the body is the contact's; and the supports',
drives', slides' and loads' forces, and their moments about the origin, have no sum.

======  =====================================================================
symbol  meaning
======  =====================================================================
R, x    a force and where it acts, N and m
M       a moment, N·m
L       the longest beam's length, m
ΣF, ΣM  ΣR and Σ(M + x × R), as shares of the largest in any station
======  =====================================================================

What only moments hold has forces that are round-off: a force counts for no less than the largest moment over L, and a
moment for no less than the largest force times L.

What is told of slides and of loads along beams is a force without its place, so that ΣM is asked only without them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.geometry import length
from cprbm_scene import Answer, FreeEnd, PinnedEnd, RigidContact, Scene, StationAnswer, scene_from
from cprbm_scene.answer import Array
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    DistributedLoad,
    FixedBody,
    Force,
    Moment,
    RotationDrive,
    SlidingBody,
    TurningBody,
)
from tests.relations.image import Data, Image, copied


def on_drives(data: Data) -> Image:
    """The image, with all that holds it asked for its force and moment."""
    scene = scene_from(data)
    new = copied(data)
    new.setdefault("drives", {})
    own = {
        name: contact
        for name, contact in scene.contacts.items()
        if isinstance(contact, RigidContact) and _stands_alone(scene, contact)
    }
    for name, contact in own.items():
        body, point = f"{name}_body", f"{name}_point"
        place = list(next(iter(scene.bodies[contact.body].points.values())))
        new["bodies"][body] = {"motion": "free", "points": {point: place}}
        new["contacts"][name]["body"] = body
        new["drives"][f"{name}_x"] = {"kind": "displacement", "point": point, "direction": [1.0, 0.0]}
        new["drives"][f"{name}_y"] = {"kind": "displacement", "point": point, "direction": [0.0, 1.0]}
        new["drives"][f"{name}_turn"] = {"kind": "rotation", "body": body}
    image = scene_from(new)
    asked = {(probe.of, probe.quantity) for probe in scene.probes}
    wanted = [
        *((point, "reaction") for point in _holding_points(image)),
        *((name, "reaction_moment") for name in _turning_holds(image)),
        *((point, "displacement") for point in _moved_points(image)),
        *((name, "force") for name in own),
    ]
    new["probes"] += [{"of": of, "quantity": q} for of, q in dict.fromkeys(wanted) if (of, q) not in asked]
    return Image("rigid things held by drives", new, beyond=balance)


def balance(scene: Scene, answer: Answer) -> dict[str, dict[tuple[str, float], float]]:
    """By what is to vanish its violation at every station.

    Args:
        scene: an image by :func:`on_drives`.
        answer: to it.
    """
    if not all(_alone(scene, contact) for contact in scene.contacts.values() if isinstance(contact, RigidContact)):
        return {}
    forces: dict[tuple[str, float], Array] = {}
    moments: dict[tuple[str, float], Array] = {}
    pushed: dict[str, dict[tuple[str, float], Array]] = {}
    loads: dict[str, float] = dict.fromkeys(scene.loads, 0.0)
    steps = {stage.name: stage.steps for stage in scene.stages}
    for station in answer.stations:
        if steps[station.stage] in loads:
            loads[steps[station.stage]] = station.value
        at = station.stage, station.value
        acting = [*_held(scene, station), *_loaded(scene, loads, station)]
        forces[at] = np.array([force for _, force, _ in acting])
        moments[at] = np.array([m + x[0] * f[1] - x[1] * f[0] for x, f, m in acting])
        for name, contact in scene.contacts.items():
            if isinstance(contact, RigidContact) and f"{contact.body}".startswith(f"{name}_"):
                pair = station.values[f"{name}.force"][0], np.hypot(*station.values[f"{name}_point.reaction"])
                pushed.setdefault(f"{name}: force of the drives", {})[at] = np.array([[pair[0], -pair[1]]]).T
    longest = max(length(beam.curve) for beam in scene.beams.values())
    largest, turning = _largest(forces), _largest(moments)
    found = {"ΣF": _shares(forces, turning / longest)}
    if not _told_without_place(scene):
        found["ΣM"] = _shares(moments, largest * longest)
    found.update({name: _shares(pairs, largest) for name, pairs in pushed.items()})
    return found


def _largest(terms: dict[tuple[str, float], Array]) -> float:
    """Of all terms (n, ...)."""
    return max((float(np.max(np.abs(each), initial=0.0)) for each in terms.values()), default=0.0)


def _shares(terms: dict[tuple[str, float], Array], least: float) -> dict[tuple[str, float], float]:
    """The norm of each sum of terms (n, ...) over the largest term of all, or what is the ``least`` if that is more."""
    largest = max(least, _largest(terms))
    return {at: float(np.linalg.norm(each.sum(axis=0))) / largest if largest else 0.0 for at, each in terms.items()}


def _held(scene: Scene, station: StationAnswer) -> Iterator[tuple[Array, Array, float]]:
    """Place, force and moment of each support, drive, pivot and slide."""
    nowhere, nothing = np.zeros(2), np.zeros(2)
    for point in _holding_points(scene):
        place = nowhere if point in scene.bodies else _place(scene, station, point)
        yield place, station.values[f"{point}.reaction"], 0.0
    for name in _turning_holds(scene):
        yield nowhere, nothing, float(station.values[f"{name}.reaction_moment"][0])


def _loaded(scene: Scene, loads: dict[str, float], station: StationAnswer) -> Iterator[tuple[Array, Array, float]]:
    """Place, force and moment of each load."""
    nowhere, nothing = np.zeros(2), np.zeros(2)
    for name, load in scene.loads.items():
        value = loads[name]
        match load:
            case Moment() | BeamMoment():
                yield nowhere, nothing, value
            case Force():
                yield _place(scene, station, load.point), value * _unit(load.direction), 0.0
            case BeamForce():
                yield nowhere, value * _unit(load.direction), 0.0
            case DistributedLoad():
                stretch = (load.along[1] - load.along[0]) * length(scene.beams[load.beam].curve)
                yield nowhere, value * stretch * _unit(load.direction), 0.0


def _place(scene: Scene, station: StationAnswer, point: str) -> Array:
    moved = station.values.get(f"{point}.displacement")
    place = np.array(scene.place_of(point))
    return place if moved is None else place + moved


def _unit(direction: tuple[float, float]) -> Array:
    return np.asarray(np.array(direction) / np.hypot(*direction))


def _told_without_place(scene: Scene) -> bool:
    return any(isinstance(body, SlidingBody) for body in scene.bodies.values()) or any(
        isinstance(load, BeamForce | DistributedLoad) for load in scene.loads.values()
    )


def _stands_alone(scene: Scene, contact: RigidContact) -> bool:
    """Whether what is rigid stands on the ground and can be given a body of its own."""
    if not isinstance(scene.bodies[contact.body], FixedBody):
        return False
    return not any(
        isinstance(end, PinnedEnd) for end in (scene.beams[contact.beam].start, scene.beams[contact.beam].end)
    )


def _alone(scene: Scene, contact: RigidContact) -> bool:
    """Whether what is rigid is not on the ground, which does not tell of its force."""
    return not isinstance(scene.bodies[contact.body], FixedBody)


def _supports(scene: Scene) -> list[str]:
    fixed = {point for body in scene.bodies.values() if isinstance(body, FixedBody) for point in body.points}
    ends = [end for beam in scene.beams.values() for end in (beam.start, beam.end) if not isinstance(end, FreeEnd)]
    pinned = [point for pin in scene.pins.values() for point in pin.points]
    return [point for point in dict.fromkeys([*(end.point for end in ends), *pinned]) if point in fixed]


def _driven_points(scene: Scene) -> list[str]:
    return [drive.point for drive in scene.drives.values() if isinstance(drive, DisplacementDrive)]


def _holding_points(scene: Scene) -> list[str]:
    """Supports, pivots, driven points, and bodies that slide."""
    pivots = [body.about for body in scene.bodies.values() if isinstance(body, TurningBody)]
    slides = [name for name, body in scene.bodies.items() if isinstance(body, SlidingBody)]
    return list(dict.fromkeys([*_supports(scene), *pivots, *_driven_points(scene), *slides]))


def _turning_holds(scene: Scene) -> list[str]:
    """Supports and bodies whose rotation is driven."""
    turned = [drive.body for drive in scene.drives.values() if isinstance(drive, RotationDrive)]
    return list(dict.fromkeys([*_supports(scene), *turned]))


def _moved_points(scene: Scene) -> list[str]:
    """Points at which something acts, and which may move."""
    return list(
        dict.fromkeys(
            [*_driven_points(scene), *(load.point for load in scene.loads.values() if isinstance(load, Force))]
        )
    )
