"""A wrong solver that several tests plant, and how coarsely the right one stands beside it."""

from __future__ import annotations

from dataclasses import replace

from frozendict import frozendict

from comparisons.choices import Choices
from comparisons.pairing import Solver
from scene import Answer, Scene
from scene.answer import frozen_array

COARSE = Choices(elements=20, kinematics="bending")


def without_contact(solver: Solver) -> Solver:
    def answer(scene: Scene, choices: Choices) -> Answer:
        others = tuple(probe for probe in scene.probes if probe.of not in scene.contacts)
        bare = scene.model_copy(update={"contacts": frozendict(), "probes": others})
        found = solver(bare, choices)
        open_contact = {
            probe.name: frozen_array([0.0] if probe.quantity == "force" else [])
            for probe in scene.probes
            if probe.of in scene.contacts
        }
        stations = tuple(
            replace(station, values=frozendict({**station.values, **open_contact})) for station in found.stations
        )
        return replace(found, stations=stations)

    return answer
