"""Something rigid on a slide or a lever that is driven against a beam, in the place of a load on the mechanism."""

from __future__ import annotations

import numpy as np

from comparisons.stress.chance import any_of, between, happens, rounded, sign
from comparisons.stress.draft import Data, Draft
from comparisons.stress.estimate import BARS, Estimate
from comparisons.stress.obstacles import Obstacle, Spot, is_clear, rigid

CLEAR = 0.02  # of the size, between the beam and what is driven against it
_TRIES = 20


def put_pusher(draft: Draft, model: Estimate) -> bool:
    """Add a driven body with an obstacle beside some beam, the contact, and the stage; whether a place was found."""
    rng, size = draft.rng, draft.frame.size
    rest = np.zeros(model.unknowns)
    for _ in range(_TRIES):
        beam = any_of(rng, list(draft.data["beams"]))
        place = int(rng.integers(4, BARS))
        nodes = model.shape(rest, beam)
        tangent = (nodes[place + 1] - nodes[place - 1]) / np.hypot(*(nodes[place + 1] - nodes[place - 1]))
        n = sign(rng) * np.array([-tangent[1], tangent[0]])  # from the beam to the obstacle
        gap = 0.5 * model.scene.beams[beam].thickest + CLEAR * size
        spot = Spot(beam, nodes[place] + gap * n, n, size)
        obstacle = rigid(rng, spot)
        if not is_clear(model, obstacle, list(draft.data["beams"]), spot):
            continue
        _drive(draft, spot, obstacle)
        return True
    return False


def _drive(draft: Draft, spot: Spot, obstacle: Obstacle) -> None:
    rng, size = draft.rng, spot.size
    name = "slider" if happens(rng, 0.5) else "lever"
    depth = size * between(rng, 0.06, 0.32) + CLEAR * size
    direction = [round(float(-c), 3) for c in spot.n]
    if name == "slider":
        at = draft.frame.written((float(spot.s[0]), float(spot.s[1])))
        body: Data = {"motion": "slides", "along": direction, "points": {"D": list(at)}}
        drive: Data = {"kind": "displacement", "point": "D", "direction": direction}
        last = depth
    else:
        arm = between(rng, 0.6, 1.2) * size * sign(rng) * spot.along
        pivot = draft.frame.written((float(spot.s[0] - arm[0]), float(spot.s[1] - arm[1])))
        body = {"motion": "turns", "about": "D", "points": {"D": list(pivot)}}
        drive = {"kind": "rotation", "body": name}
        # a turn about the pivot moves the surface along the arm, turned to its left
        towards = float(np.array([-arm[1], arm[0]]) @ -spot.n)
        last = float(np.sign(towards)) * depth / float(np.hypot(*arm))
    draft.data["bodies"][name] = body
    draft.data.setdefault("drives", {})["push"] = drive
    contact = {"kind": obstacle.data["kind"], "beam": spot.beam, "body": name} | obstacle.data
    draft.data["contacts"] = {"contact1": contact}
    shares = any_of(rng, ((1.0,), (0.5, 1.0), (0.35, 0.7, 1.0)))
    stations = [rounded(share * last) for share in shares]
    draft.data["stages"] = [{"name": "stage1", "steps": "push", "stations": stations}]
