"""Beams whose section varies, in both solvers beside an elastica that was integrated on its own."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Scene, scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, MOMENT, RIGIDITY, THICKNESS, WIDTH, cantilever_data, force
from tests.references.small import bar_extension
from tests.references.tapered import Bent, Sizes, bent

LINEAR: Sizes = ((0.0, 1.0), (THICKNESS, 0.4 * THICKNESS))
# at thirds, which no mesh of 4, 16, 64 or 256 even elements has as borders, and all have at a third of an element
KNOTTED: Sizes = ((0.0, 1 / 3, 2 / 3, 1.0), (THICKNESS, 0.5 * THICKNESS, 0.9 * THICKNESS, 0.6 * THICKNESS))
EVEN: Sizes = ((0.0, 1.0), (WIDTH, WIDTH))
NARROW: Sizes = ((0.0, 2 / 3, 1.0), (WIDTH, 0.3 * WIDTH, 0.8 * WIDTH))
PROFILES = {"linear": (LINEAR, EVEN), "width": (((0.0, 1.0), (THICKNESS,) * 2), NARROW), "both": (KNOTTED, NARROW)}
PLACES = 11
FORCE, TIP_MOMENT = RIGIDITY / LENGTH**2, 0.35 * RIGIDITY / LENGTH


def sized(sizes: Sizes) -> dict[str, list[float]]:
    return {"at": list(sizes[0]), "values": list(sizes[1])}


def scene_of(profile: str, load: str) -> Scene:
    thickness, width = PROFILES[profile]
    data = cantilever_data(force(0.0, 1.0), [FORCE]) if load == "force" else cantilever_data(MOMENT, [TIP_MOMENT])
    data["beams"]["beam"] |= {"thickness": sized(thickness), "width": sized(width)}
    return scene_from(data)


@cache
def exact(profile: str, load: str) -> Bent:
    thickness, width = PROFILES[profile]
    loads = ((0.0, FORCE), 0.0) if load == "force" else ((0.0, 0.0), TIP_MOMENT)
    return bent(LENGTH, MODULUS, thickness, width, *loads, np.linspace(0.0, 1.0, PLACES))


def errors(answer, reference: Bent) -> dict[str, float]:
    assert answer.completed, answer.sentence
    values = answer.stations[-1].values
    x, y = values["T.displacement"] / LENGTH
    stress = values["beam.bending_stress"]
    return {
        "place": np.hypot(x + 1.0 - reference.x / LENGTH, y - reference.y / LENGTH),
        "angle": abs(values["tip.rotation"][0] - reference.angle),
        "stress": np.max(np.abs(stress - reference.stress)) / np.max(np.abs(reference.stress)),
        "energy": abs(values["scene.potential_energy"][0] / reference.energy - 1.0),
    }


def by_cprbm(scene: Scene, n: int):
    return cprbm.answer(scene, cprbm.Settings(links=n))


def by_fea(scene: Scene, n: int):
    return fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending"))


def observed(solver, counts: tuple[int, int], profile: str, load: str, last: float) -> dict[str, float]:
    """Orders of the errors' fall from the first number of links or elements to the second, whose are below ``last``."""
    reference, scene = exact(profile, load), scene_of(profile, load)
    coarse, fine = (errors(solver(scene, n), reference) for n in counts)
    assert max(fine.values()) < last
    # an even moment turns springs and elements exactly
    kinds = [kind for kind in coarse if coarse[kind] > 1e-9]
    return {kind: float(np.log(coarse[kind] / fine[kind]) / np.log(counts[1] / counts[0])) for kind in kinds}


@pytest.mark.parametrize("load", ["force", "moment"])
@pytest.mark.parametrize("profile", list(PROFILES))
def test_the_cprbm_converges_with_order_four(profile, load):
    # reference: tests.references.tapered; a kink within an element leaves the third order
    orders = observed(by_cprbm, (16, 64), profile, load, 2e-5)
    assert min(orders.values(), default=4.0) > 2.7


@pytest.mark.parametrize("load", ["force", "moment"])
@pytest.mark.parametrize("profile", list(PROFILES))
def test_the_finite_elements_converge_with_order_four(profile, load):
    # reference: tests.references.tapered; within an element that holds a kink the line is known to the third order,
    # and so is the lever of the force there, which makes the stress
    orders = observed(by_fea, (16, 64), profile, load, 5e-7)
    assert orders.pop("stress", 4.0) > 2.9
    assert orders == pytest.approx(dict.fromkeys(orders, 4.0), abs=0.15)
    assert "place" in orders


@pytest.mark.parametrize("knot", [0.31, 0.3333, 0.36, 0.4])
def test_it_hardly_matters_where_in_an_element_a_kink_lies(knot):
    # reference: tests.references.tapered
    thickness: Sizes = ((0.0, knot, 1.0), (THICKNESS, 0.4 * THICKNESS, 0.8 * THICKNESS))
    reference = bent(LENGTH, MODULUS, thickness, EVEN, (0.0, FORCE), 0.0, np.linspace(0.0, 1.0, PLACES))
    data = cantilever_data(force(0.0, 1.0), [FORCE])
    data["beams"]["beam"]["thickness"] = sized(thickness)
    scene = scene_from(data)
    assert all(errors(by_cprbm(scene, n), reference)["place"] < 1e-8 for n in (160, 161))
    assert errors(by_fea(scene, 41), reference)["place"] < 5e-7


def test_shear_and_stretch_add_what_the_textbook_says():
    # reference: with a small force the tip goes by ∫ P/(5/6 G A) ds more, and along it stretches by ∫ P/(E A) ds; of a
    # thickness t₀ (1 − 0.6 s/L) the mean of 1/A is that at the clamp times −ln(0.4)/0.6
    small, scene = 1e-5, scene_of("linear", "force")
    P, softer = small * FORCE, -np.log(0.4) / 0.6
    area, shear = WIDTH * THICKNESS, 2.0 * (1.0 + scene.materials["m"].poisson_ratio) / (5.0 / 6.0)

    def tip(direction: tuple[float, float], kinematics):
        data = cantilever_data(force(*direction), [P])
        data["beams"]["beam"]["thickness"] = sized(LINEAR)
        settings = fea_reference.Settings(elements=7, kinematics=kinematics)
        return fea_reference.answer(scene_from(data), settings).stations[-1].values["T.displacement"]

    stretched = bar_extension(P, LENGTH, MODULUS * area) * softer
    assert tip((1.0, 0.0), "stretch")[0] == pytest.approx(stretched, rel=1e-6)
    sheared = tip((0.0, 1.0), "shear")[1] - tip((0.0, 1.0), "bending")[1]
    assert sheared == pytest.approx(stretched * shear, rel=1e-4)


def test_a_profile_of_one_value_is_the_number():
    data = cantilever_data(force(0.3, 1.0), [FORCE])
    plain = scene_from(data)
    data["beams"]["beam"] |= {
        "thickness": sized(((0.0, 0.31, 1.0), (THICKNESS,) * 3)),
        "width": sized(((0.0, 0.7, 1.0), (WIDTH,) * 3)),
    }
    for solver in (by_cprbm, by_fea):
        one, other = solver(plain, 13).stations[-1].values, solver(scene_from(data), 13).stations[-1].values
        for name, values in one.items():
            assert other[name] == pytest.approx(values, rel=1e-9, abs=1e-9 * np.max(np.abs(values))), name
