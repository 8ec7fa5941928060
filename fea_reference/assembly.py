"""Assembly before the first stage: beams' ends drawn apart from their points are moved there.

Auxiliary moments grow on the free ends; the ends are then held and moved straight to their points; finally the
moments are removed. Stops can close once the ends have arrived.
"""

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.statement import Scene
from fea_reference.acting import Acting
from fea_reference.march import March, StoppedError
from fea_reference.model import MOMENTS, WAY
from fea_reference.stops import StopPart
from fea_reference.travel import Course, reach

_BEYOND = 1e-9  # rad


def assemble_ends(scene: Scene, march: March) -> None:
    """Assemble all ends drawn apart.

    Raises:
        SceneError: a stop forbids the assembly.
        StoppedError: the assembly fails.
    """
    model = march.model
    if not model.apart:
        return
    moments, way = (model.stepped.index(share) for share in (MOMENTS, WAY))
    try:
        reach(march, Course(moments, 1.0), 1.0)
        ways = np.array([_vector_to_end(march, i) for i in range(len(model.apart))])
        march.constrain(Acting(ways, stopping=False))
        reach(march, Course(way, 1.0), 1.0)
        forbidden = [mistake for stop in model.stops for mistake in _limit_mistakes(march, stop, scene)]
        if forbidden:
            raise SceneError(forbidden)
        march.constrain(Acting(ways, stopping=True))
        reach(march, Course(moments, 1.0), 0.0)
    except StoppedError as stopped:
        raise StoppedError(stopped.ending, f"during the assembly: {stopped.sentence}") from stopped
    # contacts closed during the assembly are closed before any load or drive of the scene
    march.closing = dict.fromkeys(march.closing, 0.0)


def _vector_to_end(march: March, number: int) -> Array:
    """Vector (2,) from the point of an end to the end."""
    joint = march.model.apart[number].joint
    body = march.model.bodies[joint.body]
    return np.asarray(march.system.z[joint.dofs[:2]] - march.model.carried(body, joint.arm, march.system.z))


def _limit_mistakes(march: March, stop: StopPart, scene: Scene) -> list[Mistake]:
    """A mistake if an assembled end is beyond a limit of its stop; else an empty list."""
    margin, limit = stop.margin(march.system.z)
    if margin >= -_BEYOND:
        return []
    key = f"contacts.{stop.owner}" if stop.owner else f"stops.{stop.name}.{'most' if limit == stop.most else 'least'}"
    message = (
        f"{limit:g} rad: a stop that forbids the assembly, by which {stop.end[0]!r} comes to "
        f"stand at {stop.angle(march.system.z):.4g} rad"
    )
    return [Mistake(key, message, "limits that the assembled beam keeps, or other moments", scene.file)]
