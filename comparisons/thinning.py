"""A scene at fewer stations, for what needs many solves of it."""

from __future__ import annotations

from cprbm_scene import Scene, Stage


def at_shown(scene: Scene) -> Scene:
    """The scene whose stages have those stations only that they show, and their last; other stages have all.

    What happens between stations is looked for all the same where a stage asks for the ends of branches.
    """
    stages = tuple(
        stage.model_copy(update={"stations": kept(stage)}) if stage.shown else stage for stage in scene.stages
    )
    return scene.model_copy(update={"stages": stages})


def kept(stage: Stage) -> tuple[float, ...]:
    """The stations of a stage that it shows, in their order, or else the middle one; and the last."""
    middle = len(stage.stations) // 2
    few = {*(stage.shown or stage.stations[middle : middle + 1]), stage.stations[-1]}
    return tuple(value for value in stage.stations if value in few)
