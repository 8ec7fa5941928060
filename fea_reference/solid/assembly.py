"""Assembly before the first stage: beams' ends drawn apart from their points are moved there.

Moments grow on the free end faces; the faces are then held and their middles moved straight to their points; finally
the moments are removed. Stops can close once the ends have arrived. While ends are free, the mechanism lacks their
rows, the last rows.
"""

from dataclasses import replace

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.statement import Scene
from fea_reference.solid.march import March, StoppedError, reach
from fea_reference.solid.model import WAY, Model, SharePart
from fea_reference.solid.stops import StopPart
from fea_reference.solid.system import assemble

_BEYOND = 1e-9  # rad


def assemble_ends(scene: Scene, march: March) -> None:
    """Assemble all ends drawn apart.

    Raises:
        SceneError: a stop forbids the assembly.
        StoppedError: the assembly fails.
    """
    whole = march.model
    if not whole.apart:
        return
    moments = next(i for i, part in enumerate(whole.stepped) if isinstance(part, SharePart))
    way = whole.stepped.index(WAY)
    try:
        _continue_with(march, _with_free_ends(whole), march.values[:-1], march.system.z[: -len(whole.apart)])
        reach(march, moments, 1.0)
        caught = _with_held_ends(whole, march.system.z)
        unheld = np.concatenate([march.system.z, np.zeros(len(whole.apart))])
        _continue_with(march, replace(caught, stops=()), np.append(march.values, 1.0), unheld)
        reach(march, way, 0.0)
        forbidden = [mistake for stop in whole.stops for mistake in _limit_mistakes(march, stop, scene)]
        if forbidden:
            raise SceneError(forbidden)
        _continue_with(march, caught, march.values, march.system.z)
        reach(march, moments, 0.0)
    except StoppedError as stopped:
        raise StoppedError(stopped.ending, f"during the assembly: {stopped.sentence}") from stopped
    # contacts closed during the assembly are closed before any load or drive of the scene
    march.closing = dict.fromkeys(march.closing, 0.0)


def _continue_with(march: March, model: Model, values: Array, z: Array) -> None:
    """Continue load stepping with another mechanism."""
    march.model, march.values, march.step = model, values, np.inf
    march.system = assemble(model, march.penalties, march.settings.quadrature, values, z)


def _with_free_ends(model: Model) -> Model:
    """The mechanism with free ends, without stops."""
    remaining = tuple(row for row in model.rows if not row.point)
    drives = tuple(part for part in model.drives if part is not WAY)
    return replace(model, rows=remaining, drives=drives, stops=(), size=model.size - len(model.apart))


def _with_held_ends(model: Model, z: Array) -> Model:
    """The mechanism with the ends held at their positions in a state ``z`` with free ends: the way is one."""
    rows = tuple(replace(row, way=row.violation(model.bodies, z)) if row.point else row for row in model.rows)
    return replace(model, rows=rows)


def _limit_mistakes(march: March, stop: StopPart, scene: Scene) -> list[Mistake]:
    """A mistake if an assembled end is beyond a limit of its stop; else an empty list."""
    angle = stop.angle(march.system.z)
    for key, limit, beyond in (("least", stop.least, stop.least - angle), ("most", stop.most, angle - stop.most)):
        if beyond > _BEYOND:
            message = (
                f"{limit:g} rad: a stop that forbids the assembly, by which {scene.stops[stop.name].beam!r} comes to "
                f"stand at {angle:.4g} rad"
            )
            allowed = "limits that the assembled beam keeps, or other moments"
            return [Mistake(f"stops.{stop.name}.{key}", message, allowed, scene.file)]
    return []
