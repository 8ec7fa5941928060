"""Requirements of a scene that only some solvers meet: a solver states the met requirements and refuses all others."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cprbm_scene.check_overlaps import overlap_at_rest
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.statement import BeamContact, Scene

Requirement = Literal["theory", "overlap at rest"]


def requirements(scene: Scene) -> Iterator[tuple[Requirement, Mistake]]:
    """Kinds of requirements, with the keys, the values found, and values that every solver allows."""
    if scene.theory != "bending":
        yield "theory", Mistake("theory", repr(scene.theory), "'bending'", scene.file)
    for name, contact in scene.contacts.items():
        if isinstance(contact, BeamContact) and (overlap := overlap_at_rest(scene, contact)):
            found = f"beams that overlap at the start by {overlap:.3g} m"
            yield "overlap at rest", Mistake(f"contacts.{name}", found, "beams that touch or are apart", scene.file)


def refuse(scene: Scene, solver: str, *met: Requirement) -> None:
    """Refuse a scene with requirements that a ``solver`` has not ``met``.

    Raises:
        SceneError: the scene has such requirements; the error names every key.
    """
    found = [mistake for kind, mistake in requirements(scene) if kind not in met]
    if found:
        raise SceneError([Mistake(e.key, e.found, f"{e.allowed}, for {solver}", e.file) for e in found])
