"""Solvers that solve nothing: plausible answers by hand, so that the harness is tested without mechanics.

The numbers follow smooth laws with a discretisation error C/N² and a step per theory.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from comparisons.choices import Choices
from comparisons.geometry import length, points
from cprbm_scene import Answer, Certificate, Curve, Ending, Event, Scene, Shape, StationAnswer
from cprbm_scene.answer import ContactState, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict

CERTIFICATE = Certificate(1e-13, 1e-13, 1e-15, 1e-5, 1e-12, 1e-12, 1e-12, 0.3, 5)
CLOSES = 0.2
"""Load at which the contact of the made-up hinge closes."""

THEORY = {"bending": 0.0, "stretch": 0.002, "shear": 0.005}


@dataclass(frozen=True)
class MadeUp:
    """Answer function of a solver.

    Attributes:
        solver: name; error: C/N² at N = 40, relative; paper: relative change in that formulation; penalty: relative
            change by a penetration of 1e-4.
        stiffness: factor of the load at which a state is reached; closes: reach at which contacts close; contact:
            whether they do; sign: of their force; until: number of stations; spoilt: change of the last station.
    """

    solver: str
    error: float
    stiffness: float = 1.0
    closes: float = CLOSES
    contact: bool = True
    sign: float = 1.0
    until: int | None = None
    spoilt: Callable[[StationAnswer], StationAnswer] | None = None
    paper: float = 0.0
    penalty: float = 0.0

    def __call__(self, scene: Scene, choices: Choices) -> Answer:
        count = choices.links if self.solver == "cprbm" else choices.elements
        n = count if isinstance(count, int) else min(count.values())
        variant = self.paper * (self.solver == "cprbm" and choices.formulation == "paper")
        theory = THEORY[choices.theory_of(scene) if self.solver == "cprbm" else choices.kinematics_of(scene)]
        factor = (
            1.0 + self.error * (40.0 / n) ** 2 + variant + theory + self.penalty * choices.penetration / 1e-4
        ) / self.stiffness
        stations = [
            self._station(scene, stage.name, value, factor) for stage in scene.stages for value in stage.stations
        ]
        if self.spoilt is not None:
            stations[-1] = self.spoilt(stations[-1])
        closing = (Event(scene.stages[0].name, name, "closes", self.closes / factor) for name in scene.contacts)
        return Answer(
            solver=self.solver,
            scene=scene.name,
            settings=frozendict({"links" if self.solver == "cprbm" else "elements": n}),
            ending=Ending.COMPLETED,
            sentence="",
            stations=tuple(stations[: self.until]),
            events=tuple(closing) if self.contact else (),
            seconds=0.01,
        )

    def _station(self, scene: Scene, stage: str, load: float, factor: float) -> StationAnswer:
        reach = load * factor
        closed = self.contact and reach > self.closes
        push = self.sign * (reach - self.closes) if closed else 0.0
        first = next(iter(scene.beams))
        total = length(scene.beams[first].curve)
        shift = 0.01 * total * push / (1.0 + abs(push))
        laws: dict[str, np.ndarray] = {
            "displacement": np.array([0.01 * reach, 0.02 * reach - 0.005 * push]),
            "rotation": np.array([0.9 * reach - 0.1 * push]),
            "force": np.array([20.0 * abs(push)]),
            "centre": np.array([0.5 * total + shift]) if closed else np.empty(0),
            "ends": np.array([0.4 * total, 0.6 * total + shift]) if closed else np.empty(0),
            "closing_load": np.array([self.closes / factor]) if closed else np.empty(0),
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
        for name, beam in scene.beams.items():
            s, line, bow = _at_rest(beam.curve)
            x, y = line + 0.01 * reach * bow
            shapes[name] = Shape(s, frozen_array(x), frozen_array(y))
        places = frozen_array([[shapes[first].x[20], shapes[first].y[20] - 0.001]])
        nowhere = frozen_array(np.zeros((0, 2)))
        return StationAnswer(
            stage,
            load,
            frozendict(values),
            frozendict(shapes),
            frozendict(dict.fromkeys(scene.contacts, places) if closed else {}),
            CERTIFICATE,
            forces=_pressing(scene, 0.5 * total + shift, 20.0 * push) if closed else PointForces(),
            contacts=frozendict({name: ContactState(closed, places if closed else nowhere) for name in scene.contacts}),
        )


@cache
def _at_rest(curve: Curve) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arc lengths (41,) of a beam, the places at rest (2, 41), and the shape (2, 41) of their change."""
    s = np.linspace(0.0, length(curve), 41)
    return frozen_array(s), points(curve, s).T, np.outer([1.0, 1.5], (s / s[-1]) ** 2)


def _pressing(scene: Scene, s: float, force: float) -> PointForces:
    """Forces of all contacts at the arc length ``s``, opposite on the two beams of a contact."""
    pairs = [(name, beam) for name, contact in scene.contacts.items() for beam in contact.beams]
    signs = [1.0 if beam == scene.contacts[name].beams[0] else -1.0 for name, beam in pairs]
    return PointForces(
        tuple(name for name, _ in pairs),
        tuple(beam for _, beam in pairs),
        frozen_array(np.full(len(pairs), s)),
        frozen_array(np.zeros((len(pairs), 2))),
        frozen_array(np.outer(signs, [0.0, -force])),
        frozen_array(np.zeros(len(pairs))),
    )


def with_value(probe: str, value: object) -> Callable[[StationAnswer], StationAnswer]:
    """A fault: one probe's value at the last station."""

    def spoilt(station: StationAnswer) -> StationAnswer:
        return replace(station, values=frozendict({**station.values, probe: frozen_array(value)}))

    return spoilt
