"""Scenes that tests alter: the names tell the mechanism."""

from tests.cprbm_scene.editing import edited, two_lines

T, L, R = 0.002, 0.1, 0.03


def over_a_circle(gap=0.0, *, thick=True, body="ground"):
    """A level cantilever of 0.1 m, 2 mm thick, ``gap`` above a circle of 30 mm below its clamp."""
    offset = R + gap + (0.5 * T if thick else 0.0)
    return {
        "name": "circle",
        "theory": "bending",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0]}},
            "block": {"motion": "free", "points": {"Q": [L, 0.0]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [L, 0.0]},
                "thickness": T,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": "weld", "point": "O"},
                "end": {"joint": "weld", "point": "Q"},
            }
        },
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, -1.0]}},
        "contacts": {
            "touch": {
                "kind": "beam-circle",
                "beam": "beam",
                "body": body,
                "center": [0.0, -offset],
                "radius": R,
                "thick": thick,
            }
        },
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "Q", "quantity": "displacement"}],
    }


CIRCLE = over_a_circle()


LINE = {"kind": "beam-line", "points": [[-0.01, 0.0], [0.05, 0.0], [0.12, -0.01]], "side": "left"}


HALF_PLANE = {"kind": "beam-half-plane", "point": [0.3, 0.0], "normal": [0.0, 7.0]}


FUNCTION = {
    "kind": "beam-function",
    "axis": "x",
    "coefficients": [0.0, 0.0, -1.0],
    "range": [-0.1, 0.1],
    "side": "above",
}


def over(contact, gap=0.0, *, thick=True, start="weld"):
    """A level cantilever of 0.1 m, 2 mm thick, whose edge starts ``gap`` above the origin."""
    y = gap + (0.5 * T if thick else 0.0)
    return {
        "name": "edge",
        "theory": "bending",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"O": [0.0, y]}},
            "block": {"motion": "free", "points": {"Q": [L, y]}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, y], "end": [L, y]},
                "thickness": T,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": start, "point": "O"},
                "end": {"joint": "weld", "point": "Q"},
            }
        },
        "loads": {"F": {"kind": "force", "point": "Q", "direction": [0.0, -1.0]}},
        "contacts": {"touch": {"beam": "beam", "body": "ground", "thick": thick, **contact}},
        "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
        "probes": [{"of": "Q", "quantity": "displacement"}],
    }


SLIDES = {"motion": "slides", "along": [1.0, 0.0], "points": {"B": [0.051, 0.02625], "D": [0.051, -0.02625]}}


TURN = {"kind": "rotation", "body": "BD"}


PUSH = {"kind": "displacement", "point": "B", "direction": [3.0, 4.0]}


STAGE = [{"name": "drive", "steps": "d", "stations": [0.001]}]


DRIVEN = edited(("loads", {}), ("drives", {"d": PUSH}), ("stages", STAGE), ("claims", []))


TURNED = edited(("loads", {}), ("drives", {"d": TURN}), ("stages", STAGE), ("claims", []))


SLIDING = edited(("bodies/BD", SLIDES), ("drives/d", PUSH), base=DRIVEN)


WITH_FORCE = edited(
    ("loads", {"F": {"kind": "force", "point": "B", "direction": [1.0, 0.0]}}),
    ("stages/1", {"name": "load", "steps": "F", "stations": [1.0]}),
    base=edited(("bodies/BD", SLIDES), ("drives", {}), base=DRIVEN),
)


WITH_FORCE["stages"] = WITH_FORCE["stages"][1:]


SLOTTED = edited(("bodies/BD/turns", True), ("bodies/BD/about", "B"), base=SLIDING)


FORCE = {"kind": "beam_force", "beam": "lower", "at": 0.3, "direction": [0.0, -2.0]}


WEIGHT = {"kind": "distributed", "beam": "upper", "direction": [0.0, -1.0]}


LOADED_STAGES = [{"name": name, "steps": name, "stations": [1.0]} for name in ("F", "q")]


LOADED = edited(("loads", {"F": FORCE, "q": WEIGHT}), ("stages", LOADED_STAGES), base=two_lines(0.01))


LINKAGE = {
    "name": "linkage",
    "theory": "bending",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0], "E": [0.2, 0.0]}},
        "crank": {"motion": "free", "points": {"O1": [0.0, 0.0], "A": [0.0, 0.05]}},
        "coupler": {"motion": "free", "points": {"A1": [0.0, 0.05], "B": [0.15, 0.1]}},
        "rocker": {"motion": "turns", "about": "D", "points": {"D": [0.15, 0.0], "B1": [0.15, 0.1]}},
    },
    "pins": {
        "at_O": {"points": ["O", "O1"]},
        "at_A": {"points": ["A", "A1"]},
        "at_B": {"points": ["B", "B1"]},
    },
    "beams": {
        "spring": {
            "curve": {
                "kind": "arc",
                "center": [0.175, 0.05],
                "start": [0.2, 0.0],
                "end": [0.15, 0.1],
                "direction": "counterclockwise",
            },
            "thickness": 0.001,
            "width": 0.01,
            "material": "steel",
            "start": {"joint": "weld", "point": "E"},
            "end": {"joint": "weld", "point": "B1"},
        }
    },
    "loads": {"M": {"kind": "moment", "body": "crank"}},
    "stages": [{"name": "load", "steps": "M", "stations": [0.01]}],
    "probes": [{"of": "A", "quantity": "displacement"}],
}


LINKAGE["drives"] = {}


A, TIP = 29.28, 0.05  # the parabola x = A y²/2 + 0.05 m up to y = TIP


PARABOLA = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, 0.0, A / 2], "range": [0.0, TIP]}


def bowed(**changes):
    """A cantilever of one beam on the parabola."""
    data = two_lines(0.01)
    del data["beams"]["upper"], data["contacts"], data["bodies"]["ground"]["points"]["P"]
    data["beams"]["lower"]["curve"] = {**PARABOLA, **changes}
    data["bodies"]["ground"]["points"]["O"] = [0.05, 0.0]
    data["bodies"]["block"]["points"]["Q"] = [0.05 + A / 2 * TIP**2, TIP]
    return data


POINTS = [[0.0, 0.0], [0.03, 0.008], [0.07, 0.004], [0.1, 0.0]]


def through_points(**changes):
    """A cantilever through points."""
    data = two_lines(0.01)
    del data["beams"]["upper"], data["contacts"], data["bodies"]["ground"]["points"]["P"]
    data["beams"]["lower"]["curve"] = {"kind": "spline", "points": POINTS, **changes}
    return data


LINES = two_lines(0.01, thick=False)
