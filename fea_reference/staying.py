"""Frame of a body: the ground, if guides and constant drives prevent any motion, else the body itself.

======  ===================================================================================
symbol  meaning
======  ===================================================================================
n, r    a constrained direction, and its place relative to the body's first point, m
l       the body's size, the largest r, so that a rotation φ moves the constrained points by lφ
C       rows (n, r × n/l) of constraints, over the body's (u, v, lφ); (0, 0, 1) for its rotation
======  ===================================================================================

C x = 0 has only the solution x = 0 if its rank is three. Such a body counts as the ground: a beam held on a
constrained body may touch fixed bodies as if both were a single body.
"""

from collections.abc import Iterator

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive, FixedBody, Scene, SlidingBody, TurningBody

# singular value of C: a smaller one permits a rotation a thousand times the tolerance of the constraints
_BARRED = 1e-6


def frame_of(scene: Scene, body: str) -> str:
    """Name of a body's frame: the body, or an empty string for the ground and for fully constrained bodies."""
    if isinstance(scene.bodies[body], FixedBody):
        return ""
    barred = tuple(_constraints(scene, body))
    first = np.array(next(iter(scene.bodies[body].points.values())))
    arms = [np.array(at) - first for at, _ in barred if at is not None]
    size = max((float(np.hypot(*arm)) for arm in arms), default=0.0) or 1.0
    C = np.zeros((len(barred), 3))
    for row, (at, n) in zip(C, barred, strict=True):
        if at is None:
            row[2] = 1.0
            continue
        r = (np.array(at) - first) / size
        row[:] = n[0], n[1], r[0] * n[1] - r[1] * n[0]
    return "" if np.linalg.matrix_rank(C, tol=_BARRED) == 3 else body


def _constraints(scene: Scene, body: str) -> Iterator[tuple[tuple[float, float] | None, Array]]:
    """Place and direction (2,) of every constraint on a body; None and zero for a constrained rotation."""
    turning = None, np.zeros(2)
    record = scene.bodies[body]
    if isinstance(record, TurningBody):
        yield from ((scene.place_of(record.about), n) for n in np.eye(2))
    elif isinstance(record, SlidingBody):
        along = _unit(record.along)
        yield scene.place_of(record.pin or next(iter(record.points))), np.array([-along[1], along[0]])
        if record.pin is None:
            yield turning
    stepped = {stage.steps for stage in scene.stages}
    for drive in (drive for name, drive in scene.drives.items() if name not in stepped):
        if not isinstance(drive, DisplacementDrive):
            if drive.body == body:
                yield turning
        elif scene.body_of(drive.point) == body:
            yield scene.place_of(drive.point), _unit(drive.direction)


def _unit(direction: tuple[float, float]) -> Array:
    return np.asarray(np.array(direction) / np.hypot(*direction))
