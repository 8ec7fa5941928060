"""The figure of the paper's Table 1 beside our run times."""

from __future__ import annotations

import numpy as np

from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Figure
from comparisons.studies.table1 import Table


def run_times(table: Table) -> Figure:
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
        return finished(
            figure,
            "table1",
            "Seconds to the last load: ours as medians with the quartiles, and the paper's, on another machine.",
        )
