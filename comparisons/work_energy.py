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
stations, or between them and d, there is no such derivative.  The central difference leaves ρ²d²F″/6, a few
millionths of F where F is smooth; where a contact opens or closes F has a kink, and nothing is said of it there.

The energies nearly cancel.  What round-off leaves of their difference is at most the floor of the certificates'
residuals times the energy, over 2ρd; it is stated beside each number as a share of F.  (What an equilibrium leaves
unsettled in the state counts twice: the energy is stationary there.)

The force at a driven point is that of all its drives, Σ F_j n_j; the F_j follow from it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from comparisons.formats import percent
from comparisons.measures import UNITS
from comparisons.nearby import ENERGY, RHO, is_asked, reaction_of, visited
from comparisons.scales import VANISHING
from comparisons.stations import station_of
from scene import Answer, Scene, Stage, StationAnswer
from scene.freedoms import unit
from scene.statement import DisplacementDrive

WITHIN = 1e-3
"""How far the two reactions of one solver may be apart, away from a contact that opens or closes."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """A drive's reaction at a station, in ``unit``; positive along the drive.

    Attributes:
        multiplier: the CPRBM's, as the multiplier of what the drive prescribes.
        work_energy: the same from its energies; None where the run beside the station has not reached it.
        fea: the finite elements'.
        scale: what differences are divided by: the multiplier's magnitude, or the stage's largest where that vanishes.
        floor: what round-off may leave of ``work_energy``, in ``unit``.
        changes: contacts that open or close, and stops that take hold or let go, between the two stations next to this
            one.
        branch: the branch that the CPRBM is on here.
        jumped: whether one of the runs beside the station is on another branch; there is no ``work_energy`` then.
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
        return self.difference is not None and abs(self.difference) > WITHIN

    def _share(self, value: float) -> float | None:
        return value / self.scale if self.scale > 0.0 else None


def reactions(scene: Scene, cprbm: Answer, fea: Answer, near: Answer) -> tuple[Reaction, ...]:
    """The reaction of every drive that a stage steps, at every station but zero.

    Args:
        scene: the question.
        cprbm: a whole answer to it.
        fea: another.
        near: the CPRBM's answer to :func:`comparisons.nearby.nearby`, as far as it came.

    Raises:
        KeyError: ``cprbm`` or ``fea`` lacks a station or a probe.
    """
    found: list[Reaction] = []
    place = 0
    closed = _closed(scene, cprbm)
    for stage in scene.stages:
        asked = is_asked(scene, stage)
        largest = (
            max(abs(along(scene, stage, station_of(cprbm, stage.name, d))) for d in stage.stations) if asked else 0.0
        )
        for d in stage.stations:
            values = visited(d) if asked else (d,)
            beside = near.stations[place : place + len(values)]
            place += len(values)
            if not asked or d == 0.0:
                continue
            here = station_of(cprbm, stage.name, d)
            F = along(scene, stage, here)
            jumped = any(station.branch != here.branch for station in beside)
            found.append(
                Reaction(
                    stage=stage.name,
                    station=d,
                    drive=stage.steps,
                    unit=UNITS[reaction_of(scene.drives[stage.steps]).quantity],
                    multiplier=F,
                    work_energy=None if jumped else _work_energy(d, values, beside),
                    fea=along(scene, stage, station_of(fea, stage.name, d)),
                    scale=abs(F) if abs(F) >= VANISHING * largest else largest,
                    floor=_floor(d, beside),
                    changes=_changes(closed, (stage.name, d), beside),
                    branch=here.branch,
                    jumped=jumped,
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
    known = [each for each in found if each.difference is not None]
    away = [each for each in known if not each.changes]
    near = [each for each in known if each.changes]
    said = f"Work–energy with ρ = {percent(RHO)}: within {percent(WITHIN)} of the multiplier at "
    said += f"{sum(not each.apart for each in away)} of {len(away)} stations away from a contact that opens or closes, "
    said += f"and at {sum(not each.apart for each in near)} of {len(near)} within one station of one."
    apart = [f"{each.stage} {each.station:g} ({percent(each.difference)})" for each in known if each.apart]
    if apart:
        said += f" Further apart: {', '.join(apart)}."
    floor = max((each.floor / each.scale for each in known if each.scale > 0.0), default=0.0)
    said += f" Round-off of the energies leaves at most {percent(floor)}."
    said += "".join(_on_branch(branch, known) for branch in dict.fromkeys((each.stage, each.branch) for each in known))
    jumped = sum(each.jumped for each in found)
    missing = len(found) - len(known) - jumped
    if jumped:
        said += f" At {jumped} stations the run beside is on another branch, and no derivative is taken across a jump."
    return said + (f" {missing} stations were not reached by the run beside them." if missing else "")


def _on_branch(branch: tuple[str, int], known: list[Reaction]) -> str:
    """The largest difference on one branch, away from contacts that change; nothing where all are beside one."""
    mine = [each for each in known if (each.stage, each.branch) == branch and not each.changes]
    if not mine:
        return ""
    worst = max(mine, key=lambda each: abs(each.difference or 0.0))
    where = branch[0] if branch[1] == 0 else f"{branch[0]}, branch {branch[1]}"
    return f" Largest in {where}: {percent(abs(worst.difference or 0.0))} at {worst.station:g}."


def _work_energy(d: float, values: tuple[float, ...], beside: tuple[StationAnswer, ...]) -> float | None:
    """(PE2 − PE1)/(2ρd); None where one of the two stations is missing."""
    if len(beside) < 2 or not all(
        math.isclose(station.value, value, rel_tol=1e-12) for station, value in zip(beside, values, strict=False)
    ):
        return None
    PE1, PE2 = (_energy(station) for station in beside[:2])
    F = (PE2 - PE1) / (2.0 * RHO * d)
    return F if math.isfinite(F) else None


def _floor(d: float, beside: tuple[StationAnswer, ...]) -> float:
    return max(
        (station.certificate.residual_floor * abs(_energy(station)) / abs(2.0 * RHO * d) for station in beside[:2]),
        default=0.0,
    )


def _energy(station: StationAnswer) -> float:
    return float(station.values[ENERGY.name][0])


@dataclass(frozen=True, slots=True)
class _Held:
    """Which contacts are closed at a station and, of those that are asked for, which stops hold."""

    at: tuple[str, float]
    contacts: frozenset[str]
    stops: frozenset[str]


def _closed(scene: Scene, answer: Answer) -> list[_Held]:
    """Every station in order."""
    moments = {probe.of: probe.name for probe in scene.probes if probe.quantity == "moment"}
    found = []
    for stage in scene.stages:
        for d in stage.stations:
            station = station_of(answer, stage.name, d)
            stops = frozenset(stop for stop, moment in moments.items() if station.values[moment].any())
            found.append(_Held((stage.name, d), frozenset(station.touching), stops))
    return found


def _changes(closed: list[_Held], at: tuple[str, float], beside: tuple[StationAnswer, ...]) -> tuple[str, ...]:
    """Contacts and stops that are not in one state from the station before to the one after, and close round this one.

    Before the first station nothing is loaded, and no contact presses.
    """
    here = next(place for place, each in enumerate(closed) if each.at == at)
    nothing = frozenset[str]()
    around = [closed[here - 1] if here > 0 else _Held(at, nothing, nothing), *closed[here : here + 2]]
    contacts = [*(each.contacts for each in around), *(frozenset(station.touching) for station in beside)]
    stops = [each.stops for each in around]
    changing = [frozenset.union(*states) - frozenset.intersection(*states) for states in (contacts, stops)]
    return tuple(sorted(frozenset.union(*changing)))
