"""Poisson's ratio, which only shear knows: another one in a scene, and the one at which a claim would be ours.

======  ==============================================================================================
symbol  meaning
======  ==============================================================================================
ν, ν_0  Poisson's ratio, and the scene's own, in (−1, 1/2]
v_c     the CPRBM's value, in which ν has no part
v(ν)    the finite elements' value in the theory ``shear``
g       what shear adds to it at ν_0
======  ==============================================================================================

Shear yields by ∫ ds/(κ G A), and E/G = 2(1 + ν) with the shear factor κ of a rectangle the same for every ν.  Where it
is small beside bending it adds to every value in proportion:

    v(ν) = v(ν_0) + g ((1 + ν)/(1 + ν_0) − 1),

so that ν → −1 is the theory ``stretch``.  A run at the ν that is found says how far this holds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from comparisons.budgets.parts import Budget
from comparisons.budgets.runs import BudgetRuns
from comparisons.claims import claim_difference, claim_of
from comparisons.quantities import norm
from comparisons.stations import station_of
from comparisons.verdict.rows import Row
from comparisons.verdict.scales import denominator
from cprbm_scene import Answer, Claim, Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import STRESSES

BOUNDS = (-1.0, 0.5)
"""Between which ν lies; the first is not reached."""
_INTERVALS = 60


@dataclass(frozen=True, slots=True)
class ClaimedRatio:
    """A claim at the last station, and Poisson's ratios at which our difference would be as large as it.

    Attributes:
        claim: what is claimed.
        budget: ours, at the scene's own ratio.
        without_shear, incompressible: our difference for ν → −1 and at ν = 1/2, fractions as the claim takes them.
        ratios: where it is the claimed one, ascending; none where there is no such ratio.
        reruns: what a run at each of them gives instead, None where it ended early; empty before they are run.
    """

    claim: Claim
    budget: Budget
    without_shear: float
    incompressible: float
    ratios: tuple[float, ...]
    reruns: tuple[float | None, ...] = ()


def with_ratio(scene: Scene, ratio: float) -> Scene:
    """The scene with another Poisson's ratio of all its materials."""
    materials = {name: own.model_copy(update={"poisson_ratio": ratio}) for name, own in scene.materials.items()}
    return scene.model_copy(update={"materials": frozendict(materials)})


def claimed_ratios(scene: Scene, runs: BudgetRuns, budgets: Sequence[Budget]) -> tuple[ClaimedRatio, ...]:
    """Every claim about the last station; none without shear, or where the materials' ratios are not one."""
    own = {material.poisson_ratio for material in scene.materials.values()}
    if runs.kinematics != "shear" or len(own) != 1:
        return ()
    found = (_claimed(scene, runs, budget, own.copy().pop()) for budget in last_budgets(scene, budgets))
    return tuple(each for each in found if each is not None)


def last_budgets(scene: Scene, budgets: Sequence[Budget]) -> tuple[Budget, ...]:
    """The budgets of the last station of the last stage."""
    last = scene.stages[-1]
    return tuple(each for each in budgets if each.row.stage == last.name and each.row.station == last.stations[-1])


def rerun(found: ClaimedRatio, answers: Sequence[Answer]) -> ClaimedRatio:
    """The claim with what the finite elements' ``answers`` at its ratios, in their order, make of our difference."""
    row = found.budget.row
    reruns = tuple(
        _difference(row, station_of(each, row.stage, row.station).values[row.probe.name]) if each.completed else None
        for each in answers
    )
    return replace(found, reruns=reruns)


def _claimed(scene: Scene, runs: BudgetRuns, budget: Budget, own: float) -> ClaimedRatio | None:
    row = budget.row
    claim = claim_of(scene, row)
    if claim is None or claim.value is not None or row.probe.quantity in STRESSES:
        return None
    tightest = (runs.fea[theory][0] for theory in ("shear", "stretch"))
    shear, stretch = (station_of(each, row.stage, row.station).values[row.probe.name] for each in tightest)
    g = shear - stretch

    def difference(ratio: float) -> float:
        return _difference(row, row.fea + g * ((1.0 + ratio) / (1.0 + own) - 1.0))

    grid = np.linspace(*BOUNDS, _INTERVALS + 1)
    beyond = np.array([difference(ratio) - claim.bound for ratio in grid])
    ratios = tuple(
        float(brentq(lambda ratio: difference(ratio) - claim.bound, grid[i], grid[i + 1], xtol=1e-12))
        for i in np.flatnonzero(beyond[:-1] * beyond[1:] < 0.0)
    )
    return ClaimedRatio(claim, budget, difference(BOUNDS[0]), difference(BOUNDS[1]), ratios)


def _difference(row: Row, fea: Array) -> float:
    """The row's difference as a claim takes it, with another value of the finite elements'.

    Raises:
        ValueError: nothing to take a fraction of.
    """
    found = claim_difference(
        replace(
            row,
            fea=fea,
            difference=norm(row.probe.quantity, row.cprbm - fea),
            denominator=denominator(row.probe, norm(row.probe.quantity, fea), row.scale),
        )
    )
    if found is None:
        raise ValueError(f"{row.probe.name} has nothing to measure a difference by")
    return found
