"""Small scenes for the records of a scene; :mod:`tests.together.feature_rows` states the solvers of each."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, sin
from typing import Any

from tests.cprbm_scene.editing import edited

Data = dict[str, Any]

LENGTH, THICKNESS, WIDTH, MODULUS = 0.1, 1.0e-3, 0.012, 2.0e9
RIGIDITY = MODULUS * WIDTH * THICKNESS**3 / 12.0  # N·m²
FORCE, MOMENT = RIGIDITY / LENGTH**2, RIGIDITY / LENGTH
STRIP: Data = {"thickness": THICKNESS, "width": WIDTH, "material": "m"}


def weld(point: str) -> Data:
    return {"joint": "weld", "point": point}


def pin(point: str) -> Data:
    return {"joint": "pin", "point": point}


def line(x: float, y: float, u: float, v: float) -> Data:
    return {"kind": "line", "start": [x * LENGTH, y * LENGTH], "end": [u * LENGTH, v * LENGTH]}


def fixed(**points: list[float]) -> Data:
    return {"motion": "fixed", "points": places(points)}


def free(**points: list[float]) -> Data:
    return {"motion": "free", "points": places(points)}


def places(points: Mapping[str, list[float]]) -> Data:
    return {name: [x * LENGTH, y * LENGTH] for name, (x, y) in points.items()}


def probes(*names: str) -> list[Data]:
    """Probes from their names."""
    found: list[Data] = []
    for name in names:
        of, quantity = name.split(".")
        found.append({"of": of, "quantity": quantity} | ({"points": 9} if quantity.endswith("stress") else {}))
    return found


DOWN: Data = {"kind": "force", "point": "T", "direction": [0.0, -1.0]}
ASKED = ("T.displacement", "scene.potential_energy")


def cantilever(curve: Data | None = None, asked: tuple[str, ...] = ASKED, **changes: Any) -> Data:
    """A beam from R in the wall to T of a free body, which a force pulls down; ``changes`` are the scene's keys."""
    beam = {**STRIP, "curve": curve or line(0, 0, 1, 0), "start": weld("R"), "end": weld("T")}
    start, end = ends_of(beam["curve"])
    stepped = next(iter(changes.get("drives") or changes.get("loads") or {"F": None}))
    amount = {
        "force": 1.5 * FORCE,
        "moment": 1.2 * MOMENT,
        "beam_force": 2.0 * FORCE,
        "distributed": 3.0 * FORCE / LENGTH,
    }
    amount |= {"beam_moment": 1.5 * MOMENT, "displacement": 0.3 * LENGTH, "rotation": 0.8}
    kind = ((changes.get("drives") or changes.get("loads") or {"F": DOWN})[stepped])["kind"]
    return {
        "name": "feature",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": start}},
            "tip": {"motion": "free", "points": {"T": end}},
        },
        "beams": {"beam": beam},
        "loads": {} if "drives" in changes else {"F": DOWN},
        "stages": [{"name": "load", "steps": stepped, "stations": [amount[kind]]}],
        "probes": probes(*asked),
    } | changes


def ends_of(curve: Data) -> tuple[list[float], list[float]]:
    """Where a curve starts and ends, m."""
    if curve["kind"] == "spline":
        return curve["points"][0], curve["points"][-1]
    if curve["kind"] != "polynomial":
        return curve["start"], curve["end"]
    found = []
    for v in curve["range"]:
        w = sum(c * v**k for k, c in enumerate(curve["coefficients"]))
        found.append([v, w] if curve["axis"] == "x" else [w, v])
    return found[0], found[1]


def arc(turn: float) -> Data:
    """A quarter or so of a circle from the origin, at first along x."""
    r = LENGTH / turn
    end = [r * sin(turn), r * (1.0 - cos(turn))]
    return {"kind": "arc", "center": [0.0, r], "start": [0.0, 0.0], "end": end, "direction": "counterclockwise"}


POLYNOMIAL: Data = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, 0.2, 3.0], "range": [0.0, 0.09]}
SPLINE: Data = {"kind": "spline", "points": [[0.0, 0.0], [0.03, 0.012], [0.06, 0.008], [0.09, 0.02]]}


def sized(**sizes: Any) -> Data:
    """A cantilever of other thickness or width."""
    data = cantilever()
    data["beams"]["beam"] |= sizes
    return data


def ended(end: Data) -> Data:
    """An arc whose end is welded, pinned, or free, its load upon the beam."""
    data = cantilever(arc(1.5), asked=("R.reaction", "R.reaction_moment", "scene.potential_energy"))
    data["beams"]["beam"]["end"] = end
    data["loads"] = {"F": {"kind": "beam_force", "beam": "beam", "at": 0.6, "direction": [0.0, -1.0]}}
    tip = data["bodies"].pop("tip")["points"]["T"]
    if end["joint"] != "free":
        data["bodies"]["wall"]["points"]["G"] = tip
    return data


def sliding(**how: Any) -> Data:
    """An arc to a body in a slot, which is pushed along it."""
    data = cantilever(arc(1.2), asked=(*ASKED, "R.reaction"))
    data["bodies"]["tip"] |= {"motion": "slides", "along": [0.0, 1.0], **how}
    return data


def slotted() -> Data:
    """The same with an arm's pin in an oblique slot, of which the reaction is asked."""
    data = sliding(turns=True, about="T")
    data["bodies"]["tip"] |= {"along": [0.6, 0.8]}
    return data | {"probes": probes("tip.reaction", "R.reaction")}


def pivoted() -> Data:
    """A beam welded to a lever on a pivot."""
    data = cantilever(asked=("T.displacement", "lever.rotation", "P.reaction"))
    data["bodies"]["tip"] = {"motion": "turns", "about": "P", "points": places({"P": [1.2, 0.1], "T": [1, 0]})}
    data["bodies"] = {"wall": data["bodies"]["wall"], "lever": data["bodies"]["tip"]}
    data["beams"]["beam"]["curve"] = curve = arc(1.0)
    data["bodies"]["lever"]["points"]["T"] = curve["end"]
    return data


def linked() -> Data:
    """A cantilever whose body carries another body by a pin, which slides."""
    data = cantilever(arc(1.2), asked=("K.displacement", "tip.rotation", "scene.potential_energy"))
    x, y = data["bodies"]["tip"]["points"]["T"]
    data["bodies"]["tip"]["points"]["Q"] = [x, y + 0.02]
    data["bodies"]["car"] = {
        "motion": "slides",
        "along": [1.0, 0.0],
        "turns": True,
        "about": "K",
        "points": {"K": [x + 0.03, y + 0.02], "J": [x, y + 0.02]},
    }
    data["pins"] = {"joint": {"points": ["Q", "J"]}}
    data["loads"] = {"F": {"kind": "force", "point": "K", "direction": [-1.0, 0.0]}}
    return data


def stopped() -> Data:
    """A beam pinned to the wall, that a stop keeps from turning on."""
    data = cantilever(asked=("stop.angle", "stop.moment", "T.displacement"))
    data["bodies"]["wall"]["points"]["W"] = [0.0, -LENGTH]
    data["beams"]["beam"]["start"] = pin("R")
    data["stops"] = {"stop": {"beam": "beam", "end": "start", "towards": "W", "least": 1.4}}
    data["loads"], data["drives"] = {}, {"d": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}}
    data["stages"] = [{"name": "press", "steps": "d", "stations": [0.3 * LENGTH]}]
    return data


def held_by(contact: Data, **changes: Any) -> Data:
    """A cantilever over something rigid."""
    asked = ("T.displacement", "c.force", "c.centre", "R.reaction")
    return cantilever(asked=asked, contacts={"c": {"beam": "beam", "body": "wall", **contact}}) | changes


def moved(contact: Data) -> Data:
    """What is rigid is on a lever, which is turned up against the beam."""
    data = held_by({**contact, "body": "lever"})
    data["bodies"]["lever"] = {"motion": "turns", "about": "P", "points": places({"P": [0.2, -0.4]})}
    data["drives"] = {"turn": {"kind": "rotation", "body": "lever"}}
    data["stages"] = [{"name": "turn", "steps": "turn", "stations": [0.3]}]
    data["probes"] = probes("T.displacement", "c.force", "c.centre", "lever.reaction_moment")
    return data


CIRCLE: Data = {"kind": "beam-circle", "center": [0.06, -0.012], "radius": 0.01}
PLANE: Data = {"kind": "beam-half-plane", "point": [0.0, -0.012], "normal": [0.1, 1.0]}
TABLE: Data = {"kind": "beam-line", "points": [[0.02, -0.01], [0.2, -0.012]], "side": "left"}
INSIDE: Data = {"kind": "beam-circle", "center": [0.05, 0.0], "radius": 0.06, "side": "inside"}
ELLIPSE: Data = {"kind": "beam-ellipse", "center": [0.05, -0.04], "semi_axes": [0.03, 0.02], "angle": 0.3}
RAIL: Data = {"kind": "beam-spline", "points": [[0.0, -0.03], [0.05, -0.01], [0.1, -0.03]], "side": "left"}
ROOF: Data = {"kind": "beam-line", "points": [[0.03, -0.03], [0.05, -0.003], [0.08, -0.03]], "side": "left"}
BLOCK: Data = ROOF | {"points": [[0.05, -0.003], [0.08, -0.03], [0.03, -0.03], [0.05, -0.003]]}
HILL: Data = {
    "kind": "beam-function", "axis": "x", "coefficients": [-0.04, 1.3, -11.5], "range": [0.02, 0.09], "side": "above",
}  # fmt: skip


def two_beams(**contact: Any) -> Data:
    """A cantilever that is pressed on an arch."""
    data = cantilever(asked=("T.displacement", "c.force", "R.reaction", "S.reaction"))
    data["bodies"]["wall"]["points"] |= {"S": [0.03, -0.03], "U": [0.09, -0.03]}
    arch = {"kind": "arc", "center": [0.06, -0.03], "start": [0.03, -0.03], "end": [0.09, -0.03]}
    data["beams"]["arch"] = {**STRIP, "curve": arch | {"direction": "clockwise"}, "start": weld("S"), "end": weld("U")}
    data["beams"]["beam"]["curve"] = line(0, 0.05, 1, 0.05)
    data["bodies"]["wall"]["points"]["R"], data["bodies"]["tip"]["points"]["T"] = [0.0, 0.005], [LENGTH, 0.005]
    hints = {"boundary": "arch", "related": {"arch": {"x": [0.04, 0.08]}, "beam": {"x": [0.045, 0.075]}}}
    data["contacts"] = {"c": {"kind": "beam-beam", "between": ["beam", "arch"], "paper": hints} | contact}
    return data


def crossing() -> Data:
    """The same beams in two planes: the cantilever passes the arch."""
    data = two_beams() | {"contacts": {}, "may_cross": [["beam", "arch"]]}
    return data | {"probes": probes("T.displacement", "R.reaction")}


def two_tapered() -> Data:
    """The same beams, one of which grows thinner."""
    data = two_beams()
    data["beams"]["beam"]["thickness"] = {"at": [0.0, 1.0], "values": [1.2e-3, 0.8e-3]}
    return data


def pulled() -> Data:
    """A beam on a circle, with a weight of its own, a force at a place and one at its end."""
    data = held_by({**CIRCLE, "center": [0.07, -0.0115]}) | {"probes": probes("beam.combined_stress")}
    weight = {"kind": "distributed", "beam": "beam", "direction": [1.0, -2.0], "along": [0.1, 0.7]}
    pull = {"kind": "beam_force", "beam": "beam", "at": 0.3, "direction": [1.0, 0.2]}
    data["loads"] = data["loads"] | {"q": weight, "P": pull, "H": {**DOWN, "direction": [1.0, 0.0]}}
    values = {"H": 15.0 * FORCE, "P": 15.0 * FORCE, "q": 25.0 * FORCE / LENGTH, "F": 4.0 * FORCE}
    data["stages"] = [{"name": f"by_{name}", "steps": name, "stations": [value]} for name, value in values.items()]
    return data


def lying_on_its_pin() -> Data:
    """An arc pinned to the plane that it lies on from its pin on."""
    data = cantilever(arc(0.9), asked=("T.displacement", "c.moment", "scene.potential_energy", "T.reaction"))
    data["beams"]["beam"]["start"] = pin("R")
    plane = {"kind": "beam-half-plane", "point": [0.0, 0.0], "normal": [0.0, 1.0], "thick": False}
    data["contacts"] = {"c": {"beam": "beam", "body": "wall", **plane}}
    data["drives"] = {"d": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}}
    data["loads"] = {}
    data["stages"] = [{"name": "press", "steps": "d", "stations": [0.35 * LENGTH]}]
    return data


def lying_by_its_edge() -> Data:
    """The same arc, that lies on the plane by its edge."""
    data = lying_on_its_pin()
    data["contacts"]["c"] |= {"thick": True, "point": [0.0, -0.5 * THICKNESS]}
    return data


def bowed() -> Data:
    """A cantilever whose tip is brought to a pin above it, by a moment that bends it that way."""
    data = cantilever(asked=("R.reaction", "R.reaction_moment", "T.reaction"))
    data["bodies"] = {
        "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "T": [0.085, 0.04]}},
        "idle": {"motion": "free", "points": {"I": [0.0, -0.1], "Q": [0.1, -0.1]}},
    }
    data["beams"]["beam"]["end"] = pin("T")
    data["bodies"]["wall"]["points"]["I"] = [0.0, -0.1]
    data["bodies"]["idle"]["points"] = {"Q": [0.1, -0.1]}
    data["beams"]["spring"] = {**STRIP, "curve": line(0, -1, 1, -1), "start": weld("I"), "end": weld("Q")}
    data["loads"] = {"F": {"kind": "force", "point": "Q", "direction": [0.0, -1.0]}}
    data["assembly"] = {"moments": {"beam": 0.5 * MOMENT}}
    return data


def itself() -> Data:
    """A strip that is rolled up by its narrow end until its laps press on each other."""
    data = cantilever(
        drives={"r": {"kind": "rotation", "body": "tip"}}, asked=("T.displacement", "tip.reaction_moment")
    )
    sizes = {"thickness": 0.35e-3, "width": {"at": [0.0, 0.3, 0.9, 1.0], "values": [0.02, 0.0155, 0.017, 0.01]}}
    data["beams"]["beam"] |= sizes
    data["contacts"] = {"c": {"kind": "beam-self", "beam": "beam"}}
    data["stages"] = [{"name": "roll", "steps": "r", "stations": [7.0]}]
    return data


def itself_tapered() -> Data:
    """The same strip, thicker towards its narrow end, and rolled up farther."""
    data = itself()
    data["beams"]["beam"]["thickness"] = {"at": [0.0, 1.0], "values": [0.35e-3, 0.37e-3]}
    data["stages"] = [{"name": "roll", "steps": "r", "stations": [8.0]}]
    return data


def resting() -> Data:
    """A slider with a round nose that a dead weight presses on a leaf spring: contact and load hold the slider."""
    data = held_by(CIRCLE | {"center": [0.07, 0.0105]})
    data["bodies"]["slider"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"N": [0.07, 0.02]}}
    return edited(("contacts/c/body", "slider"), ("loads/F/point", "N"), base=data)


def three_points() -> Data:
    """A strip without joints on two circles, which the nose of a driven punch presses down."""
    data = held_by(CIRCLE) | {"probes": probes("c.force")}
    data["bodies"] = {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}}}
    data["bodies"]["punch"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"P": [0.05, 0.02]}}
    nose = data["contacts"]["c"] | {"center": [0.05, 0.0105], "body": "punch"}
    rollers = {name: data["contacts"]["c"] | {"center": [x, -0.0105]} for name, x in (("l", 0.01), ("r", 0.09))}
    free = {"joint": "free"}
    drive = {"kind": "displacement", "point": "P", "direction": [0.0, -1.0]}
    changes = [("beams/beam/start", free), ("beams/beam/end", free), ("contacts", {"c": nose, **rollers})]
    return edited(*changes, ("loads", {}), ("drives", {"d": drive}), ("stages/0/steps", "d"), base=data)


def pressed_then_held() -> Data:
    """A cantilever under a force at its tip; in a second stage a drive holds the tip and lowers the tip."""
    drive = {"kind": "displacement", "point": "T", "direction": [0.0, -1.0], "from": "hold"}
    stages = [("press", "F", [FORCE]), ("hold", "d", [0.008])]
    return edited(
        ("drives", {"d": drive}),
        ("stages", [{"name": name, "steps": steps, "stations": values} for name, steps, values in stages]),
        base=held_by(CIRCLE),
    )


def stepped_together() -> Data:
    """A cantilever under two forces that are stepped together."""
    force = {"kind": "force", "point": "T", "direction": [1.0, 0.0]}
    return edited(("loads/H", force), ("stages/0/steps", ["F", "H"]), base=held_by(CIRCLE))
