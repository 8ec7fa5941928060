"""Bodies that contacts alone hold."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene import Scene
from cprbm_scene.freedoms import FREEDOMS, Freedoms, unsupported


def loose_bodies(scene: Scene) -> list[str]:
    """Bodies with a single motion that no beam, pin or drive resists: only contacts may hold them."""
    return [name for name in _unsupported_parts(scene) if name]


def contacts_may_hold(scene: Scene) -> bool:
    """True if every part without support is such a body."""
    return all(_unsupported_parts(scene))


def _unsupported_parts(scene: Scene) -> Iterator[str]:
    """For every part without support the name of the body, if the part is a body with a single motion, else empty."""
    freedoms = Freedoms(scene)
    for mistake, names in unsupported(scene, freedoms):
        name = mistake.key.removeprefix("bodies.")
        yield name if names == {name} and len(freedoms.guide(name)) == FREEDOMS - 1 else ""
