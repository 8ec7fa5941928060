"""The picture of the readings."""

from __future__ import annotations

import numpy as np

from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture
from comparisons.studies.readings import THEIRS, TOP, Followed, Readings


def jumps_of_readings(found: Readings) -> Picture:
    """Where each variant jumps on the way forwards, a line for each; the paper's angles as a band."""
    ahead = [track for track in found.tracks if track.way == "forwards"]
    with canvas(8.2, 1.4 + 0.24 * len(ahead)) as figure:
        axes = figure.add_subplot()
        axes.axvspan(*np.degrees(THEIRS), color=RED, alpha=0.35, linewidth=0.0, label="the paper's jump")
        for place, track in enumerate(ahead):
            for number, jump in enumerate(track.jumps):
                low, high = np.degrees((jump.before, jump.after))
                axes.plot([low, high], [place, place], "-", color=GREY if number else BLUE, linewidth=4.0)
            for end in track.ends[:1]:
                axes.plot(np.degrees(end.alpha), place, "D", color=RED, markersize=5)
            if not track.jumps:
                axes.plot(TOP, place, ">", color=GREY, markersize=5)
        axes.plot([], [], "D", color=RED, markersize=5, label="the branch ends")
        axes.plot([], [], "-", color=BLUE, linewidth=4.0, label="first jump")
        axes.plot([], [], "-", color=GREY, linewidth=4.0, label="further jumps")
        axes.plot([], [], ">", color=GREY, label="none")
        axes.set_yticks(
            range(len(ahead)),
            [
                track.variant.name
                if isinstance(track.variant, Followed)
                else f"{track.variant.name}; {track.variant.start}"
                for track in ahead
            ],
            fontsize=8.0,
        )
        axes.invert_yaxis()
        axes.set_xlim(0.0, TOP + 1.0)
        axes.set_xlabel("turn of the crank, degrees")
        axes.grid(visible=True, which="major", axis="x", color="#e4e4e4", linewidth=0.6)
        figure.legend(loc="outside upper center", ncols=5, fontsize=8.0)
        return picture(
            figure,
            "readings",
            "Where a beam jumps while the crank turns from 0° to 90°: branches followed with care above, general "
            "optimisers below.",
        )
