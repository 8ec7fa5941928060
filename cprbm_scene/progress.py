"""Progress of a solver as records of ``logging`` at the level INFO, with the numbers of stations for a progress bar."""

from __future__ import annotations

import logging

from cprbm_scene.answer import StationAnswer
from cprbm_scene.statement import Scene


def station_reached(logger: logging.Logger, scene: Scene, reached: int, station: StationAnswer) -> None:
    """Log that a solver has come to the ``station`` with the number ``reached`` of the scene."""
    steps, whole = {stage.name: stage.steps for stage in scene.stages}, sum(len(each.stations) for each in scene.stages)
    spent = station.certificate.iterations
    logger.info(
        "%s: %s, stage %s: station %d of %d, %s = %.6g, %d iteration%s",
        scene.name,
        logger.name.rpartition(".")[0],
        station.stage,
        reached,
        whole,
        steps[station.stage],
        station.value,
        spent,
        "" if spent == 1 else "s",
        extra={"done": reached, "whole": whole},
    )
