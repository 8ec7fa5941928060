"""The beam element against exact answers."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from cprbm_scene import Ending, Loss
from fea_reference import Settings, answer
from tests.fea_reference.cantilever import (
    EI,
    LENGTH,
    MOMENT,
    POISSON,
    THICKNESS,
    WIDTH,
    YOUNG,
    cantilever,
    elastica,
    force,
)


def test_the_reference_itself():
    """The elliptic integrals against an integration of the differential equation θ'' = −alpha cos θ."""
    s = np.linspace(0, 1, 200)
    solved = solve_bvp(
        lambda s, v: np.stack([v[1], -4.0 * np.cos(v[0]), np.cos(v[0]), np.sin(v[0])]),
        lambda a, b: np.array([a[0], b[1], a[2], a[3]]),
        s,
        np.stack([s, 1 - s, s, 0.5 * s]),
        tol=1e-10,
        max_nodes=20000,
    )
    assert solved.success
    x, y, phi = elastica(4.0)
    assert np.array([phi, x, y]) == pytest.approx(solved.y[[0, 2, 3], -1], abs=1e-8)


@pytest.mark.parametrize("angle", [0.0, 2.5])
def test_tip_force_follows_the_elastica(angle):
    alphas = (0.5, 1.0, 2.0, 5.0, 10.0)
    stations = tuple(alpha * EI / LENGTH**2 for alpha in alphas)
    load = force(-np.sin(angle), np.cos(angle))
    got = answer(cantilever(load, stations, angle=angle), Settings(elements=40, kinematics="bending"))
    assert got.ending is Ending.COMPLETED
    back = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    for alpha, station in zip(alphas, got.stations, strict=True):
        x, y, phi = elastica(alpha)
        tip = back @ station.values["tip.displacement"] / LENGTH
        assert tip + np.array([1.0, 0.0]) == pytest.approx([x, y], abs=1e-6)
        assert station.values["end.rotation"][0] == pytest.approx(phi, abs=1e-6)
        # Clapeyron does not hold; the root's moment is statics on the bent shape.
        assert station.values["root.reaction_moment"][0] == pytest.approx(-alpha * EI / LENGTH * x, rel=1e-5)


def test_the_error_falls_with_the_fourth_power_of_the_element():
    """The shallow-arch membrane strain makes it so; a straight-chord element has the second power."""
    x, y, _ = elastica(6.0)
    errors = []
    for n in (4, 8, 16, 32):
        scene = cantilever(force(0, 1), (6.0 * EI / LENGTH**2,))
        tip = answer(scene, Settings(elements=n, kinematics="bending")).stations[-1].values["tip.displacement"]
        errors.append(np.hypot(*(tip / LENGTH + (1.0, 0.0) - (x, y))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("turns", [1, 2])
def test_an_end_moment_rolls_the_beam_up(turns):
    """M = 2π EI/L per turn: the tip comes back to the root, the stress is the same everywhere."""
    moment = turns * 2 * np.pi * EI / LENGTH
    got = answer(cantilever(MOMENT, (moment / 2, moment)), Settings(elements=40, kinematics="bending"))
    assert got.ending is Ending.COMPLETED
    values = got.stations[-1].values
    assert values["end.rotation"][0] == pytest.approx(turns * 2 * np.pi, rel=1e-9)
    assert values["tip.displacement"] / LENGTH == pytest.approx([-1.0, 0.0], abs=1e-5)
    stress = moment * THICKNESS / 2 / (WIDTH * THICKNESS**3 / 12)
    assert values["beam.bending_stress"] == pytest.approx(np.full(11, stress), rel=1e-8)
    work = -0.5 * moment * turns * 2 * np.pi
    assert values["scene.potential_energy"][0] == pytest.approx(work, rel=1e-8)


def test_a_short_cantilever_shears():
    """Timoshenko: F L³/3EI + F L/(k G A), k = 5/6, at a load so small that nothing else counts."""
    length, thickness = 0.061, 0.011
    stiffness = YOUNG * WIDTH * thickness**3 / 12
    F = 1e-6 * stiffness / length**2
    scene = cantilever(force(0, 1), (F,), length=length, thickness=thickness)
    bent = F * length**3 / (3 * stiffness)
    sheared = F * length / (5 / 6 * YOUNG / (2 * (1 + POISSON)) * WIDTH * thickness)
    for kinematics, expected in (("bending", bent), ("stretch", bent), ("shear", bent + sheared)):
        got = answer(scene, Settings(elements=8, kinematics=kinematics))
        assert got.stations[-1].values["tip.displacement"][1] == pytest.approx(expected, rel=1e-7)


def test_an_axial_force_stretches():
    F = 1e-3 * YOUNG * WIDTH * THICKNESS
    scene = cantilever(force(1, 0), (F,))
    for kinematics, strain in (("bending", 0.0), ("stretch", 1e-3), ("shear", 1e-3)):
        got = answer(scene, Settings(elements=8, kinematics=kinematics))
        values = got.stations[-1].values
        assert values["tip.displacement"] == pytest.approx([strain * LENGTH, 0.0], abs=1e-12 * LENGTH)
        assert values["root.reaction"] == pytest.approx([-F, 0.0], abs=1e-9 * F)


def test_the_units_do_not_matter():
    alpha = 3.0
    reference = None
    for young in (1.0, 1e-9, 1e9):
        for units in (1.0, 1e-6, 1e6):
            scene = cantilever(
                force(0, 1), (alpha * EI * young * units**2 / LENGTH**2,), young=YOUNG * young, units=units
            )
            got = answer(scene, Settings(elements=10))
            assert got.ending is Ending.COMPLETED
            tip = got.stations[-1].values["tip.displacement"] / units
            reference = tip if reference is None else reference
            assert tip == pytest.approx(reference, rel=1e-10)


def test_a_straight_column_beyond_eulers_load_is_no_answer():
    """Euler: π² EI/(4 L²) for a cantilever; the straight branch is an equilibrium on either side of it."""
    euler = np.pi**2 * EI / (4 * LENGTH**2)
    for kinematics in ("bending", "shear"):
        got = answer(
            cantilever(force(-1, 0), (0.5 * euler, 0.98 * euler, 1.02 * euler)),
            Settings(elements=20, kinematics=kinematics),
        )
        assert got.ending is Ending.BRANCH_ENDS
        assert [critical.loss for critical in got.critical] == [Loss.BIFURCATION]
        # stretch and shear change Euler's load by some (π t/L)²/48
        within = 1e-6 if kinematics == "bending" else 3e-5
        assert got.critical[0].value == pytest.approx(euler, rel=within)
        assert [station.value for station in got.stations] == [0.5 * euler, 0.98 * euler]
        assert got.stations[0].certificate.smallest_curvature > got.stations[1].certificate.smallest_curvature > 0


def test_the_smallest_curvature_is_the_lowest_vibration():
    """Of an unloaded cantilever with a massive rigid tip; here the tip's mass and inertia are one, the beam's
    is one.

    Independent: eigenvalues of cubic Hermite beam matrices by hand, written out for the linear beam.
    """
    n, L = 24, 1.0
    h = L / n
    K, M = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
    for e in range(n):
        at = slice(2 * e, 2 * e + 4)
        K[at, at] += (
            np.array(
                [
                    [12, 6 * h, -12, 6 * h],
                    [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                    [-12, -6 * h, 12, -6 * h],
                    [6 * h, 2 * h**2, -6 * h, 4 * h**2],
                ]
            )
            / h**3
        )
        M[at, at] += np.eye(4) * h / 2
    M[-2:, -2:] += np.eye(2)
    lowest = np.min(np.linalg.eigvals(np.linalg.solve(M[2:, 2:], K[2:, 2:])).real)
    got = answer(cantilever(MOMENT, (1e-9 * EI / LENGTH,)), Settings(elements=n, kinematics="bending"))
    assert got.stations[0].certificate.smallest_curvature == pytest.approx(lowest, rel=1e-3)


def test_too_coarse_for_the_roll_up_ends_by_name():
    moment = 4 * np.pi * EI / LENGTH
    got = answer(cantilever(MOMENT, (0.1 * moment, moment)), Settings(elements=4, kinematics="bending"))
    assert got.ending is Ending.TURNED_TOO_FAR
    assert len(got.stations) == 1
