"""Figures of a drive's reaction against its displacement or rotation, in the manner of the paper's Fig. 15."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from comparisons.case import Comparison
from comparisons.display_units import axis_unit, display_unit
from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture
from comparisons.quantities import LOAD_UNITS
from comparisons.reaction_sheets import by_drive
from comparisons.reactions import MESH_ALLOWANCE, WorkEnergyReaction
from cprbm_scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def of_comparison(compared: Comparison) -> tuple[Picture, ...]:
    """A figure for every drive with two stations at least; the table suffices for a single station."""
    return tuple(
        _drawn(compared.scene, drive, reactions)
        for drive, reactions in by_drive(compared.reactions).items()
        if len({reaction.station for reaction in reactions}) > 1
    )


def _drawn(scene: Scene, drive: str, reactions: Sequence[WorkEnergyReaction]) -> Picture:
    """The figure of one drive: reactions above, relative differences below."""
    factor, unit = display_unit(scene, reactions[0].unit, max(abs(reaction.multiplier) for reaction in reactions))
    load_unit = LOAD_UNITS[scene.drives[drive].kind]
    step, step_unit = axis_unit(scene, load_unit, max(abs(reaction.station) for reaction in reactions))
    what = "moment" if load_unit == "rad" else "force"
    with canvas(6.4, 6.0) as figure:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for place, branch in enumerate(dict.fromkeys((reaction.stage, reaction.branch) for reaction in reactions)):
            mine = [reaction for reaction in reactions if (reaction.stage, reaction.branch) == branch]
            _reactions(above, mine, step, factor, first=place == 0)
            _differences(below, mine, step, first=place == 0)
        above.set_ylabel(f"reaction {what}, {unit}")
        above.legend(loc="best")
        band = 100.0 * MESH_ALLOWANCE
        below.axhspan(-band, band, color="#eef2f7", zorder=0)
        below.axhline(0.0, color=GREY, linewidth=0.6)
        below.set_ylabel("relative difference, %")
        below.set_xlabel(f"{drive}, {step_unit}")
        below.legend(loc="best")
        return picture(
            figure,
            f"reaction-{drive}",
            f"Reaction at the drive {drive}. Below: relative differences from the CPRBM's multiplier. The band of "
            f"{band:g} % to either side is the allowance for the motion of the mesh where contacts are closed. "
            "Stations beside an event have no work–energy reaction.",
        )


def _reactions(axes: Axes, mine: Sequence[WorkEnergyReaction], step: float, factor: float, *, first: bool) -> None:
    """Draw the three reactions of one branch; only the first branch has labels."""
    d = [reaction.station / step for reaction in mine]
    own = [(at.station / step, at.work_energy / factor) for at in mine if at.work_energy is not None]
    axes.plot(
        d, [reaction.fea / factor for reaction in mine], "x", color=RED, markersize=6, label="FEA" if first else None
    )
    label = "CPRBM, multiplier" if first else None
    axes.plot(d, [reaction.multiplier / factor for reaction in mine], "-", color=BLUE, linewidth=1.4, label=label)
    axes.plot(
        [station for station, _ in own],
        [value for _, value in own],
        "o",
        color=BLUE,
        markersize=4.5,
        markerfacecolor="none",
        label="CPRBM, work–energy" if first else None,
    )


def _differences(axes: Axes, mine: Sequence[WorkEnergyReaction], step: float, *, first: bool) -> None:
    """Draw the differences from the CPRBM's multiplier of one branch, in per cent."""
    fea = [(at.station / step, -100.0 * at.from_fea) for at in mine if at.from_fea is not None]
    own = [(at.station / step, 100.0 * at.difference) for at in mine if at.difference is not None]
    for points, marker, colour, label in ((fea, "x", RED, "FEA"), (own, ".", BLUE, "work–energy")):
        axes.plot(
            [station for station, _ in points],
            [value for _, value in points],
            marker,
            color=colour,
            label=label if first else None,
        )
