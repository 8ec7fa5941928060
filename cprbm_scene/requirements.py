"""Requirements of a scene for its solvers: a solver states the met requirements and refuses the others by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cprbm_scene.clearance import overlap_at_rest
from cprbm_scene.freedoms import Freedoms, unsupported
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.statement import BeamContact, CircleContact, EllipseContact, Scene, SplineContact

Requirement = Literal["theory", "overlap at rest", "from", "together", "support", "edge"]


def requirements(scene: Scene) -> Iterator[tuple[Requirement, Mistake]]:
    """Kinds of requirements, with keys, values found, and values for a solver without the feature."""
    if scene.theory != "bending":
        yield "theory", Mistake("theory", repr(scene.theory), "'bending'", scene.file)
    for name, drive in scene.drives.items():
        if not scene.holds(drive, scene.stages[0].name):
            yield (
                "from",
                Mistake(
                    f"drives.{name}.from",
                    f"a drive that is free before the stage {drive.begins!r}",
                    "drives that hold from the start",
                    scene.file,
                ),
            )
    for i, stage in enumerate(scene.stages):
        if stage.together:
            yield "together", Mistake(f"stages[{i}].steps", f"{list(stage.together)}", "one name", scene.file)
    for mistake, _ in unsupported(scene, Freedoms(scene)):
        yield "support", Mistake(mistake.key, mistake.found, "joints, guides and drives that hold it", scene.file)
    for name, contact in scene.contacts.items():
        if isinstance(contact, SplineContact | EllipseContact) or (
            isinstance(contact, CircleContact) and contact.side == "inside"
        ):
            yield (
                "edge",
                Mistake(
                    f"contacts.{name}",
                    f"{contact.kind!r}, {contact.side}",
                    "a circle from outside, a line, a half-plane or a function",
                    scene.file,
                ),
            )
        if isinstance(contact, BeamContact) and (overlap := overlap_at_rest(scene, contact)):
            yield (
                "overlap at rest",
                Mistake(
                    f"contacts.{name}",
                    f"beams that overlap at the start by {overlap:.3g} m",
                    "beams that touch or are apart",
                    scene.file,
                ),
            )


def refuse(scene: Scene, solver: str, *met: Requirement) -> None:
    """Refuse a scene with requirements beyond those ``met`` by a ``solver``.

    Args:
        scene: the problem statement.
        solver: name of the solver for the message.
        met: kinds of requirements for which the solver has equations.

    Raises:
        SceneError: the scene has further requirements; the error names every key.
    """
    found = [mistake for kind, mistake in requirements(scene) if kind not in met]
    if found:
        raise SceneError([Mistake(e.key, e.found, f"{e.allowed}, for {solver}", e.file) for e in found])
