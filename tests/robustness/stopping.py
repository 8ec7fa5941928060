"""Stops at pins, reached on the way that the estimate foresees."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, tau

import numpy as np

from cprbm_scene import PinnedEnd
from cprbm_scene.curve_records import shape_of
from tests.robustness.chance import between, happens
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import Estimate, State

SHARE = 0.85  # of the pinned ends that turn
LEAST = 0.04  # rad


def put_stops(draft: Draft, model: Estimate, states: Sequence[State]) -> None:
    """Give pinned ends a stop that limits them before they are where they would go."""
    rng, scene = draft.rng, model.scene
    stops: Data = {}
    for name, beam in scene.beams.items():
        for side, end in (("start", beam.start), ("end", beam.end)):
            if not isinstance(end, PinnedEnd) or not happens(rng, SHARE):
                continue
            owner = scene.body_of(end.point)
            points = draft.data["bodies"][owner]["points"]
            bar = model.turns[name].start if side == "start" else model.turns[name].stop - 1
            body = model.bodies.get(owner)
            turned = [float(s.q[bar] - (0.0 if body is None else s.q[body + 2])) for s in states]
            if abs(turned[-1]) < LEAST:
                continue
            towards = f"{name}_{side}_mark"
            x, y = points[end.point]
            dx, dy = draft.frame.direction((between(rng, -0.3, 0.3), 0.5))
            points[towards] = list(draft.frame.written((x + dx * draft.frame.size, y + dy * draft.frame.size)))
            tx, ty = shape_of(beam.curve).tangent(np.array([0.0 if side == "start" else 1.0]))[0]
            out = atan2(ty, tx) if side == "start" else atan2(-ty, -tx)
            angle = out - atan2(points[towards][1] - y, points[towards][0] - x)
            angle -= tau * round(angle / tau)
            limit = round(angle + between(rng, 0.25, 0.8) * turned[-1], 3)
            stops[f"stop{len(stops) + 1}"] = {
                "beam": name,
                "end": side,
                "towards": towards,
                "most" if turned[-1] > 0.0 else "least": limit,
            }
    if stops:
        draft.data["stops"] = stops
