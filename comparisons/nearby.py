"""The question of the work–energy reaction: a driven scene with two stations close round each of its own.

======  =======================================================
symbol  meaning
======  =======================================================
d       a station of a drive, m or rad
ρ       how far the two stations beside it are, as a share of d
d1, d2  d(1 − ρ) and d(1 + ρ), eqs. (12) and (13)
======  =======================================================

In the place of every station d the drive goes to d1 and d2, and at a stage's last on to d, so that a further stage
finds the drive where this one leaves it.  Whether d1 of one station lies before d2 of the last does not matter: an
equilibrium without friction does not know from which side it was reached.  A station at zero has no d1 and d2; a
load's stations are as they are.

Where a scene asks for the potential energy itself, and a stage's own stations are close together, nothing needs to be
run beside it: the energies at the stations tell their derivative (:mod:`comparisons.slopes`).
"""

from __future__ import annotations

from itertools import chain, pairwise

from comparisons.branches import span_of
from comparisons.slopes import MOST
from cprbm_scene import Drive, Probe, Scene, Stage
from cprbm_scene.statement import DisplacementDrive

RHO = 2e-3
"""ρ of section 2.4 of the paper."""

CLOSE = 0.02
"""Largest distance of neighbouring stations, a share of the stage's span, from which a derivative is taken.

The rate of an energy that goes through a whole wave in the stage is then off by less than 1e-7 of its largest.
"""

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


def is_dense(scene: Scene, stage: Stage) -> bool:
    """Whether the energies at a stage's own stations are asked for, and the stations close enough together."""
    asked = ENERGY.name in {probe.name for probe in scene.probes}
    apart = max((abs(b - a) for a, b in pairwise(stage.stations)), default=0.0)
    return asked and len(stage.stations) >= MOST and apart <= CLOSE * span_of(scene, stage)


def needs_more(scene: Scene, stage: Stage) -> bool:
    """Whether a stage steps a drive whose reaction is asked for, and its own stations do not tell the energy's rate."""
    return is_asked(scene, stage) and not is_dense(scene, stage)


def visited(scene: Scene, stage: Stage) -> tuple[tuple[float, ...], ...]:
    """The values that are gone to for each station of a stage."""
    if not needs_more(scene, stage):
        return tuple((d,) for d in stage.stations)
    last = len(stage.stations) - 1
    return tuple(
        (d * (1.0 - RHO), d * (1.0 + RHO), *([d] if place == last else [])) if d != 0.0 else (d,)
        for place, d in enumerate(stage.stations)
    )


def nearby(scene: Scene) -> Scene | None:
    """The scene with d1 and d2 beside every station d of a drive, and the energy for its only probe.

    Stages that tell it by themselves keep their stations; None where no other steps a drive whose reaction is asked.
    """
    if not any(needs_more(scene, stage) for stage in scene.stages):
        return None
    stages = tuple(
        stage.model_copy(update={"stations": tuple(chain.from_iterable(visited(scene, stage)))})
        for stage in scene.stages
    )
    return scene.model_copy(update={"stages": stages, "probes": (ENERGY,), "claims": ()})
