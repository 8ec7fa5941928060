"""Random scenes from a counter: the scene of a seed and an index is the same whatever else is drawn.

A mechanism is laid out and acted on; a rough estimate of how it moves says how large its loads are and where something
is in its way.  What would be no question (a free motion, beams that overlap as drawn) is drawn anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator, Philox

from cprbm_scene import SceneError
from tests.robustness.actions import ENERGY, Action, drawn_action, drawn_turn, led, stations_to
from tests.robustness.chance import RedrawError, between, happens, rounded, weighted
from tests.robustness.contacts import put_in_the_way
from tests.robustness.dead_points import without_dead_point
from tests.robustness.draft import Draft, started
from tests.robustness.estimate import Estimate, State
from tests.robustness.mechanisms import MECHANISMS
from tests.robustness.pushers import push
from tests.robustness.stopping import put_stops
from tests.robustness.taut import slack
from tests.robustness.theories import made_thin, share_of
from tests.robustness.toml import toml_of
from tests.robustness.whole import WHOLE

Data = dict[str, Any]
_MOST_DRAWS = 400
_FURTHER = 3  # actions are tried at most where the first ones turn a mechanism too little
NEARLY = 0.7  # of what a mechanism is to turn


@dataclass(frozen=True, slots=True)
class Drawn:
    """A scene's ``name``, its ``data`` as read from a file, the ``text`` of that file, and the number of ``draws``."""

    name: str
    data: Data
    text: str
    draws: int


def drawn(seed: int, index: int) -> Drawn:
    """The scene of an ``index`` under a ``seed``, both from 0 to 2⁶⁴ − 1.

    Raises:
        RuntimeError: nothing that was drawn is a scene, which the distribution does not allow for.
    """
    rng = Generator(Philox(key=np.array([seed, index], dtype=np.uint64)))
    name = f"random-{seed}-{index}"
    for draws in range(1, _MOST_DRAWS + 1):
        try:
            data = _scene(rng, name)
            without_dead_point(data)
        except (RedrawError, SceneError):
            continue
        return Drawn(name, data, toml_of(data), draws)
    raise RuntimeError(f"{name}: nothing in {_MOST_DRAWS} draws is a scene")


def _scene(rng: Generator, name: str) -> Data:
    draft = started(rng)
    kind = weighted(rng, (("whole", 0.24), ("pushed", 0.12), ("acted on", 0.64)))
    if kind == "whole":
        weighted(rng, WHOLE)(draft)
    else:
        weighted(rng, MECHANISMS)(draft)
        if kind == "pushed":
            push(draft)
        else:
            _act(draft)
    _ask(draft)
    data = {**draft.data, "name": name}
    return {key: data[key] for key in sorted(data, key=_ORDER.index) if data[key]}


def _act(draft: Draft) -> None:
    rng, number = draft.rng, 1 if happens(draft.rng, 0.65) else 2
    turn = max(drawn_turn(rng) for _ in range(number))
    model, actions, states = _led(draft, number, turn)
    for _ in range(_FURTHER):
        if model.largest_turn(states[-1].q) > NEARLY * turn:
            break
        before = {**draft.data}
        try:
            model, actions, states = _led(draft, number, turn)
        except RedrawError:
            draft.data = before
    stages = draft.data["stages"]
    put_stops(draft, model, states)
    way, barriers = put_in_the_way(draft, model, states, [action.name for action in actions])
    rigid = [
        barrier
        for barrier, contact in zip(barriers, draft.data.get("contacts", {}).values(), strict=True)
        if contact["kind"] != "beam-beam"
    ]
    last = {name: value for name, value in slack(model, way, rigid).items() if value}
    for stage in stages:
        stage["stations"] = stations_to(rng, last.get(stage["steps"], 0.0))
    begun = [stage for stage in stages if stage["steps"] in last]
    if happens(rng, 0.12):
        acting = begun[-1]["steps"]
        begun.append({"name": "back", "steps": acting, "stations": [rounded(between(rng, 0.2, 0.7) * last[acting])]})
    draft.data["stages"] = begun
    made_thin(draft, share_of(model, way, barriers))


def _led(draft: Draft, number: int, turn: float) -> tuple[Estimate, list[Action], list[State]]:
    """So many actions in the place of all there are, and the states through which they lead, the last by ψ.

    Raises:
        RedrawError: one of them leads nowhere.
    """
    actions = [drawn_action(draft, f"act{i + 1}") for i in range(number)]
    draft.data |= {"loads": {}, "drives": {}}
    for action in actions:
        draft.data[action.group][action.name] = action.data
    stages = [{"name": f"stage{i + 1}", "steps": action.name, "stations": [1.0]} for i, action in enumerate(actions)]
    draft.data |= {"stages": stages, "probes": ENERGY}
    model = Estimate(without_dead_point(draft.data))
    states, state = list[State](), State(np.zeros(model.unknowns), {})
    for i, action in enumerate(actions):
        states += led(model, state, action, turn * (i + 1) / number)
        state = states[-1]
    return model, actions, states


_ORDER = (
    "name", "theory", "materials", "bodies", "pins", "beams", "assembly", "stops", "loads", "drives", "contacts",
    "stages", "probes",
)  # fmt: skip


def _ask(draft: Draft) -> None:
    probes = [{"of": "scene", "quantity": "potential_energy"}]
    for body in draft.data["bodies"].values():
        if body["motion"] != "fixed":
            probes.append({"of": next(iter(body["points"])), "quantity": "displacement"})
    probes += [{"of": name, "quantity": "force"} for name in draft.data.get("contacts", {})]
    draft.data["probes"] = probes
