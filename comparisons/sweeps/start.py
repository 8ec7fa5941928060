"""Sweeps from Python."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from itertools import product
from pathlib import Path

from comparisons.choices import Choices
from comparisons.pairing import Solvers
from comparisons.sweeps.outcome import Asked
from comparisons.sweeps.points import Axis, chosen_for_check, in_file_units
from comparisons.sweeps.running import Sweep, known_outcomes, run, tasks_of
from comparisons.sweeps.tables import write_tables
from comparisons.sweeps.workers import Workers, workers_on
from cprbm_scene import Scene


def start(
    scene: Scene,
    vary: Mapping[str, Sequence[float]],
    asked: Asked,
    check: int,
    choices: Choices | None,
    executor: Executor | str | None,
    limit: float,
    out: Path | None,
) -> Sweep:
    """The finished sweep; arguments and errors as of :func:`comparisons.sweep`."""
    points = tuple(dict(zip(vary, map(float, values), strict=True)) for values in product(*vary.values()))
    chosen = choices or Choices()
    axes = [Axis(name, min(each), max(each), len(each)) for name, each in vary.items()]
    tasks = tasks_of(scene, points, asked, chosen_for_check(points, axes, check), chosen)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
    sweep = Sweep(scene, in_file_units(scene, axes), tasks, {} if out is None else known_outcomes([out]))
    place = f"local:{os.cpu_count() or 1}" if executor is None else executor
    with workers_on(place) if isinstance(place, str) else nullcontext(Workers(place)) as workers:
        sweep = run(sweep, workers, chosen, Solvers(), limit, out)
    if out is not None:
        write_tables(out, sweep)
    return sweep
