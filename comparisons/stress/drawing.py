"""Random scenes from a counter: the scene of a seed and an index is the same whatever else is drawn.

A mechanism is laid out and acted on; a rough estimate of how it moves says how large its loads are and where something
is in its way.  What would be no question (a free motion, beams that overlap as drawn) is drawn anew.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator, Philox

from comparisons.stress.actions import drawn_action, drawn_turn, led, stations_to
from comparisons.stress.chance import RedrawError, happens, weighted
from comparisons.stress.draft import Draft, started
from comparisons.stress.estimate import Estimate, State
from comparisons.stress.mechanisms import MECHANISMS
from comparisons.stress.obstacles import Spot, companion, is_clear, rigid, spot_on
from comparisons.stress.pushers import put_pusher
from comparisons.stress.stopping import put_stops
from comparisons.stress.toml import toml_of
from comparisons.stress.whole import WHOLE
from scene import Scene
from scene.mistakes import SceneError
from scene.reading import scene_from

Data = dict[str, Any]
_MOST_DRAWS = 400


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
            scene_from(data)
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
            _push(draft)
        else:
            _act(draft)
    _ask(draft)
    data = {**draft.data, "name": name}
    return {key: data[key] for key in sorted(data, key=_ORDER.index) if data[key]}


def _push(draft: Draft) -> None:
    if not put_pusher(draft, Estimate(_at_rest(draft))):
        raise RedrawError


def _at_rest(draft: Draft) -> Scene:
    """The mechanism with a load that is nothing to it: a scene has at least one stage."""
    beam = next(iter(draft.data["beams"]))
    idle = {"loads": {"none": {"kind": "beam_moment", "beam": beam, "at": 0.5}}}
    stages = [{"name": "none", "steps": "none", "stations": [0.0]}]
    return scene_from({**draft.data, **idle, "stages": stages, "probes": _ENERGY})


def _act(draft: Draft) -> None:
    rng = draft.rng
    actions = [drawn_action(draft, f"act{i + 1}") for i in range(1 if happens(rng, 0.65) else 2)]
    for action in actions:
        draft.data.setdefault(action.group, {})[action.name] = action.data
    stages = [{"name": f"stage{i + 1}", "steps": action.name, "stations": [1.0]} for i, action in enumerate(actions)]
    draft.data |= {"stages": stages, "probes": _ENERGY}
    model = Estimate(scene_from(draft.data))
    states, state = [], State(np.zeros(model.unknowns), {})
    for action, stage in zip(actions, stages, strict=True):
        way = led(model, state, action, drawn_turn(rng))
        stage["stations"] = stations_to(rng, way[-1].values[action.name])
        states += way
        state = way[-1]
    put_stops(draft, model, states)
    _put_in_the_way(draft, model, states)


_ENERGY = [{"of": "scene", "quantity": "potential_energy"}]


_ORDER = (
    "name", "materials", "bodies", "pins", "beams", "assembly", "stops", "loads", "drives", "contacts",
    "stages", "probes",
)  # fmt: skip


def _put_in_the_way(draft: Draft, model: Estimate, states: list[State]) -> None:
    contacts: Data = {}
    for i in range(weighted(draft.rng, ((0, 0.08), (1, 0.5), (2, 0.27), (3, 0.1), (4, 0.05)))):
        for _ in range(12):
            try:
                spot = spot_on(draft, model, states)
                if happens(draft.rng, 0.25):
                    if _put_companion(draft, model, f"contact{i + 1}", spot, contacts):
                        break
                    continue
                obstacle = rigid(draft.rng, spot)
            except RedrawError:
                continue
            if is_clear(model, obstacle, list(model.scene.beams), spot):
                body = "wall"
                kind = obstacle.data["kind"]
                contacts[f"contact{i + 1}"] = {"kind": kind, "beam": spot.beam, "body": body} | obstacle.data
                if happens(draft.rng, 0.2):
                    contacts[f"contact{i + 1}"]["thick"] = False
                break
    if contacts:
        draft.data["contacts"] = contacts


def _put_companion(draft: Draft, model: Estimate, name: str, spot: Spot, contacts: Data) -> bool:
    """Add a further beam in the way of another, if there is room for it."""
    beam = f"beam{len(draft.data['beams']) + 1}"
    if beam == "beam5":
        return False
    before = deepcopy(draft.data)
    obstacle = companion(draft, beam, spot)
    if not is_clear(model, obstacle, list(model.scene.beams), spot):
        draft.data = before
        return False
    contacts[name] = obstacle.data
    if happens(draft.rng, 0.25):
        contacts[name]["thick"] = False
    return True


def _ask(draft: Draft) -> None:
    probes = [{"of": "scene", "quantity": "potential_energy"}]
    for body in draft.data["bodies"].values():
        if body["motion"] != "fixed":
            probes.append({"of": next(iter(body["points"])), "quantity": "displacement"})
    probes += [{"of": name, "quantity": "force"} for name in draft.data.get("contacts", {})]
    draft.data["probes"] = probes
