"""Moments at points of beams: a cantilever rolled up as far as that, and an arch that both solvers know alike."""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import SceneError, StationAnswer, scene_from
from cprbm_scene.frozendict import frozendict
from tests.cprbm.scenes import LENGTH as SCENES_LENGTH
from tests.cprbm.scenes import MODULUS as SCENES_MODULUS
from tests.cprbm.scenes import WIDTH, cantilever_data
from tests.together.features import LENGTH, MODULUS, MOMENT, THICKNESS, Data, arc, cantilever, ended, probes, weld

AT, FACTOR = 0.63, 1.3


def station(data: Data, solver: str, n: int) -> StationAnswer:
    scene = scene_from(data)
    if solver == "cprbm":
        answer = cprbm.answer(scene, cprbm.Settings(links=n))
    else:
        answer = fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending"))
    assert answer.completed, answer.sentence
    return answer.stations[-1]


def loaded(data: Data, at: float, value: float, *asked: str) -> Data:
    loads = {"M": {"kind": "beam_moment", "beam": "beam", "at": at}}
    stages = [{"name": "turn", "steps": "M", "stations": [value]}]
    return data | {"loads": loads, "stages": stages, "probes": probes(*asked)}


@pytest.mark.parametrize("kinematics", ["stretch", "shear"])
@pytest.mark.parametrize("n", [11, 37])
def test_a_thick_cantilever_is_not_sheared_by_a_moment(kinematics: str, n: int) -> None:
    # the same closed form: with neither a force across nor one along the beam no theory adds anything to bending
    scene = scene_from(cantilever_data({"kind": "beam_moment", "beam": "beam", "at": 0.37}, [0.7]))
    thick = scene.beams["beam"].model_copy(update={"thickness": 0.0091})
    rigidity = SCENES_MODULUS * WIDTH * 0.0091**3 / 12.0
    M, a = 0.31 * rigidity / SCENES_LENGTH, 0.37 * SCENES_LENGTH
    stage = scene.stages[0].model_copy(update={"stations": (M,)})
    scene = scene.model_copy(update={"beams": frozendict({"beam": thick}), "stages": (stage,)})
    answer = fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics=kinematics))
    assert answer.completed, answer.sentence
    values = answer.stations[-1].values
    bent, rest = M / rigidity, SCENES_LENGTH - a
    x = np.sin(bent * a) / bent + rest * np.cos(bent * a) - SCENES_LENGTH
    y = (1.0 - np.cos(bent * a)) / bent + rest * np.sin(bent * a)
    assert values["T.displacement"] == pytest.approx([x, y], abs=2e-6 * SCENES_LENGTH)
    assert values["tip.rotation"] == pytest.approx([bent * a], rel=1e-5)
    assert values["scene.potential_energy"] == pytest.approx([-0.5 * M**2 * a / rigidity], rel=2e-5)


@pytest.mark.parametrize(("solver", "error"), [("cprbm", 0.1), ("fea", 1e-3)])
def test_a_cantilever_is_an_arc_up_to_the_moment_and_straight_beyond(solver: str, error: float) -> None:
    # closed form: κ = M/EI up to a, θ(a) = M a/EI, energy −½ M² a/EI
    asked = ("T.displacement", "tip.rotation", "scene.potential_energy", "beam.bending_stress", "R.reaction_moment")
    data = loaded(cantilever(), AT, FACTOR * MOMENT, *asked)
    bent, theta = FACTOR / LENGTH, FACTOR * AT
    rest = (1.0 - AT) * LENGTH
    x, y = np.sin(theta) / bent + rest * np.cos(theta), (1.0 - np.cos(theta)) / bent + rest * np.sin(theta)
    for n in (10, 20, 40):
        values = station(data, solver, n).values
        assert np.hypot(*(values["T.displacement"] - [x - LENGTH, y])) < error / n**2 * LENGTH
        assert values["tip.rotation"][0] == pytest.approx(theta, rel=1e-5)
        assert values["scene.potential_energy"][0] == pytest.approx(-0.5 * FACTOR * theta * MOMENT, rel=1e-5)
        assert values["R.reaction_moment"][0] == pytest.approx(-FACTOR * MOMENT, rel=1e-9)
        stress = values["beam.bending_stress"] / (0.5 * MODULUS * THICKNESS * bent)
        assert stress == pytest.approx([1.0] * 6 + [0.0] * 3, abs=1e-9)


@pytest.mark.parametrize(("solver", "error"), [("cprbm", 1e-6), ("fea", 1e-6)])
def test_two_moments_in_one_element_turn_each_other(solver: str, error: float) -> None:
    # closed form: energy −½ ∫ m²/EI with m the sum of the moments that act beyond a place
    a, b, one, other = 0.62, 0.64, 1.5, -1.1
    loads = {name: {"kind": "beam_moment", "beam": "beam", "at": at} for name, at in (("M", a), ("N", b))}
    stages = [{"name": n, "steps": n, "stations": [v * MOMENT]} for n, v in (("M", one), ("N", other))]
    data = cantilever() | {"loads": loads, "stages": stages, "probes": probes("scene.potential_energy")}
    energy = station(data, solver, 10).values["scene.potential_energy"][0] / MOMENT
    assert energy == pytest.approx(-0.5 * (a * (one + other) ** 2 + (b - a) * other**2), rel=error)


def test_in_a_clamped_arch_both_go_to_the_same() -> None:
    # reference: the other solver; the order is three where moments act within elements
    asked = ("R.reaction", "R.reaction_moment", "scene.potential_energy", "beam.bending_stress")
    data = loaded(ended(weld("G")), AT, 4.0 * MOMENT, *asked)
    coarse, finest = (station(data, "cprbm", n).values for n in (40, 160))
    reference = station(data, "fea", 80).values
    for name, value in reference.items():
        size = 4.0 * MOMENT if name == "R.reaction_moment" else np.max(np.abs(value))
        errors = [np.max(np.abs(each[name] - value)) / size for each in (coarse, finest)]
        assert errors[0] / errors[1] > 20.0
        assert errors[1] < 2e-5


@pytest.mark.parametrize("at", [0.0, 1.0])
def test_a_moment_on_a_clamp_is_a_mistake(at: float) -> None:
    data = loaded(ended(weld("G")), at, MOMENT, "R.reaction")
    with pytest.raises(SceneError, match=r"loads\.M\.at: found .* held at"):
        scene_from(data)


def test_at_the_end_it_is_one_on_what_the_end_holds() -> None:
    asked = ("T.displacement", "tip.rotation", "scene.potential_energy")
    on_the_body = cantilever(arc(0.7), asked=asked, loads={"M": {"kind": "moment", "body": "tip"}})
    on_the_beam = loaded(cantilever(arc(0.7)), 1.0, on_the_body["stages"][0]["stations"][0], *asked)
    for solver in ("cprbm", "fea"):
        one, other = (station(data, solver, 12).values for data in (on_the_body, on_the_beam))
        for name, value in one.items():
            assert other[name] == pytest.approx(value, rel=1e-9)
