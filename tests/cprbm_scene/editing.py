"""Scenes that tests alter, edits of their data, and beams on given curves: the names tell the mechanism."""

import copy
from pathlib import Path

import numpy as np

from comparisons import cases
from cprbm_scene import Beam, FreeEnd, SceneError, scene_from
from cprbm_scene.clearance import beam_gap
from cprbm_scene.curve_records import shape_of
from cprbm_scene.curves import least

FILE = Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml"
HINGE = cases.data("hinge")
REMOVED = object()


def edited(*edits, base=HINGE):
    """``base`` with each (path, value) put in; REMOVED takes the key away."""
    data = copy.deepcopy(base)
    for path, value in edits:
        keys = [int(key) if key.isdigit() else key for key in path.split("/")]
        place = data
        for key in keys[:-1]:
            place = place[key]
        if value is REMOVED:
            del place[keys[-1]]
        elif isinstance(place, list) and keys[-1] == len(place):
            place.append(value)
        else:
            place[keys[-1]] = value
    return data


def mistakes(*edits, base=HINGE):
    """Key and both halves of the sentence of every mistake after the edits."""
    try:
        scene_from(edited(*edits, base=base), file="case.toml")
    except SceneError as error:
        return {mistake.key: f"{mistake.found}; {mistake.allowed}" for mistake in error.mistakes}
    return {}


T, L, R = 0.002, 0.1, 0.03
BEAM = {"thickness": T, "width": 0.01, "material": "steel"}
QUESTION = {
    "name": "pair",
    "theory": "bending",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
    "probes": [{"of": "Q", "quantity": "displacement"}],
}


def straight(start, end):
    """A straight line between two places."""
    return {"kind": "line", "start": list(start), "end": list(end)}


def weld(point):
    """A weld at a point."""
    return {"joint": "weld", "point": point}


def two_lines(gap, *, thick=True, second=None):
    """Two level cantilevers of 0.1 m, 2 mm thick, their neutral lines ``gap`` apart."""
    ends = second or ((0.0, gap), (L, gap))
    lower = {**BEAM, "curve": straight((0.0, 0.0), (L, 0.0)), "start": weld("O"), "end": weld("Q")}
    upper = {**BEAM, "curve": straight(*ends), "start": weld("P"), "end": {"joint": "free"}}
    return copy.deepcopy(QUESTION) | {
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "P": list(ends[0])}},
            "block": {"motion": "free", "points": {"Q": [L, 0.0]}},
        },
        "beams": {"lower": lower, "upper": upper},
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, 1.0]}},
        "contacts": {"touch": {"kind": "beam-beam", "between": ["lower", "upper"], "thick": thick}},
    }


def cantilever(curve, first, last, **changes):
    """The lower cantilever alone, along a curve between two places."""
    data = two_lines(0.01)
    del data["beams"]["upper"], data["contacts"], data["bodies"]["ground"]["points"]["P"]
    data["beams"]["lower"] |= {"curve": curve, **changes}
    data["bodies"]["ground"]["points"]["O"], data["bodies"]["block"]["points"]["Q"] = list(first), list(last)
    return data


def over(contact, gap=0.0, *, thick=True, start="weld", body="ground"):
    """A level cantilever of 0.1 m, 2 mm thick, whose edge starts ``gap`` above the origin."""
    y = gap + (0.5 * T if thick else 0.0)
    data = cantilever(straight((0.0, y), (L, y)), (0.0, y), (L, y), start={"joint": start, "point": "O"})
    data["beams"]["beam"] = data["beams"].pop("lower")
    return data | {"contacts": {"touch": {"beam": "beam", "body": body, "thick": thick, **contact}}}


CIRCLE = {"kind": "beam-circle", "center": [0.0, -R], "radius": R}
LINE = {"kind": "beam-line", "points": [[-0.01, 0.0], [0.05, 0.0], [0.12, -0.01]], "side": "left"}
HALF_PLANE = {"kind": "beam-half-plane", "point": [0.3, 0.0], "normal": [0.0, 7.0]}
FUNCTION = {
    "kind": "beam-function",
    "axis": "x",
    "coefficients": [0.0, 0.0, -1.0],
    "range": [-0.1, 0.1],
    "side": "above",
}
ELLIPSE = {"kind": "beam-ellipse", "center": [0.0, -0.03], "semi_axes": [0.05, 0.03]}
SPLINE = {"kind": "beam-spline", "points": [[-0.1, -0.01], [0.0, 0.0], [0.1, -0.01]], "side": "left"}

CIRCULAR = over(CIRCLE)
OWN = {"kind": "beam-self", "beam": "beam1"}
BELOW = {"kind": "beam-half-plane", "beam": "low", "body": "ground", "point": [0.0, -0.013], "normal": [0.0, 1.0]}

SLIDES = {"motion": "slides", "along": [1.0, 0.0], "points": {"B": [0.051, 0.02625], "D": [0.051, -0.02625]}}
TURN = {"kind": "rotation", "body": "BD"}
PUSH = {"kind": "displacement", "point": "B", "direction": [3.0, 4.0]}
ACROSS = {"kind": "force", "point": "B", "direction": [-4.0, 3.0]}
STAGE = [{"name": "drive", "steps": "d", "stations": [0.001]}]
DRIVEN = edited(("loads", {}), ("drives", {"d": PUSH}), ("stages", STAGE), ("claims", []))
TURNED = edited(("drives/d", TURN), base=DRIVEN)
SLIDING = edited(("bodies/BD", SLIDES), base=DRIVEN)
WITH_FORCE = edited(
    ("bodies/BD", SLIDES),
    ("drives", {}),
    ("loads", {"F": {"kind": "force", "point": "B", "direction": [1.0, 0.0]}}),
    ("stages", QUESTION["stages"]),
    base=DRIVEN,
)
SLOTTED = edited(("bodies/BD/turns", True), ("bodies/BD/about", "B"), base=SLIDING)
SLIDER = {**SLIDES, "points": {"E": [0.1, 0.0]}}
BOTH = edited(
    ("drives/t", TURN),
    ("drives/e", {"kind": "displacement", "point": "E", "direction": [1.0, 1.0]}),
    ("bodies/slider", SLIDER),
    ("loads/F", ACROSS),
    base=DRIVEN,
)
LOADED = edited(
    ("loads/F", {"kind": "beam_force", "beam": "lower", "at": 0.3, "direction": [0.0, -2.0]}),
    ("loads/q", {"kind": "distributed", "beam": "upper", "direction": [0.0, -1.0]}),
    ("stages/1", {"name": "q", "steps": "q", "stations": [1.0]}),
    base=two_lines(0.01),
)
LINES = two_lines(0.01, thick=False)

PARAMETERS = {
    "t": {"value": 2.0, "unit": "mm", "range": [1.6, 2.4], "tolerance": {"normal": 0.02}},
    "L": {"value": 0.1, "unit": "m"},
    "slope": {"value": 30.0, "unit": "deg"},
    "E": {"value": 200.0, "unit": "GPa"},
    "M": {"value": 40.0, "unit": "N*mm"},
    "k": {"value": 0.5},
    "half": {"value": "= t/2"},
}
PARAMETRIC = edited(("parameters", PARAMETERS), ("beams/lower/thickness", "= t"), base=two_lines(0.02, thick=False))

SPRING = {
    "kind": "arc",
    "center": [0.175, 0.05],
    "start": [0.2, 0.0],
    "end": [0.15, 0.1],
    "direction": "counterclockwise",
}
LINKAGE = QUESTION | {
    "name": "linkage",
    "bodies": {
        "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "E": [0.2, 0.0]}},
        "crank": {"motion": "free", "points": {"O1": [0.0, 0.0], "A": [0.0, 0.05]}},
        "coupler": {"motion": "free", "points": {"A1": [0.0, 0.05], "B": [0.15, 0.1]}},
        "rocker": {"motion": "turns", "about": "D", "points": {"D": [0.15, 0.0], "B1": [0.15, 0.1]}},
    },
    "pins": {"at_O": {"points": ["O", "O1"]}, "at_A": {"points": ["A", "A1"]}, "at_B": {"points": ["B", "B1"]}},
    "beams": {"spring": {**BEAM, "thickness": 0.001, "curve": SPRING, "start": weld("E"), "end": weld("B1")}},
    "loads": {"M": {"kind": "moment", "body": "crank"}},
    "drives": {},
    "stages": [{"name": "load", "steps": "M", "stations": [0.01]}],
    "probes": [{"of": "A", "quantity": "displacement"}],
}

HUNG = QUESTION | {
    "bodies": {
        "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": [0.031, 0.047]}},
        "plate": {"motion": "free", "points": {"P": [0.0731, 0.0], "Q": [0.0731, 0.0193]}},
    },
    "beams": {
        name: {
            **BEAM,
            "curve": straight(*ends),
            "start": {"joint": "pin", "point": first},
            "end": {"joint": "pin", "point": last},
        }
        for name, first, last, ends in (
            ("low", "R", "P", ((0.0, 0.0), (0.0731, 0.0))),
            ("high", "S", "Q", ((0.031, 0.047), (0.0731, 0.0193))),
        )
    },
    "loads": {"F": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
}
"""A plate on two pinned bars."""
STOPPED = edited(
    ("beams/low/end/joint", "weld"),
    ("stops", {"s": {"beam": "low", "end": "start", "towards": "S", "least": -1.2, "most": 0.2}}),
    base=HUNG,
)
ASSEMBLED = edited(
    ("beams/lower/end", {"joint": "pin", "point": "Q"}),
    ("beams/upper/end/point", "T"),
    ("bodies/block", {"motion": "fixed", "points": {"Q": [0.09, 0.03]}}),
    ("loads/F/point", "T"),
    ("contacts", {}),
    ("assembly", {"moments": {"lower": 0.1}}),
    base=two_lines(0.01),
)

A, TIP = 29.28, 0.05  # the parabola x = A y²/2 + 0.05 m up to y = TIP
PARABOLA = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, 0.0, A / 2], "range": [0.0, TIP]}
BOWED = cantilever(PARABOLA, (0.05, 0.0), (0.05 + A / 2 * TIP**2, TIP))
POINTS = [[0.0, 0.0], [0.03, 0.008], [0.07, 0.004], [0.1, 0.0]]
THROUGH_POINTS = cantilever({"kind": "spline", "points": POINTS}, POINTS[0], POINTS[-1])


def beam_on(curve, thickness):
    """A beam along a curve, without joints."""
    free = FreeEnd(joint="free")
    thickness = thickness or 1e-4 * shape_of(curve).length
    return Beam(curve=curve, thickness=thickness, width=0.01, material="m", start=free, end=free)


def line_distance(first, second, near=0.0):
    """Least distance of two neutral lines, m, that is ``near`` a value; a distance far above is not refined."""
    return near + beam_gap(beam_on(first, near), beam_on(second, near), thick=near > 0.0)[0]


def distance_to(curve, point):
    """Least distance of a neutral line from a point, m."""
    return least(lambda u: np.hypot(*(shape_of(curve).point(u) - point).T), np.linspace(0.0, 1.0, 2001))[0]
