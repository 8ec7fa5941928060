"""The question of the work–energy reaction: a driven scene with two stations close round each of its own.

======  =======================================================
symbol  meaning
======  =======================================================
d       a station of a drive, m or rad
ρ       how far the two stations beside it are, as a share of d
d1, d2  d(1 − ρ) and d(1 + ρ), eqs. (12) and (13)
======  =======================================================

At every station the drive goes to d1, to d2 and then to d, so that what follows (the next station, or a further
stage, which finds the drive where this one has left it) goes on from where the scene itself would.  Whether d1 of one
station lies before d2 of the last does not matter: an equilibrium without friction does not know from which side it
was reached.  A station at zero has no d1 and d2; a load's stations are as they are.
"""

from __future__ import annotations

from scene import Drive, Probe, Scene, Stage
from scene.statement import DisplacementDrive

RHO = 2e-3
"""ρ of section 2.4 of the paper."""

ENERGY = Probe(of="scene", quantity="potential_energy")


def reaction_of(drive: Drive) -> Probe:
    """The probe of what a drive pushes or turns with."""
    if isinstance(drive, DisplacementDrive):
        return Probe(of=drive.point, quantity="reaction")
    return Probe(of=drive.body, quantity="reaction_moment")


def is_asked(scene: Scene, stage: Stage) -> bool:
    """Whether a stage steps a drive whose reaction the scene asks for."""
    if stage.steps not in scene.drives:
        return False
    return reaction_of(scene.drives[stage.steps]).name in {probe.name for probe in scene.probes}


def visited(d: float) -> tuple[float, ...]:
    """The values of a drive that are gone to at a station d, the last of them d."""
    return (d * (1.0 - RHO), d * (1.0 + RHO), d) if d != 0.0 else (d,)


def nearby(scene: Scene) -> Scene | None:
    """The scene with d1 and d2 beside every station d of a drive, and the energy for its only probe.

    None where no stage steps a drive whose reaction is asked for.
    """
    if not any(is_asked(scene, stage) for stage in scene.stages):
        return None
    stages = tuple(
        stage.model_copy(update={"stations": tuple(value for d in stage.stations for value in visited(d))})
        if is_asked(scene, stage)
        else stage
        for stage in scene.stages
    )
    return scene.model_copy(update={"stages": stages, "probes": (ENERGY,), "claims": ()})
