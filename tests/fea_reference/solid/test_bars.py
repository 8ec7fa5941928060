"""Bars whose displacements and stresses are known in closed form."""

import numpy as np
import pytest

from fea_reference import solid
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, quarter, straight
from tests.references.elastica import cantilever_under_tip_force

TIP = (("tip", "displacement"), ("block", "rotation"), ("scene", "potential_energy"))


def answered(scene, elements, across=2):
    """All stations' values of a completed answer."""
    found = solid.answer(scene, solid.Settings(elements=elements, across=across))
    assert found.completed, found.sentence
    return [station.values for station in found.stations]


@pytest.mark.parametrize("poisson", [0.0, 0.35])
def test_a_slender_cantilever_is_the_elastica(poisson):
    # Bisshopp & Drucker; L/t = 150, so that what stretch, shear and the clamp's hold on the section add, all of the
    # order (t/L)² or ν² t/L of a bar's own, stays below 1e-3
    length, thickness, alpha = 0.3, 0.002, 1.7
    force = alpha * YOUNG * WIDTH * thickness**3 / 12 / length**2
    scene = bar(straight(length), thickness, poisson=poisson, stations=(force,), probes=TIP)
    (values,) = answered(scene, 40, 1)
    tip = cantilever_under_tip_force(alpha)
    assert values["tip.displacement"] / length == pytest.approx(
        [tip.x - 1.0, tip.y], abs=2e-4 if poisson == 0.0 else 8e-4
    )


def test_what_a_thick_cantilever_gives_more_is_timoshenkos_shear():
    # δ = P L³/(3 E I) + 6 P L/(5 G A); both ends hold their section from warping, which takes away less than a fifth
    length, thickness, force = 0.31, 0.042, 0.011
    scene = bar(straight(length), thickness, stations=(force,), probes=TIP)
    (values,) = answered(scene, 30, 4)
    area, inertia = WIDTH * thickness, WIDTH * thickness**3 / 12
    bending, shear = force * length**3 / (3 * YOUNG * inertia), 1.2 * force * length / (0.5 * YOUNG * area)
    assert 0.8 * shear < values["tip.displacement"][1] - bending < shear


@pytest.mark.parametrize("poisson", [0.0, 0.35])
def test_a_thick_ring_in_pure_bending_has_golovins_stress(poisson):
    # Timoshenko & Goodier, Theory of Elasticity, section 29 (H. Golovin 1881), where M opens
    # the ring and here it closes it: at the middle of a
    # quarter whose ends are held, two and a half thicknesses away
    a, b, moment = 0.0425, 0.0575, 1e-4
    log, n = np.log(b / a), (b**2 - a**2) ** 2 - 4 * a**2 * b**2 * np.log(b / a) ** 2

    def hoop(r):
        inner = -((a * b / r) ** 2) * log + b**2 * np.log(r / b) + a**2 * np.log(a / r) + b**2 - a**2
        return 4 * moment / (WIDTH * n) * inner

    scene = bar(
        quarter(0.05),
        b - a,
        poisson=poisson,
        load={"kind": "moment", "body": "block"},
        stations=(moment,),
        probes=(("beam", "bending_stress"), ("beam", "combined_stress")),
    )
    (values,) = answered(scene, 24, 6)
    # the left of a line that runs counter-clockwise is the inside
    bending, membrane = 0.5 * (hoop(b) - hoop(a)), 0.5 * (hoop(b) + hoop(a))
    assert values["beam.bending_stress"][40] == pytest.approx(bending, rel=2e-4)
    assert values["beam.combined_stress"][40] == pytest.approx(abs(bending) + abs(membrane), rel=2e-4)


def test_the_energy_falls_by_what_the_load_moves():
    # dΠ/dP = −u, since an equilibrium's energy does not change with what is free
    force, less = 5.3, 1e-3
    stations = (force - less, force, force + less)
    values = answered(bar(quarter(0.11), 0.007, poisson=0.35, stations=stations, probes=TIP), 12)
    energies = [each["scene.potential_energy"][0] for each in values]
    assert (energies[2] - energies[0]) / (2 * less) == pytest.approx(-values[1]["tip.displacement"][1], rel=1e-6)
