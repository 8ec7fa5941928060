"""Where the equations end, the answer does too: with the stations before, a sentence, and never an exception."""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import elastica_reference
from cprbm_scene import Ending, SceneError, scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force
from tests.elastica_reference.scenes import FREE, STRIP, answer, completed, line, post_buckled, tip_on_beam, weld
from tests.references.elastica import cantilever_under_tip_force
from tests.references.two_cantilevers import TwoCantilevers

UNIT = RIGIDITY / LENGTH**2


def refused(data, stations, *words):
    found = answer(data)
    assert found.ending is Ending.NOT_COVERED
    assert len(found.stations) == stations
    assert found.sentence.endswith(".")
    assert all(word in found.sentence for word in words), found.sentence
    for station in found.stations:
        assert station.certificate.residual < 1e-9
        assert station.certificate.smallest_curvature > 0.0


@pytest.mark.parametrize("factors", [[0.9, 1.1], [0.5, 3.0], [0.9, 30.0], [0.9, 61.0, 121.0]])
def test_a_perfect_column_ends_at_eulers_load(factors):
    # reference: Euler's π² EI/(4 L²); between his second and third loads the determinant has its first sign again
    data = cantilever_data(force(-1.0, 0.0), [0.25 * np.pi**2 * UNIT * factor for factor in factors])
    refused(data, 1, "fold or a bifurcation")


@pytest.mark.parametrize("load", [10.0, 45.0, 100.0])
def test_the_first_station_may_lie_beyond_several_critical_loads(load):
    data = cantilever_data(force(-1.0, 0.0), [0.25 * np.pi**2 * UNIT * load])
    refused(data, 0, "fold or a bifurcation")


def test_a_column_under_its_load_is_stable_until_then():
    data = cantilever_data(force(-1.0, 0.0), [0.25 * np.pi**2 * UNIT * factor for factor in (0.5, 0.999999)])
    first, last = (station.certificate.smallest_curvature for station in completed(data).stations)
    # reference: the energy's second variation at the mode sin(π s/(2 L)) vanishes at Euler's load
    assert 0.0 < last < 1e-5 * first


def test_it_gives_up_where_steps_are_many():
    # ten times E·I/L² across the tip in one station: the first steps are a fifth of the way and less
    scene = scene_from(cantilever_data(force(0.0, -1.0), [0.1 * UNIT, 10.0 * UNIT]))
    found = elastica_reference.answer(scene, elastica_reference.Settings(steps=2))
    assert found.ending is Ending.NOT_COVERED
    assert "2 steps lead no farther than" in found.sentence
    assert len(found.stations) < 2
    assert elastica_reference.answer(scene).completed


def test_a_shallow_arch_ends_at_its_fold():
    rise, half = 0.01, 0.05
    radius = (half**2 + rise**2) / (2.0 * rise)
    arc = {"kind": "arc", "center": [0.0, rise - radius], "direction": "clockwise"}
    data = cantilever_data({"kind": "force", "point": "T", "direction": [0.0, -1.0]}, [0.1, 3.0])
    data["bodies"] = {
        "wall": {"motion": "fixed", "points": {"A": [-half, 0.0], "B": [half, 0.0]}},
        "top": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": [0.0, rise]}},
    }
    left, right = {**arc, "start": [-half, 0.0], "end": [0.0, rise]}, {**arc, "start": [0.0, rise], "end": [half, 0.0]}
    pin = {"joint": "pin"}
    data["beams"] = {
        "left": {**STRIP, "thickness": 0.0005, "curve": left, "start": {**pin, "point": "A"}, "end": weld("T")},
        "right": {**STRIP, "thickness": 0.0005, "curve": right, "start": weld("T"), "end": {**pin, "point": "B"}},
    }
    data["probes"] = [{"of": "T", "quantity": "displacement"}]
    refused(data, 1)


def test_a_tip_that_slides_off():
    # reference: tests.references.two_cantilevers, where the lower beam is long enough the tip stays on it
    refused(tip_on_beam(TwoCantilevers(0.02, 1.8, 0.82, 2.0), [0.5, 2.0]), 1, "touch", "slides off the end of lower")
    completed(tip_on_beam(TwoCantilevers(0.02, 1.8, 1.0, 2.0), [0.5, 2.0]))


def on_its_twin():
    """A cantilever pressed down along its length on another one that is stiffer: they lie on each other."""
    apart = THICKNESS + 1e-4
    data = cantilever_data(force(0.0, -1.0), [0.02 * UNIT, 40.0 * UNIT])
    data["bodies"]["wall"]["points"]["Q"] = [0.0, -apart]
    beam = {**STRIP, "thickness": THICKNESS, "width": 10.0 * STRIP["width"]}
    data["beams"]["under"] = {
        **beam,
        "curve": line([0.0, -apart], [1.5 * LENGTH, -apart]),
        "start": weld("Q"),
        "end": FREE,
    }
    data["contacts"] = {"pair": {"kind": "beam-beam", "between": ["beam", "under"]}}
    data["probes"].append({"of": "pair", "quantity": "force"})
    return data


def test_beams_that_lie_on_each_other():
    refused(on_its_twin(), 1, "pair")


def test_a_beam_that_may_touch_itself():
    data = cantilever_data(force(0.0, -1.0), [0.5 * UNIT])
    data["contacts"] = {"own": {"kind": "beam-self", "beam": "beam"}}
    with pytest.raises(SceneError, match=r"contacts\.own\.kind: found 'beam-self'; allowed: .* for the exact solution"):
        answer(data)


def test_a_wrap_with_a_varying_edge():
    data = cantilever_data(force(0.0, -1.0), [0.5 * UNIT, 60.0 * UNIT])
    data["beams"]["beam"]["thickness"] = {"at": [0.0, 1.0], "values": [THICKNESS, 0.5 * THICKNESS]}
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "radius": 0.5 * LENGTH}
    data["contacts"] = {"round": circle | {"center": [0.3 * LENGTH, -0.5 * LENGTH - 0.6 * THICKNESS]}}
    refused(data, 1, "round")


def test_a_wrap_of_a_beam_whose_width_varies():
    # reference: the CPRBM; clamp and zone share their force to first order (docs/contact-rules.md, 1).  With m' = 0 the
    # clamp's shear would be missing
    data = cantilever_data(force(0.0, -1.0), [12.0 * UNIT])
    data["beams"]["beam"]["width"] = {"at": [0.0, 1.0], "values": [0.009, 0.004]}
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "radius": 0.6 * LENGTH}
    data["contacts"] = {"round": circle | {"center": [0.0, -0.6 * LENGTH - 0.5 * THICKNESS]}}
    data["probes"] += [{"of": "round", "quantity": quantity} for quantity in ("force", "ends")]
    values = completed(data).stations[-1].values
    other = cprbm.answer(scene_from(data), cprbm.Settings(links=160)).stations[-1].values
    for probe in ("T.displacement", "R.reaction", "round.force", "round.ends"):
        scale = (1e-3 if probe.startswith("round") or probe == "R.reaction" else 1e-4) * np.max(np.abs(values[probe]))
        np.testing.assert_allclose(other[probe], values[probe], rtol=0.0, atol=scale, err_msg=probe)
    assert abs(values["R.reaction"][1]) > 0.01 * UNIT


@pytest.mark.parametrize("radius", [0.005, 0.02, 0.05])
def test_no_circle_is_passed_in_one_step(radius):
    # reference: without the circle the tip goes down by a third of the length, with it it stays above its top
    data = cantilever_data(force(0.0, -1.0), [4.0 * UNIT])
    place = [0.7 * LENGTH, -0.2 * LENGTH]
    circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "radius": radius * LENGTH, "center": place}
    data["contacts"] = {"pin": circle}
    data["probes"].append({"of": "pin", "quantity": "force"})
    values = completed(data).stations[-1].values
    assert values["pin.force"][0] > 0.5 * UNIT
    assert values["T.displacement"][1] > 0.7 * LENGTH * cantilever_under_tip_force(-4.0).y


def random_scene(seed):
    """The first of a series of random ones that is a scene."""
    for attempt in range(50):
        data = randomly(np.random.default_rng([57, seed, attempt]), seed)
        try:
            scene_from(data)
        except SceneError:
            continue
        return data
    raise AssertionError(seed)


def randomly(random, seed):
    """A cantilever or a pair of them with random sizes among circles, pushed far."""
    data = {**cantilever_data(force(*random.standard_normal(2).tolist()), []), "contacts": {}}
    if seed % 2:
        at = [float(random.uniform(0.3, 1.5)) * LENGTH, -float(random.uniform(0.1, 0.6)) * LENGTH]
        turn = float(random.uniform(0.0, 2.0 * np.pi))
        far = [at[0] + 0.4 * LENGTH * np.cos(turn), at[1] + 0.4 * LENGTH * np.sin(turn)]
        data["bodies"]["wall"]["points"]["Q"] = at
        data["beams"]["other"] = {**STRIP, "curve": line(at, far), "start": weld("Q"), "end": FREE}
        data["contacts"]["pair"] = {"kind": "beam-beam", "between": ["beam", "other"], "thick": seed % 4 == 1}
        data["loads"]["P"]["direction"] = [0.3, -1.0]
    else:
        for k in range(2):
            radius = float(random.uniform(0.03, 0.4)) * LENGTH
            place = [
                float(random.uniform(0.1, 1.0)) * LENGTH,
                (-1.0) ** k * (radius + float(random.uniform(0.1, 3.0)) * THICKNESS),
            ]
            circle = {"kind": "beam-circle", "beam": "beam", "body": "wall", "radius": radius, "center": place}
            data["contacts"][f"circle{k}"] = circle
    size = float(np.exp(random.uniform(0.0, 3.5))) * UNIT
    data["stages"][0]["stations"] = [0.1 * size, size, -0.5 * size]
    data["probes"] += [{"of": name, "quantity": "force"} for name in data["contacts"]]
    return data


@pytest.mark.parametrize("seed", [3, 4, 5])  # circles, and pairs with and without thickness
def test_no_scene_raises(seed):
    found = answer(random_scene(seed))
    assert found.ending in (Ending.COMPLETED, Ending.NOT_COVERED)
    assert bool(found.sentence) == (found.ending is Ending.NOT_COVERED)
    for station in found.stations:
        assert all(np.all(np.isfinite(value)) for value in station.values.values())
        assert station.certificate.smallest_curvature > 0.0


def test_the_post_buckled_column_without_its_push_is_refused():
    data = post_buckled(45.0)
    data["stages"] = data["stages"][1:2]  # half of the load is less than Euler's
    refused(data, 1, "fold or a bifurcation")
