"""Loads on beams: tangent against differences, nodes that are exact in small deflections, balances."""

import numpy as np
import pytest

from fea_reference import Settings, answer
from fea_reference.beam_loads import beam_load, load_forces
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH
from tests.fea_reference.test_derivatives import bent
from tests.together.test_beam_loads import FORCE, acting, point, scene_from, spread

LOADS = [point(0.61, 2.0, 9.0), spread(0.3, -4.0, (0.1, 0.7)), point(1.0, 1.0, 0.0), point(0.5, -1.0, 2.0)]
LOADS.append(({"kind": "beam_moment", "beam": "beam", "at": 0.43}, 3.0))


@pytest.mark.parametrize("kinematics", ["bending", "stretch", "shear"])
@pytest.mark.parametrize("bowed", [False, True])
def test_the_whole_tangent(kinematics, bowed):
    model = build(scene_from(acting(LOADS, bowed=bowed)), Settings(elements=4, kinematics=kinematics))
    z, values = bent(model), np.array([7.0, 5.0, -3.0, 11.0, 4.0])

    def at(z):
        return assemble(model, {}, 6, values, State.of(z), model.initial_constraints)

    tangent = at(z).tangent.matrix.toarray()
    for i in range(model.size):
        step = np.zeros(model.size)
        step[i] = 1e-6
        slope = (at(z + step).residual - at(z - step).residual) / 2e-6
        assert tangent[:, i] == pytest.approx(slope, abs=1e-6 * np.abs(tangent).max())


def test_loads_without_a_value_are_not_looked_at():
    # those of the stages that are yet to come; an empty list of loads on beams is what a scene without any has
    model = build(scene_from(acting(LOADS)), Settings(elements=4))
    values = np.array([0.0, 5.0, 0.0, 0.0, 4.0])
    z = State.of(bent(model))
    found = assemble(model, {}, 6, values, z, model.initial_constraints)
    assert [load.value for load in found.loads] == [5.0, 4.0]
    alone = sum(
        (np.bincount(load.dofs.ravel(), load.gradient.ravel(), model.size) for load in found.loads),
        np.zeros(model.size),
    )
    without = assemble(model, {}, 6, 0.0 * values, z, model.initial_constraints)
    assert found.residual + alone == pytest.approx(without.residual, abs=1e-12 * found.scale)


@pytest.mark.parametrize("bowed", [False, True])
def test_forces_are_derivatives_of_the_work(bowed):
    model = build(scene_from(acting(LOADS, bowed=bowed)), Settings(elements=5, kinematics="shear"))
    z, rng = bent(model), np.random.default_rng(3)
    for part in model.loads:
        here = beam_load(model, part, 3.0, State.of(z))
        f = np.zeros(model.size)
        np.add.at(f, here.dofs, here.gradient)
        for _ in range(4):
            v = rng.standard_normal(model.size)
            ahead, behind = (beam_load(model, part, 3.0, State.of(z + sign * 1e-6 * v)).work for sign in (1.0, -1.0))
            assert f @ v == pytest.approx((ahead - behind) / 2e-6, abs=1e-6 * np.abs(f).max())
        # what does not grow with the square of the load is what a load of next to nothing does
        little = beam_load(model, part, 1e-9, State.of(z))
        f = np.zeros(model.size)
        np.add.at(f, little.dofs, little.gradient / 1e-9)
        assert load_forces(model, part, State.of(z)) == pytest.approx(f, abs=1e-8 * np.abs(f).max())


@pytest.mark.parametrize(
    ("load", "tip"),
    [
        (point(0.37, 0.0, 1e-5), lambda: 0.37**2 * (3.0 - 0.37) / 6.0),
        (spread(0.0, 1e-5), lambda: 1.0 / 8.0),
        (spread(0.0, 1e-5, (0.5, 1.0)), lambda: 41.0 / 384.0),
    ],
)
def test_in_small_deflections_two_elements_are_exact(load, tip):
    """Reference: deflections of a cantilever's tip in a textbook, over F L³/EI and q L⁴/EI; energy by Clapeyron."""
    scene = scene_from(acting([load]))
    values = answer(scene, Settings(elements=2, kinematics="bending")).stations[-1].values
    size = 1e-5 * LENGTH
    assert values["T.displacement"][1] == pytest.approx(tip() * size, rel=1e-8)
    # a force's own deflection, bubble and all: a³/3
    if load[0]["kind"] == "beam_force":
        energy = -0.5 * 0.37**3 / 3.0 * 1e-10 * RIGIDITY / LENGTH
        assert values["scene.potential_energy"][0] == pytest.approx(energy, rel=1e-7)


@pytest.mark.parametrize("at", [0.37, 0.5, 0.86])
@pytest.mark.parametrize("kinematics", ["stretch", "shear"])
def test_wherever_in_its_element_a_force_is_its_energy_is_exact(kinematics, at):
    """Reference: the give a³/(3 EI) + a/GA across and a/EA along, by Clapeyron; in small deflections."""
    EA, a = MODULUS * WIDTH * THICKNESS, at * LENGTH
    GA = 5.0 / 6.0 * EA / (2.0 * (1.0 + 0.31)) if kinematics == "shear" else np.inf
    for load, give in ((point(at, 1e-3, 0.0), a / EA), (point(at, 0.0, 1e-5), a**3 / (3.0 * RIGIDITY) + a / GA)):
        (station,) = answer(scene_from(acting([load])), Settings(elements=3, kinematics=kinematics)).stations
        energy = -0.5 * load[1] ** 2 * give
        assert station.values["scene.potential_energy"][0] == pytest.approx(energy, rel=1e-6)


def test_what_is_asked_is_balanced():
    (station,) = answer(scene_from(acting(LOADS[:1])), Settings(elements=7)).stations
    force, moment = station.values["R.reaction"], station.values["R.reaction_moment"][0]
    assert force == pytest.approx([-2.0 * FORCE, -9.0 * FORCE], rel=1e-9)
    assert station.values["beam.bending_stress"][-1] == pytest.approx(0.0, abs=1e-6)
    assert abs(moment) > 0.1 * RIGIDITY / LENGTH
    assert station.certificate.moment_balance < 1e-10


@pytest.mark.parametrize("kinematics", ["bending", "shear"])
@pytest.mark.parametrize("bowed", [False, True])
@pytest.mark.parametrize("elements", [3, 7, 40])
def test_a_moment_alone_is_exact_wherever_in_its_element_it_acts(kinematics, bowed, elements):
    """Reference: up to its place the moment bends evenly, by 2.1 on the whole length; ½ M²/EI of energy per length."""
    at, turn = 0.39, 2.1
    load = ({"kind": "beam_moment", "beam": "beam", "at": at}, turn * RIGIDITY / LENGTH)
    scene = scene_from(acting([load], bowed=bowed))
    values = answer(scene, Settings(elements=elements, kinematics=kinematics)).stations[-1].values
    energy = -0.5 * turn**2 * at * RIGIDITY / LENGTH
    assert values["scene.potential_energy"][0] == pytest.approx(energy, rel=1e-10)
