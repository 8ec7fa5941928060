"""Scenes that are laid out as a whole: what acts on them, and what they touch, belongs to their idea.

======  ========================================================
symbol  meaning
======  ========================================================
EI, L   a beam's bending stiffness, and its length or so, m
======  ========================================================
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from tests.robustness.actions import force_of
from tests.robustness.chance import RedrawError, between, happens, rounded, sign, spread, weighted
from tests.robustness.curves import arc_of_turn
from tests.robustness.draft import THINNEST, Data, Draft

STOUTEST_COLUMN = 120.0  # times as long as thick
STOUTEST_HELD = 60.0  # the same of a beam with both ends held, which has to stretch where it can bend but little
TAUT = 0.95  # of a beam's length, between its ends
FLAT = 0.93  # of the way on which a beam comes to lie flat
NEAREST_WALL = 0.1  # of a column's length
PRESSED: dict[tuple[str, ...], tuple[float, float]] = {("weld", "weld"): (2.2, 3.9), ("weld", "pin"): (2.3, 4.9)}
"""How far a column between walls is pressed, L = 1 its length and g its distance from each wall, as shares of g².

By beams of small slopes it touches a wall at e = (π²/4) g² = 2.47 g² where both ends are clamped (2.58 g² where one is
pinned), lies on it along a length from 3 g² (27/8 g²) on, and what lies there buckles off again at 9/2 g² (45/8 g²),
as soon as it is as long as what leads there from a clamp.  Beyond, it snaps into waves, where its branch ends.
"""


def rolled(draft: Draft) -> None:
    """A strip that is rolled up by its narrow end until it presses on itself."""
    rng, size = draft.rng, draft.frame.size
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    draft.body("tip", "free", {"T": (1.0, 0.0)})
    start, end = draft.place("R"), draft.place("T")
    turn = between(rng, 0.3, 1.2) * sign(rng)
    curve: Data = arc_of_turn(start, end, turn) if happens(rng, 0.5) else _line(start, end)
    drawn = turn if curve["kind"] == "arc" else 0.0
    draft.beam_of("beam1", curve, {"joint": "weld", "point": "R"}, {"joint": "weld", "point": "T"})
    thin = rounded(size / between(rng, 220.0, 300.0), 3)
    wide = size * between(rng, 0.12, 0.2)
    shares = (between(rng, 0.9, 1.1), between(rng, 0.75, 0.85), between(rng, 0.8, 0.9), between(rng, 0.45, 0.6))
    widths = [rounded(wide * share, 3) for share in shares]
    thickness: Data | float = {"at": [0.0, 1.0], "values": [thin, rounded(1.05 * thin, 3)]}
    draft.data["beams"]["beam1"] |= {
        "thickness": thickness if happens(rng, 0.3) else thin,
        "width": {"at": [0.0, 0.3, 0.9, 1.0], "values": widths},
    }
    way = np.copysign(between(rng, 7.0, 7.6), drawn or sign(rng)) - drawn
    draft.data["drives"] = {"roll": {"kind": "rotation", "body": "tip"}}
    draft.data["contacts"] = {"contact1": {"kind": "beam-self", "beam": "beam1"}}
    draft.data["stages"] = [{"name": "stage1", "steps": "roll", "stations": [rounded(float(way))]}]


def assembled(draft: Draft) -> None:
    """A beam that is bowed while its end is brought to a pin, of the wall or of a crank that is turned then."""
    rng = draft.rng
    draft.slenderness = spread(rng, STOUTEST_HELD, 1.0 / THINNEST)
    side = sign(rng)
    T = (between(rng, 0.72, 0.9), side * between(rng, 0.2, 0.42))
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    draft.body("mark", "fixed", {"Z": (1.0, 0.0)})
    start, end = draft.place("R"), draft.place("Z")
    del draft.data["bodies"]["mark"]
    a = between(rng, -2.5, 2.5)
    cranked = happens(rng, 0.6)
    if cranked:
        pivot = (T[0] + 0.5 * cos(a), T[1] + 0.5 * sin(a))
        draft.body("crank", "turns", {"P": pivot, "T": T}, about="P")
    else:
        draft.body("post", "fixed", {"T": T})
    curve: Data = arc_of_turn(start, end, draft.frame.mirror * side * between(rng, 0.1, 0.5))
    draft.beam_of(
        "beam1", curve if happens(rng, 0.4) else _line(start, end), _weld("R"), {"joint": "pin", "point": "T"}
    )
    force, size = force_of(draft, "beam1"), draft.frame.size
    up = draft.frame.mirror * side
    draft.data["assembly"] = {"moments": {"beam1": rounded(up * between(rng, 0.4, 0.9) * force * size)}}
    if cranked:
        draft.data["drives"] = {"turn": {"kind": "rotation", "body": "crank"}}
        last = sign(rng) * between(rng, 0.1, 0.35)
        # a beam that is drawn straight locks; the crank goes where its ends come closer, as the frame mirrors it
        if _farthest(T, pivot, draft.frame.mirror * last) > TAUT:
            last = -last
        if _farthest(T, pivot, draft.frame.mirror * last) > TAUT:
            raise RedrawError
    else:
        x, y = draft.frame.direction((between(rng, -0.3, 0.3), side))
        at = round(between(rng, 0.3, 0.8), 2)
        draft.data["loads"] = {
            "turn": {"kind": "beam_force", "beam": "beam1", "at": at, "direction": [round(x, 3), round(y, 3)]}
        }
        last = spread(rng, 0.5, 6.0) * force * sign(rng)
    draft.data["stages"] = [{"name": "stage1", "steps": "turn", "stations": [rounded(0.5 * last), rounded(last)]}]


def _farthest(place: tuple[float, float], pivot: tuple[float, float], turn: float) -> float:
    """How far from the origin a place comes that turns about a pivot."""
    turns = np.exp(1j * np.linspace(0.0, turn, 20))
    return float(np.max(np.abs(complex(*pivot) + turns * (complex(*place) - complex(*pivot)))))


def lying(draft: Draft) -> None:
    """A beam pinned to a half-plane that it lies on from its pin on as it is pressed down."""
    rng, up = draft.rng, draft.frame.mirror
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    turn = between(rng, 0.5, 1.2)
    radius = 1.0 / turn
    draft.body("tip", "free", {"T": (radius * sin(turn), radius * (1.0 - cos(turn)))})
    curve: Data = arc_of_turn(draft.place("R"), draft.place("T"), up * turn)
    draft.beam_of("beam1", curve, {"joint": "pin", "point": "R"}, _weld("T"))
    lean = between(rng, -0.1, 0.1)
    n, down = draft.frame.direction((0.0, 1.0)), draft.frame.direction((lean, -1.0))
    contact: Data = {"kind": "beam-half-plane", "beam": "beam1", "body": "wall", "point": list(draft.place("R"))}
    # the arc begins along the plane: written with few digits its normal would have the beam behind it
    draft.data["contacts"] = {"contact1": contact | {"normal": list(n), "thick": False}}
    draft.data["drives"] = {"press": {"kind": "displacement", "point": "T", "direction": [round(c, 3) for c in down]}}
    # the beam, whose length is one, lies flat on the plane then, and its tip can follow the drive no farther
    flat = radius * (1.0 - cos(turn)) + max(lean, 0.0) * (1.0 - radius * sin(turn))
    depth = rounded(draft.frame.size * min(between(rng, 0.1, 0.4), FLAT * flat / float(np.hypot(1.0, lean))))
    draft.data["stages"] = [{"name": "stage1", "steps": "press", "stations": [rounded(0.4 * depth), depth]}]


def column(draft: Draft) -> None:
    """A column that is pressed far past its buckling load, with something that says to which side it goes."""
    rng, size = draft.rng, draft.frame.size
    # so near to its critical load what shear takes of that decides how far it bends
    draft.slenderness = spread(rng, STOUTEST_COLUMN, 1.0 / THINNEST)
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    ends, critical = weighted(
        rng,
        (
            ((("weld", "weld"), 4.0 * pi**2), 0.3),
            ((("weld", "pin"), 2.05 * pi**2), 0.4),
            ((("free",), pi**2 / 4.0), 0.4),
        ),
    )
    along = [round(c, 4) for c in draft.frame.direction((1.0, 0.0))]
    if ends == ("free",):
        draft.body("tip", "free", {"T": (1.0, 0.0)})
    else:
        draft.body("tip", "slides", {"T": (1.0, 0.0)}, along=along)
    start, end = draft.place("R"), draft.place("T")
    turn = spread(rng, 0.03, 0.2) * sign(rng)
    # a load on a column that folds as it bends further, and a straight one between ends that are held, lead nowhere
    driven = ends != ("free",) and (ends[-1] == "pin" or happens(rng, 0.5))
    bent = driven or happens(rng, 0.6)
    curve: Data = arc_of_turn(start, end, turn) if bent else _line(start, end)
    draft.beam_of("beam1", curve, _weld("R"), {"joint": ends[-1] if ends != ("free",) else "weld", "point": "T"})
    force = force_of(draft, "beam1")
    back = [-c for c in along]
    stages: list[Data] = []
    loads: Data = {}
    # aside first, its ends would be held by the drive
    if not bent or (not driven and happens(rng, 0.3)):
        side = draft.frame.direction((0.0, sign(rng)))
        loads["nudge"] = {"kind": "distributed", "beam": "beam1", "direction": [round(c, 3) for c in side]}
        stages.append({"name": "aside", "steps": "nudge", "stations": [rounded(spread(rng, 0.3, 1.5) * force / size)]})
    walled = happens(rng, 0.9)
    gap = between(rng, NEAREST_WALL if driven else 0.06, 0.3)
    if driven:
        draft.data["drives"] = {"press": {"kind": "displacement", "point": "T", "direction": back}}
        last = size * (gap**2 * between(rng, *PRESSED[ends]) if walled else between(rng, 0.05, 0.45))
    else:
        loads["press"] = {"kind": "force", "point": "T", "direction": back}
        last = force * critical * between(rng, 1.12, 1.6 if ends == ("free",) else 1.15)
    stages.append({"name": "press", "steps": "press", "stations": [rounded(share * last) for share in (0.6, 0.9, 1.0)]})
    draft.data |= {"loads": loads, "stages": stages}
    if walled:
        _walls(draft, gap, start, end)


def _walls(draft: Draft, gap: float, start: tuple[float, float], end: tuple[float, float]) -> None:
    """A half-plane on either side of a column, so far from it in its lengths."""
    contacts: Data = {}
    middle = 0.5 * (np.array(start) + np.array(end))
    for i, side in enumerate((1.0, -1.0)):
        x, y = draft.frame.direction((0.0, side))
        place = draft.frame.written((middle[0] + gap * draft.frame.size * x, middle[1] + gap * draft.frame.size * y))
        contacts[f"contact{i + 1}"] = {
            "kind": "beam-half-plane",
            "beam": "beam1",
            "body": "wall",
            "point": list(place),
            "normal": [-round(x, 4), -round(y, 4)],
        }
    draft.data["contacts"] = contacts


WHOLE = ((rolled, 0.065), (assembled, 0.06), (lying, 0.07), (column, 0.1))


def _weld(point: str) -> Data:
    return {"joint": "weld", "point": point}


def _line(start: tuple[float, float], end: tuple[float, float]) -> Data:
    return {"kind": "line", "start": list(start), "end": list(end)}
