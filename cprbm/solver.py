"""From a scene to an answer."""

from __future__ import annotations

import time

from threadpoolctl import threadpool_limits

from cprbm.march import March
from cprbm.refining import coarser
from cprbm.settings import Settings
from scene import Answer, Ending, Scene


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """Solve a scene by the chained pseudo-rigid-body model.

    Args:
        scene: the problem statement.
        settings: numerical choices; by default 40 links per beam and contact where beams are closest.

    Returns:
        Certified answers at the scene's stations, or those reached before the solver's Ending says why it stopped.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    began = time.perf_counter()
    settings = settings or Settings()
    # small matrices: more than one thread of BLAS costs more than it brings
    with threadpool_limits(limits=1, user_api="blas"):
        march = March(scene, coarser(settings))
        ending, sentence = march.run()
        if ending not in (Ending.COMPLETED, Ending.BRANCH_ENDS) and len(march.family) > 1:
            # a coarse mesh may be too coarse: without it then
            march = March(scene, (settings,))
            ending, sentence = march.run()
        notes = march.notes()
    return Answer(
        solver="cprbm",
        scene=scene.name,
        settings=settings.plain(),
        ending=ending,
        sentence=sentence,
        stations=tuple(march.reached),
        events=tuple(march.events),
        critical=tuple(march.critical),
        seconds=time.perf_counter() - began,
        notes=tuple(notes),
    )
