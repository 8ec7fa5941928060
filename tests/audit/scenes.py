"""Scenes of the audit: built-in cases at few stations, awkward contacts, and straight beams for made-up answers."""

from __future__ import annotations

from functools import cache

import numpy as np

import cprbm
import fea_reference
from comparisons import cases
from comparisons.audit import audit
from cprbm_scene import Answer, Certificate, Ending, Shape, StationAnswer, read, scene_from
from cprbm_scene.answer import BeamState
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force
from tests.scenes.rare_scenes import FOLDER

SOLVERS = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=20)),
    "shear": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="shear")),
    "bending": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending")),
    "fine": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=160, kinematics="bending")),
    "default": fea_reference.answer,
}


def built_in(case):
    """A built-in case at the last stations of its stages."""
    scene = cases.asked(case)
    stages = []
    for stage in scene.stages:
        stations = stage.stations if stage.beyond is None else stage.stations[::20]
        update = {"stations": stations[-2:] if stage.beyond is None else stations, "shown": ()}
        stages.append(stage.model_copy(update=update))
    return scene.model_copy(update={"stages": tuple(stages), "claims": ()})


def cam():
    """A leaf on an eccentric disc that turns: the contact closes at 30 degrees and opens at 150 degrees."""
    data = cantilever_data(force(0.0, -1.0), [1.0])
    eccentric, down = [(0.62 + shift) * LENGTH for shift in (0.0, 0.04)], -0.15 * LENGTH
    data["bodies"]["cam"] = {"motion": "turns", "points": {"O": [eccentric[0], down]}, "about": "O"}
    disc = {"kind": "beam-circle", "beam": "beam", "body": "cam", "center": [eccentric[1], down]}
    disc["radius"] = 0.13 * LENGTH - 0.5 * THICKNESS
    data["contacts"] = {"disc": disc}
    data["loads"] = {}
    data["drives"] = {"turn": {"kind": "rotation", "body": "cam"}}
    stages = {"round": [90.0, 360.0], "back": [180.0, 90.0, 0.0]}
    data["stages"] = [
        {"name": name, "steps": "turn", "stations": np.radians(degrees).tolist()} for name, degrees in stages.items()
    ]
    data["probes"] = [{"of": "disc", "quantity": "force"}, {"of": "cam", "quantity": "reaction_moment"}]
    return scene_from(data)


def wound_spiral():
    """A spiral of 1.6 turns, wound by 1.25 turns: a middle lap is pressed from both sides."""
    way = np.linspace(0.0, 1.6, 33)
    places = ((0.01 + 0.003 * way) * np.exp(2j * np.pi * way)).view(float).reshape(-1, 2).tolist()
    return scene_from(
        {
            "name": "spiral",
            "materials": {"m": {"youngs_modulus": 3e9, "poisson_ratio": 0.4}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": places[0]}},
                "end": {"motion": "free", "points": {"E": places[-1]}},
            },
            "beams": {
                "b": {
                    "curve": {"kind": "spline", "points": places},
                    "thickness": 1e-3,
                    "width": 8e-3,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "E"},
                }
            },
            "contacts": {"k": {"kind": "beam-self", "beam": "b"}},
            "drives": {"turn": {"kind": "rotation", "body": "end"}},
            "stages": [{"name": "wind", "steps": "turn", "stations": [1.5 * np.pi, 2.5 * np.pi]}],
            "probes": [{"of": "k", "quantity": "force"}],
        }
    )


def on_an_edge(**edge):
    """A beam that a tip force presses on a round solid; lengths in units of the beam."""
    data = cantilever_data(force(0.0, -1.0), [0.7 * RIGIDITY / LENGTH**2])
    scaled = {key: (np.array(value) * LENGTH).tolist() for key, value in edge.items() if key not in ("kind", "side")}
    data["contacts"] = {"edge": {**edge, **scaled, "beam": "beam", "body": "wall"}}
    data["probes"].append({"of": "edge", "quantity": "force"})
    return scene_from(data)


def on_a_needle(depth):
    """A beam pressed on a needle at 0.55 of the length, whose tip stands a ``depth`` in lengths below the beam."""
    x, y = 0.55, -depth - 0.5 * THICKNESS / LENGTH
    flanks = LENGTH * np.array([[x - 0.02, y - 0.2], [x, y], [x + 0.02, y - 0.2]])
    data = cantilever_data(force(0.0, -1.0), [])
    needle = {"kind": "beam-line", "beam": "beam", "body": "wall", "points": flanks.tolist(), "side": "left"}
    data["contacts"], data["loads"] = {"needle": needle}, {}
    data["drives"] = {"P": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}}
    data["stages"][0]["stations"] = [0.1 * LENGTH, 0.25 * LENGTH]
    return scene_from(data)


def taut_strip():
    """A strip drawn on a circle and pulled along the tangent, by a faint and a larger force: no section bends."""
    angle, radius = 1.571, LENGTH
    tip = [radius * np.cos(angle), radius * np.sin(angle)]
    data = cantilever_data(force(-np.sin(angle), np.cos(angle)), [])
    data["bodies"]["wall"]["points"]["R"], data["bodies"]["tip"]["points"]["T"] = [radius, 0.0], tip
    curve = {"kind": "arc", "center": [0.0, 0.0], "start": [radius, 0.0], "end": tip, "direction": "counterclockwise"}
    data["beams"]["beam"]["curve"] = curve
    disc = {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": [0.0, 0.0]}
    data["contacts"] = {"disc": {**disc, "radius": radius - 0.5 * THICKNESS}}
    data["stages"][0]["stations"] = [share * RIGIDITY / LENGTH**2 for share in (2e-3, 2e-2)]
    return scene_from(data)


SCENES = {
    "cam": cam,
    "spiral": wound_spiral,
    "strip": taut_strip,
    # the tangent at the ellipse's top is the clamped beam's; the tip presses on the lower side of the hole
    "ellipse": lambda: on_an_edge(
        kind="beam-ellipse", center=[0.0, -0.3 - 0.5 * THICKNESS / LENGTH], semi_axes=[1.0, 0.3]
    ),
    "hole": lambda: on_an_edge(kind="beam-circle", center=[0.5, 0.5], radius=0.8, side="inside"),
    "needle": lambda: on_a_needle(0.01),
} | {
    name: lambda name=name: read(FOLDER.parent / f"{name}.toml")
    for name in ("dead-point", "moment-at-a-probe", "micro-gripper")
}
"""Scenes beside the built-in cases by name."""


@cache
def asked(name):
    """A scene by name: of :data:`SCENES`, or a built-in case at few stations."""
    return SCENES[name]() if name in SCENES else built_in(name)


@cache
def answered(name, solver):
    """The complete answer of a solver to a scene."""
    found = SOLVERS[solver](asked(name))
    assert found.completed, found.sentence
    return found


# -- Made-up answers of straight beams with drawn neutral lines

T = 1e-3
CERTIFICATE = Certificate(1e-13, 1e-13, 1e-15, 1e-5, 1e-12, 1e-12, 1e-12, 0.3, 5)


def line(start, end, count=41):
    return np.linspace(start, end, count)


def arc(radius, length, count):
    angle = np.linspace(0.0, length / radius, count)
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def scene_of(beams, contacts=(), thickness=T, **keys):
    """Straight beams ``{name: (start, end)}``, welded to the ground at the starts, beside a body ``slide``."""
    points = {f"P{name}": list(start) for name, (start, _) in beams.items()}
    return scene_from(
        {
            "name": "drawn",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": points},
                "slide": {"motion": "slides", "along": [1.0, 0.0], "points": {"S": list(beams["a"][1])}},
            },
            "beams": {
                name: {
                    "curve": {"kind": "line", "start": list(start), "end": list(end)},
                    "thickness": thickness,
                    "width": 0.01,
                    "material": "steel",
                    "start": {"joint": "weld", "point": f"P{name}"},
                    "end": {"joint": "weld", "point": "S"} if name == "a" else {"joint": "free"},
                }
                for name, (start, end) in beams.items()
            },
            "loads": {"F": {"kind": "force", "point": "S", "direction": [1.0, 0.0]}},
            "contacts": dict(contacts),
            "stages": [{"name": "push", "steps": "F", "stations": [1.0, 2.0, 3.0]}],
            "probes": [{"of": "S", "quantity": "displacement"}],
            **keys,
        }
    )


def crossings(scene, *drawn, slide=(0.0, 0.0, 0.0)):
    """Sentences on neutral lines ``{name: places}``, a dictionary for every station; other beams stay at rest."""
    stations = []
    for value, lines in zip(scene.stages[0].stations, drawn, strict=False):
        lines = {name: line(beam.curve.start, beam.curve.end) for name, beam in scene.beams.items()} | lines
        shapes, states = {}, {}
        for name, places in lines.items():
            curve = scene.beams[name].curve
            s = np.linspace(0.0, np.hypot(*np.subtract(curve.end, curve.start)), len(places))
            x, y = places.T
            angle, zero = np.unwrap(np.arctan2(*(np.gradient(of, s, edge_order=2) for of in (y, x)))), np.zeros(len(s))
            shapes[name], states[name] = Shape(s, x, y), BeamState(s, x, y, angle, angle, zero, zero, zero, s)
        bodies = {"slide": np.array(slide)}
        stations.append(StationAnswer("push", value, {}, shapes, {}, CERTIFICATE, beams=states, bodies=bodies))
    return audit(scene, Answer("planted", scene.name, {}, Ending.COMPLETED, "", tuple(stations))).crossings
