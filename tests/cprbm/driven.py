"""Scenes with drives and slides, and what textbooks and the elastica say of them."""

from __future__ import annotations

from typing import Any

from scene import Scene
from scene.reading import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, cantilever_data, hinge_data

UNIT_FORCE = RIGIDITY / LENGTH**2
UNIT_MOMENT = RIGIDITY / LENGTH


def driven_cantilever(drives: dict[str, Any], stages: list[dict[str, Any]], **changes: Any) -> Scene:
    """The cantilever of :mod:`tests.cprbm.scenes` with drives in the place of its load, their reactions asked."""
    data = {**cantilever_data({}, []), "loads": {}, "drives": drives, "stages": stages, **changes}
    reactions = [
        {"of": drive["point"], "quantity": "reaction"}
        if drive["kind"] == "displacement"
        else {"of": drive["body"], "quantity": "reaction_moment"}
        for drive in drives.values()
    ]
    return scene_from({**data, "probes": [*data["probes"], *reactions]})


def push(x: float, y: float) -> dict[str, Any]:
    """A drive of the cantilever's tip."""
    return {"kind": "displacement", "point": "T", "direction": [x, y]}


TURN = {"kind": "rotation", "body": "tip"}


def driven_hinge(angle: float) -> Scene:
    """The hinge, turned by a drive in the place of its moment."""
    data = hinge_data()
    drive = {"kind": "rotation", "body": "BD"}
    probes = [*data["probes"], {"of": "BD", "quantity": "reaction_moment"}]
    stages = [{"name": "turn", "steps": "turn", "stations": [angle]}]
    return scene_from(
        {**data, "loads": {}, "drives": {"turn": drive}, "stages": stages, "probes": probes, "claims": []}
    )
