"""A drive's reaction from the change of the potential energy, beside the multiplier and the finite elements.

==========  ===================================================================================================
symbol      meaning
==========  ===================================================================================================
d, ρ        a station of a drive, and how far the two beside it are, as a share of d
PE1, PE2    the CPRBM's potential energy at d(1 − ρ) and d(1 + ρ), eqs. (12) and (13)
F           the drive's force along its direction, or its moment, as the multiplier of what it prescribes
n_j         unit directions of the drives of one point
==========  ===================================================================================================

    F = (PE2 − PE1)/(2ρd)                                                                         (14), (15)

A drive's work is in the strain energy alone and the dead loads' work is taken off, so that F is the derivative of
the potential energy with respect to d, other drives and loads kept, along one branch: where a jump lies between the
stations, or between them and d, there is no such derivative.

Where a stage's stations are close together (:func:`comparisons.nearby.is_dense`), their own energies give it, by
polynomials through as many as nine of them (:mod:`comparisons.slopes`) within a stretch: stations that follow each
other on one branch, with the same contacts closed and the same stops holding.  The two reactions are then to be within
1e-4 of each other; what two orders of the derivative are apart is stated beside it.

Elsewhere the CPRBM is run at stations beside d, and eqs. (14), (15) are taken.  The central difference leaves
ρ²d²F″/6, a few millionths of F where F is smooth; where a contact opens or closes F has a kink, and nothing is said of
it there.  Within 1e-3 is asked.

The energies nearly cancel.  What round-off leaves of their difference is at most the floor of the certificates'
residuals times the energy, over 2ρd; it is stated beside each number as a share of F.  (What an equilibrium leaves
unsettled in the state counts twice: the energy is stationary there.)

The force at a driven point is that of all its drives, Σ F_j n_j; the F_j follow from it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from comparisons.formats import percent
from comparisons.held import Held, changes, held, stretches
from comparisons.measures import UNITS
from comparisons.nearby import ENERGY, RHO, is_asked, is_dense, reaction_of, visited
from comparisons.scales import VANISHING
from comparisons.slopes import FEWEST, slope
from comparisons.stations import station_of
from cprbm_scene import Answer, Scene, Stage, StationAnswer
from cprbm_scene.freedoms import unit
from cprbm_scene.statement import DisplacementDrive

WITHIN = 1e-3
"""How far the two reactions of one solver may be apart, away from a contact that opens or closes."""

WITHIN_DENSE = 1e-4
"""The same where the energies at the stations themselves give one of them."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """A drive's reaction at a station, in ``unit``; positive along the drive.

    Attributes:
        multiplier: the CPRBM's, as the multiplier of what the drive prescribes.
        work_energy: the same from its energies; None where the run beside the station has not reached it, or the
            stretch has too few stations.
        fea: the finite elements'.
        scale: what differences are divided by: the multiplier's magnitude, or the stage's largest where that vanishes.
        floor: what round-off may leave of ``work_energy``, in ``unit``.
        changes: contacts that open or close, and stops that take hold or let go, between the two stations next to this
            one.
        branch: the branch that the CPRBM is on here.
        jumped: whether one of the runs beside the station is on another branch, and there is no ``work_energy``; of
            stations that are close together, whether the next or the last one is.
        dense: whether the stations' own energies are taken.
        truncation: how far two orders of ``work_energy`` are apart, in ``unit``; of a run beside the station 0.
    """

    stage: str
    station: float
    drive: str
    unit: str
    multiplier: float
    work_energy: float | None
    fea: float
    scale: float
    floor: float
    changes: tuple[str, ...]
    branch: int = 0
    jumped: bool = False
    dense: bool = False
    truncation: float = 0.0

    @property
    def within(self) -> float:
        """How far the two reactions of the CPRBM may be apart."""
        return WITHIN_DENSE if self.dense else WITHIN

    @property
    def difference(self) -> float | None:
        """Of work–energy from the multiplier, a fraction with its sign."""
        return None if self.work_energy is None else self._share(self.work_energy - self.multiplier)

    @property
    def from_fea(self) -> float | None:
        """Of the multiplier from the finite elements', a fraction with its sign."""
        return self._share(self.multiplier - self.fea)

    @property
    def apart(self) -> bool:
        """Whether the two reactions of the CPRBM are further apart than they may be."""
        return self.difference is not None and abs(self.difference) > self.within

    def _share(self, value: float) -> float | None:
        return value / self.scale if self.scale > 0.0 else None


def reactions(scene: Scene, cprbm: Answer, fea: Answer, near: Answer | None) -> tuple[Reaction, ...]:
    """The reaction of every drive that a stage steps, at every station, but at zero where a run stands beside it.

    Args:
        scene: the question.
        cprbm: a whole answer to it.
        fea: another.
        near: the CPRBM's answer to :func:`comparisons.nearby.nearby`, as far as it came; without it only stages
            whose own stations are close together have reactions.

    Raises:
        KeyError: ``cprbm`` or ``fea`` lacks a station or a probe.
    """
    every = held(scene, cprbm)
    found = []
    for stage in scene.stages:
        if not is_asked(scene, stage):
            continue
        mine = [place for place, each in enumerate(every) if each.station.stage == stage.name]
        forces = {place: along(scene, stage, every[place].station) for place in mine}
        largest = max(map(abs, forces.values()))
        dense = is_dense(scene, stage)
        rates = _of_stations(scene, every, mine) if dense else _of_runs(scene, every, mine, near)
        for place, rate in rates.items():
            here, F = every[place].station, forces[place]
            found.append(
                Reaction(
                    stage=stage.name,
                    station=here.value,
                    drive=stage.steps,
                    unit=UNITS[reaction_of(scene.drives[stage.steps]).quantity],
                    multiplier=F,
                    work_energy=rate.value,
                    fea=along(scene, stage, station_of(fea, stage.name, here.value)),
                    scale=abs(F) if abs(F) >= VANISHING * largest else largest,
                    floor=rate.floor,
                    changes=rate.changes,
                    branch=here.branch,
                    jumped=rate.jumped,
                    dense=dense,
                    truncation=rate.truncation,
                )
            )
    return tuple(found)


def along(scene: Scene, stage: Stage, station: StationAnswer) -> float:
    """The multiplier F of the drive that a stage steps: along its direction in N, or its moment in N·m.

    Raises:
        KeyError: the station lacks the drive's reaction.
    """
    drive = scene.drives[stage.steps]
    values = station.values[reaction_of(drive).name]
    if not isinstance(drive, DisplacementDrive):
        return float(values[0])
    others = {
        name: unit(each.direction)
        for name, each in scene.drives.items()
        if isinstance(each, DisplacementDrive) and each.point == drive.point
    }
    F = np.linalg.lstsq(np.stack(list(others.values()), axis=1), values)[0]
    return float(F[list(others).index(stage.steps)])


def by_drive(found: tuple[Reaction, ...]) -> dict[str, tuple[Reaction, ...]]:
    """The reactions of each drive, in the order of its stages and stations."""
    return {name: tuple(each for each in found if each.drive == name) for name in dict.fromkeys(e.drive for e in found)}


def sentence(found: tuple[Reaction, ...]) -> str:
    """How far the two reactions of the CPRBM are apart, and where they are further apart than they may be."""
    said = [_sentence([each for each in found if each.dense is dense]) for dense in (False, True)]
    return " ".join(each for each in said if each)


def _sentence(found: list[Reaction]) -> str:
    """The same of reactions that are all found in one way; nothing of none."""
    if not found:
        return ""
    known = [each for each in found if each.difference is not None]
    dense, within = found[0].dense, percent(found[0].within)
    if dense:
        met = f"{sum(not each.apart for each in known)} of {len(known)} stations"
        said = f"Work–energy from the stations' own energies: within {within} of the multiplier at {met}."
        truncation = max((each.truncation / each.scale for each in known if each.scale > 0.0), default=0.0)
        said += f" Two orders of the derivative are at most {percent(truncation)} apart."
    else:
        away = [each for each in known if not each.changes]
        near = [each for each in known if each.changes]
        said = f"Work–energy with ρ = {percent(RHO)}: within {within} of the multiplier at "
        said += f"{sum(not each.apart for each in away)} of {len(away)} stations away from a contact that opens or "
        said += f"closes, and at {sum(not each.apart for each in near)} of {len(near)} within one station of one."
    apart = _apart(found)
    if apart:
        said += f" Further apart: {', '.join(apart)}."
    floor = max((each.floor / each.scale for each in known if each.scale > 0.0), default=0.0)
    said += f" Round-off of the energies leaves at most {percent(floor)}."
    said += "".join(_on_branch(branch, known) for branch in dict.fromkeys((each.stage, each.branch) for each in known))
    across = sum(each.work_energy is None and each.jumped for each in found)
    missing = len(found) - len(known) - across
    if across and not dense:
        said += f" At {across} stations the run beside is on another branch, and no derivative is taken across a jump."
    if missing or (across and dense):
        said += (
            f" {missing + across} stations are in stretches of fewer than {FEWEST} between changes."
            if dense
            else f" {missing} stations were not reached by the run beside them."
        )
    return said


def _apart(found: list[Reaction]) -> list[str]:
    """Where the two reactions are further apart than they may be: those that follow each other together."""
    said = []
    for (apart, stage), group in groupby(found, key=lambda each: (each.apart, each.stage)):
        if not apart:
            continue
        mine = list(group)
        worst = max(mine, key=lambda each: abs(each.difference or 0.0))
        if len(mine) == 1:
            said.append(f"{stage} {worst.station:g} ({percent(worst.difference)})")
        else:
            most = f"{len(mine)} stations, at most {percent(abs(worst.difference or 0.0))} at {worst.station:g}"
            said.append(f"{stage} {mine[0].station:g} to {mine[-1].station:g} ({most})")
    return said


def _on_branch(branch: tuple[str, int], known: list[Reaction]) -> str:
    """The largest difference on one branch, where the derivative crosses no change; nothing where all of them do."""
    mine = [each for each in known if (each.stage, each.branch) == branch and (each.dense or not each.changes)]
    if not mine:
        return ""
    worst = max(mine, key=lambda each: abs(each.difference or 0.0))
    where = branch[0] if branch[1] == 0 else f"{branch[0]}, branch {branch[1]}"
    return f" Largest in {where}: {percent(abs(worst.difference or 0.0))} at {worst.station:g}."


@dataclass(frozen=True, slots=True)
class _Rate:
    """The energy's rate at a station; attributes as those of :class:`Reaction`."""

    value: float | None
    floor: float
    changes: tuple[str, ...]
    jumped: bool
    truncation: float = 0.0


def _of_stations(scene: Scene, every: Sequence[Held], mine: Sequence[int]) -> dict[int, _Rate]:
    """By place, of the stations at the places ``mine`` of a stage, from their own energies."""
    rates: dict[int, _Rate] = {}
    for stretch in stretches([every[place] for place in mine]):
        x, PE = (
            np.array(values)
            for values in zip(*((at.station.value, _energy(at.station)) for at in stretch), strict=True)
        )
        rounding = np.array([_left(each.station) for each in stretch])
        for index in range(len(stretch)):
            place = mine[len(rates)]
            found = slope(x, PE, rounding, index)
            around = every[max(place - 1, mine[0]) : min(place + 1, mine[-1]) + 1]
            rates[place] = _Rate(
                value=None if found is None else found.value,
                floor=0.0 if found is None else found.round_off,
                changes=changes(scene, every, place),
                jumped=any(each.station.branch != every[place].station.branch for each in around),
                truncation=0.0 if found is None else found.truncation,
            )
    return rates


def _of_runs(scene: Scene, every: Sequence[Held], mine: Sequence[int], near: Answer | None) -> dict[int, _Rate]:
    """The same from a run at stations close by, eqs. (14) and (15); of no station where there is no such run."""
    if near is None:
        return {}
    rates = {}
    gone_to = [values for stage in scene.stages for values in visited(scene, stage)]
    first = sum(len(values) for values in gone_to[: mine[0]])
    for place, values in zip(mine, gone_to[mine[0] : mine[-1] + 1], strict=True):
        here, beside = every[place].station, near.stations[first : first + len(values)]
        first += len(values)
        if here.value == 0.0:
            continue
        jumped = any(station.branch != here.branch for station in beside)
        rates[place] = _Rate(
            value=None if jumped else _work_energy(here.value, values, beside),
            floor=max((_left(station) / abs(2.0 * RHO * here.value) for station in beside[:2]), default=0.0),
            changes=changes(scene, every, place, beside),
            jumped=jumped,
        )
    return rates


def _work_energy(d: float, values: tuple[float, ...], beside: tuple[StationAnswer, ...]) -> float | None:
    """(PE2 − PE1)/(2ρd); None where one of the two stations is missing."""
    if len(beside) < 2 or not all(
        math.isclose(station.value, value, rel_tol=1e-12) for station, value in zip(beside, values, strict=False)
    ):
        return None
    PE1, PE2 = (_energy(station) for station in beside[:2])
    F = (PE2 - PE1) / (2.0 * RHO * d)
    return F if math.isfinite(F) else None


def _left(station: StationAnswer) -> float:
    """What round-off may leave of a station's energy, J."""
    return station.certificate.residual_floor * abs(_energy(station))


def _energy(station: StationAnswer) -> float:
    return float(station.values[ENERGY.name][0])
