"""Scenes of bodies on pivots, stops at pins and assemblies, whose answers are known."""

import numpy as np

from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH
from tests.fea_reference.cantilever import elastica

MOMENT, FORCE = RIGIDITY / LENGTH, RIGIDITY / LENGTH**2
STRIP = {"thickness": THICKNESS, "width": WIDTH, "material": "m"}
MATERIALS = {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}}


def weld(point):
    return {"joint": "weld", "point": point}


def pin(point):
    return {"joint": "pin", "point": point}


def line(start, end):
    return {"kind": "line", "start": list(start), "end": list(end)}


def lever(r):
    """A lever on a pivot, whose arm r pulls a bar."""
    return scene_from(
        {
            "name": "lever",
            "theory": "bending",
            "materials": MATERIALS,
            "bodies": {
                "ground": {"motion": "fixed", "points": {"G": [LENGTH, r]}},
                # the points' mean is not the pivot
                "lever": {
                    "motion": "turns",
                    "about": "A",
                    "points": {"A": [0.0, 0.0], "B": [0.0, r], "far": [9.0, 7.0]},
                },
            },
            "beams": {"bar": {**STRIP, "curve": line([0.0, r], [LENGTH, r]), "start": pin("B"), "end": pin("G")}},
            "loads": {"M": {"kind": "moment", "body": "lever"}},
            "stages": [{"name": "pull", "steps": "M", "stations": [MOMENT]}],
            "probes": [
                {"of": "lever", "quantity": "rotation"},
                {"of": "A", "quantity": "reaction"},
                {"of": "A", "quantity": "displacement"},
                {"of": "G", "quantity": "reaction"},
            ],
        }
    )


def wheel(towards, end, limits, stations, drawn_at=0.0):
    """A beam pinned to a driven wheel at its pivot and clamped to a shoe that slides along it: idle but for the stop.

    ``towards`` is the direction, rad, of the wheel's other point against the beam, and ``drawn_at`` that of the beam.
    """

    def polar(distance, angle):
        return [float(distance * np.cos(angle)), float(distance * np.sin(angle))]

    wheel_end, shoe_end = [0.0, 0.0], polar(LENGTH, drawn_at)
    along = line(wheel_end, shoe_end) if end == "start" else line(shoe_end, wheel_end)
    ends = {"start": pin("A"), "end": weld("T")} if end == "start" else {"start": weld("T"), "end": pin("A")}
    other = polar(0.3 * LENGTH, towards + drawn_at)
    return scene_from(
        {
            "name": "wheel",
            "theory": "bending",
            "materials": MATERIALS,
            "bodies": {
                "wheel": {"motion": "turns", "about": "A", "points": {"A": [0.0, 0.0], "W": other}},
                "shoe": {"motion": "slides", "along": polar(1.0, drawn_at), "points": {"T": shoe_end}},
            },
            "beams": {"beam": {**STRIP, "curve": along, **ends}},
            "drives": {"turn": {"kind": "rotation", "body": "wheel"}},
            "stops": {"stop": {"beam": "beam", "end": end, "towards": "W", **limits}},
            "stages": [
                {"name": f"way{i}", "steps": "turn", "stations": list(values)} for i, values in enumerate(stations)
            ],
            "probes": [
                {"of": "stop", "quantity": "angle"},
                {"of": "stop", "quantity": "moment"},
                {"of": "wheel", "quantity": "reaction_moment"},
            ],
        }
    )


def bowed(alpha, *, moment, stop=None):
    """A straight cantilever whose tip is brought to where the elastica has it under a force across, alpha EI/L²."""
    x, y, _ = elastica(alpha)
    data = {
        "name": "bowed",
        "theory": "bending",
        "materials": MATERIALS,
        "bodies": {
            "ground": {
                "motion": "fixed",
                "points": {"O": [0.0, 0.0], "T": [x * LENGTH, y * LENGTH], "W": [x * LENGTH, 3.0 * LENGTH]},
            },
            "idle": {"motion": "turns", "about": "O2", "points": {"O2": [0.0, -LENGTH]}},
        },
        "beams": {
            "beam": {**STRIP, "curve": line([0.0, 0.0], [LENGTH, 0.0]), "start": weld("O"), "end": pin("T")},
            "spring": {
                **STRIP,
                "curve": line([0.0, -LENGTH], [LENGTH, -LENGTH]),
                "start": weld("O2"),
                "end": {"joint": "free"},
            },
        },
        "drives": {"turn": {"kind": "rotation", "body": "idle"}},
        "assembly": {"moments": {"beam": moment}},
        "stages": [{"name": "turn", "steps": "turn", "stations": [0.0]}],
        "probes": [
            {"of": "T", "quantity": "reaction"},
            {"of": "O", "quantity": "reaction_moment"},
            {"of": "scene", "quantity": "potential_energy"},
        ],
    }
    if stop is not None:
        data["stops"] = {"stop": {"beam": "beam", "end": "end", "towards": "W", **stop}}
        data["probes"].append({"of": "stop", "quantity": "angle"})
    return scene_from(data)


def straight():
    """A straight cantilever whose tip is pushed towards its clamp."""
    return scene_from(
        {
            **bowed(3.0, moment=0.0).model_dump(mode="json", exclude={"file"}),
            "bodies": {
                "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "T": [0.9 * LENGTH, 0.0]}},
                "idle": {"motion": "turns", "about": "O2", "points": {"O2": [0.0, -LENGTH]}},
            },
            "probes": [{"of": "scene", "quantity": "potential_energy"}],
        }
    )
