"""What a benchmark asks: the last load at once, and the numbers of the error.

With every station and every probe a time would be that of stresses, places of contact and closing loads as well, none
of which a peer can give.  So a scene keeps the last station of each of its stages, and of its probes:

========  =============================================================================================
measure   probes
========  =============================================================================================
places    displacements of points and rotations of bodies
forces    resultants of contacts; the force of a drive at its point, the moment of one that turns a body
========  =============================================================================================
"""

from __future__ import annotations

from typing import Literal

from comparisons.studies.last_loads import at_last_loads
from cprbm_scene import Scene
from cprbm_scene.statement import DisplacementDrive, Probe

Measure = Literal["places", "forces"]
MEASURES: tuple[Measure, ...] = ("places", "forces")


def asked(scene: Scene) -> Scene:
    """The scene with its last loads and the probes of both measures, and without claims."""
    probes = tuple(probe for probe in scene.probes if measure_of(scene, probe) is not None)
    return at_last_loads(scene).model_copy(update={"probes": probes, "claims": ()})


def measure_of(scene: Scene, probe: Probe) -> Measure | None:
    """The measure that a probe counts for, or None."""
    driven = {drive.point if isinstance(drive, DisplacementDrive) else drive.body for drive in scene.drives.values()}
    if probe.quantity in ("displacement", "rotation"):
        return "places"
    at_drive = probe.quantity in ("reaction", "reaction_moment") and probe.of in driven
    return "forces" if at_drive or probe.quantity == "force" else None
