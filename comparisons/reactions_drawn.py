"""A drive's reaction against its displacement or rotation, in the manner of the paper's Fig. 15."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from comparisons.figures import BLUE, GREY, RED, Picture, along_axis, canvas, picture
from comparisons.formats import scaled_unit
from comparisons.measures import LOAD_UNITS
from comparisons.verdict import Comparison
from comparisons.work_energy import Reaction, by_drive
from cprbm_scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def of_comparison(compared: Comparison) -> tuple[Picture, ...]:
    """A figure for each drive that is stepped to two values at least; one alone is told by the table."""
    return tuple(
        _drawn(compared.scene, drive, reactions)
        for drive, reactions in by_drive(compared.reactions).items()
        if len({each.station for each in reactions}) > 1
    )


def _drawn(scene: Scene, drive: str, reactions: Sequence[Reaction]) -> Picture:
    factor, unit = scaled_unit(reactions[0].unit, max(abs(each.multiplier) for each in reactions))
    along = LOAD_UNITS[scene.drives[drive].kind]
    step, step_unit = along_axis(along, max(abs(each.station) for each in reactions))
    what = "moment" if along == "rad" else "force"
    with canvas(6.4, 6.0) as figure:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        for place, branch in enumerate(dict.fromkeys((each.stage, each.branch) for each in reactions)):
            mine = [each for each in reactions if (each.stage, each.branch) == branch]
            _reactions(above, mine, step, factor, first=place == 0)
            _differences(below, mine, step, first=place == 0)
        above.set_ylabel(f"reaction {what}, {unit}")
        above.legend(loc="best")
        within = 100.0 * max(each.within for each in reactions)
        below.axhspan(-within, within, color="#eef2f7", zorder=0)
        below.axhline(0.0, color=GREY, linewidth=0.6)
        below.set_ylabel("relative difference, %")
        below.set_xlabel(f"{drive}, {step_unit}")
        below.legend(loc="best")
        return picture(
            figure,
            f"reaction-{drive}",
            f"Reaction at the drive {drive}. Below: relative differences from the CPRBM's multiplier; the band is "
            f"{within:g} % wide to either side. Rings: within one station of a contact that opens or closes.",
        )


def _reactions(axes: Axes, mine: list[Reaction], step: float, factor: float, *, first: bool) -> None:
    d = [each.station / step for each in mine]
    known = [each for each in mine if each.work_energy is not None]
    axes.plot(d, [each.fea / factor for each in mine], "x", color=RED, markersize=6, label="FEA" if first else None)
    label = "CPRBM, multiplier" if first else None
    axes.plot(d, [each.multiplier / factor for each in mine], "-", color=BLUE, linewidth=1.4, label=label)
    axes.plot(
        [each.station / step for each in known],
        [(each.work_energy or 0.0) / factor for each in known],
        "o",
        color=BLUE,
        markersize=4.5,
        markerfacecolor="none",
        label="CPRBM, work–energy" if first else None,
    )


def _differences(axes: Axes, mine: list[Reaction], step: float, *, first: bool) -> None:
    fea = [(each.station / step, -100.0 * each.from_fea) for each in mine if each.from_fea is not None]
    own = [(each.station / step, 100.0 * each.difference) for each in mine if each.difference is not None]
    near = [
        (each.station / step, 100.0 * each.difference) for each in mine if each.difference is not None and each.changes
    ]
    for points, marker, colour, label in ((fea, "x", RED, "FEA"), (own, ".", BLUE, "work–energy")):
        if points:
            d, differences = zip(*points, strict=True)
            axes.plot(d, differences, marker, color=colour, label=label if first else None)
    if near:
        d, differences = zip(*near, strict=True)
        axes.plot(d, differences, "o", color=BLUE, markersize=9, markerfacecolor="none")
