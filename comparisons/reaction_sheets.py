"""Tables of drives' reactions: the multiplier, the work–energy reaction and the finite elements' reaction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from comparisons.case import Comparison
from comparisons.display_units import at_station, display_unit
from comparisons.formats import number, percent
from comparisons.reactions import MESH_ALLOWANCE, PERTURBATION, WorkEnergyReaction, is_long
from comparisons.sheet import Sheet
from comparisons.thinning import kept
from cprbm_scene import Scene

_HEADERS = ("station", "multiplier", "work–energy", "from it", "FEA", "multiplier from it", "no value because")


def of_reactions(compared: Comparison) -> tuple[Sheet, ...]:
    """The table of every moved drive, with a row for every perturbed station."""
    run = compared.runs.perturbed
    ended = "" if run is None or run.completed else f" The perturbed run ended early: {run.ending.value}."
    return tuple(_sheet(compared.scene, drive, found, ended) for drive, found in by_drive(compared.reactions).items())


def by_drive(found: Sequence[WorkEnergyReaction]) -> dict[str, tuple[WorkEnergyReaction, ...]]:
    """The reactions of every drive, in the order of stages and stations."""
    drives = dict.fromkeys(reaction.drive for reaction in found)
    return {drive: tuple(reaction for reaction in found if reaction.drive == drive) for drive in drives}


def summary(scene: Scene, found: Sequence[WorkEnergyReaction]) -> str:
    """How many stations are within the allowance, the largest difference, the stated errors, and absent values."""
    known = [reaction for reaction in found if reaction.difference is not None]
    beyond = [f"{at_station(scene, at.stage, at.station)} ({percent(at.difference)})" for at in known if at.apart]
    said = f"Work–energy by a central difference with ρ = {percent(PERTURBATION)}: "
    said += f"within the allowance at {len(known) - len(beyond)} of {len(known)} stations."
    said += f" Beyond the allowance: {', '.join(beyond)}." if beyond else ""
    if known:
        worst = max(known, key=lambda reaction: abs(reaction.difference or 0.0))
        truncation = max(reaction.share(reaction.truncation) or 0.0 for reaction in known)
        round_off = max(reaction.share(reaction.round_off) or 0.0 for reaction in known)
        said += f" Largest difference: {percent(worst.difference)} at {at_station(scene, worst.stage, worst.station)}."
        said += f" Truncation is at most {percent(truncation)}, round-off at most {percent(round_off)}."
        said += f" Where contacts are closed, the motion of the mesh is allowed {percent(MESH_ALLOWANCE)} more."
    absent = Counter(reaction.absence for reaction in found if reaction.absence)
    return said + "".join(f" No value at {count} stations: {reason.value}." for reason, count in absent.items())


def _sheet(scene: Scene, drive: str, found: Sequence[WorkEnergyReaction], ended: str) -> Sheet:
    """The table of one drive, of long stages with the shown stations alone."""
    shown = {
        (stage.name, value) for stage in scene.stages for value in (kept(stage) if is_long(stage) else stage.stations)
    }
    factor, unit = display_unit(scene, found[0].unit, max(abs(reaction.multiplier) for reaction in found))
    body = tuple(
        (
            at_station(scene, reaction.stage, reaction.station),
            number(reaction.multiplier / factor, 5),
            "–" if reaction.work_energy is None else number(reaction.work_energy / factor, 5),
            percent(reaction.difference),
            number(reaction.fea / factor, 5),
            percent(reaction.from_fea),
            _reason(reaction),
        )
        for reaction in found
        if (reaction.stage, reaction.station) in shown
    )
    return Sheet(f"Reaction at the drive {drive}, {unit}", _HEADERS, body, summary(scene, found) + ended)


def _reason(reaction: WorkEnergyReaction) -> str:
    """Why a reaction has no work–energy value, with the contacts and stops that change; empty if it has a value."""
    if reaction.absence is None:
        return ""
    return f"{reaction.absence.value}: {', '.join(reaction.changes)}" if reaction.changes else reaction.absence.value
