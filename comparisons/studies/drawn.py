"""The studies' figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture
from comparisons.studies.materials import MATERIALS, Materials, Sweep, Tested
from comparisons.studies.table1 import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def error_against_ratio(found: Materials) -> Picture:
    """Displacement errors against Poisson's ratio, a panel for each case; the materials as marks on the lines."""
    with canvas(7.2, 3.4 * len(found.sweeps)) as figure:
        panels = figure.subplots(len(found.sweeps), 1, squeeze=False)[:, 0]
        for axes, sweep in zip(panels, found.sweeps, strict=True):
            tested = [each for each in found.tested if each.specimen == sweep.specimen]
            for (probe, errors), colour, up in zip(sweep.errors.items(), (BLUE, RED), (-14, 6), strict=False):
                _line(axes, sweep, probe, errors, colour)
                _marks(axes, tested, probe, colour, up)
            bound = 100.0 * sweep.specimen.bound
            axes.axhline(bound, color=GREY, linewidth=1.0, linestyle=":", label=f"claimed, {bound:g} %")
            axes.set_ylim(bottom=0.0)
            axes.set_title(sweep.specimen.case, loc="left")
            axes.set_ylabel("displacement error, %")
            axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        panels[-1].set_xlabel("Poisson's ratio ν")
        return picture(
            figure,
            "materials",
            "Error of the CPRBM beside the finite elements in shear against Poisson's ratio; dashed beside those in "
            "stretch, dash-dotted in bending. Dotted: the source's bound for every material. Rings, by their initials: "
            f"{', '.join(MATERIALS)}, at loads in the ratio of their moduli.",
        )


def run_times(table: Table) -> Picture:
    """Our median times with their quartiles and the paper's, a line for each cell."""
    cells = list(table.times)
    with canvas(7.2, 1.2 + 0.26 * len(cells)) as figure:
        axes = figure.add_subplot()
        for place, cell in enumerate(cells):
            times = table.times[cell]
            if times.seconds:
                low, middle, high = np.percentile(times.seconds, (25.0, 50.0, 75.0))
                bars = [[middle - low], [high - middle]]
                axes.errorbar(middle, place, xerr=bars, fmt="o", color=BLUE, markersize=5, capsize=3)
            if cell.theirs is not None:
                axes.plot(cell.theirs, place, "x", color=RED, markersize=6)
        axes.plot([], [], "o", color=BLUE, label="ours")
        axes.plot([], [], "x", color=RED, label="the paper's")
        axes.set_yticks(range(len(cells)), [f"{cell.case}, {cell.label}, {cell.sized}" for cell in cells])
        axes.invert_yaxis()
        axes.set_xscale("log")
        axes.grid(visible=True, which="major", axis="x", color="#e4e4e4", linewidth=0.6)
        axes.set_xlabel("seconds")
        figure.legend(loc="outside upper right", ncols=2)
        return picture(
            figure,
            "table1",
            "Seconds to the last load: ours as medians with the quartiles, and the paper's, on another machine.",
        )


def _line(axes: Axes, sweep: Sweep, probe: str, errors: tuple[float | None, ...], colour: str) -> None:
    known = [(ratio, 100.0 * e) for ratio, e in zip(sweep.poisson_ratios, errors, strict=True) if e is not None]
    if known:
        ratios, percents = zip(*known, strict=True)
        axes.plot(ratios, percents, "-", color=colour, linewidth=1.6, label=f"{probe.partition('.')[0]}, shear")
    for error, style in zip(sweep.without_shear[probe].values(), ("-.", "--"), strict=True):
        if error is not None:
            axes.axhline(100.0 * error, color=colour, linewidth=0.9, linestyle=style)


def _marks(axes: Axes, tested: list[Tested], probe: str, colour: str, up: int) -> None:
    """The materials on a probe's line, their initials so many points above it."""
    for each in tested:
        error = each.error(probe, "shear", finer=True)
        if error is not None:
            place = (each.properties.poisson_ratio, 100.0 * error)
            axes.plot(*place, "o", color=colour, markerfacecolor="none")
            axes.annotate(
                each.material[0], place, textcoords="offset points", xytext=(0, up), ha="center", color=colour
            )
