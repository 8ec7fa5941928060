"""Loads and drives: which there may be, and how far they lead the mechanism, by its estimate.

======  ================================================================================
symbol  meaning
======  ================================================================================
EI, L   a beam's bending stiffness, and the scene's size, m: the units of loads
ψ       the largest turn of a bar or a body, rad, that a load or drive is to lead to
======  ================================================================================
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, inf, sin, tau

import numpy as np
from numpy.random import Generator

from tests.robustness.chance import RedrawError, any_of, between, happens, rounded, sign, spread, weighted
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import Estimate, State, followed

GROWTH = 1.3  # of a load from one state to the next
MOST_STATES = 34
ENERGY = [{"of": "scene", "quantity": "potential_energy"}]
LEAST_SOFTNESS = 0.02
STEP, FARTHEST = 0.03, 0.7  # of a driven displacement, in sizes


@dataclass(frozen=True, slots=True)
class Action:
    """What acts, as ``data``, in ``group`` (loads or drives); ``unit`` is one of its values of order one, signed."""

    name: str
    group: str
    data: Data
    unit: float


def drawn_action(draft: Draft, name: str) -> Action:
    """A load or drive of something that can move."""
    rng, data = draft.rng, draft.data
    moving = {body: each for body, each in data["bodies"].items() if each["motion"] != "fixed"}
    turning = [body for body, each in moving.items() if each["motion"] in ("free", "turns") or each.get("turns")]
    beam = any_of(rng, list(data["beams"]))
    force, size = force_of(draft, beam), draft.frame.size
    kinds = [("beam_force", 0.7), ("beam_moment", 0.6), ("distributed", 0.8)]
    if moving:
        kinds += [("force", 1.6), ("displacement", 1.3)]
    if turning:
        kinds += [("moment", 1.1), ("rotation", 1.1)]
    kind = weighted(rng, kinds)
    if kind in ("moment", "rotation"):
        said: Data = {"kind": kind, "body": any_of(rng, turning)}
        unit = force * size if kind == "moment" else 1.0
        return Action(name, "loads" if kind == "moment" else "drives", said, sign(rng) * unit)
    if kind in ("force", "displacement"):
        body = any_of(rng, list(moving))
        said = {"kind": kind, "point": any_of(rng, list(moving[body]["points"])), "direction": _direction(rng)}
        if moving[body]["motion"] == "slides" and happens(rng, 0.7):
            said["direction"] = list(moving[body]["along"])
        return Action(name, "loads" if kind == "force" else "drives", said, force if kind == "force" else size)
    if kind == "beam_moment":
        return Action(name, "loads", {"kind": kind, "beam": beam, "at": _at(rng)}, sign(rng) * force * size)
    if kind == "beam_force":
        return Action(name, "loads", {"kind": kind, "beam": beam, "at": _at(rng), "direction": _direction(rng)}, force)
    along = [0.0, 1.0] if happens(rng, 0.5) else [round(between(rng, 0.0, 0.4), 2), round(between(rng, 0.6, 1.0), 2)]
    said = {"kind": kind, "beam": beam, "direction": _direction(rng), "along": along}
    return Action(name, "loads", said, force / size)


def _at(rng: Generator) -> float:
    return round(between(rng, 0.35, 0.98), 2)


def _direction(rng: Generator) -> list[float]:
    a = between(rng, 0.0, tau)
    return [round(cos(a), 3), round(sin(a), 3)]


def force_of(draft: Draft, beam: str) -> float:
    """EI/L² of a beam, N, with its mean sizes."""
    sizes = draft.data["beams"][beam]
    t, w = (
        np.mean(each["values"]) if isinstance(each, dict) else each for each in (sizes["thickness"], sizes["width"])
    )
    modulus = draft.data["materials"][draft.material]["youngs_modulus"]
    return float(modulus * w * t**3 / 12.0 / draft.frame.size**2)


def drawn_turn(rng: Generator) -> float:
    """ψ, from nearly nothing to more than a right angle."""
    kind = weighted(rng, (("tiny", 0.07), ("moderate", 0.2), ("large", 0.73)))
    if kind == "tiny":
        return spread(rng, 0.003, 0.1)
    return between(rng, 0.15, 1.0) if kind == "moderate" else between(rng, 1.25, 2.0)


def led(model: Estimate, state: State, action: Action, turn: float) -> list[State]:
    """The states that an action leads through from a ``state`` on, until something has turned by ψ.

    Raises:
        RedrawError: it leads nowhere, to where the mechanism snaps, or presses a perfect column.
    """
    if model.softness(state.q, action.name) < LEAST_SOFTNESS:
        raise RedrawError
    first = state.values.get(action.name, 0.0)
    growing = _of_drive(action, model.size) if action.group == "drives" else _of_load(action)
    states: list[State] = []
    for each in followed(model, state, action.name, (first + value for value in growing)):
        states.append(each)
        if model.largest_turn(each.q) >= turn:
            return states
    # a fold or a jump is near where no further state is found: loads keep away from it
    states = states[: int(0.8 * len(states))]
    if len(states) < 4 or model.largest_turn(states[-1].q) < min(0.12, turn):
        raise RedrawError
    return states


def _of_load(action: Action) -> Iterator[float]:
    value = 0.02 * action.unit
    for _ in range(MOST_STATES):
        yield value
        value *= GROWTH


def _of_drive(action: Action, size: float) -> Iterator[float]:
    unit = size if action.data["kind"] == "displacement" else 1.0
    most = FARTHEST if unit == size else inf
    for i in range(1, 60):
        if i * STEP > most:
            return
        yield float(np.copysign(i * STEP * unit, action.unit))


def stations_to(rng: Generator, last: float, first: float = 0.0) -> list[float]:
    """One to four values on the way to the last one."""
    n = int(rng.integers(1, 5))
    shares = [(i + 1) / n for i in range(n)]
    return [rounded(first + (last - first) * share) for share in shares]
