"""The chained pseudo-rigid-body model: equilibrium as a minimum of potential energy under contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cprbm.paper.offset_points import OffsetPoints, offset_points
from cprbm.settings import Settings
from cprbm_scene import Answer, Scene

if TYPE_CHECKING:
    from cprbm.results.stations import Run

__all__ = ["OffsetPoints", "Settings", "answer", "offset_points", "prepared"]


def prepared(scene: Scene, settings: Settings | None = None) -> Run:
    """The mechanism in the stress-free state; the method ``answer`` solves the scene once.

    The preparation is separate for measurements of time.

    Args:
        scene: as of :func:`answer`.
        settings: as of :func:`answer`.

    Returns:
        The run at its stress-free start; :meth:`answer` of the run gives the answer of the scene.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    settings = settings or Settings()
    settings.check(scene)
    from cprbm.results.stations import Run  # Numba and its kernels take 0.4 s to load

    return Run(scene, settings)


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """Answer of the chained pseudo-rigid-body model: certified states at the stations.

    Args:
        scene: the problem statement.
        settings: numerical choices; by default 40 links per beam and contact without hints.

    Returns:
        States at the scene's stations, or at the stations before the end of the branch; the Ending says why the
        solver stopped.  Values are read-only arrays in SI, of the shapes in :mod:`cprbm_scene.answer`.

    Raises:
        SceneError: the settings do not fit the scene.

    Source:
        Jin et al., Mechanism and Machine Theory 145 (2020) 103700: eq. (1) by Newton's method; the contact of ``auto``
        and the corrections of fourth order are not the paper's.

    Example:
        >>> import cprbm
        >>> from cprbm_scene import read
        >>> answer = cprbm.answer(read("comparisons/cases/tapered.toml"), cprbm.Settings(links=12))
        >>> answer.completed, answer.stations[-1].values["T.displacement"].shape
        (True, (2,))
    """
    return prepared(scene, settings).answer()
