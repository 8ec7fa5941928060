"""Requirements of a scene for its solvers: a solver states the met requirements and refuses the others by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cprbm_scene.clearance import overlap_at_rest
from cprbm_scene.freedoms import Freedoms, unsupported
from cprbm_scene.mistakes import Mistake, SceneError, broken
from cprbm_scene.statement import BeamContact, CircleContact, EllipseContact, Scene, SplineContact

Requirement = Literal["theory", "overlap at rest", "from", "together", "support", "edge"]


def requirements(scene: Scene) -> Iterator[tuple[Requirement, Mistake]]:
    """Kinds of requirements, with keys, values found, and values for a solver without the feature."""
    first, file, contacts = scene.stages[0].name, scene.file, [*scene.contacts.items()]
    overlaps = ((name, overlap_at_rest(scene, each)) for name, each in contacts if isinstance(each, BeamContact))
    rules: dict[Requirement, Iterator[Mistake]] = {
        "theory": broken(scene.theory != "bending" and Mistake("theory", repr(scene.theory), "'bending'", file)),
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
            for mistake, _ in unsupported(scene, Freedoms(scene))
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
            for name, overlap in overlaps
            if overlap
        ),
    }
    return ((kind, mistake) for kind, mistakes in rules.items() for mistake in mistakes)


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
