"""Bodies that contacts alone hold."""

from __future__ import annotations

from cprbm_scene import Scene
from cprbm_scene.freedoms import Freedoms, unsupported
from cprbm_scene.statement import SlidingBody, TurningBody


def loose_bodies(scene: Scene) -> list[str]:
    """Bodies with a single motion that no beam, pin or drive resists: only contacts may hold them."""
    loose = [(mistake.key, names) for mistake, names in unsupported(scene, Freedoms(scene))]
    return [name for name in scene.bodies if (f"bodies.{name}", {name}) in loose and _has_one_motion(scene, name)]


def contacts_may_hold(scene: Scene) -> bool:
    """True if every part without support is such a body."""
    loose = {f"bodies.{name}" for name in loose_bodies(scene)}
    return all(mistake.key in loose for mistake, _ in unsupported(scene, Freedoms(scene)))


def _has_one_motion(scene: Scene, name: str) -> bool:
    body = scene.bodies[name]
    return isinstance(body, TurningBody) or (isinstance(body, SlidingBody) and not body.turns)
