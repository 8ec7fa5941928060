"""What of a scene can be compared where answers end before the last station."""

from __future__ import annotations

from dataclasses import replace

from comparisons.pairing import Runs
from cprbm_scene import Answer, Ending, Scene
from cprbm_scene.frozendict import frozendict


def within_reach(scene: Scene, runs: Runs) -> tuple[Scene, Runs] | None:
    """The scene and all answers up to the last station that every run reached; None where no run's branch ends, or
    one has ended before the last station for another reason.

    The answers say that they are complete, which they are for such a scene; what was found beyond is left out.
    None as well where not a single station was reached.
    """
    every = [answer for _, answer in runs.everything()]
    asked = sum(len(stage.stations) for stage in scene.stages)
    if not any(map(ends_at_critical, every)) or any(
        not answer.completed or len(answer.stations) < asked for answer in every if not ends_at_critical(answer)
    ):
        return None
    count = min(len(answer.stations) for answer in every)
    return None if count == 0 else up_to(scene, runs, count)


def first_stations(scene: Scene, count: int) -> Scene:
    """A scene with its first stations alone, ``count`` of them, and the stages that have one."""
    stages, left = [], count
    for stage in scene.stages:
        stations = stage.stations[:left]
        left -= len(stations)
        if stations:
            stages.append(stage.model_copy(update={"stations": stations}))
    return scene.model_copy(update={"stages": tuple(stages)})


def up_to(scene: Scene, runs: Runs, count: int) -> tuple[Scene, Runs]:
    """A scene's first stations, ``count`` of them, and the answers to these alone, each as far as it goes.

    An answer that has them all says that it is complete, which it is for such a scene.
    """

    def cut(answer: Answer) -> Answer:
        ending = Ending.COMPLETED if len(answer.stations) >= count else answer.ending
        return replace(answer, stations=answer.stations[:count], ending=ending)

    def maybe(answer: Answer | None) -> Answer | None:
        return None if answer is None else cut(answer)

    return first_stations(scene, count), replace(
        runs,
        cprbm=tuple(map(cut, runs.cprbm)),
        fea=frozendict({theory: tuple(map(cut, answers)) for theory, answers in runs.fea.items()}),
        auto=maybe(runs.auto),
        beside=maybe(runs.beside),
        fea_beside=maybe(runs.fea_beside),
        paper=None,
    )


def ends_at_critical(answer: Answer) -> bool:
    """Whether an answer says that its branch ends, and where."""
    last = answer.stations[-1].branch if answer.stations else 0
    return answer.ending is Ending.BRANCH_ENDS and len(answer.critical) == last + 1
