"""A solve beside its equations: refused requirements at the begin, a single thread of BLAS and progress during it.

A solver states the met requirements and refuses the others by name.

For small matrices further threads of BLAS take time.  In a process with a loaded BLAS only threadpoolctl can limit the
threads.  Without threadpoolctl BLAS keeps the threads of the process; the program ``cprbm`` limits these threads at the
start (:mod:`comparisons.threads`).
"""

import logging
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from typing import Any, Literal, cast

from cprbm_scene.answer import StationAnswer
from cprbm_scene.clearance import overlap_at_rest
from cprbm_scene.freedoms import Freedoms, unsupported
from cprbm_scene.mistakes import Mistake, refuse_broken
from cprbm_scene.statement import BeamContact, CircleContact, EllipseContact, Scene, SplineContact

Requirement = Literal["overlap at rest", "from", "together", "support", "edge"]


def requirements(scene: Scene) -> dict[Requirement, Iterator[Mistake]]:
    """Keys, values found, and values for a solver without the feature, by kinds of requirements."""
    first, file, contacts = scene.stages[0].name, scene.file, [*scene.contacts.items()]
    return {
        "from": (
            Mistake(
                f"drives.{name}.from",
                f"a drive that is free before the stage {drive.begins!r}",
                "drives that hold from the start",
                file,
            )
            for name, drive in scene.drives.items()
            if not scene.holds(drive, first)
        ),
        "together": (
            Mistake(f"stages[{i}].steps", f"{list(stage.together)}", "one name", file)
            for i, stage in enumerate(scene.stages)
            if stage.together
        ),
        "support": (
            Mistake(mistake.key, mistake.found, "joints, guides and drives that hold it", file)
            for mistake, _ in unsupported(Freedoms(scene))
        ),
        "edge": (
            Mistake(
                f"contacts.{name}",
                f"{each.kind!r}, {each.side}",
                "a circle from outside, a line, a half-plane or a function",
                file,
            )
            for name, each in contacts
            if isinstance(each, SplineContact | EllipseContact)
            or (isinstance(each, CircleContact) and each.side == "inside")
        ),
        "overlap at rest": (
            Mistake(
                f"contacts.{name}",
                f"beams that overlap at the start by {overlap:.3g} m",
                "beams that touch or are apart",
                file,
            )
            for name, each in contacts
            if isinstance(each, BeamContact) and (overlap := overlap_at_rest(scene, each))
        ),
    }


def refuse(scene: Scene, solver: str, *met: Requirement) -> None:
    """Refuse a scene with requirements beyond those ``met`` by a ``solver``.

    Args:
        scene: the problem statement.
        solver: name of the solver for the message.
        met: kinds of requirements for which the solver has equations.

    Raises:
        SceneError: the scene has further requirements; the error names every key.
    """
    refuse_broken(
        *(
            mistake._replace(allowed=f"{mistake.allowed}, for {solver}")
            for kind, mistakes in requirements(scene).items()
            if kind not in met
            for mistake in mistakes
        )
    )


def station_reached(logger: logging.Logger, scene: Scene, reached: int, station: StationAnswer) -> None:
    """Log, at the level INFO, that a solver has come to the ``station`` with the number ``reached`` of the scene."""
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


def one_thread() -> AbstractContextManager[object]:
    """Context with a single thread per loaded library of linear algebra; without effect if threadpoolctl is missing."""
    try:
        return cast("AbstractContextManager[object]", _loaded(len(sys.modules)).limit(limits=1, user_api="blas"))
    except ImportError:
        return nullcontext()


@lru_cache(maxsize=1)
def _loaded(modules: int) -> Any:  # noqa: ANN401 - threadpoolctl has no types
    """Controller of the loaded libraries, cached: threadpoolctl reads the process's map of memory, which takes long.

    Libraries are loaded with Python modules, so that an equal number of ``modules`` means equal libraries.
    """
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
