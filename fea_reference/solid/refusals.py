"""Features of a scene that the solid lacks; such a scene is refused before the solution."""

from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.solving import refuse as refuse_requirements
from cprbm_scene.statement import Scene
from fea_reference.solid.areas import too_curved


def refuse(scene: Scene) -> None:
    """Check that the solid offers all features of a scene.

    Raises:
        SceneError: a feature is missing.
    """
    refuse_requirements(scene, "the solid")
    mistakes = too_curved(scene)
    for name, contact in scene.contacts.items():
        if not contact.thick:
            allowed = "for the solid, edges, thick = true: thick beams overlap before their lines touch"
            mistakes.append(Mistake(f"contacts.{name}", "contact of neutral lines", allowed))
    for stage in scene.stages:
        if stage.beyond is not None:
            mistakes.append(
                Mistake(
                    f"stages.{stage.name}.beyond",
                    repr(stage.beyond),
                    "for the solid, none: the solid follows no branches",
                )
            )
    if mistakes:
        raise SceneError(mistakes)
