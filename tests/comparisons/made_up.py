"""Solvers that solve nothing: plausible answers by hand, so that the harness is tested without mechanics.

The numbers follow smooth laws with a discretisation error C/N² and, for finite elements, a step per theory.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from comparisons.choices import Choices
from comparisons.geometry import length, points
from cprbm_scene import Answer, Certificate, Ending, Event, Scene, Shape, StationAnswer
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict

CERTIFICATE = Certificate(1e-13, 1e-13, 1e-15, 1e-5, 1e-12, 1e-12, 1e-12, 0.3, 5)
CLOSES = 0.2
"""Load at which the contact of the made-up hinge closes."""

THEORY = {"bending": 0.0, "stretch": 0.002, "shear": 0.005}


@dataclass(frozen=True)
class MadeUp:
    """An answer function: ``error`` is C/N² at N = 40, relative; ``paper`` what that formulation adds; ``penalty``
    what a penetration of 1e-4 does; the rest plants faults."""

    solver: str
    error: float
    stiffness: float = 1.0
    contact: bool = True
    sign: float = 1.0
    until: int | None = None
    spoilt: Callable[[StationAnswer], StationAnswer] | None = None
    paper: float = 0.0
    penalty: float = 0.0

    def __call__(self, scene: Scene, choices: Choices) -> Answer:
        count = choices.links if self.solver == "cprbm" else choices.elements
        n = count if isinstance(count, int) else min(count.values())
        variant = self.paper * (choices.formulation == "paper")
        theory = variant if self.solver == "cprbm" else THEORY[choices.kinematics]
        factor = (
            1.0 + self.error * (40.0 / n) ** 2 + theory + self.penalty * choices.penetration / 1e-4
        ) / self.stiffness
        stations = [
            self._station(scene, stage.name, value, factor) for stage in scene.stages for value in stage.stations
        ]
        if self.spoilt is not None:
            stations[-1] = self.spoilt(stations[-1])
        return Answer(
            solver=self.solver,
            scene=scene.name,
            settings=frozendict({"n": n}),
            ending=Ending.COMPLETED,
            sentence="",
            stations=tuple(stations[: self.until]),
            events=(Event(scene.stages[0].name, "contact", "closed", CLOSES / factor),),
            seconds=0.01,
        )

    def _station(self, scene: Scene, stage: str, load: float, factor: float) -> StationAnswer:
        reach = load * factor
        closed = self.contact and reach > CLOSES
        push = self.sign * (reach - CLOSES) if closed else 0.0
        first = next(iter(scene.beams))
        total = length(scene.beams[first].curve)
        shift = 0.01 * total * push / (1.0 + abs(push))
        laws: dict[str, np.ndarray] = {
            "displacement": np.array([0.01 * reach, 0.02 * reach - 0.005 * push]),
            "rotation": np.array([0.9 * reach - 0.1 * push]),
            "force": np.array([20.0 * abs(push)]),
            "centre": np.array([0.5 * total + shift]) if closed else np.empty(0),
            "ends": np.array([0.4 * total, 0.6 * total + shift]) if closed else np.empty(0),
            "closing_load": np.array([CLOSES / factor]) if closed else np.empty(0),
            "reaction": np.array([3.0 * load, 1.0 * load + 5.0 * push]),
            "reaction_moment": np.array([0.3 * load + 0.02 * push]),
            "potential_energy": np.array([-0.4 * load * reach]),
            "angle": np.array([0.5 * reach]),
            "moment": np.array([0.3 * abs(push)]),
        }
        values = {}
        for probe in scene.probes:
            found = laws.get(probe.quantity)
            if found is None:
                s = np.linspace(0.0, 1.0, probe.points)
                found = 2e7 * (reach * np.cos(2 * s) - push * (0.25 - (s - 0.5) ** 2))
            values[probe.name] = frozen_array(found)
        shapes = {}
        touching = {}
        for name, beam in scene.beams.items():
            s = np.linspace(0.0, length(beam.curve), 41)
            x, y = points(beam.curve, s).T + 0.01 * reach * np.outer([1.0, 1.5], (s / s[-1]) ** 2)
            shapes[name] = Shape(frozen_array(s), frozen_array(x), frozen_array(y))
        if closed:
            touching["contact"] = frozen_array([[shapes[first].x[20], shapes[first].y[20] - 0.001]])
        return StationAnswer(stage, load, frozendict(values), frozendict(shapes), frozendict(touching), CERTIFICATE)


def with_value(probe: str, value: object) -> Callable[[StationAnswer], StationAnswer]:
    """A fault: one probe's value at the last station."""

    def spoilt(station: StationAnswer) -> StationAnswer:
        return replace(station, values=frozendict({**station.values, probe: frozen_array(value)}))

    return spoilt
