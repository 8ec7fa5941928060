"""Wrong solvers that several tests plant, and how coarsely the right one stands beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers
from comparisons.verdict.runs import Runs, solver_of
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict

COARSE = Choices(elements=20)


def remembered(runs: Runs) -> Solvers:
    """Solvers that hand out answers which are there already."""
    cprbm = [answer for name, answer in runs.answers.items() if solver_of(name) == "cprbm"]

    def by_cprbm(scene: Scene, choices: Choices) -> Answer:
        asked = {(stage.name, value) for stage in scene.stages for value in stage.stations}
        return next(
            answer
            for answer in cprbm
            if answer.settings["links"] == choices.links
            and answer.settings["kinematics"] == choices.theory_of(scene)
            and {(station.stage, station.value) for station in answer.stations} == asked
        )

    def by_fea(scene: Scene, choices: Choices) -> Answer:
        answers = [answer for name, answer in runs.answers.items() if solver_of(name) == "fea"]
        return next(answer for answer in answers if answer.settings["elements"] == choices.elements)

    return Solvers(by_cprbm, by_fea)


def stiffer(scene: Scene) -> Scene:
    """The scene with all Young's moduli 2 % larger."""
    materials = {
        name: material.model_copy(update={"youngs_modulus": 1.02 * material.youngs_modulus})
        for name, material in scene.materials.items()
    }
    return scene.model_copy(update={"materials": frozendict(materials)})


def asked_of(solver: Solver, altered: Callable[[Scene], Scene]) -> Solver:
    """A solver that takes every question for another."""
    return lambda scene, choices: solver(altered(scene), choices)


def without_contact(solver: Solver, *ignored: str) -> Solver:
    """A solver that ignores some contacts, or all if none is named, and says that they are open."""

    def answer(scene: Scene, choices: Choices) -> Answer:
        missing = set(ignored or scene.contacts)
        left = {name: contact for name, contact in scene.contacts.items() if name not in missing}
        others = tuple(probe for probe in scene.probes if probe.of not in missing)
        found = solver(scene.model_copy(update={"contacts": frozendict(left), "probes": others}), choices)
        open_contact = {
            probe.name: frozen_array([0.0] if probe.quantity == "force" else [])
            for probe in scene.probes
            if probe.of in missing
        }
        stations = tuple(
            replace(station, values=frozendict({**station.values, **open_contact})) for station in found.stations
        )
        return replace(found, stations=stations)

    return answer
