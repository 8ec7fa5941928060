"""Bodies that slide and turn, a pin in a slot: all solvers beside a closed form and an integration of its own."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import cprbm
import elastica_reference
import fea_reference
from cprbm_scene import Ending, scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, cantilever_data
from tests.elastica_reference.scenes import post_buckled
from tests.references.slotted import slotted

SLOT, ARM, LOADS = 0.4, (0.13, -0.21), (-3.0, 4.0)  # rad, beam's lengths, EI/L²


def solved(solver, data, n):
    if solver is cprbm:
        answer = cprbm.answer(scene_from(data), cprbm.Settings(links=n))
    elif solver is elastica_reference:
        answer = elastica_reference.answer(scene_from(data))
    else:
        answer = fea_reference.answer(scene_from(data), fea_reference.Settings(elements=n, kinematics="bending"))
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations


def armed(load):
    """A cantilever along x whose tip carries an arm with a pin K in a slot; the load is along the slot, at K."""
    data = cantilever_data({"kind": "force", "point": "K", "direction": [cos(SLOT), sin(SLOT)]}, [load])
    pin = [LENGTH * (1.0 + ARM[0]), LENGTH * ARM[1]]
    points = {"T": [LENGTH, 0.0], "K": pin}
    data["bodies"]["tip"] = {
        "motion": "slides",
        "along": [cos(SLOT), sin(SLOT)],
        "turns": True,
        "about": "K",
        "points": points,
    }
    data["probes"].append({"of": "K", "quantity": "displacement"})
    return data


def errors(solver, load, n):
    """Of the pin's way, the rotation, the wall's force and its moment, each over a size of the scene's own."""
    true = slotted(SLOT, ARM, load)
    (station,) = solved(solver, armed(load * RIGIDITY / LENGTH**2), n)
    found = station.values
    way = found["K.displacement"] / LENGTH
    assert way @ [-sin(SLOT), cos(SLOT)] == pytest.approx(0.0, abs=1e-10)
    force = -found["R.reaction"] * LENGTH**2 / RIGIDITY
    return np.array(
        [
            abs(way @ [cos(SLOT), sin(SLOT)] - true.way),
            abs(found["tip.rotation"][0] - true.rotation),
            np.hypot(*(force - true.force)) / np.hypot(*true.force),
            abs(-found["R.reaction_moment"][0] * LENGTH / RIGIDITY - true.clamp_moment) / abs(true.clamp_moment),
        ]
    )


@pytest.mark.parametrize("load", LOADS)
def test_an_arm_with_a_pin(load):
    assert abs(slotted(SLOT, ARM, load).rotation) > 0.1
    assert np.all(errors(elastica_reference, load, 0) < 1e-9)
    for solver, counts, order in ((cprbm, (20, 40, 80), 4.0), (fea_reference, (8, 16, 32), 4.0)):
        found = np.array([errors(solver, load, n) for n in counts])
        assert np.log2(found[:-1] / found[1:]) == pytest.approx(np.full((2, 4), order), abs=0.15)


def pinned_column(load):
    """Two halves between pins, bowed by a force that goes again: one body turns in place, the other in its slot."""
    data = post_buckled(load)
    weld = {"joint": "weld", "point": "E"}
    data["bodies"]["guide"] = {**data["bodies"]["guide"], "turns": True}
    data["beams"]["second"]["end"] = weld
    data["beams"]["first"]["start"] = {"joint": "pin", "point": "R"}
    data["probes"] = [probe for probe in data["probes"] if probe["quantity"] != "reaction_moment"]
    data["probes"].append({"of": "guide", "quantity": "rotation"})
    return data


@pytest.mark.parametrize("solver", [cprbm, fea_reference, elastica_reference])
def test_the_column_between_pins_beyond_eulers_load(solver):
    """Reference: Euler's elastica, P = (2K)²EI/L², shortened by 2(1 − E/K)L, its middle aside by kL/K, k = sin(α/2)."""
    load = 1.3 * pi**2
    m = brentq(lambda m: 4.0 * ellipk(m) ** 2 - load, 1e-6, 0.999)
    K, E = ellipk(m), ellipe(m)
    stations = solved(solver, pinned_column(load), 40)
    found, tolerance = stations[-1].values, {cprbm: 2e-3, fea_reference: 1e-5, elastica_reference: 1e-9}[solver]
    assert found["E.displacement"] == pytest.approx([-2.0 * (1.0 - E / K) * LENGTH, 0.0], rel=tolerance, abs=1e-9)
    assert found["M.displacement"][1] == pytest.approx(np.sqrt(m) / K * LENGTH, rel=tolerance)
    assert abs(found["guide.rotation"][0]) == pytest.approx(2.0 * np.arcsin(np.sqrt(m)), rel=tolerance)


def test_a_body_with_one_point_need_not_name_it():
    data = armed(1.0)
    data["bodies"]["tip"]["points"]["T"] = data["beams"]["beam"]["curve"]["end"]
    del data["bodies"]["tip"]["points"]["K"], data["bodies"]["tip"]["about"]
    data["loads"]["P"]["point"], data["probes"] = "T", data["probes"][:2]
    unnamed = solved(cprbm, data, 10)
    data["bodies"]["tip"]["about"] = "T"
    assert solved(cprbm, data, 10)[0].values["T.displacement"] == pytest.approx(unnamed[0].values["T.displacement"])
