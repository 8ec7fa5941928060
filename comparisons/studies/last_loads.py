"""A scene's last loads alone, each gone to at once."""

from __future__ import annotations

from cprbm_scene import Scene


def at_last_loads(scene: Scene) -> Scene:
    """The scene with the last station of every stage and no other."""
    stages = tuple(stage.model_copy(update={"stations": stage.stations[-1:]}) for stage in scene.stages)
    return scene.model_copy(update={"stages": stages})
