"""What a scene may ask of the solid: the rest is refused before anything is solved."""

from __future__ import annotations

from fea_reference.solid.areas import too_curved
from scene.mistakes import Mistake, SceneError
from scene.statement import (
    BeamMoment,
    Scene,
)


def refuse(scene: Scene) -> None:
    """See that the solid offers all that a scene asks.

    Raises:
        SceneError: it does not.
    """
    mistakes = too_curved(scene)
    for name, load in scene.loads.items():
        if isinstance(load, BeamMoment):
            mistakes.append(Mistake(f"loads.{name}", "a moment on a beam", "for the solid, forces on beams"))
    for name, contact in scene.contacts.items():
        if not contact.thick:
            mistakes.append(Mistake(f"contacts.{name}", "lines that touch", "for the solid, edges: thick = true"))
    if scene.assembly is not None:
        mistakes.append(Mistake("assembly", "ends drawn apart", "for the solid, beams drawn as they are joined"))
    for stage in scene.stages:
        if stage.beyond is not None:
            mistakes.append(
                Mistake(
                    f"stages.{stage.name}.beyond", repr(stage.beyond), "for the solid, none: it follows no branches"
                )
            )
    for probe in scene.probes:
        if probe.quantity == "moment" and probe.of in scene.contacts:
            mistakes.append(
                Mistake(
                    f"probes.{probe.name}", repr(probe.quantity), "for the solid, a contact's force, or a stop's moment"
                )
            )
    if mistakes:
        raise SceneError(mistakes)
