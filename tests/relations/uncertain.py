"""Uncertainty of a solver's discretisation, from an answer at twice the links or elements.

The largest uncertainty of a probe in a stage counts at every station (:mod:`comparisons.verdict.uncertainty`), over
the probe's scale.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.quantities import arc_lengths, norm, probe_scales
from comparisons.stations import station_of
from comparisons.verdict.point_forces import away_from_point_forces
from comparisons.verdict.uncertainty import error, largest
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES, Quantity


@dataclass(frozen=True)
class Solved:
    """A scene and a solver's answer to it; ``refined`` finds the answer at twice the links or elements."""

    scene: Scene
    answer: Answer
    refined: Callable[[], Answer] = field(repr=False)

    @cached_property
    def finer(self) -> Answer:
        """The answer at twice the links or elements, found when it is asked for."""
        return self.refined()


def solved(scene: Scene, solver: Solver, choices: Choices) -> Solved:
    """A solver's answer to a scene.

    Raises:
        SceneError: it refuses the question.
    """
    return Solved(scene, solver(scene, choices), lambda: solver(scene, choices.finer()))


def uncertainties(found: Solved) -> dict[tuple[str, str, float], float]:
    """Stated uncertainty over the scale, by probe, stage and station."""
    scales = probe_scales(found.scene, (found.answer,))
    rows = [(probe, station) for probe in found.scene.probes for station in found.answer.stations]
    stated = largest(((probe.name, station.stage), _stated(found, probe, station)) for probe, station in rows)
    return {
        (probe.name, station.stage, station.value): stated[probe.name, station.stage]
        / scales[station.stage, probe.name]
        for probe, station in rows
    }


def critical_uncertainties(found: Solved) -> list[float]:
    """u of where each branch ends, SI; nothing where at twice the links or elements not as many end."""
    mine, finer = found.answer.critical, found.finer.critical
    if len(mine) != len(finer):
        return [0.0] * len(mine)
    pairs = zip(mine, finer, strict=True)
    return [_size("closing_load", np.array([each.value]), np.array([other.value])) for each, other in pairs]


def _stated(found: Solved, probe: Probe, station: StationAnswer) -> float:
    """Stated uncertainty of a value; nothing where only one answer has it."""
    try:
        finer = station_of(found.finer, station.stage, station.value)
    except KeyError:
        return 0.0
    v, V = station.values[probe.name], finer.values[probe.name]
    if v.shape != V.shape:
        return 0.0
    if probe.quantity in STRESSES:
        counts = away_from_point_forces(found.scene, probe.of, arc_lengths(found.scene, probe), (station, finer))
        v, V = v[counts], V[counts]
    return _size(probe.quantity, v, V)


def _size(quantity: Quantity, v: Array, V: Array) -> float:
    """Stated uncertainty of values at N (k,) with others at 2N."""
    return norm(quantity, error((1.0, 2.0), (v, V)).even)
