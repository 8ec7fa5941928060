"""Both solvers at the ends of what may be asked: few and many elements, slender and thick, contacts that change."""

import copy

import numpy as np
import pytest

import cprbm
import elastica_reference
import fea_reference
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, WIDTH, cantilever_data, force
from tests.fea_reference.cantilever import elastica
from tests.references.wrapped import Wrapped

DOWN = force(0.0, -1.0)
RADIUS = 0.0313


def solved(solver, data, elements, kinematics="bending"):
    scene = scene_from(data)
    answer = (
        cprbm.answer(scene, cprbm.Settings(links=elements))
        if solver == "cprbm"
        else fea_reference.answer(scene, fea_reference.Settings(elements=elements, kinematics=kinematics))
    )
    assert answer.completed, answer.sentence
    return answer.stations


def circle(x, radius, gap=0.0, thickness=THICKNESS):
    below = [x, -(radius + 0.5 * thickness + gap)]
    return {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": below, "radius": radius}


@pytest.mark.parametrize(
    ("solver", "elements", "allowed"),
    [
        # the CPRBM's error falls with the square of the number, from a third of the tip's way at one element
        ("cprbm", 2, 0.1),
        ("cprbm", 3, 0.05),
        ("cprbm", 5, 0.02),
        ("cprbm", 5000, 2e-7),
        # the finite elements' with the fourth power, as far as round-off
        ("fea", 2, 2e-3),
        ("fea", 3, 4e-4),
        ("fea", 5, 5e-5),
        ("fea", 1280, 1e-7),
    ],
)
def test_the_fewest_and_the_most_elements(solver, elements, allowed):
    # reference: the elastica of Bisshopp and Drucker
    load = 2.3
    (station,) = solved(solver, cantilever_data(DOWN, [load * RIGIDITY / LENGTH**2]), elements)
    x, y, turned = elastica(load)
    off = np.hypot(*(station.values["T.displacement"] / LENGTH - [x - 1.0, -y]))
    assert off < allowed * np.hypot(1.0 - x, y)
    assert abs(station.values["tip.rotation"][0] + turned) < allowed * turned


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize(("slender", "loads"), [(1.1e-5, (9.1, 23.3)), (0.19, (3.1,))])
def test_the_most_slender_and_the_thickest_beam_on_a_circle(solver, slender, loads):
    # reference: the wrapped elastica's closed form; what touches at rest is what the clamp holds there.
    # Clamp and zone share the force to first order in the link (docs/contact-rules.md, 1): the thick beam's short zone
    # needs 80 links
    links = 80 if solver == "cprbm" else 40
    thickness = slender * LENGTH
    rigidity = MODULUS * WIDTH * thickness**3 / 12.0
    data = cantilever_data(DOWN, [load * rigidity / LENGTH**2 for load in loads])
    data["beams"]["beam"]["thickness"] = thickness
    data["contacts"] = {"round": circle(0.0, RADIUS, thickness=thickness)}
    data["probes"] += [{"of": "round", "quantity": "force"}]
    for station in solved(solver, data, links):
        truth = Wrapped(LENGTH, RADIUS, thickness, WIDTH, MODULUS, station.value)
        assert truth.wrapped
        assert station.values["tip.rotation"][0] == pytest.approx(truth.rotation, rel=1e-3)
        assert station.values["T.displacement"] == pytest.approx(np.array(truth.displacement), rel=1e-3)
        assert station.values["round.force"][0] == pytest.approx(float(np.hypot(*truth.contact_force)), rel=2e-3)


@pytest.mark.parametrize("kinematics", ["stretch", "shear"])
def test_stretch_and_shear_of_the_most_slender_beam_are_nothing(kinematics):
    # reference: the elastica of Bisshopp and Drucker and the wrapped one, whose beams bend and do no more; what stretch
    # and shear add goes with the square of t/L, 1e-8
    thickness = 1.1e-4 * LENGTH
    unit = MODULUS * WIDTH * thickness**3 / 12.0 / LENGTH**2
    free = cantilever_data(DOWN, [2.3 * unit])
    free["beams"]["beam"]["thickness"] = thickness
    (station,) = solved("fea", free, 40, kinematics)
    x, y, turned = elastica(2.3)
    assert np.hypot(*(station.values["T.displacement"] / LENGTH - [x - 1.0, -y])) < 1e-7
    assert station.values["tip.rotation"][0] == pytest.approx(-turned, rel=1e-7)
    lying = cantilever_data(DOWN, [9.1 * unit, 23.3 * unit])
    lying["beams"]["beam"]["thickness"] = thickness
    lying["contacts"] = {"round": circle(0.0, RADIUS, thickness=thickness)}
    lying["probes"] += [{"of": "round", "quantity": "force"}]
    for station in solved("fea", lying, 40, kinematics):
        truth = Wrapped(LENGTH, RADIUS, thickness, WIDTH, MODULUS, station.value)
        assert station.values["tip.rotation"][0] == pytest.approx(truth.rotation, rel=1e-5)
        assert station.values["T.displacement"] == pytest.approx(np.array(truth.displacement), rel=2e-5)
        assert station.values["round.force"][0] == pytest.approx(float(np.hypot(*truth.contact_force)), rel=2e-5)


@pytest.mark.parametrize(("gap", "slope"), [(1e-6, 1e-4), (1e-6, -1e-7)])
def test_beams_that_are_parallel_but_for_round_off_of_a_drawing(gap, slope):
    # references: where only the ends touch, the room exact; pressed flat on each other, the other solver.  What presses
    # beside the common root each mesh shares out otherwise: its moment about the root is what converges
    unit = RIGIDITY / LENGTH**2
    data = cantilever_data(DOWN, [0.7 * unit])
    below = -(THICKNESS + gap * LENGTH)
    lower = copy.deepcopy(data["beams"]["beam"])
    lower["curve"] = {"kind": "line", "start": [0.0, below], "end": [0.93 * LENGTH, below - slope * 0.93 * LENGTH]}
    lower |= {"start": {"joint": "weld", "point": "Q"}, "end": {"joint": "free"}}
    data["bodies"]["wall"]["points"]["Q"] = [0.0, below]
    data["beams"]["lower"] = lower
    data["contacts"] = {"lap": {"kind": "beam-beam", "between": ["beam", "lower"]}}
    data["probes"] = [{"of": "T", "quantity": "displacement"}]
    data["probes"] += [{"of": "lap", "quantity": each} for each in ("force", "centre")]
    truth = elastica_reference.answer(scene_from(data))
    assert truth.completed, truth.sentence
    data["stages"][0]["stations"].append(3.1 * unit)
    # more than 60 links: all joints overlap by the round-off at once, and the set of closed places does not settle
    answers = [solved("cprbm", data, 60), solved("fea", data, 40)]
    for ends_touch, _ in answers:
        for probe, allowed in (("T.displacement", 2e-4), ("lap.force", 3e-4), ("lap.centre", 1e-4)):
            assert ends_touch.values[probe] == pytest.approx(truth.stations[0].values[probe], rel=allowed)
    (_, chain), (_, elements) = answers
    assert chain.values["T.displacement"] == pytest.approx(elements.values["T.displacement"], rel=2e-4)
    moments = [flat.values["lap.force"][0] * flat.values["lap.centre"][0] for flat in (chain, elements)]
    assert moments[0] == pytest.approx(moments[1], rel=4e-3)
    assert moments[0] > 2.5 * truth.stations[0].values["lap.force"][0] * truth.stations[0].values["lap.centre"][0]


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_a_contact_goes_from_one_circle_to_the_next_and_back(solver):
    # reference: the differential equations, integrated by the room exact
    unit = RIGIDITY / LENGTH**2
    data = cantilever_data(DOWN, [])
    data["contacts"] = {"near": circle(0.31 * LENGTH, 0.0057, 0.0007), "far": circle(0.63 * LENGTH, 0.0043, 0.0045)}
    data["stages"] = [
        {"name": "down", "steps": "P", "stations": [0.5 * unit, 1.5 * unit, 5.0 * unit]},
        {"name": "back", "steps": "P", "stations": [0.5 * unit, 0.0]},
    ]
    data["probes"] = [{"of": name, "quantity": "force"} for name in ("near", "far")]
    data["probes"] += [{"of": "T", "quantity": "displacement"}]
    truth = elastica_reference.answer(scene_from(data))
    assert truth.completed, truth.sentence
    closed = []
    for station, true in zip(solved(solver, data, 40), truth.stations, strict=True):
        forces = [station.values[f"{name}.force"][0] for name in ("near", "far")]
        assert forces == pytest.approx([true.values[f"{name}.force"][0] for name in ("near", "far")], abs=0.02 * unit)
        off = station.values["T.displacement"] - true.values["T.displacement"]
        assert np.hypot(*off) < 2e-3 * 0.3 * LENGTH
        closed.append(tuple(bool(one > 0.0) for one in forces))
    assert closed == [(True, False), (True, True), (False, True), (True, False), (False, False)]


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_a_zone_splits_and_comes_together(solver):
    # reference: a long strip of weight q, lifted off its floor by a force P, leaves it over 3 P / (4 q) to either side
    # (its curvature, slope and height vanish where it lifts off), and rises by q a⁴/(72 E I) in the middle
    unit = RIGIDITY / LENGTH**2
    weight, lift, at = 17.0 * unit / LENGTH, 2.9 * unit, 0.57
    data = cantilever_data({"kind": "distributed", "beam": "beam", "direction": [0.0, -1.0]}, [])
    data["loads"]["lift"] = {"kind": "beam_force", "beam": "beam", "at": at, "direction": [0.0, 1.0]}
    floor = {"point": [0.0, -0.5 * THICKNESS], "normal": [0.0, 1.0]}
    data["contacts"] = {"floor": {"kind": "beam-half-plane", "beam": "beam", "body": "wall", **floor}}
    data["stages"] = [
        {"name": "lay", "steps": "P", "stations": [weight]},
        {"name": "lift", "steps": "lift", "stations": [lift]},
        {"name": "leave", "steps": "lift", "stations": [0.0]},
    ]
    data["probes"] = [{"of": "floor", "quantity": "force"}, {"of": "floor", "quantity": "ends"}]
    before, lifted, after = solved(solver, data, 80)
    half = 0.75 * lift / weight
    shape = lifted.shapes["beam"]
    high = np.max(shape.y)
    assert high == pytest.approx(weight * half**4 / (72.0 * RIGIDITY), rel=0.03)
    places = lifted.touching["floor"][:, 0]
    gap = np.sort(places)[np.searchsorted(np.sort(places), at * LENGTH) + np.array([-1, 0])]
    assert gap == pytest.approx(at * LENGTH + np.array([-half, half]), abs=2.0 * LENGTH / 80)
    assert lifted.values["floor.ends"] == pytest.approx([0.0, LENGTH], abs=2.0 * LENGTH / 80)
    carried = before.values["floor.force"][0]
    assert lifted.values["floor.force"][0] == pytest.approx(carried - lift, rel=1e-2)
    assert after.values["floor.force"][0] == pytest.approx(carried, rel=1e-6)
