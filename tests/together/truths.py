"""Answers from outside: the references of ``tests/references``, which import no solver, as an exact third column.

Each pair of a scene and a solver: the solver looks nothing up in the scene but its stations and probes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from comparisons import cases
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.geometry import length, points
from cprbm_scene import Answer, Certificate, Ending, Probe, Scene, Shape, StationAnswer, scene_from
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.references import hinge, two_cantilevers
from tests.references.tapered import guided
from tests.references.wrapped import Wrapped

Truth = Callable[[Probe, float], object]
"""A probe's true value at a station, empty where a contact is open."""

_CERTIFICATE = Certificate(1e-12, 1e-12, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1)


def told_by(truth: Truth) -> Solver:
    """A solver that hands out what is known; its shapes are those at rest, and nobody looks at them."""

    def answer(scene: Scene, choices: Choices) -> Answer:
        shapes = {}
        for name, beam in scene.beams.items():
            s = np.linspace(0.0, length(beam.curve), 11)
            x, y = points(beam.curve, s).T
            shapes[name] = Shape(frozen_array(s), frozen_array(x), frozen_array(y))
        stations = tuple(
            StationAnswer(
                stage.name,
                value,
                frozendict({probe.name: frozen_array(truth(probe, value)) for probe in scene.probes}),
                frozendict(shapes),
                frozendict(),
                _CERTIFICATE,
            )
            for stage in scene.stages
            for value in stage.stations
        )
        return Answer("exact", scene.name, frozendict(), Ending.COMPLETED, "", stations)

    return answer


def of_hinge(of: hinge.Hinge, shares: tuple[float, ...]) -> tuple[Scene, Solver]:
    """Contact in a point; the stations are ``shares`` of the moment at which it closes."""
    data = cases.data("hinge")
    x0, x1, y = of.xc - of.radius, of.xc + of.radius, of.yc
    data["claims"] = []
    data["bodies"]["AC"]["points"] = {"A": [x0, y], "C": [x0, -y]}
    data["bodies"]["BD"]["points"] = {"B": [x1, y], "D": [x1, -y]}
    data["materials"]["abs"]["youngs_modulus"] = of.youngs_modulus
    for name, sign in (("beam1", 1.0), ("beam2", -1.0)):
        beam = data["beams"][name]
        beam["thickness"], beam["width"] = of.thickness, of.width
        curve = {"center": [of.xc, sign * y], "start": [x0, sign * y], "end": [x1, sign * y]}
        beam["curve"] = {**beam["curve"], **curve}
    closing = hinge.closing_moment(of)
    data["stages"][0]["stations"] = [share * closing for share in shares]
    scene = scene_from(data)

    def truth(probe: Probe, moment: float) -> object:
        arc = np.linspace(0.0, length(scene.beams[probe.of].curve), probe.points) if probe.of in scene.beams else None
        return hinge_truth(hinge.solve(of, moment), closing, probe.name, arc)

    return scene, told_by(truth)


def hinge_truth(solution: hinge.HingeSolution, closing: float, probe: str, arc: np.ndarray | None) -> object:
    """A probe's true value; of a stress at arc lengths (k,)."""
    if probe.endswith("bending_stress"):
        assert arc is not None
        return solution.bending_stress(int(probe[4]), arc)
    return {
        "B.displacement": solution.displacement_B,
        "D.displacement": solution.displacement_D,
        "BD.rotation": [solution.rotation],
        "contact.force": [solution.contact_force],
        "contact.centre": [solution.contact_arc_lengths[0]] if solution.contact_arc_lengths else [],
        "contact.closing_load": [closing] if solution.contact_arc_lengths else [],
        "A.reaction": solution.reaction_A,
        "A.reaction_moment": [solution.reaction_moment_A],
        "C.reaction": solution.reaction_C,
        "C.reaction_moment": [solution.reaction_moment_C],
        "scene.potential_energy": [solution.potential_energy],
    }[probe]


PAPER_HINGE = hinge.PAPER


def wrapped_truth(probe: str, load: float) -> object:
    """A probe's true value; the numbers are those of ``comparisons/cases/wrapped.toml``."""
    beam = Wrapped(length=0.0973, radius=0.0711, thickness=0.00103, width=0.0097, youngs_modulus=2.07e11, force=load)
    return {
        "T.displacement": lambda: beam.displacement,
        "tip.rotation": lambda: [beam.rotation],
        "contact.force": lambda: [np.linalg.norm(beam.contact_force)],
        "contact.centre": lambda: [beam.contact_centre] if beam.wrapped else [],
        "contact.ends": lambda: [0.0, beam.wrap_length] if beam.wrapped else [],
        "C.reaction": lambda: beam.reaction,
        "C.reaction_moment": lambda: [beam.reaction_moment],
        "beam.bending_stress": lambda: beam.bending_stress(81),
        "scene.potential_energy": lambda: [beam.potential_energy],
    }[probe]()


def of_wrapped() -> tuple[Scene, Solver]:
    """Contact over a length: a closed form."""
    return cases.opened("wrapped"), told_by(lambda probe, load: wrapped_truth(probe.name, load))


def of_tapered() -> tuple[Scene, Solver]:
    """No contact, and a section with kinks.  The numbers are those of ``comparisons/cases/tapered.toml``."""
    thickness = ((0.0, 0.173, 0.407, 0.631, 0.859, 1.0), (0.0021, 0.0009, 0.0023, 0.0019, 0.0008, 0.0017))
    width = ((0.0, 0.523, 1.0), (0.0071, 0.0097, 0.0059))
    places = np.linspace(0.0, 1.0, 81)

    @lru_cache
    def bent(load: float):
        return guided(0.0973, 2.3e9, thickness, width, (0.0, -load), places)

    def truth(probe: Probe, load: float) -> object:
        found, moment = bent(load)
        return {
            "T.displacement": [found.x - 0.0973, found.y],
            "block.reaction_moment": [moment],
            "C.reaction_moment": [-found.moment[0]],
            "beam.bending_stress": found.stress,
            "scene.potential_energy": [found.energy],
        }[probe.name]

    return cases.opened("tapered"), told_by(truth)


PAIR = two_cantilevers.TwoCantilevers(gap=0.07, reach=1.45, lower_length=1.2, force=1.0)


def of_two_cantilevers() -> tuple[Scene, Solver]:
    """A tip on a beam: contact of lines in a point that slides."""
    unit, thin, young, width = 0.113, 0.0009, 7.1e10, 0.0083
    EI = young * width * thin**3 / 12.0
    h, a, free = PAIR.gap * unit, PAIR.reach * unit, {"joint": "free"}
    beam = {"thickness": thin, "width": width, "material": "m"}
    lower = {"kind": "line", "start": [a, 0.0], "end": [a - PAIR.lower_length * unit, 0.0]}
    upper = {"kind": "line", "start": [0.0, h], "end": [unit, h]}
    forces = (0.5, 1.2, 2.0, 3.0)
    scene = scene_from(
        {
            "name": "pair",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": young, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.0, h], "V": [a, 0.0]}},
                "end": {"motion": "free", "points": {"tip": [unit, h]}},
            },
            "beams": {
                "lower": {**beam, "curve": lower, "start": {"joint": "weld", "point": "V"}, "end": free},
                "upper": {
                    **beam,
                    "curve": upper,
                    "start": {"joint": "weld", "point": "U"},
                    "end": {"joint": "weld", "point": "tip"},
                },
            },
            "loads": {"F": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["upper", "lower"], "thick": False}},
            "stages": [{"name": "load", "steps": "F", "stations": [force * EI / unit**2 for force in forces]}],
            "probes": [
                {"of": "tip", "quantity": "displacement"},
                {"of": "end", "quantity": "rotation"},
                {"of": "touch", "quantity": "force"},
                {"of": "U", "quantity": "reaction_moment"},
                {"of": "V", "quantity": "reaction_moment"},
            ],
        }
    )

    @lru_cache
    def solved(force: float):
        return two_cantilevers.solve(dataclasses.replace(PAIR, force=force * unit**2 / EI))

    def truth(probe: Probe, force: float) -> object:
        found = solved(force)
        return {
            "tip.displacement": unit * (found.tip - [1.0, PAIR.gap]),
            "end.rotation": [found.rotation],
            "touch.force": [found.contact_force * EI / unit**2],
            "U.reaction_moment": [-found.upper_moment * EI / unit],
            "V.reaction_moment": [-found.lower_moment * EI / unit],
        }[probe.name]

    return scene, told_by(truth)
