"""Question of a benchmark: the last loads at once, and the probes of the errors.

A time with all stations and probes would include stresses, places of contact and closing loads, which no peer gives.
Therefore a scene keeps the last station of every stage, and these probes:

========  =============================================================================================
measure   probes
========  =============================================================================================
places    displacements of points and rotations of bodies
forces    resultants of contacts; the force of a drive at its point, the moment of a drive that turns a body
========  =============================================================================================
"""

from __future__ import annotations

from typing import Literal

from cprbm_scene import Scene
from cprbm_scene.statement import DisplacementDrive, Probe

Measure = Literal["places", "forces"]
MEASURES: tuple[Measure, ...] = ("places", "forces")


def at_last_loads(scene: Scene) -> Scene:
    """The scene with the last station of every stage only."""
    stages = tuple(stage.model_copy(update={"stations": stage.stations[-1:]}) for stage in scene.stages)
    return scene.model_copy(update={"stages": stages})


def asked(scene: Scene) -> Scene:
    """The scene with its last loads and the probes of both measures, and without claims."""
    probes = tuple(probe for probe in scene.probes if measure_of(scene, probe) is not None)
    return at_last_loads(scene).model_copy(update={"probes": probes, "claims": ()})


def measure_of(scene: Scene, probe: Probe) -> Measure | None:
    """The measure of a probe; None of a probe without a measure."""
    if probe.quantity in ("displacement", "rotation"):
        return "places"
    driven = {drive.point if isinstance(drive, DisplacementDrive) else drive.body for drive in scene.drives.values()}
    at_drive = probe.quantity in ("reaction", "reaction_moment") and probe.of in driven
    return "forces" if at_drive or probe.quantity == "force" else None
