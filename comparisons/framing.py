"""What a figure of a mechanism shows: all of it, unless it has drawn itself together and would be small in that."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cprbm_scene import StationAnswer

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SMALL = 2.0  # as many times larger than the loaded mechanism is a window in which that is small
ROOM = 0.3  # of the loaded mechanism's size, to every side of it


def frame(axes: Axes, loaded: StationAnswer) -> None:
    """Even axes; where the loaded mechanism would be small its surroundings alone, and the rest runs out."""
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    ends = np.array([(each.min(), each.max()) for shape in loaded.shapes.values() for each in (shape.x, shape.y)])
    low, high = ends[:, 0].reshape(-1, 2).min(axis=0), ends[:, 1].reshape(-1, 2).max(axis=0)
    size = float((high - low).max())
    axes.autoscale_view()
    whole = max(np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim()))
    if whole > SMALL * size > 0.0:
        axes.set_aspect("equal", adjustable="box")
        middle, half = (low + high) / 2.0, (0.5 + ROOM) * size
        axes.set_xlim(middle[0] - half, middle[0] + half)
        axes.set_ylim(middle[1] - half, middle[1] + half)
