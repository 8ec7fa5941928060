"""From a scene to an answer.

The second edition (:mod:`cprbm.results.stations`) answers in every theory.  The first edition (:mod:`cprbm.march`)
answers contacts of ``auto`` in bending, and edges with corners, ends or features smaller than a link
(:mod:`cprbm.routing`).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cprbm.march import March
from cprbm.refining import coarser
from cprbm.routing import by_second_edition
from cprbm.settings import Settings
from cprbm_scene import Answer, Ending, Scene
from cprbm_scene.contact_states import openings
from cprbm_scene.threads import one_thread

if TYPE_CHECKING:
    from cprbm.results.stations import Run


@dataclass(frozen=True, slots=True)
class Prepared:
    """A scene made ready: the ``march`` stands at the stress-free state, and goes its way once.

    ``seconds`` is how long that took.
    """

    scene: Scene
    settings: Settings
    march: March
    seconds: float

    def answer(self) -> Answer:
        """March, and hand back what :func:`answer` does."""
        began = time.perf_counter()
        march, settings = self.march, self.settings
        with one_thread():
            ending, sentence = march.run()
            if ending not in (Ending.COMPLETED, Ending.BRANCH_ENDS) and len(march.family) > 1:
                # a coarse mesh may be too coarse: without it then
                march = March(self.scene, (settings,))
                ending, sentence = march.run()
            notes = march.notes()
        return Answer(
            solver="cprbm",
            scene=self.scene.name,
            settings=settings.plain(),
            ending=ending,
            sentence=sentence,
            stations=tuple(march.reached),
            events=(*march.events, *openings(self.scene, march.reached)),
            critical=tuple(march.critical),
            gone_over=tuple(march.gone_over),
            seconds=self.seconds + time.perf_counter() - began,
            notes=tuple(notes),
        )


def prepared(scene: Scene, settings: Settings | None = None) -> Prepared | Run:
    """Make a scene ready without solving anything: the set-up of an answer, for those who time it by itself.

    Args:
        scene: as of :func:`answer`.
        settings: as of :func:`answer`.

    Returns:
        The mechanism at the stress-free state; its ``answer`` solves the scene once.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    began = time.perf_counter()
    settings = settings or Settings()
    settings.check(scene)
    if by_second_edition(scene, settings.formulation, settings.links_of):
        from cprbm.results.stations import Run  # Numba and its kernels take 0.4 s to load

        return Run(scene, settings)
    march = March(scene, coarser(settings))
    return Prepared(scene, settings, march, time.perf_counter() - began)


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """Solve a scene by the chained pseudo-rigid-body model.

    Args:
        scene: the problem statement.
        settings: numerical choices; by default 40 links per beam and contact where beams are closest.

    Returns:
        Certified answers at the scene's stations, or those reached before the solver's Ending says why it stopped.
        Their values are read-only arrays in SI, of the shapes in :mod:`cprbm_scene.answer`.

    Raises:
        SceneError: the settings do not fit the scene.

    Source:
        Jin et al., Mechanism and Machine Theory 145 (2020) 103700: eq. (1) by Newton's method; ``auto`` contact is not
        the paper's.

    Example:
        >>> import cprbm
        >>> from cprbm_scene import read
        >>> answer = cprbm.answer(read("comparisons/cases/tapered.toml"), cprbm.Settings(links=12))
        >>> answer.completed, answer.stations[-1].values["T.displacement"].shape
        (True, (2,))
    """
    return prepared(scene, settings).answer()
