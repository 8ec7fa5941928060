"""Neutral lines of every kind from one place to another.

======  ===============================================================
symbol  meaning
======  ===============================================================
P, Q    the two places, m; c their distance, τ from P to Q, n to its left
φ       turn of an arc, rad
v, w    variable of a polynomial's graph, and its value
======  ===============================================================
"""

from __future__ import annotations

from math import pi, sin, tan

import numpy as np
from numpy.polynomial import Polynomial as Graph
from numpy.random import Generator

from tests.robustness.chance import between, happens, sign, weighted
from tests.robustness.frame import Frame, Place

Data = dict[str, object]

KINDS = (("line", 0.3), ("arc", 0.24), ("polynomial", 0.26), ("spline", 0.2))
LARGEST_TURN = 1.15 * pi


def curve_between(rng: Generator, frame: Frame, start: Place, end: Place, *, bowed: float = 1.0) -> Data:
    """A neutral line between two places, m; ``bowed`` says how far from straight it may be, 0 that it is a line."""
    kind = weighted(rng, KINDS) if bowed > 0.0 else "line"
    match kind:
        case "line":
            return {"kind": "line", "start": list(start), "end": list(end)}
        case "arc":
            return arc_of_turn(start, end, sign(rng) * between(rng, 0.15, LARGEST_TURN * bowed))
        case "polynomial":
            return _graph(rng, start, end, bowed)
    return _spline(rng, frame, start, end, bowed)


def arc_of_turn(start: Place, end: Place, turn: float) -> Data:
    """The arc that turns by φ, counter-clockwise if that is positive."""
    P, Q = np.array(start), np.array(end)
    half = 0.5 * (Q - P)
    center = P + half + np.array([-half[1], half[0]]) / tan(0.5 * turn)
    direction = "counterclockwise" if turn > 0.0 else "clockwise"
    # centers are written in full: both ends have to lie on the circle
    return {"kind": "arc", "center": center.tolist(), "start": [*start], "end": [*end], "direction": direction}


def _graph(rng: Generator, start: Place, end: Place, bowed: float) -> Data:
    """w = chord + (v − v₀)(v₁ − v)/(v₁ − v₀) times a constant, or a line in v."""
    along = 0 if abs(end[0] - start[0]) >= abs(end[1] - start[1]) else 1
    v0, v1, w0, w1 = start[along], end[along], start[1 - along], end[1 - along]
    t = Graph([-v0 / (v1 - v0), 1.0 / (v1 - v0)])
    bulge = between(rng, -1.6, 1.6) * bowed
    shape = Graph([bulge]) + (between(rng, -1.8, 1.8) * bowed * (t - 0.5) if happens(rng, 0.6) else 0.0)
    w = w0 + (w1 - w0) * t + (v1 - v0) * t * (1.0 - t) * shape
    return {"kind": "polynomial", "axis": "xy"[along], "coefficients": w.coef.tolist(), "range": [v0, v1]}


def _spline(rng: Generator, frame: Frame, start: Place, end: Place, bowed: float) -> Data:
    """Through one to three places beside the chord, on one side of it or on both."""
    P, Q = np.array(start), np.array(end)
    n = np.array([P[1] - Q[1], Q[0] - P[0]])
    inner = int(rng.integers(1, 4))
    high, twisted = between(rng, -0.3, 0.3) * bowed, between(rng, -0.14, 0.14) * bowed
    points = [start]
    for i in range(1, inner + 1):
        t = i / (inner + 1) + between(rng, -0.08, 0.08) / inner
        place = P + t * (Q - P) + (high * sin(pi * t) + twisted * sin(2.0 * pi * t)) * n
        points.append(frame.written((place[0], place[1])))
    curve: Data = {"kind": "spline", "points": [list(point) for point in (*points, end)]}
    for key, slope in (
        ("start_direction", pi * (high + 2.0 * twisted)),
        ("end_direction", pi * (2.0 * twisted - high)),
    ):
        if happens(rng, 0.35):
            d = (Q - P) / np.hypot(*(Q - P)) + slope * n / np.hypot(*n)
            curve[key] = [round(float(d[0]), 3), round(float(d[1]), 3)]
    return curve
