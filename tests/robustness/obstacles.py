"""Rigid things and further beams in a mechanism's way: where the estimate without them would have gone.

======  ================================================================================================
symbol  meaning
======  ================================================================================================
x, n    a place of a beam's neutral line on its way, m, and the normal on the side to which it moves
t       thickness there, m
s       surface of what is in the way: x + n t/2, with the normal −n towards the beam
======  ================================================================================================
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from tests.robustness.chance import RedrawError, any_of, between, happens, sign, spread, weighted
from tests.robustness.curves import curve_between
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import BARS, Estimate, State

Array = NDArray[np.float64]
Distance = Callable[[Array], Array]
SLACK = 0.08  # of the size: by how much a beam between two held ends is bowed at least
TURNED = 1.15  # rad: a mechanism that has turned by so much meets what is late in its way
ON = 0.01  # of the size: how far a beam would go on at least from where something is in its way
_TRIES = 12
_KINDS = (("circle", 0.3), ("half-plane", 0.16), ("line", 0.28), ("roof", 0.14), ("block", 0.12), ("function", 0.18))


@dataclass(frozen=True, slots=True)
class Spot:
    """A place on the way of ``beam``: ``s`` (2,) and ``n`` (2,), m, as the ``body`` sees it that the obstacle is on."""

    beam: str
    s: Array
    n: Array
    size: float

    @property
    def along(self) -> Array:
        """The unit vector (2,) along the surface, the beam on its left."""
        return np.array([-self.n[1], self.n[0]])


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A contact as ``data`` without beam and body, and its ``distance`` from places (k, 2)."""

    data: Data
    distance: Distance


def spot_on(draft: Draft, model: Estimate, states: Sequence[State], *, late: bool) -> Spot:
    """Where some beam is on its way, and how it moves there; ``late`` once the mechanism has turned far, if it does.

    Raises:
        RedrawError: nothing moves across itself.
    """
    rng, size = draft.rng, draft.frame.size
    far = next((i for i, state in enumerate(states) if model.largest_turn(state.q) > TURNED), len(states))
    shares = (far / len(states), 1.0) if late and far < len(states) - 1 else (0.12, 0.65)
    for _ in range(_TRIES):
        beam = any_of(rng, list(model.scene.beams))
        share = between(rng, *shares)
        state = states[min(int(share * len(states)), len(states) - 1)]
        place = int(rng.integers(2, BARS)) if happens(rng, 0.9) else int(any_of(rng, (1, BARS)))
        now, at_rest = model.shape(state.q, beam), model.shape(np.zeros(model.unknowns), beam)
        after = model.shape(states[-1].q, beam)
        low, high = max(place - 1, 0), min(place + 1, BARS)
        tangent = (now[high] - now[low]) / np.hypot(*(now[high] - now[low]))
        n = np.array([-tangent[1], tangent[0]])
        moved = float((after - at_rest)[place] @ n)
        come, on = float((now - at_rest)[place] @ n), float((after - now)[place] @ n)
        thickness = float(model.scene.beams[beam].thickness_at(np.array([place / BARS]))[0])
        if abs(moved) < 0.01 * size or come * moved <= 0.0 or abs(come) < 2e-3 * size:
            continue
        if on * np.sign(moved) < ON * size:
            continue
        n = n * np.sign(moved)
        return Spot(beam, now[place] + 0.5 * thickness * n, n, size)
    raise RedrawError


def rigid(rng: Generator, spot: Spot) -> Obstacle:
    """Something rigid whose surface is at a spot."""
    kind = weighted(rng, _KINDS)
    return _RIGID[kind](rng, spot)


def _circle(rng: Generator, spot: Spot) -> Obstacle:
    radius = float(f"{spread(rng, 0.02, 0.6) * spot.size:.3g}")
    center = spot.s + radius * spot.n
    data = {"kind": "beam-circle", "center": _written(center, spot), "radius": radius}
    return Obstacle(data, lambda p: np.hypot(*(p - center).T) - radius)


def _half_plane(rng: Generator, spot: Spot) -> Obstacle:
    n = -_turned(spot.n, between(rng, -0.25, 0.25))
    data = {"kind": "beam-half-plane", "point": _written(spot.s, spot), "normal": [round(float(c), 4) for c in n]}
    return Obstacle(data, lambda p: (p - spot.s) @ n)


def _line(rng: Generator, spot: Spot) -> Obstacle:
    tau = _turned(spot.along, between(rng, -0.25, 0.25))
    a, b = between(rng, 0.12, 0.6) * spot.size, between(rng, 0.12, 0.6) * spot.size
    return _polyline(rng, [spot.s - a * tau, spot.s + b * tau], spot)


def _roof(rng: Generator, spot: Spot) -> Obstacle:
    return _polyline(rng, _gable(rng, spot), spot)


def _block(rng: Generator, spot: Spot) -> Obstacle:
    first, apex, last = _gable(rng, spot)
    return _polyline(rng, [apex, last, first, apex], spot)


def _gable(rng: Generator, spot: Spot) -> list[Array]:
    """Two pieces that lead back from the surface, to either side."""
    sides = []
    for side in (-1.0, 1.0):
        fall = between(rng, 0.25, 1.1)
        sides.append(spot.s + spot.size * between(rng, 0.1, 0.35) * _turned(side * spot.along, -side * fall))
    if (sides[0] - spot.s) @ spot.n < 0.0 or (sides[1] - spot.s) @ spot.n < 0.0:
        raise RedrawError
    return [sides[0], spot.s, sides[1]]


def _polyline(rng: Generator, points: list[Array], spot: Spot) -> Obstacle:
    corners, side = np.array(points), "left"
    if happens(rng, 0.5):
        points, side = points[::-1], "right"
    data = {"kind": "beam-line", "points": [_written(point, spot) for point in points], "side": side}
    return Obstacle(data, lambda p: _from_pieces(corners, p))


def _function(rng: Generator, spot: Spot) -> Obstacle:
    axis = 1 if abs(spot.n[0]) > abs(spot.n[1]) else 0
    v0, w0 = spot.s[axis], spot.s[1 - axis]
    slope = -spot.n[axis] / spot.n[1 - axis]
    above = spot.n[1 - axis] < 0.0  # the beam's side
    bend = between(rng, 0.0, 2.0) / spot.size * (-1.0 if above else 1.0)
    reach = between(rng, 0.1, 0.35) * spot.size, between(rng, 0.1, 0.35) * spot.size
    low, high = float(f"{v0 - reach[0]:.4g}"), float(f"{v0 + reach[1]:.4g}")
    coefficients = [w0 - slope * v0 + bend * v0**2, slope - 2.0 * bend * v0, bend]
    written = [float(f"{c:.9g}") for c in coefficients]
    data = {
        "kind": "beam-function",
        "axis": "xy"[axis],
        "coefficients": written,
        "range": [low, high],
        "side": "above" if above else "below",
    }
    v = np.linspace(low, high, 9)
    w = np.polynomial.polynomial.polyval(v, coefficients)
    points = np.column_stack((v, w) if axis == 0 else (w, v))
    if above == (axis == 1):  # the beam on the left
        points = points[::-1]
    return Obstacle(data, lambda p: _from_pieces(points, p))


def companion(draft: Draft, name: str, spot: Spot) -> Obstacle:
    """A further beam whose edge is at a spot, from the wall to nothing or to the wall again; it joins the draft."""
    rng, size = draft.rng, spot.size
    tau = _turned(spot.along, between(rng, -0.35, 0.35)) * sign(rng)
    a, b = between(rng, 0.3, 0.8) * size, between(rng, 0.15, 0.6) * size
    section = draft.section()
    thickness = section["thickness"]["values"][0] if isinstance(section["thickness"], dict) else section["thickness"]
    middle = spot.s + 0.5 * thickness * spot.n
    high = between(rng, 0.0, 0.2)
    bow = high * size * spot.n
    root, end = draft.frame.written(_pair(middle - a * tau + bow)), draft.frame.written(_pair(middle + b * tau + bow))
    if happens(rng, 0.35):
        between_them = draft.frame.written(_pair(middle))
        curve: Data = {"kind": "spline", "points": [list(root), list(between_them), list(end)]}
        points = np.array([root, between_them, end])
    else:
        curve = curve_between(rng, draft.frame, root, end, bowed=0.0 if happens(rng, 0.5) else 0.15)
        points = np.array([root, end])
    wall = draft.data["bodies"]["wall"]["points"]
    wall[f"{name}_root"] = list(root)
    joints = weighted(rng, ((("weld", "free"), 0.5), (("weld", "weld"), 0.25), (("weld", "pin"), 0.25)))
    if len(points) < 3 or high < SLACK:  # straight between two held ends it would not give way by bending
        joints = ("weld", "free")
    ends: list[Data] = [{"joint": "weld", "point": f"{name}_root"}, {"joint": "free"}]
    if joints[1] != "free":
        wall[f"{name}_end"] = list(end)
        ends[1] = {"joint": joints[1], "point": f"{name}_end"}
    draft.data["beams"][name] = {
        "curve": curve,
        **section,
        "material": draft.material,
        "start": ends[0],
        "end": ends[1],
    }
    data = {"kind": "beam-beam", "between": [spot.beam, name]}
    return Obstacle(data, lambda p: np.abs(_from_pieces(points, p)) - 0.5 * 1.3 * thickness)


def _pair(place: Array) -> tuple[float, float]:
    return float(place[0]), float(place[1])


_RIGID = {
    "circle": _circle,
    "half-plane": _half_plane,
    "line": _line,
    "roof": _roof,
    "block": _block,
    "function": _function,
}


def is_clear(model: Estimate, obstacle: Obstacle, beams: Sequence[str], spot: Spot) -> bool:
    """Whether beams as drawn are on the free side of an obstacle and away from it."""
    rest = np.zeros(model.unknowns)
    for beam in beams:
        nodes = model.shape(rest, beam)
        if obstacle.distance(nodes).min() < 0.5 * model.scene.beams[beam].thickest + 1e-3 * spot.size:
            return False
    return True


def _from_pieces(points: Array, p: Array) -> Array:
    """Distances of places (k, 2) from a line of straight pieces, negative where they are behind it, on its right."""
    a, ab = points[:-1], points[1:] - points[:-1]
    r = p[:, None, :] - a
    t = np.clip((r * ab).sum(axis=2) / (ab * ab).sum(axis=1), 0.0, 1.0)
    away = r - t[:, :, None] * ab
    nearest = np.hypot(away[:, :, 0], away[:, :, 1]).argmin(axis=1)
    every = np.arange(len(p))
    away, t = away[every, nearest], t[every, nearest]
    n = np.array((-ab[:, 1], ab[:, 0])).T / np.hypot(ab[:, 0], ab[:, 1])[:, None]
    closed = len(points) > 2 and bool(np.all(points[0] == points[-1]))
    other = np.where(t <= 0.0, nearest - 1, np.where(t >= 1.0, nearest + 1, nearest))
    beyond = np.zeros(len(p), bool) if closed else (other < 0) | (other >= len(ab))
    side = (away * (n[nearest] + n[other % len(ab)])).sum(axis=1)
    return np.asarray(np.where(beyond | (side >= 0.0), 1.0, -1.0) * np.hypot(away[:, 0], away[:, 1]))


def _turned(v: Array, angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1]])


def _written(place: Array, spot: Spot) -> list[float]:
    digits = 5 - int(np.floor(np.log10(spot.size)))
    return [round(float(c), digits) for c in place]
