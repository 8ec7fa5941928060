"""A beam that begins where it ended.

Two things of a discretised problem know where a beam begins, and such an image is another one, as that of ``pair`` is.
Of two parts of one beam that touch, it is the first that is asked for gaps, and in the image the other.  And at the
joints of a beam whose stress-free curvature varies, the CPRBM's smooth line has the tangent of the link behind: what it
is off that of the link before is of fifth order in the elements (:mod:`cprbm.smooth`).
"""

from __future__ import annotations

import numpy as np

from comparisons.geometry import length
from cprbm_scene import FreeEnd, Polynomial, Probe, Spline, scene_from
from cprbm_scene.answer import Array
from tests.relations.frames import OTHER_WAY
from tests.relations.image import Data, Image, copied

ASSEMBLED = 1e-6
"""Of a beam's length: an end that is drawn farther from its point is brought there by the assembly."""


def may_run_back(data: Data, beam: str) -> bool:
    """Whether a ``beam`` can be drawn from its end: one that assembly brings to its point must be an end."""
    drawn = scene_from(data).beams[beam]
    if isinstance(drawn.end, FreeEnd):
        return True
    place = np.array(scene_from(data).place_of(drawn.end.point))
    return bool(np.hypot(*(place - drawn.curve.end)) <= ASSEMBLED * length(drawn.curve))


def reversed_beam(data: Data, beam: str) -> Image:
    """The image in which a ``beam`` runs the other way.

    Where it touches itself its places are not compared: they are the smaller of two, and from the other end the other.
    """
    scene = scene_from(data)
    L = length(scene.beams[beam].curve)
    first = {name for name, each in scene.contacts.items() if each.beams[0] == beam}
    own = {name for name, each in scene.contacts.items() if each.kind == "beam-self" and each.beam == beam}

    def expected(probe: Probe, stage: str, value: Array) -> Array | None:
        if probe.quantity in ("centre", "ends") and probe.of in first:
            return None if probe.of in own else np.asarray(L - value[::-1])
        if probe.of != beam:
            return value
        return np.asarray((-1.0 if probe.quantity == "bending_stress" else 1.0) * value[::-1])

    anew = bool(own) or isinstance(scene.beams[beam].curve, Polynomial | Spline)
    return Image(f"{beam} reversed", _data(data, beam), expected, discretised_anew=anew)


def _data(data: Data, name: str) -> Data:
    new = copied(data)
    beam = new["beams"][name]
    beam["start"], beam["end"] = beam["end"], beam["start"]
    beam["curve"] = _curve(beam["curve"])
    for size in ("thickness", "width"):
        if isinstance(beam[size], dict):
            at, values = beam[size]["at"], beam[size]["values"]
            beam[size] = {"at": [1.0 - u for u in at[::-1]], "values": values[::-1]}
    for load in new.get("loads", {}).values():
        if load.get("beam") == name and "at" in load:
            load["at"] = 1.0 - load["at"]
        if load.get("beam") == name and "along" in load:
            load["along"] = [1.0 - u for u in load["along"][::-1]]
    for stop in new.get("stops", {}).values():
        if stop["beam"] == name:
            stop["end"] = "start" if stop["end"] == "end" else "end"
    return new


def _curve(curve: Data) -> Data:
    match curve["kind"]:
        case "polynomial":
            return {**curve, "range": curve["range"][::-1]}
        case "spline":
            new = {"kind": "spline", "points": curve["points"][::-1]}
            for key, other in (("start_direction", "end_direction"), ("end_direction", "start_direction")):
                if curve.get(other) is not None:
                    new[key] = [-c for c in curve[other]]
            return new
        case _:
            new = {**curve, "start": curve["end"], "end": curve["start"]}
            return new | ({"direction": OTHER_WAY[curve["direction"]]} if "direction" in curve else {})
