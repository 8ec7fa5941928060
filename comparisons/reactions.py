"""A drive's reaction from the change of the potential energy: a central difference, eqs. (12) to (15).

==========  ========================================================================================
symbol      meaning
==========  ========================================================================================
d           station of a drive, m or rad
ρ           relative perturbation of a station
h           step: ρ|d|; at d = 0 it is ρ times the largest |d| of the stage
d₁, d₂      perturbed stations d − h and d + h, eqs. (12) and (13)
U, U₁, U₂   potential energy of the CPRBM's equilibrium at d, d₁ and d₂, J
F, F₁, F₂   multiplier of the drive's constraint there: force along the drive, N, or moment, N·m
R           work–energy reaction, N or N·m
ε           residual floor of a station's certificate
n_j         unit directions of the drives of one point
==========  ========================================================================================

**Perturbed scene.** The CPRBM solves the scene once more, at d₁ and d₂ in place of every station d of a drive. A stage
then goes on to its own last station, where the next stage begins. Equilibria without friction do not depend on the
direction of motion, so that d₁ may lie before the d₂ of the last station.  A stage of many even stations needs no
further run: d₁ and d₂ are then its own neighbouring stations.

**Derivative.** An equilibrium at d makes the potential energy Π(q) stationary under the constraint c(q) = d:
∂Π/∂q = F ∂c/∂q.  With U(d) = Π(q(d)), dU/dd = ∂Π/∂q · dq/dd = F ∂c/∂q · dq/dd = F.  The central difference is

    R = (U₂ − U₁)/(2h)                                                                            (14), (15)

**Smooth intervals.** At a jump U falls. Where a contact or a stop changes its state, F has a kink. The difference is
therefore taken only if d₁, d and d₂ are on one branch, with the same contacts and stops, and no critical point was
passed between d₁ and d₂. Elsewhere the answer states the reason for the missing R.

**Truncation.** For a smooth F, R − F = h²F″/6 and F₁ − 2F + F₂ = h²F″, both up to h⁴. A stop without a moment probe may
still cause a kink: the slope of F changes by J at d + ξh, 0 ≤ ξ ≤ 1. Then R − F = Jh(1 − ξ)²/4 and
F₁ − 2F + F₂ = Jh(1 − ξ). A quarter of |F₁ − 2F + F₂| bounds both errors and is the stated truncation error.

**Round-off.** The energies nearly cancel. Their round-off leaves at most (ε₁|U₁| + ε₂|U₂|)/(2h) in R.

**Multiplier.** All drives of a point together exert the force Σ F_j n_j on the point; the F_j follow by least squares.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from comparisons.quantities import VANISHING, stage_of
from comparisons.stations import find_station, kept, station_of
from cprbm_scene import Answer, DisplacementDrive, Drive, Probe, Scene, Stage, StationAnswer
from cprbm_scene.curves import unit_vector as unit

PERTURBATION = 2e-3
"""ρ of section 2.4 of the paper."""

MESH_ALLOWANCE = 1e-3
"""Allowed difference of R from F besides truncation and round-off where contacts are closed, a fraction.

Element borders follow the ends of contact zones. The energy of a moving mesh changes with the mesh as well, by a part
of the discretisation error, while F is the derivative on a fixed mesh. The value is a fifth of the paper's 0.5 % claim.
"""

EQUILIBRIUM_ALLOWANCE = 1e-6
"""The same allowance without closed contacts.

The mesh is fixed, and only the equilibria's convergence is left. The built-in cases need less than 1e-9; the rest is
a margin for an F that is small beside the other forces.
"""

MOST_PERTURBED = 40
"""Stations of a stage, the count of the paper's driven gripper, up to which every station is perturbed.

In a longer stage the neighbouring stations serve, where the energy is a probe of the scene and the steps are equal.
"""

EVEN = 1e-6
"""Largest difference of two neighbouring steps that are equal, a share of the step."""

ENERGY = Probe(of="scene", quantity="potential_energy")

_STATE = ("reaction", "reaction_moment", "moment")
"""Quantities of the perturbed states: multipliers of drives, and moments of stops."""


class Absence(Enum):
    """Why a station has no work–energy reaction; the value states the reason in tables."""

    NOT_PERTURBED = "no even neighbours in a long stage"
    NOT_REACHED = "perturbed stations not reached"
    BRANCH = "change of branch"
    CRITICAL_POINT = "critical point passed"
    CONTACT = "contact or stop changes"


@dataclass(frozen=True, slots=True)
class WorkEnergyReaction:
    """A drive's reaction at a station, in ``unit``; positive along the drive.

    Attributes:
        stage: name of the stage.
        station: d, m or rad.
        drive: name of the drive.
        unit: N or N·m.
        branch: number of the CPRBM's branch at the station.
        multiplier: F of the CPRBM.
        fea: F of the finite elements.
        scale: divisor of differences: \\|F\\|, or the stage's largest \\|F\\| where F vanishes.
        touches: whether contacts are closed at the station.
        work_energy: R; None on an interval from d − h to d + h with an event, or without a state at an end.
        truncation: bound of the truncation error of R, in ``unit``; 0 without R.
        round_off: bound of the round-off of R, in ``unit``; 0 without R.
        changes: contacts and stops that are active in some states of the interval, but not in all.
        absence: the reason for a missing R.
    """

    stage: str
    station: float
    drive: str
    unit: str
    branch: int
    multiplier: float
    fea: float
    scale: float
    touches: bool
    work_energy: float | None = None
    truncation: float = 0.0
    round_off: float = 0.0
    changes: tuple[str, ...] = ()
    absence: Absence | None = None

    @property
    def difference(self) -> float | None:
        """R less the multiplier, a fraction with its sign; None without R or a scale."""
        return None if self.work_energy is None else self.share(self.work_energy - self.multiplier)

    @property
    def from_fea(self) -> float | None:
        """The multiplier less the finite elements', a fraction with its sign; None without a scale."""
        return self.share(self.multiplier - self.fea)

    @property
    def allowed(self) -> float:
        """Largest expected magnitude of ``difference``, a fraction."""
        allowance = MESH_ALLOWANCE if self.touches else EQUILIBRIUM_ALLOWANCE
        return allowance + (self.share(self.truncation + self.round_off) or 0.0)

    @property
    def apart(self) -> bool:
        """Whether R and the multiplier differ by more than allowed."""
        return self.difference is not None and abs(self.difference) > self.allowed

    def share(self, value: float) -> float | None:
        """``value`` as a fraction of the scale; None without a scale."""
        return value / self.scale if self.scale > 0.0 else None


def reaction_probe(drive: Drive) -> Probe:
    """The probe of a drive's force or moment."""
    return (
        Probe(of=drive.point, quantity="reaction")
        if isinstance(drive, DisplacementDrive)
        else Probe(of=drive.body, quantity="reaction_moment")
    )


def perturbed_scene(scene: Scene) -> Scene | None:
    """The scene at d − h and d + h in place of a drive's stations; None where no stage needs further stations.

    Stages of loads and of other drives keep their stations, and long stages the stations that tables show.
    """
    perturbed = [stage for stage in scene.stages if _has_reaction(scene, stage) and not is_long(stage)]
    if not perturbed:
        return None
    stations = {stage.name: kept(stage) if is_long(stage) else stage.stations for stage in scene.stages}
    for stage in perturbed:
        ends = (end for d, h in _steps(stage).items() for end in (d - h, d + h))
        stations[stage.name] = (*ends, stage.stations[-1])
    stages = tuple(stage.model_copy(update={"stations": stations[stage.name]}) for stage in scene.stages)
    probes = (ENERGY, *(probe for probe in scene.probes if probe.quantity in _STATE))
    return scene.model_copy(update={"stages": stages, "probes": probes, "claims": ()})


def reactions(scene: Scene, cprbm: Answer, fea: Answer, perturbed: Answer | None) -> tuple[WorkEnergyReaction, ...]:
    """The reaction of every drive with a reaction probe, at every station of the stages that move the drive.

    Args:
        scene: the question.
        cprbm: a whole answer of the CPRBM.
        fea: a whole answer of the finite elements.
        perturbed: the CPRBM's answer to :func:`perturbed_scene`; stations may be missing, or all of it.

    Raises:
        KeyError: ``cprbm`` or ``fea`` lacks a station or a probe.
    """
    found = []
    for stage in (stage for stage in scene.stages if _has_reaction(scene, stage)):
        beside = cprbm if is_long(stage) else perturbed
        probes = {probe.name for probe in scene.probes_in(stage.name)}
        steps = {} if is_long(stage) and ENERGY.name not in probes else _steps(stage)
        ends = [point.end for answer in (cprbm, beside) if answer is not None for point in answer.gone_over]
        passed = [end.value for end in ends if end.stage == stage.name]
        forces = [multiplier(scene, stage, station_of(cprbm, stage.name, d)) for d in stage.stations]
        largest = max(map(abs, forces))
        for d, F in zip(stage.stations, forces, strict=True):
            here = station_of(cprbm, stage.name, d)
            row = WorkEnergyReaction(
                stage=stage.name,
                station=here.value,
                drive=stage.steps,
                unit="N" if isinstance(scene.drives[stage.steps], DisplacementDrive) else "N·m",
                branch=here.branch,
                multiplier=F,
                fea=multiplier(scene, stage, station_of(fea, stage.name, d)),
                scale=abs(F) if abs(F) >= VANISHING * largest else largest,
                touches=bool(here.touching),
            )
            found.append(_with_work_energy(scene, row, here, beside, steps.get(d), passed))
    return tuple(found)


def _with_work_energy(
    scene: Scene,
    row: WorkEnergyReaction,
    here: StationAnswer,
    beside: Answer | None,
    h: float | None,
    passed: Sequence[float],
) -> WorkEnergyReaction:
    """The row with R, or with the reason for its absence.

    Args:
        scene, row: the question, and the row of a station d.
        here: the state at d.
        beside: the answer with the states at d − h and d + h, if any.
        h: the step; None where the station is not perturbed.
        passed: loads of passed critical points.
    """
    if beside is None or h is None:
        return replace(row, absence=Absence.NOT_PERTURBED)
    before, after = (find_station(beside, row.stage, row.station + step) for step in (-h, h))
    if before is None or after is None:
        return replace(row, absence=Absence.NOT_REACHED)
    states, stage = (before, here, after), stage_of(scene, row.stage)
    active = [_active(scene, state) for state in states]
    changes = tuple(sorted(frozenset.union(*active) - frozenset.intersection(*active)))
    events = {
        Absence.BRANCH: len({state.branch for state in states}) > 1,
        Absence.CRITICAL_POINT: any(before.value <= value <= after.value for value in passed),
        Absence.CONTACT: bool(changes),
    }
    if any(events.values()):
        return replace(row, changes=changes, absence=next(event for event, met in events.items() if met))
    U1, U2 = (float(state.values[ENERGY.name][0]) for state in (before, after))
    F1, F, F2 = (multiplier(scene, stage, state) for state in states)
    width = after.value - before.value
    left = before.certificate.residual_floor * abs(U1) + after.certificate.residual_floor * abs(U2)
    return replace(row, work_energy=(U2 - U1) / width, truncation=abs(F1 - 2.0 * F + F2) / 4.0, round_off=left / width)


def multiplier(scene: Scene, stage: Stage, station: StationAnswer) -> float:
    """F of the drive that a stage moves: a force along the drive in N, or a moment in N·m.

    Raises:
        KeyError: the station lacks the drive's reaction.
    """
    drive = scene.drives[stage.steps]
    values = station.values[reaction_probe(drive).name]
    if not isinstance(drive, DisplacementDrive):
        return float(values[0])
    directions = {
        name: unit(other.direction)
        for name, other in scene.drives.items()
        if isinstance(other, DisplacementDrive) and other.point == drive.point
    }
    F = np.linalg.lstsq(np.stack(list(directions.values()), axis=1), values)[0]
    return float(F[list(directions).index(stage.steps)])


def by_drive(found: Sequence[WorkEnergyReaction]) -> dict[str, tuple[WorkEnergyReaction, ...]]:
    """The reactions of every drive, in the order of stages and stations."""
    drives = dict.fromkeys(reaction.drive for reaction in found)
    return {drive: tuple(reaction for reaction in found if reaction.drive == drive) for drive in drives}


def _has_reaction(scene: Scene, stage: Stage) -> bool:
    """Whether a stage moves a drive whose reaction is a probe of the scene."""
    drive = scene.drives.get(stage.steps) if any(stage.stations) else None
    return drive is not None and reaction_probe(drive).name in {probe.name for probe in scene.probes_in(stage.name)}


def _steps(stage: Stage) -> dict[float, float]:
    """h by d; of a long stage at the stations between two equal steps."""
    if is_long(stage):
        between = zip(stage.stations, stage.stations[1:], stage.stations[2:], strict=False)
        return {
            d: abs(after - d) for before, d, after in between if abs(after - 2.0 * d + before) <= EVEN * abs(after - d)
        }
    largest = max(map(abs, stage.stations))
    return {d: PERTURBATION * (abs(d) or largest) for d in stage.stations}


def is_long(stage: Stage) -> bool:
    """Whether a stage's own neighbouring stations serve as perturbed stations."""
    return len(stage.stations) > MOST_PERTURBED


def _active(scene: Scene, station: StationAnswer) -> frozenset[str]:
    """The closed contacts, and the holding stops among the stops with a moment probe."""
    moments = {probe.of: station.values[probe.name] for probe in scene.probes if probe.quantity == "moment"}
    return frozenset(station.touching) | {name for name, moment in moments.items() if moment.any()}
