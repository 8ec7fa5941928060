"""Random scenes from a counter: the scene of a seed and an index is the same whatever else is drawn.

A mechanism is laid out and acted on; a rough estimate of how it moves says how large its loads are and where something
is in its way.  What would be no question (a free motion, beams that overlap as drawn) is drawn anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator, Philox

from comparisons.stress.actions import drawn_action, drawn_turn, led, stations_to
from comparisons.stress.chance import RedrawError, happens, weighted
from comparisons.stress.draft import Draft, started
from comparisons.stress.estimate import Estimate, State
from comparisons.stress.mechanisms import MECHANISMS
from comparisons.stress.obstacles import is_clear, rigid, spot_on
from comparisons.stress.toml import toml_of
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
    weighted(rng, MECHANISMS)(draft)
    actions = [drawn_action(draft, f"act{i + 1}") for i in range(1 if happens(rng, 0.65) else 2)]
    for action in actions:
        draft.data.setdefault(action.group, {})[action.name] = action.data
    draft.data["stages"] = [
        {"name": f"stage{i + 1}", "steps": a.name, "stations": [1.0]} for i, a in enumerate(actions)
    ]
    draft.data["probes"] = [{"of": "scene", "quantity": "potential_energy"}]
    model = Estimate(scene_from(draft.data))
    states, state = [], State(np.zeros(model.unknowns), {})
    for action, stage in zip(actions, draft.data["stages"], strict=True):
        way = led(model, state, action, drawn_turn(rng))
        stage["stations"] = stations_to(rng, way[-1].values[action.name])
        states += way
        state = way[-1]
    _put_in_the_way(draft, model, states)
    _ask(draft)
    data = {"name": name} | {key: value for key, value in draft.data.items() if key != "name"}
    return {key: data[key] for key in sorted(data, key=_ORDER.index)}


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
                obstacle = rigid(draft.rng, spot)
            except RedrawError:
                continue
            if is_clear(model, obstacle, list(draft.data["beams"]), spot):
                body = "wall"
                kind = obstacle.data["kind"]
                contacts[f"contact{i + 1}"] = {"kind": kind, "beam": spot.beam, "body": body} | obstacle.data
                if happens(draft.rng, 0.2):
                    contacts[f"contact{i + 1}"]["thick"] = False
                break
    if contacts:
        draft.data["contacts"] = contacts


def _ask(draft: Draft) -> None:
    probes = [{"of": "scene", "quantity": "potential_energy"}]
    for body in draft.data["bodies"].values():
        if body["motion"] != "fixed":
            probes.append({"of": next(iter(body["points"])), "quantity": "displacement"})
    probes += [{"of": name, "quantity": "force"} for name in draft.data.get("contacts", {})]
    draft.data["probes"] = probes
