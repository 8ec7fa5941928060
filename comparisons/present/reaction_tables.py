"""Tables of drives' reactions: the multiplier, the work–energy reaction and the finite elements' reaction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from comparisons.case import Comparison
from comparisons.display_units import at_station, display_unit
from comparisons.formats import number, percent
from comparisons.present.columns import Column, Table, table_of
from comparisons.reactions import MESH_ALLOWANCE, PERTURBATION, WorkEnergyReaction, is_long
from comparisons.thinning import kept
from cprbm_scene import Scene


def reaction_tables(compared: Comparison) -> tuple[Table, ...]:
    """The table of every moved drive, with a row for every perturbed station, or the shown stations of a long stage."""
    return tuple(_table(compared, drive, found) for drive, found in by_drive(compared.reactions).items())


def _table(compared: Comparison, drive: str, found: Sequence[WorkEnergyReaction]) -> Table:
    scene, run = compared.scene, compared.runs.perturbed
    shown = {
        (stage.name, value) for stage in scene.stages for value in (kept(stage) if is_long(stage) else stage.stations)
    }
    factor, unit = display_unit(scene, found[0].unit, max(abs(each.multiplier) for each in found))
    columns = [
        Column[WorkEnergyReaction]("station", lambda at: at_station(scene, at.stage, at.station)),
        Column("multiplier", lambda at: number(at.multiplier / factor, 5)),
        Column("work–energy", lambda at: None if at.work_energy is None else number(at.work_energy / factor, 5)),
        Column("from it", lambda at: percent(at.difference)),
        Column("FEA", lambda at: number(at.fea / factor, 5)),
        Column("multiplier from it", lambda at: percent(at.from_fea)),
        Column("no value because", _reason),
    ]
    rows = [each for each in found if (each.stage, each.station) in shown]
    ended = "" if run is None or run.completed else f" The perturbed run ended early: {run.ending.value}."
    return table_of(f"Reaction at the drive {drive}, {unit}", columns, rows, summary(scene, found) + ended)


def by_drive(found: Sequence[WorkEnergyReaction]) -> dict[str, tuple[WorkEnergyReaction, ...]]:
    """The reactions of every drive, in the order of stages and stations."""
    drives = dict.fromkeys(reaction.drive for reaction in found)
    return {drive: tuple(reaction for reaction in found if reaction.drive == drive) for drive in drives}


def summary(scene: Scene, found: Sequence[WorkEnergyReaction]) -> str:
    """Number of stations within the allowance, largest difference, stated errors, and absent values."""
    known = [reaction for reaction in found if reaction.difference is not None]
    beyond = [f"{at_station(scene, at.stage, at.station)} ({percent(at.difference)})" for at in known if at.apart]
    text = f"Work–energy by a central difference with ρ = {percent(PERTURBATION)}: within the allowance at "
    text += f"{len(known) - len(beyond)} of {len(known)} stations."
    text += f" Beyond the allowance: {', '.join(beyond)}." if beyond else ""
    if known:
        worst = max(known, key=lambda reaction: abs(reaction.difference or 0.0))
        truncation, round_off = (
            percent(max(reaction.share(getattr(reaction, size)) or 0.0 for reaction in known))
            for size in ("truncation", "round_off")
        )
        text += (
            f" Largest difference: {percent(worst.difference)} at {at_station(scene, worst.stage, worst.station)}. "
            f"Truncation is at most {truncation}, round-off at most {round_off}. Where contacts are closed, the motion "
            f"of the mesh is allowed {percent(MESH_ALLOWANCE)} more."
        )
    absent = Counter(reaction.absence for reaction in found if reaction.absence)
    return text + "".join(f" No value at {count} stations: {reason.value}." for reason, count in absent.items())


def _reason(reaction: WorkEnergyReaction) -> str:
    """Cause of a missing value, with the contacts and stops that change; empty for a reaction with a value."""
    if reaction.absence is None:
        return ""
    return f"{reaction.absence.value}: {', '.join(reaction.changes)}" if reaction.changes else reaction.absence.value
