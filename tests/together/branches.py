"""Scenes whose branches end, as data in SI units, each beside the module of ``tests.references`` that knows where.

Forces are given over EI/L², moments over EI/L, with L the beam's length (of an arch its radius).
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH
from tests.references.arch import Arch
from tests.references.let_go import Held
from tests.references.snap import Snap
from tests.references.toggle import Toggle

FORCE, MOMENT = RIGIDITY / LENGTH**2, RIGIDITY / LENGTH

# one of each kind, with numbers that nothing else has
PINNED_ARCH, CLAMPED_ARCH = Arch(1.23, "pinned"), Arch(0.79, "clamped")
SNAP, STOPPED_AT = Snap(0.9), 0.66
RISE = 0.06  # m, of a double cosine beam over 2 × 1.5 m
HELD = Held(load=3.21, center=(0.62, 0.15), radius=0.13)
TOGGLE = Toggle(arc=0.6, base=1.3, arm=0.45)

_STRIP = {"thickness": THICKNESS, "width": WIDTH, "material": "m"}


def _weld(point: str) -> dict[str, str]:
    return {"joint": "weld", "point": point}


def _pin(point: str) -> dict[str, str]:
    return {"joint": "pin", "point": point}


def _line(start: list[float], end: list[float]) -> dict[str, Any]:
    return {"kind": "line", "start": start, "end": end}


def _stage(name: str, steps: str, stations: list[float], beyond: str) -> dict[str, Any]:
    return {"name": name, "steps": steps, "stations": stations, "beyond": beyond}


def _scene(name: str, **parts: Any) -> dict[str, Any]:
    return {
        "name": name,
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.31}},
        **parts,
    }


def arch(half_angle: float, left: str, right: str, stations: list[float], *, beyond: str = "stop") -> dict[str, Any]:
    """An arch about the origin, ``left`` and ``right`` its joints, with a dead force P down at its crown C."""
    x, y = LENGTH * sin(half_angle), LENGTH * cos(half_angle)
    ends = {"weld": _weld, "pin": _pin}

    def half(start: list[float], end: list[float]) -> dict[str, Any]:
        return {"kind": "arc", "center": [0.0, 0.0], "start": start, "end": end, "direction": "clockwise"}

    return _scene(
        "arch",
        bodies={
            "ground": {"motion": "fixed", "points": {"A": [-x, y], "B": [x, y]}},
            "crown": {"motion": "free", "points": {"C": [0.0, LENGTH]}},
        },
        beams={
            "left": {**_STRIP, "curve": half([-x, y], [0.0, LENGTH]), "start": ends[left]("A"), "end": _weld("C")},
            "right": {**_STRIP, "curve": half([0.0, LENGTH], [x, y]), "start": _weld("C"), "end": ends[right]("B")},
        },
        loads={"P": {"kind": "force", "point": "C", "direction": [0.0, -1.0]}},
        stages=[_stage("load", "P", [force * FORCE for force in stations], beyond)],
        probes=[
            {"of": "C", "quantity": "displacement"},
            {"of": "crown", "quantity": "rotation"},
            {"of": "A", "quantity": "reaction"},
            {"of": "A", "quantity": "reaction_moment"},
        ],
    )


def driven_arch(half_angle: float, left: str, right: str, ways: list[float], *, beyond: str = "stop") -> dict[str, Any]:
    """The same with its crown moved down by ``ways`` over R, free to move across and to turn."""
    data = arch(half_angle, left, right, [], beyond=beyond)
    del data["loads"]
    data["drives"] = {"w": {"kind": "displacement", "point": "C", "direction": [0.0, -1.0]}}
    data["stages"] = [_stage("lower", "w", [way * LENGTH for way in ways], beyond)]
    data["probes"].append({"of": "C", "quantity": "reaction"})
    return data


def cantilever_column(loads: list[float], *, beyond: str = "jump") -> dict[str, Any]:
    """Clamped at the origin, along x, with P against x at its tip T."""
    return _scene(
        "cantilever-column",
        bodies={
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
        },
        beams={"beam": {**_STRIP, "curve": _line([0.0, 0.0], [LENGTH, 0.0]), "start": _weld("R"), "end": _weld("T")}},
        loads={"P": {"kind": "force", "point": "T", "direction": [-1.0, 0.0]}},
        stages=[_stage("press", "P", [load * FORCE for load in loads], beyond)],
        probes=[{"of": "T", "quantity": "displacement"}, {"of": "tip", "quantity": "rotation"}],
    )


def pinned_column(loads: list[float], *, beyond: str = "jump") -> dict[str, Any]:
    """Pinned at the origin and at a slide along x, in two halves whose joint is M."""
    half = 0.5 * LENGTH
    return _scene(
        "pinned-column",
        bodies={
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "middle": {"motion": "free", "points": {"M": [half, 0.0]}},
            "slide": {"motion": "slides", "along": [1.0, 0.0], "points": {"E": [LENGTH, 0.0]}},
        },
        beams={
            "first": {**_STRIP, "curve": _line([0.0, 0.0], [half, 0.0]), "start": _pin("R"), "end": _weld("M")},
            "second": {**_STRIP, "curve": _line([half, 0.0], [LENGTH, 0.0]), "start": _weld("M"), "end": _pin("E")},
        },
        loads={"P": {"kind": "force", "point": "E", "direction": [-1.0, 0.0]}},
        stages=[_stage("press", "P", [load * FORCE for load in loads], beyond)],
        probes=[{"of": "M", "quantity": "displacement"}, {"of": "E", "quantity": "displacement"}],
    )


def column_between_pegs(
    loads: list[float], *, angle: float = 0.0, gap: float = 0.0, sides: tuple[str, ...] = ("left", "right"), beyond: str
) -> dict[str, Any]:
    """Pinned at the origin and at a slide at the ``angle``; pegs at the middle, a ``gap`` away over the length."""
    along, across = np.array([cos(angle), sin(angle)]), np.array([-sin(angle), cos(angle)])
    end, away = (LENGTH * along).tolist(), 0.05 * LENGTH

    def peg(side: str) -> dict[str, Any]:
        sense = 1.0 if side == "left" else -1.0
        center = 0.5 * LENGTH * along + sense * (away + 0.5 * THICKNESS + gap * LENGTH) * across
        return {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center.tolist(), "radius": away}

    return _scene(
        "column-between-pegs",
        bodies={
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "slide": {"motion": "slides", "along": along.tolist(), "points": {"E": end}},
        },
        beams={"beam": {**_STRIP, "curve": _line([0.0, 0.0], end), "start": _pin("R"), "end": _pin("E")}},
        loads={"P": {"kind": "force", "point": "E", "direction": (-along).tolist()}},
        contacts={side: peg(side) for side in sides},
        stages=[_stage("press", "P", [load * FORCE for load in loads], beyond)],
        probes=[{"of": side, "quantity": "force"} for side in sides],
    )


def strip_between_walls(shares: list[float]) -> dict[str, Any]:
    """A slightly bowed strip between clamps and two walls, 1/50 of the length away, whose ends come nearer.

    The ``shares`` of 1/375 of the length are the stations.  The ends' way bends the strip out to a wall.
    """
    s = np.linspace(0.0, 1.0, 25)
    points = np.column_stack([s, (1.0 - np.cos(2.0 * pi * s)) / 12000.0]) * LENGTH
    curve = {"kind": "spline", "points": points.tolist(), "start_direction": [1.0, 0.0], "end_direction": [1.0, 0.0]}
    beam = {"thickness": LENGTH / 600.0, "width": WIDTH, "material": "m"}
    walls = {
        name: {
            "kind": "beam-half-plane",
            "beam": "beam",
            "body": "wall",
            "point": [0.0, sense * LENGTH / 50.0],
            "normal": [0.0, -sense],
        }
        for name, sense in (("top", 1.0), ("bottom", -1.0))
    }
    return _scene(
        "strip-between-walls",
        bodies={
            "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
            "slide": {"motion": "slides", "along": [1.0, 0.0], "points": {"E": [LENGTH, 0.0]}},
        },
        beams={"beam": {**beam, "curve": curve, "start": _weld("R"), "end": _weld("E")}},
        drives={"v": {"kind": "displacement", "point": "E", "direction": [-1.0, 0.0]}},
        contacts=walls,
        stages=[_stage("press", "v", [share * LENGTH / 375.0 for share in shares], "jump")],
        probes=[{"of": "top", "quantity": "centre"}],
    ) | {"theory": "stretch"}


def snap(ways: list[list[float]], *, stopped_at: float | None = None, beyond: str = "jump") -> dict[str, Any]:
    """The beam of SNAP, hanging below, its clamp turned through one stage of angles (rad) after the other.

    The moment on its end, counter-clockwise, makes it hang: without, it could as well stand above.
    ``stopped_at`` is the least β that a stop allows.
    """
    d = SNAP.distance * LENGTH
    data = _scene(
        "snap",
        bodies={
            "hub": {"motion": "turns", "about": "O", "points": {"O": [0.0, 0.0]}},
            # W lies towards the clamp: from there β is counted, as the beam leaves its end with β + π
            "ground": {"motion": "fixed", "points": {"Q": [d, 0.0], "W": [0.3 * d, 0.0]}},
        },
        beams={"beam": {**_STRIP, "curve": _line([0.0, 0.0], [LENGTH, 0.0]), "start": _weld("O"), "end": _pin("Q")}},
        drives={"turn": {"kind": "rotation", "body": "hub"}},
        assembly={"moments": {"beam": MOMENT}},
        stages=[_stage(f"way{k}", "turn", way, beyond) for k, way in enumerate(ways)],
        probes=[
            {"of": "hub", "quantity": "rotation"},
            {"of": "hub", "quantity": "reaction_moment"},
            {"of": "Q", "quantity": "reaction"},
            {"of": "scene", "quantity": "potential_energy"},
        ],
    )
    if stopped_at is not None:
        data["stops"] = {"stop": {"beam": "beam", "end": "end", "towards": "W", "least": stopped_at}}
        data["probes"] += [{"of": "stop", "quantity": quantity} for quantity in ("angle", "moment")]
    return data


def held(releases: list[float], *, beyond: str = "jump") -> dict[str, Any]:
    """The column of HELD: leant on the circle by Q, pressed by P, and Q let down through ``releases``."""
    data = cantilever_column([])
    x, y = HELD.center
    data["name"] = "held-column"
    data["loads"]["Q"] = {"kind": "force", "point": "T", "direction": [0.0, 1.0]}
    data["contacts"] = {
        "touch": {
            "kind": "beam-circle",
            "beam": "beam",
            "body": "wall",
            "center": [x * LENGTH, y * LENGTH],
            "radius": HELD.radius * LENGTH - 0.5 * THICKNESS,
        }
    }
    data["stages"] = [
        _stage("lean", "Q", [0.5 * FORCE], "stop"),
        _stage("press", "P", [HELD.load * FORCE], "stop"),
        _stage("release", "Q", [force * FORCE for force in releases], beyond),
    ]
    data["probes"] += [{"of": "touch", "quantity": quantity} for quantity in ("force", "centre")]
    data["probes"] += [{"of": "R", "quantity": "reaction_moment"}, {"of": "scene", "quantity": "potential_energy"}]
    return data


def toggle(moments: list[float], *, beyond: str = "jump") -> dict[str, Any]:
    """The lever of TOGGLE, its pin A below the line from the pivot to the ground's pin; the moment lifts it."""
    psi = TOGGLE.under(0.0).lever
    b, arm, radius = TOGGLE.base * LENGTH, TOGGLE.arm * LENGTH, LENGTH / TOGGLE.arc
    A, G = (arm * cos(psi), -arm * sin(psi)), (b, 0.0)
    chord = (G[0] - A[0], G[1] - A[1])
    d = sqrt(chord[0] ** 2 + chord[1] ** 2)
    off = sqrt(radius**2 - 0.25 * d**2) / d  # of the center from the chord, on the right: the beam bows to the left
    center = [0.5 * (A[0] + G[0]) + off * chord[1], 0.5 * (A[1] + G[1]) - off * chord[0]]
    curve = {"kind": "arc", "center": center, "start": list(A), "end": list(G), "direction": "clockwise"}
    return _scene(
        "toggle",
        bodies={
            "lever": {"motion": "turns", "about": "O", "points": {"O": [0.0, 0.0], "A": list(A)}},
            "ground": {"motion": "fixed", "points": {"G": list(G)}},
        },
        beams={"beam": {**_STRIP, "curve": curve, "start": _pin("A"), "end": _pin("G")}},
        loads={"M": {"kind": "moment", "body": "lever"}},
        stages=[_stage("push", "M", [moment * MOMENT for moment in moments], beyond)],
        probes=[{"of": "lever", "quantity": "rotation"}, {"of": "G", "quantity": "reaction"}],
    )


def double_cosine() -> dict[str, Any]:
    """Two halves of a clamped cosine beam, their middle pushed down by half the rise, without a turn."""

    def half(start: float, end: float) -> dict[str, Any]:
        share = [i / 12 for i in range(13)]
        points = [[3.0 * x, 0.5 * RISE * (1.0 - cos(2.0 * pi * x))] for x in (start + s * (end - start) for s in share)]
        return {"kind": "spline", "points": points, "start_direction": [1.0, 0.0], "end_direction": [1.0, 0.0]}

    strip = {"thickness": 0.1 * RISE, "width": 0.5, "material": "m"}
    return _scene(
        "double-cosine",
        theory="shear",
        bodies={
            "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0], "B": [3.0, 0.0]}},
            "middle": {"motion": "slides", "along": [0.0, 1.0], "points": {"C": [1.5, RISE]}},
        },
        beams={
            "left": {**strip, "curve": half(0.0, 0.5), "start": _weld("A"), "end": _weld("C")},
            "right": {**strip, "curve": half(0.5, 1.0), "start": _weld("C"), "end": _weld("B")},
        },
        drives={"v": {"kind": "displacement", "point": "C", "direction": [0.0, -1.0]}},
        stages=[_stage("push", "v", [0.05 * RISE, 0.5 * RISE], "jump")],
        probes=[{"of": "C", "quantity": "reaction"}],
    )


def uneven_halves() -> dict[str, Any]:
    """A shallow toggle of two unequal strips: behind a bifurcation the branch soon comes to a fold."""
    left, top, right = [-0.044, 0.0], [0.0, 3.2e-3], [0.043, 0.0]
    strip = {"width": 6e-3, "material": "nylon"}
    bow = {"amplitude": -1e-4, "half_waves": 1}
    return _scene(
        "uneven-halves",
        theory="stretch",
        materials={"nylon": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.33}},
        bodies={
            "ground": {"motion": "fixed", "points": {"A": left, "D": right}},
            "slider": {"motion": "slides", "along": [0.0, 1.0], "points": {"P": top}},
        },
        beams={
            "one": {
                **strip,
                "curve": _line(left, top),
                "thickness": 4e-4,
                "start": _weld("A"),
                "end": _weld("P"),
                "imperfection": bow,
            },
            "other": {**strip, "curve": _line(top, right), "thickness": 4.4e-4, "start": _weld("P"), "end": _weld("D")},
        },
        loads={"F": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
        stages=[_stage("press", "F", [0.35], "jump")],
        probes=[{"of": "P", "quantity": "displacement"}],
    )
