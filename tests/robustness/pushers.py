"""Something rigid on a slide or a lever that is driven against a beam, in the place of a load on the mechanism."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np

from cprbm_scene import FreeEnd
from tests.robustness.actions import ENERGY, Action, force_of, led
from tests.robustness.chance import RedrawError, any_of, between, happens, rounded, sign
from tests.robustness.dead_points import without_dead_point
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import BARS, Estimate, State
from tests.robustness.obstacles import Obstacle, Spot, is_clear, rigid
from tests.robustness.theories import made_thin, share_of

Motion = tuple[complex, complex]
"""A body's turn as a factor of places in the plane, and what is added to them."""

CLEAR = 0.02  # of the size, between the beam and what is driven against it
LARGEST_TURN = 1.4  # rad, of what is pushed
ROOM = 0.1  # of the size, round places where beams are held: between these and what presses them they are stiff
PARTS = 9  # of a way that are looked at
_TRIES = 8


def push(draft: Draft) -> None:
    """Add a driven body with an obstacle beside some beam, the contact and the stage.

    How far the beam may be bent a force tells that does it in the obstacle's place.

    Raises:
        RedrawError: there is no room for it, or the beam does not give way.
    """
    rng, size = draft.rng, draft.frame.size
    beam, place = any_of(rng, list(draft.data["beams"])), int(rng.integers(4, BARS))
    x, y = draft.frame.direction((0.0, sign(rng)))
    load: Data = {"kind": "beam_force", "beam": beam, "at": place / BARS, "direction": [x, y]}
    stages = [{"name": "push", "steps": "push", "stations": [1.0]}]
    model = Estimate(without_dead_point({**draft.data, "loads": {"push": load}, "stages": stages, "probes": ENERGY}))
    rest = State(np.zeros(model.unknowns), {})
    nodes = model.shape(rest.q, beam)
    tangent = (nodes[place + 1] - nodes[place - 1]) / np.hypot(*(nodes[place + 1] - nodes[place - 1]))
    n = np.array([-tangent[1], tangent[0]])  # from the beam to the obstacle
    if n @ np.array([x, y]) > 0.0:
        n = -n
    force = force_of(draft, beam)
    states = led(model, rest, Action("push", "loads", load, force), between(rng, 0.2, LARGEST_TURN))
    moved = [-float((model.shape(state.q, beam)[place] - nodes[place]) @ n) for state in states]
    depth = min(max(moved), 0.4 * size)
    if depth < 0.03 * size:
        raise RedrawError
    gap = 0.5 * model.scene.beams[beam].thickest + CLEAR * size
    spot = Spot(beam, nodes[place] + gap * n, n, size)
    for _ in range(_TRIES):
        obstacle = rigid(rng, spot)
        if not is_clear(model, obstacle, list(model.scene.beams), spot):
            continue
        before = deepcopy(draft.data)
        drive = _drive(draft, spot, obstacle, depth + CLEAR * size)
        if leaves_alone(model, obstacle, drive, ROOM * size):
            made_thin(draft, share_of(model, states, []))
            return
        draft.data = before
    raise RedrawError


def _drive(draft: Draft, spot: Spot, obstacle: Obstacle, depth: float) -> Callable[[float], Motion]:
    """Add the driven body; how it has moved at a part of its way."""
    rng, size = draft.rng, spot.size
    name = "slider" if happens(rng, 0.5) else "lever"
    direction = [round(float(-c), 3) for c in spot.n]
    if name == "slider":
        at = draft.frame.written((float(spot.s[0]), float(spot.s[1])))
        body: Data = {"motion": "slides", "along": direction, "points": {"D": list(at)}}
        drive: Data = {"kind": "displacement", "point": "D", "direction": direction}
        last = depth

        def motion(part: float) -> Motion:
            return 1.0 + 0.0j, -part * depth * complex(*spot.n)

    else:
        arm = between(rng, 0.6, 1.2) * size * sign(rng) * spot.along
        pivot = draft.frame.written((float(spot.s[0] - arm[0]), float(spot.s[1] - arm[1])))
        body = {"motion": "turns", "about": "D", "points": {"D": list(pivot)}}
        drive = {"kind": "rotation", "body": name}
        # a turn about the pivot moves the surface along the arm, turned to its left
        towards = float(np.array([-arm[1], arm[0]]) @ -spot.n)
        last = float(np.sign(towards)) * depth / float(np.hypot(*arm))
        about = complex(*(spot.s - arm))

        def motion(part: float) -> Motion:
            turn = complex(np.exp(1j * part * last))
            return turn, about - turn * about

    draft.data["bodies"][name] = body
    draft.data["drives"] = {"push": drive}
    contact = {"kind": obstacle.data["kind"], "beam": spot.beam, "body": name} | obstacle.data
    draft.data["contacts"] = {"contact1": contact}
    shares = any_of(rng, ((1.0,), (0.5, 1.0), (0.35, 0.7, 1.0)))
    stations = [rounded(share * last) for share in shares]
    draft.data["stages"] = [{"name": "stage1", "steps": "push", "stations": stations}]
    return motion


def leaves_alone(model: Estimate, obstacle: Obstacle, motion: Callable[[float], Motion], room: float) -> bool:
    """Whether on its way an obstacle comes nowhere near a place where a beam is held by what cannot move."""
    scene = model.scene
    held = [
        complex(*scene.place_of(end.point))
        for beam in scene.beams.values()
        for end in (beam.start, beam.end)
        if not isinstance(end, FreeEnd) and scene.bodies[scene.body_of(end.point)].motion == "fixed"
    ]
    for part in np.linspace(0.0, 1.0, PARTS):
        turn, shift = motion(float(part))
        seen = (np.array(held) - shift) / turn
        if np.any(obstacle.distance(np.stack((seen.real, seen.imag), axis=1)) < room):
            return False
    return True
