"""What a peer came to, as a solver's answer is told: completed or not, and the scene's own probes.

It has completed if it came to its end in time and the common residual is at most ``TOLERANCE``.  The tolerance is what
forward differences leave: SLSQP comes to 6e-7 on the hinge at N = 40, with exact derivatives all come to 1e-8 or less.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.peers.formulas import Formulas
from benchmarks.peers.kkt import Stationarity, stationarity
from benchmarks.peers.solving import LATE, Solved
from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import Probe

if TYPE_CHECKING:
    from benchmarks.peers.record import Discretised

TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True)
class Judged:
    """``ended`` is COMPLETED, TIME_IS_UP, GAVE_UP or NOT_STATIONARY; ``why`` says more; ``values`` are by probe."""

    ended: str
    why: str
    residual: float
    values: Mapping[str, Array]


def judged(scene: Scene, problem: Discretised, solved: Solved) -> Judged:
    """Judge where an optimiser stopped; the values are there only if it has completed."""
    formulas = Formulas(problem)
    found = stationarity(formulas, solved.z)
    if solved.why:
        ended, why = ("TIME_IS_UP" if solved.why == LATE else "GAVE_UP"), solved.why
    elif found.residual > TOLERANCE:
        ended, why = "NOT_STATIONARY", f"a residual of {found.residual:.1e} is more than {TOLERANCE:g}"
    else:
        return Judged("COMPLETED", "", found.residual, probed(scene, formulas, solved.z, found))
    return Judged(ended, why, found.residual, frozendict())


def probed(scene: Scene, formulas: Formulas, z: Array, found: Stationarity) -> Mapping[str, Array]:
    """Those of the scene's probes that are displacements, rotations, contact forces and what drives do; SI."""
    problem = formulas.problem
    unit_force = problem.unit_moment / problem.unit_length
    forces = formulas.contact_forces(z, found.lam)
    bodies = formulas.at(z).bodies
    drives = dict(
        zip((held.drive for held in problem.held), found.mu[len(found.mu) - len(problem.held) :], strict=True)
    )

    def value(probe: Probe) -> Array | None:
        match probe.quantity:
            case "displacement":
                return problem.unit_length * formulas.displaced(z, probe.of)
            case "rotation" if probe.of in problem.bodies:
                return np.array([bodies[problem.bodies[probe.of], 2]])
            case "force" if probe.of in forces:
                return np.array([unit_force * forces[probe.of]])
            case "reaction":
                drive = next((name for name, one in scene.drives.items() if getattr(one, "point", "") == probe.of), "")
                held = next((one for one in problem.held if drive and one.drive == drive), None)
                return None if held is None else -unit_force * drives[drive] * np.array(held.along)
        return None

    values = {probe.name: value(probe) for probe in scene.probes}
    return frozendict({name: found for name, found in values.items() if found is not None})
