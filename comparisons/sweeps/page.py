"""The page of a sweep: headline, failures, figures, and a slider through the curves of all points."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from comparisons.formats import display_unit
from comparisons.present.page import rendered
from comparisons.sweeps.pictures import curve_of, fullest, names_of, pictures
from comparisons.sweeps.running import Sweep
from comparisons.writing import write


def write_page(folder: Path, sweep: Sweep) -> None:
    """Write ``index.html`` and the figures.

    Raises:
        OSError: a file cannot be written.
    """
    drawn = tuple(pictures(sweep))
    for each in drawn:
        write(folder / f"{each.name}.svg", each.svg)
        write(folder / f"{each.name}.png", each.png)
    failed = [
        (_label(sweep, task.point), outcome.ending, outcome.sentence)
        for task, outcome in sweep.points()
        if not outcome.completed
    ]
    context = {
        "sweep": sweep,
        "figures": drawn,
        "failed": failed,
        "family": json.dumps(_family(sweep)).replace("<", "\\u003c"),
    }
    write(folder / "index.html", rendered("sweep.html", context))


def _label(sweep: Sweep, point: Any) -> str:  # noqa: ANN401 - a point
    return ", ".join(axis.text(point[axis.name]) for axis in sweep.axes)


def _family(sweep: Sweep) -> dict[str, Any]:
    """Curves of the first number of the first stage, for the slider."""
    solved = sweep.solved()
    names = names_of(fullest(solved)) if solved else []
    if not names:
        return {"curves": []}
    stage, name = names[0]
    curves = [(task, outcome, curve_of(outcome, stage, name)) for task, outcome in solved]
    ends = [curve[-1] for _, _, curve in curves if curve]
    size, unit = display_unit(sweep.scene, ends[0]["unit"], max(abs(each["value"]) for each in ends))
    step, step_unit = display_unit(sweep.scene, ends[0]["station_unit"], max(abs(each["station"]) for each in ends))
    return {
        "title": f"Stage {stage}: {name}, {unit}, against the load or drive, {step_unit}",
        "curves": [
            {
                "label": f"{_label(sweep, task.point)}: {outcome.ending}",
                "points": [[n["station"] / step, n["value"] / size, n["branch"]] for n in curve],
            }
            for task, outcome, curve in curves
        ],
    }
