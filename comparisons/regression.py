"""Regression files: what both solvers answered when a change was last accepted.

They say that something has changed, never that anything is right: the numbers come from the code itself, and
verification is the business of closed forms and of the other solver.  A file changes by one command only,
``cprbm regress CASE --accept REASON --date DATE``, which adds the date and the reason to the file's history.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons import thinning
from comparisons.choices import Choices
from comparisons.criticals import mechanism
from comparisons.documents import Plain, plain, text
from comparisons.pairing import Solvers
from comparisons.soundness import complaints
from comparisons.stations import station_of
from comparisons.writing import write
from cprbm_scene import Answer, Probe, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES

TOLERANCE = 1e-6
"""Of a probe's largest kept value: what another processor's rounding may change, and no change of method."""

_EVERY = 10
"""Of a stress along a beam every tenth place is kept."""

MANY = 40
"""Most stations of a stage that are all solved; of a longer one only those that are kept."""


@dataclass(frozen=True, slots=True)
class Departure:
    """A number that is no longer what the file says."""

    place: str
    kept: object
    found: object

    def __str__(self) -> str:
        return f"{self.place}: the file says {self.kept}, found {self.found}"


def measured(scene: Scene, solvers: Solvers) -> Plain:
    """What a regression file keeps of the answers at standard settings: few stations per stage, and critical values.

    Raises:
        SceneError: a solver refuses the scene.
        RuntimeError: a solver gave no whole answer, which is nothing to keep.
    """
    kept: Plain = {}
    settings: Plain = {}
    asked = _shortened(scene)
    for name, solver in (("cprbm", solvers.cprbm), ("fea", solvers.fea)):
        answer = solver(asked, Choices())
        found = complaints(asked, answer)
        if found:
            raise RuntimeError(f"{name} gave no whole answer: {found[0]}")
        settings[name] = plain(answer.settings)
        kept[name] = _kept(scene, answer)
    return {"case": scene.name, "tolerance": TOLERANCE, "settings": settings, "values": kept}


def departures(file: Path, found: Plain) -> tuple[Departure, ...]:
    """Where fresh numbers depart from a file's.

    Args:
        file: the regression file.
        found: as :func:`measured` makes it.

    Raises:
        OSError: the file cannot be read.
    """
    kept = json.loads(file.read_text("utf-8"))
    wrong = [
        Departure(key, kept[key], found[key])
        for key in ("case", "settings")
        if kept[key] != json.loads(text(found))[key]
    ]
    for solver in sorted({*kept["values"], *found["values"]}):
        old, new = kept["values"].get(solver, {}), found["values"].get(solver, {})
        for probe in sorted({*old, *new}):
            scale = max((_size(values) for values in old.get(probe, {}).values()), default=0.0)
            for station in sorted({*old.get(probe, {}), *new.get(probe, {})}):
                was, now = old.get(probe, {}).get(station), new.get(probe, {}).get(station)
                if not _close(was, now, kept["tolerance"] * scale):
                    wrong.append(Departure(f"{solver} {probe} {station}", was, now))
    return tuple(wrong)


def accept(file: Path, found: Plain, *, date: str, reason: str) -> None:
    """Make fresh numbers the file's own, and add why to its history.

    Raises:
        OSError: the file cannot be written.
    """
    history = json.loads(file.read_text("utf-8"))["history"] if file.exists() else []
    write(file, text({**found, "history": [*history, {"date": date, "reason": reason}]}))


def _shortened(scene: Scene) -> Scene:
    """The scene without those stations of its long stages that are not kept."""
    stages = tuple(
        stage.model_copy(update={"stations": thinning.kept(stage)}) if len(stage.stations) > MANY else stage
        for stage in scene.stages
    )
    return scene.model_copy(update={"stages": stages})


def _kept(scene: Scene, answer: Answer) -> dict[str, dict[str, list[float]]]:
    """By probe and station the values of the stations that are kept of every stage, and the critical values."""
    kept: dict[str, dict[str, list[float]]] = {probe.name: {} for probe in scene.probes}
    for stage in scene.stages:
        for value in thinning.kept(stage):
            station = station_of(answer, stage.name, value)
            for probe in scene.probes:
                kept[probe.name][f"{stage.name} {value:g}"] = _thinned(probe, station.values[probe.name]).tolist()
    for number, critical in enumerate(answer.critical):
        kept.setdefault("critical", {})[f"{number} {critical.stage} {mechanism(critical)}"] = [critical.value]
    return kept


def _thinned(probe: Probe, values: Array) -> Array:
    return values[::_EVERY] if probe.quantity in STRESSES else values


def _size(values: list[float]) -> float:
    return float(np.max(np.abs(values))) if values else 0.0


def _close(was: Any, now: Any, tolerance: float) -> bool:  # noqa: ANN401 - a list, or nothing
    if was is None or now is None or len(was) != len(now):
        return False
    return bool(np.all(np.abs(np.subtract(was, now)) <= tolerance))
