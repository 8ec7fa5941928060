"""One beam against closed forms: elliptic integrals, a circle, textbook formulas."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, scene_from
from tests.cprbm.scenes import (
    LENGTH,
    MODULUS,
    MOMENT,
    RIGIDITY,
    THICKNESS,
    WIDTH,
    cantilever,
    cantilever_data,
    force,
)
from tests.references.elastica import cantilever_under_tip_force, roll_up


def tip(answer, station=-1):
    return answer.stations[station].values["T.displacement"] / LENGTH, answer.stations[station].values["tip.rotation"][
        0
    ]


def tip_error(alpha, links, formulation="auto"):
    exact = cantilever_under_tip_force(alpha)
    answer = cprbm.answer(
        cantilever(force(0.0, 2.0), [alpha * RIGIDITY / LENGTH**2]),
        cprbm.Settings(links=links, formulation=formulation),
    )
    assert answer.completed
    moved, turn = tip(answer)
    return np.array([moved[0] - (exact.x - 1.0), moved[1] - exact.y, turn - exact.rotation])


@pytest.mark.parametrize("alpha", [0.1, 1.0, 3.7, 10.0, -10.0])
def test_tip_force_converges_to_the_elliptic_integrals_with_order_four(alpha):
    # reference: tests.references.elastica, elliptic integrals
    errors = np.array([np.max(np.abs(tip_error(alpha, n))) for n in (20, 40, 80)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(np.abs(orders - 4.0) < 0.1)
    assert errors[1] < 2e-6


@pytest.mark.parametrize("alpha", [1.0, 10.0])
def test_the_plain_chain_converges_with_order_two(alpha):
    # reference: tests.references.elastica, elliptic integrals
    errors = np.array([np.max(np.abs(tip_error(alpha, n, "paper"))) for n in (20, 40, 80, 160)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(np.abs(orders - 2.0) < 0.05)
    assert errors[1] < 5e-4


@pytest.mark.parametrize("turns", [0.5, 1.0, 2.3])
def test_an_end_moment_rolls_the_beam_up(turns):
    # reference: a circle of radius EI/M; every spring turns alike, so the rotation is exact for any N
    kappa = 2.0 * np.pi * turns
    answer = cprbm.answer(cantilever(MOMENT, [kappa * RIGIDITY / LENGTH]), cprbm.Settings(links=60))
    assert answer.completed
    moved, turn = tip(answer)
    exact = roll_up(kappa)
    assert turn == pytest.approx(kappa, rel=1e-12)
    assert np.hypot(moved[0] - (exact.x - 1.0), moved[1] - exact.y) < 0.0008 * turns**2
    stress = answer.stations[-1].values["beam.bending_stress"]
    assert stress == pytest.approx(np.full(11, MODULUS * THICKNESS / 2.0 * kappa / LENGTH), rel=1e-10)


def test_reactions_stress_and_energy_of_a_small_deflection():
    # reference: PL³/3EI, PL, and energy −P·w/2, to the square of the slope (1e-4)
    P = 2e-4 * RIGIDITY / LENGTH**2
    answer = cprbm.answer(cantilever(force(0.0, 1.0), [P]), cprbm.Settings(links=200))
    values = answer.stations[-1].values
    deflection = P * LENGTH**3 / (3.0 * RIGIDITY)
    assert values["T.displacement"][1] == pytest.approx(deflection, rel=2e-5)
    assert values["R.reaction"] == pytest.approx([0.0, -P], abs=1e-9 * P)
    assert values["R.reaction_moment"][0] == pytest.approx(-P * LENGTH, rel=1e-6)
    assert values["scene.potential_energy"][0] == pytest.approx(-0.5 * P * deflection, rel=2e-5)
    s = np.linspace(0.0, 1.0, 11)
    moment = P * LENGTH * (1.0 - s)
    assert values["beam.bending_stress"] == pytest.approx(
        moment * MODULUS * THICKNESS / (2.0 * RIGIDITY),
        abs=1e-5 * P * LENGTH * MODULUS * THICKNESS / RIGIDITY,
    )


@pytest.mark.parametrize(("share", "completed"), [(0.97, True), (1.03, False)])
def test_a_straight_column_is_certified_only_below_eulers_load(share, completed):
    # reference: π²EI/4L²; beyond it the straight state is a saddle
    critical = np.pi**2 * RIGIDITY / (4.0 * LENGTH**2)
    answer = cprbm.answer(cantilever(force(-1.0, 0.0), [share * critical]), cprbm.Settings(links=80))
    assert answer.completed is completed
    if not completed:
        assert answer.ending is Ending.BRANCH_ENDS
        assert not answer.stations


@pytest.mark.parametrize("links", [40, 200])
def test_the_smallest_curvature_is_the_columns(links):
    # reference: eigenvalue of −θ'' − Pθ with θ(0)=0, θ'(1)=0: π²/4 − P
    P = 1.3
    answer = cprbm.answer(cantilever(force(-1.0, 0.0), [P * RIGIDITY / LENGTH**2]), cprbm.Settings(links=links))
    assert answer.stations[-1].certificate.smallest_curvature == pytest.approx(np.pi**2 / 4.0 - P, rel=1e-3)


def test_the_beam_may_be_drawn_from_its_free_end():
    # the same physical cantilever, drawn from the tip to the wall
    data = cantilever_data(force(0.0, 1.0), [4.0 * RIGIDITY / LENGTH**2])
    forwards = cprbm.answer(scene_from(data), cprbm.Settings(links=40))
    beam = data["beams"]["beam"]
    beam["curve"]["start"], beam["curve"]["end"] = beam["curve"]["end"], beam["curve"]["start"]
    beam["start"], beam["end"] = beam["end"], beam["start"]
    backwards = cprbm.answer(scene_from(data), cprbm.Settings(links=40))
    for name in (
        "T.displacement",
        "tip.rotation",
        "R.reaction",
        "R.reaction_moment",
        "scene.potential_energy",
    ):
        there, back = forwards.stations[-1].values[name], backwards.stations[-1].values[name]
        assert back == pytest.approx(there, rel=1e-9, abs=1e-9 * np.max(np.abs(there)))
    # curvature changes its sign with the direction of the beam
    stress = forwards.stations[-1].values["beam.bending_stress"]
    assert backwards.stations[-1].values["beam.bending_stress"][::-1] == pytest.approx(-stress, rel=1e-8, abs=1.0)


def test_an_end_that_nothing_holds_carries_nothing():
    data = cantilever_data(force(0.0, 1.0), [3.0 * RIGIDITY / LENGTH**2])
    data["beams"]["spare"] = {
        **data["beams"]["beam"],
        "curve": {"kind": "line", "start": [LENGTH, 0.0], "end": [LENGTH, LENGTH]},
        "start": {"joint": "weld", "point": "T"},
        "end": {"joint": "free"},
    }
    data["probes"].append({"of": "spare", "quantity": "bending_stress", "points": 5})
    loaded = cprbm.answer(scene_from(data))
    assert loaded.completed
    values = loaded.stations[-1].values
    assert np.max(np.abs(values["spare.bending_stress"])) < 1e-9 * np.max(np.abs(values["beam.bending_stress"]))
    data["beams"]["spare"]["curve"] = {"kind": "line", "start": [LENGTH, LENGTH], "end": [LENGTH, 0.0]}
    data["beams"]["spare"]["start"], data["beams"]["spare"]["end"] = (
        {"joint": "free"},
        {"joint": "weld", "point": "T"},
    )
    turned = cprbm.answer(scene_from(data))
    assert turned.completed
    assert turned.stations[-1].values["T.displacement"] == pytest.approx(values["T.displacement"], rel=1e-9)


def test_a_load_no_element_can_carry_ends_by_name():
    answer = cprbm.answer(cantilever(MOMENT, [RIGIDITY / LENGTH, 500.0 * RIGIDITY / LENGTH]), cprbm.Settings(links=10))
    assert answer.ending is Ending.TURNED_TOO_FAR
    assert [station.value for station in answer.stations] == [RIGIDITY / LENGTH]
    assert "last good value" in answer.sentence


def test_a_force_on_a_lever():
    # reference: a force and a moment at the tip, PL³/3EI + ML²/2EI and PL²/2EI + ML/EI, and Clapeyron's theorem
    a, b = 0.37 * LENGTH, 0.23 * LENGTH
    data = cantilever_data({"kind": "force", "point": "F", "direction": [-3.0, 4.0]}, [1e-5 * RIGIDITY / LENGTH**2])
    data["bodies"]["tip"]["points"]["F"] = [LENGTH + a, b]
    data["probes"].append({"of": "F", "quantity": "displacement"})
    (P,) = data["stages"][0]["stations"]
    values = cprbm.answer(scene_from(data), cprbm.Settings(links=200)).stations[-1].values
    force_across, moment = 0.8 * P, 0.8 * P * a + 0.6 * P * b
    deflection = force_across * LENGTH**3 / (3.0 * RIGIDITY) + moment * LENGTH**2 / (2.0 * RIGIDITY)
    slope = force_across * LENGTH**2 / (2.0 * RIGIDITY) + moment * LENGTH / RIGIDITY
    moved = np.array([-b * slope, deflection + a * slope])
    assert values["F.displacement"] == pytest.approx(moved, rel=1e-4)
    assert values["tip.rotation"][0] == pytest.approx(slope, rel=1e-4)
    work = P * (-0.6 * moved[0] + 0.8 * moved[1])
    assert values["scene.potential_energy"][0] == pytest.approx(-0.5 * work, rel=1e-4)


@pytest.mark.parametrize("links", [10, 40])
@pytest.mark.parametrize("at", [0.31, 0.5, 0.95])
@pytest.mark.parametrize(("along", "across"), [(0.0, -1e-6), (1.0, 0.0)])
def test_the_energy_under_a_small_force_at_a_place_is_that_of_all_strains(along, across, at, links):
    # reference: Π = −(F_n² (a³/3EI + a/GA_s) + F_t² a/EA)/2, with A_s = 5/6 A and a slope that vanishes with F_n
    load = {"kind": "beam_force", "beam": "beam", "at": at, "direction": [along, across]}
    data = cantilever_data(load, [float(np.hypot(along, across))])
    data["theory"] = "shear"
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    a, area = at * LENGTH, WIDTH * THICKNESS
    bent = a**3 / (3.0 * RIGIDITY) + a / (5.0 / 6.0 * area * MODULUS / (2.0 * 1.31))
    found = -2.0 * float(answer.stations[-1].values["scene.potential_energy"][0])
    assert found == pytest.approx(across**2 * bent + along**2 * a / (area * MODULUS), rel=1e-8, abs=0.0)
