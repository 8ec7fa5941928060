"""Scenes with exact answers of their own, as data in SI units, and what may be done to a scene."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import elastica_reference
from comparisons import cases
from cprbm_scene import Answer, Ending, scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, WIDTH, cantilever_data, hinge_data
from tests.references.hinge import Hinge
from tests.references.two_cantilevers import TwoCantilevers
from tests.references.wrapped import Wrapped

CASES = Path(__file__).parents[2] / "comparisons" / "cases"
FREE = {"joint": "free"}
STRIP = {"thickness": THICKNESS, "width": WIDTH, "material": "m"}


def weld(point: str) -> dict[str, str]:
    return {"joint": "weld", "point": point}


def line(start: list[float], end: list[float]) -> dict[str, Any]:
    return {"kind": "line", "start": start, "end": end}


def answer(data: dict[str, Any]) -> Answer:
    return elastica_reference.answer(scene_from(data))


def completed(data: dict[str, Any]) -> Answer:
    found = answer(data)
    assert found.ending is Ending.COMPLETED, found.sentence
    return found


def case(name: str) -> dict[str, Any]:
    """A built-in case without its claims."""
    return {**cases.data(name), "claims": []}


# ------------------------------------------------------------------------------------------------ scenes


def hinge(of: Hinge, moments: list[float]) -> dict[str, Any]:
    """The hinge of :mod:`tests.references.hinge`."""
    data = hinge_data() | {"claims": []}
    x0, x1, y = of.xc - of.radius, of.xc + of.radius, of.yc
    data["bodies"]["AC"]["points"] = {"A": [x0, y], "C": [x0, -y]}
    data["bodies"]["BD"]["points"] = {"B": [x1, y], "D": [x1, -y]}
    data["materials"]["abs"]["youngs_modulus"] = of.youngs_modulus
    for name, sign in (("beam1", 1.0), ("beam2", -1.0)):
        beam = data["beams"][name]
        beam["thickness"], beam["width"] = of.thickness, of.width
        beam["curve"] |= {"center": [of.xc, sign * y], "start": [x0, sign * y], "end": [x1, sign * y]}
    data["stages"][0]["stations"] = moments
    return data


def wrapped(of: Wrapped, forces: list[float]) -> dict[str, Any]:
    """The cantilever on a circle of :mod:`tests.references.wrapped`, clamped at the origin."""
    data = case("wrapped")
    data["materials"]["steel"]["youngs_modulus"] = of.youngs_modulus
    data["bodies"]["ground"]["points"], data["bodies"]["tip"]["points"] = {"C": [0.0, 0.0]}, {"T": [of.length, 0.0]}
    beam = {"curve": line([0.0, 0.0], [of.length, 0.0]), "thickness": of.thickness, "width": of.width}
    data["beams"]["beam"] |= beam
    data["loads"]["F"]["direction"] = [cos(of.pull), -sin(of.pull)]
    data["contacts"]["contact"] |= {"center": [0.0, -of.neutral_radius], "radius": of.radius}
    data["stages"][0]["stations"] = forces
    data["probes"].append({"of": "contact", "quantity": "closing_load"})
    return data


def tip_on_beam(of: TwoCantilevers, forces: list[float]) -> dict[str, Any]:
    """The pair of :mod:`tests.references.two_cantilevers`, lengths times LENGTH; ``forces`` without dimension."""
    h, a = of.gap * LENGTH, of.reach * LENGTH
    data = cantilever_data({"kind": "force", "point": "T", "direction": [0.0, -1.0]}, [])
    data["bodies"] = {
        "wall": {"motion": "fixed", "points": {"R": [0.0, h], "Q": [a, 0.0]}},
        "tip": {"motion": "free", "points": {"T": [LENGTH, h]}},
    }
    data["beams"] = {
        "upper": {**STRIP, "curve": line([0.0, h], [LENGTH, h]), "start": weld("R"), "end": weld("T")},
        "lower": {
            **STRIP,
            "curve": line([a, 0.0], [a - of.lower_length * LENGTH, 0.0]),
            "start": weld("Q"),
            "end": FREE,
        },
    }
    data["contacts"] = {"touch": {"kind": "beam-beam", "between": ["upper", "lower"], "thick": False}}
    data["stages"][0]["stations"] = [force * RIGIDITY / LENGTH**2 for force in forces]
    data["probes"] = [
        {"of": "T", "quantity": "displacement"},
        {"of": "tip", "quantity": "rotation"},
        *({"of": "touch", "quantity": quantity} for quantity in ("force", "centre", "ends", "closing_load")),
        *({"of": point, "quantity": quantity} for point in "RQ" for quantity in ("reaction", "reaction_moment")),
        {"of": "scene", "quantity": "potential_energy"},
    ]
    return data


def post_buckled(load: float, *, driven_to: float | None = None) -> dict[str, Any]:
    """A column of two halves, clamped, whose other end slides: bowed, loaded beyond Euler's load, let go.

    Args:
        load: P L²/EI; driven_to: deflection of the middle over L to which a drive bows it, instead of a force that
            goes again.
    """
    half, axial = 0.5 * LENGTH, load * RIGIDITY / LENGTH**2
    data = cantilever_data({"kind": "force", "point": "E", "direction": [-1.0, 0.0]}, [])
    data["bodies"] = {
        "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
        "middle": {"motion": "free", "points": {"M": [half, 0.0]}},
        "guide": {"motion": "slides", "along": [1.0, 0.0], "points": {"E": [LENGTH, 0.0]}},
    }
    data["beams"] = {
        "first": {**STRIP, "curve": line([0.0, 0.0], [half, 0.0]), "start": weld("R"), "end": weld("M")},
        "second": {**STRIP, "curve": line([half, 0.0], [LENGTH, 0.0]), "start": weld("M"), "end": weld("E")},
    }
    press = {"name": "press", "steps": "P", "stations": [0.5 * axial, axial]}
    if driven_to is None:
        data["loads"]["Q"] = {"kind": "force", "point": "M", "direction": [0.0, 1.0]}
        aside = 20.0 * RIGIDITY / LENGTH**2
        bow = {"name": "bow", "steps": "Q", "stations": [aside]}
        data["stages"] = [bow, press, {"name": "release", "steps": "Q", "stations": [0.5 * aside, 0.0]}]
    else:
        data["drives"] = {"Q": {"kind": "displacement", "point": "M", "direction": [0.0, 1.0]}}
        data["stages"] = [{"name": "bow", "steps": "Q", "stations": [driven_to * LENGTH]}, press]
    data["probes"] = [
        {"of": "M", "quantity": "displacement"},
        {"of": "E", "quantity": "displacement"},
        {"of": "R", "quantity": "reaction"},
        {"of": "R", "quantity": "reaction_moment"},
        {"of": "first", "quantity": "bending_stress", "points": 5},
        {"of": "scene", "quantity": "potential_energy"},
    ]
    if driven_to is not None:
        data["probes"].append({"of": "M", "quantity": "reaction"})
    return data


# ------------------------------------------------------------------------- what may be done to a scene


def mapped(data: dict[str, Any], move: Callable[[Any], Any], turn: Callable[[Any], Any], *, mirror: bool) -> Any:
    """A scene all of whose places and directions are mapped; a mirror image turns the other way round."""
    new = json.loads(json.dumps(data))
    for body in new["bodies"].values():
        body["points"] = {name: move(place) for name, place in body["points"].items()}
        if "along" in body:
            body["along"] = turn(body["along"])
    for beam in new["beams"].values():
        curve = beam["curve"]
        curve |= {key: move(curve[key]) for key in ("start", "end", "center") if key in curve}
        if mirror and curve["kind"] == "arc":
            way = {"clockwise": "counterclockwise", "counterclockwise": "clockwise"}
            curve["direction"] = way[curve["direction"]]
    for contact in new["contacts"].values() if "contacts" in new else ():
        if "center" in contact:
            contact["center"] = move(contact["center"])
        contact.pop("paper", None)
    for acting in [*new.get("loads", {}).values(), *new.get("drives", {}).values()]:
        if "direction" in acting:
            acting["direction"] = turn(acting["direction"])
    return new


def reversed_beam(data: dict[str, Any], name: str) -> dict[str, Any]:
    """A scene one of whose beams begins where it ended."""
    new: dict[str, Any] = json.loads(json.dumps(data))
    beam = new["beams"][name]
    beam["start"], beam["end"] = beam["end"], beam["start"]
    curve = beam["curve"]
    if curve["kind"] == "polynomial":
        curve["range"] = curve["range"][::-1]
    else:
        curve["start"], curve["end"] = curve["end"], curve["start"]
    if curve["kind"] == "arc":
        curve["direction"] = "clockwise" if curve["direction"] == "counterclockwise" else "counterclockwise"
    for size in ("thickness", "width"):
        if isinstance(beam[size], dict):
            at, values = beam[size]["at"], beam[size]["values"]
            beam[size] = {"at": [1.0 - u for u in at[::-1]], "values": values[::-1]}
    return new


def rotation(angle: float) -> Callable[[Any], Any]:
    c, s = cos(angle), sin(angle)
    return lambda v: [c * v[0] - s * v[1], s * v[0] + c * v[1]]


TURN = rotation(0.7 * pi)
"""A turn by no special angle."""


def punched() -> dict[str, Any]:
    """A cantilever that a circle on a driven slide presses down."""
    data = cantilever_data({}, [])
    radius = 0.02
    middle = [0.6 * LENGTH, radius + 0.5 * THICKNESS + 0.002]
    data["loads"], data["drives"] = {}, {"down": {"kind": "displacement", "point": "K", "direction": [0.0, -1.0]}}
    data["bodies"]["punch"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"K": middle}}
    data["contacts"] = {
        "circle": {"kind": "beam-circle", "beam": "beam", "body": "punch", "center": middle, "radius": radius}
    }
    data["stages"] = [{"name": "down", "steps": "down", "stations": [0.001, 0.003, 0.012]}]
    contact = [{"of": "circle", "quantity": quantity} for quantity in ("force", "centre", "ends", "closing_load")]
    data["probes"] = [{"of": "tip", "quantity": "rotation"}, {"of": "beam", "quantity": "bending_stress"}, *contact]
    return data
