"""What a body moves with: the ground, if guides and drives that no stage steps leave it no way to move, or itself.

======  ===================================================================================
symbol  meaning
======  ===================================================================================
n, r    a direction that is barred, and the place of it from the body's first point, m
l       the body's size, the farthest r, so that turning by φ moves what is held by lφ
C       rows (n, r × n/l) of what is barred, over the body's (u, v, lφ); (0, 0, 1) of its turning
======  ===================================================================================

C x = 0 has x = 0 alone where its rank is three.  What is on such a body cannot move against what is on the ground, and
a beam that is held on the one lies on the other as if both were one, whichever of two names a scene gives them.
"""

from collections.abc import Iterator

import numpy as np

from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive, FixedBody, Scene, SlidingBody, TurningBody

_BARRED = 1e-6  # of C's singular values: what bars less lets the body turn by a thousand times what it is held to


def frame_of(scene: Scene, body: str) -> str:
    """What a body moves with: its name, or none if it is of the ground or held as the ground is."""
    if isinstance(scene.bodies[body], FixedBody):
        return ""
    barred = tuple(_barred(scene, body))
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


def _barred(scene: Scene, body: str) -> Iterator[tuple[tuple[float, float] | None, Array]]:
    """Where and in which direction (2,) a body is held; of its turning nowhere, and none."""
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
