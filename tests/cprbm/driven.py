"""Scenes with drives and slides, and what textbooks and the elastica say of them."""

from __future__ import annotations

from typing import Any

from cprbm_scene import Scene, scene_from
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


def guided(*, drive: bool, station: float) -> Scene:
    """A beam along x between a shoe that slides along x and one that slides along y, which is driven or loaded.

    Nothing is fixed: the two slides hold it.
    """
    data = cantilever_data({}, [])
    across = {"point": "T", "direction": [0.0, 2.0]}
    probes = [{"of": "T", "quantity": "displacement"}, {"of": "R", "quantity": "displacement"}]
    return scene_from(
        {
            **data,
            "bodies": {
                "root": {"motion": "slides", "along": [-3.0, 0.0], "points": {"R": [0.0, 0.0], "far": [-0.01, 0.02]}},
                "tip": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": [LENGTH, 0.0]}},
            },
            "loads": {} if drive else {"P": {"kind": "force", **across}},
            "drives": {"P": {"kind": "displacement", **across}} if drive else {},
            "stages": [{"name": "load", "steps": "P", "stations": [station]}],
            "probes": [
                *probes,
                {"of": "far", "quantity": "displacement"},
                {"of": "tip", "quantity": "rotation"},
                {"of": "beam", "quantity": "bending_stress", "points": 3},
                {"of": "scene", "quantity": "potential_energy"},
                *([{"of": "T", "quantity": "reaction"}] if drive else []),
            ],
        }
    )
