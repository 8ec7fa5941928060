"""The picture of the calibration."""

from __future__ import annotations

import numpy as np

from comparisons.present.canvas import GREY, canvas, finished
from comparisons.present.columns import Figure
from comparisons.studies.calibration import Calibration
from comparisons.verdict.calibration import LARGEST_MEDIAN, SOLVERS

_COLOURS = ("#1f5fa8", "#c8321e", "#2c8a4b", "#a05fb4", "#c98a12", "#3aa6a6", "#555555")
_TITLES = {"cprbm": "CPRBM", "fea": "FEA in bending"}


def stated_against_true(found: Calibration) -> Figure:
    """Stated against true errors of every row, a panel for each solver and a colour for each case."""
    with canvas(9.6, 5.2) as figure:
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        both = [(each.true / each.row.scale, each.stated / each.row.scale) for t in found.trials for each in t.held]
        low, high = 0.5 * float(np.min(both)), 2.0 * float(np.max(both))
        for axes, solver in zip(panels, SOLVERS, strict=True):
            for place, name in enumerate(found.cases):
                mine = [each for t in found.of_case(name) for each in t.held if each.solver == solver]
                axes.plot(
                    [each.true / each.row.scale for each in mine],
                    [each.stated / each.row.scale for each in mine],
                    "o",
                    color=_COLOURS[place % len(_COLOURS)],
                    markersize=2.5,
                    alpha=0.6,
                    label=name if solver == SOLVERS[0] else None,
                )
            axes.plot([low, high], [low, high], "-", color="black", linewidth=1.0)
            axes.plot([low, high], [LARGEST_MEDIAN * low, LARGEST_MEDIAN * high], "--", color=GREY, linewidth=1.0)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlim(low, high)
            axes.set_ylim(low, high)
            axes.set_aspect("equal")
            axes.set_title(_TITLES[solver], loc="left")
            axes.set_xlabel("true error / scale")
        panels[0].set_ylabel("stated error / scale")
        figure.legend(loc="outside lower center", ncols=4, markerscale=2.0)
        return finished(
            figure,
            "calibration",
            "Each row's stated error against its true one. On the line they are equal; below it the statement is not "
            "true. Dashed: stated ten times the true one, which the median is not to exceed.",
        )
