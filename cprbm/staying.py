"""Which bodies stay where they are drawn, though they are not of the ground, and which go where drives say.

======  ======================================================================================
r       a held point, from the body's first point; units of length
e       direction in which it is held
J       rows (e, r × e) of a displacement that is held and (0, 0, 1) of a rotation, over the body's u, v, φ
======  ======================================================================================

What slides, pivots and drives hold that no stage steps stays at zero.  Where J has rank three the body stays, and what
is on it cannot move against what is on the ground: how a clamp and a contact that lies along it share their force is
then as little a question of equilibrium as where both are on one body.  What stages step leads a body that it helps to
hold so: in each state it stands somewhere, and no unknown moves it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from cprbm_scene import Scene
from cprbm_scene.statement import DisplacementDrive, SlidingBody, TurningBody

INDEPENDENT = 1e-6  # of J's least singular value: less than this, and the body can turn about where it is held


def staying(scene: Scene, unit_length: float) -> frozenset[str]:
    """Names of the bodies that stay, ``unit_length`` in m."""
    stepped = {stage.steps for stage in scene.stages}
    return _wholly(scene, unit_length, [name for name in scene.drives if name not in stepped])


def led(scene: Scene, unit_length: float) -> frozenset[str]:
    """Names of the bodies that go where drives say, some of which a stage steps; ``unit_length`` in m."""
    return _wholly(scene, unit_length, scene.drives) - staying(scene, unit_length)


def _wholly(scene: Scene, unit_length: float, drives: Iterable[str]) -> frozenset[str]:
    """Names of the bodies that guides and some ``drives`` leave no way to move of their own."""
    first = {name: np.array(next(iter(body.points.values()))) for name, body in scene.bodies.items()}
    turning = (0.0, 0.0, 1.0)
    held: dict[str, list[tuple[float, float, float]]] = {name: [] for name in scene.bodies}

    def hold(owner: str, point: str, direction: tuple[float, float]) -> None:
        ex, ey = np.array(direction) / np.hypot(*direction)
        rx, ry = (np.array(scene.place_of(point)) - first[owner]) / unit_length
        held[owner].append((float(ex), float(ey), float(rx * ey - ry * ex)))

    for name, body in scene.bodies.items():
        if isinstance(body, TurningBody):
            hold(name, body.about, (1.0, 0.0))
            hold(name, body.about, (0.0, 1.0))
        elif isinstance(body, SlidingBody):
            ex, ey = body.along
            hold(name, body.pin or next(iter(body.points)), (-ey, ex))
            if body.pin is None:
                held[name].append(turning)
    for drive in (scene.drives[name] for name in drives):
        if isinstance(drive, DisplacementDrive):
            hold(scene.body_of(drive.point), drive.point, drive.direction)
        else:
            held[drive.body].append(turning)
    return frozenset(
        name for name, J in held.items() if len(J) > 2 and np.linalg.svd(np.array(J), compute_uv=False)[2] > INDEPENDENT
    )
