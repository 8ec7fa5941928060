"""What a solver's discretisation leaves uncertain, from an answer at twice the links or elements.

======  ===============================================================================================
symbol  meaning
======  ===============================================================================================
v, V    a probe's value at N and at 2N
p       order of convergence, :mod:`comparisons.order`
S, F    1.25 and 0.25, as in :mod:`comparisons.measures`
u       S·2^p/(2^p − 1)·|v − V|, no less than F times the largest in the stage, over the probe's scale
======  ===============================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from comparisons.choices import Choices
from comparisons.measures import SHARE_OF_LARGEST, arc_lengths, probe_scales
from comparisons.order import SAFETY, USUAL, order_of, richardson
from comparisons.pairing import Solver
from comparisons.scales import norm
from comparisons.spots import clear_of_spots
from comparisons.stations import station_of
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.statement import STRESSES


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
    """u by probe, stage and station."""
    scales = probe_scales(found.scene, (found.answer,))
    uncertain: dict[tuple[str, str, float], float] = {}
    for probe in found.scene.probes:
        factor = SAFETY * richardson(order_of(found.scene, probe))
        for stage in found.scene.stages:
            changes = {
                station.value: factor * _change(found, probe, station) / scales[stage.name, probe.name]
                for station in found.answer.stations
                if station.stage == stage.name
            }
            least = SHARE_OF_LARGEST * max(changes.values(), default=0.0)
            uncertain |= {(probe.name, stage.name, value): max(size, least) for value, size in changes.items()}
    return uncertain


def critical_uncertainties(found: Solved) -> list[float]:
    """u of where each branch ends, SI; nothing where at twice the links or elements not as many end."""
    mine, finer = found.answer.critical, found.finer.critical
    if len(mine) != len(finer):
        return [0.0] * len(mine)
    factor = SAFETY * richardson(USUAL)
    return [factor * abs(each.value - other.value) for each, other in zip(mine, finer, strict=True)]


def _change(found: Solved, probe: Probe, station: StationAnswer) -> float:
    """|v − V|; of what only one of them has nothing."""
    try:
        finer = station_of(found.finer, station.stage, station.value)
    except KeyError:
        return 0.0
    v, V = station.values[probe.name], finer.values[probe.name]
    if v.shape != V.shape:
        return 0.0
    if probe.quantity in STRESSES:
        counts = clear_of_spots(found.scene, probe.of, arc_lengths(found.scene, probe), (station, finer))
        v, V = v[counts], V[counts]
    return norm(probe.quantity, v - V)
