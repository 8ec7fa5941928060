"""Beams that are parabolas when free of stress: both solvers beside an independent integration, and in contact."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from
from tests.references.curved import bent
from tests.together.bowed import CLAMP, MOMENT, PARABOLA, RIGIDITY, TIP, cantilever, force, on_a_beam, on_a_circle

LENGTH = 0.0643879  # about: a scale for errors and loads
OPEN, CLOSED = (1.0, 0.2), (-0.6, 0.8)  # directions of tip forces that open the bow and that wind it up
LOADS = {
    "opened": (force(*OPEN), 4.0 * RIGIDITY / LENGTH**2),
    "wound": (force(*CLOSED), 6.0 * RIGIDITY / LENGTH**2),
    "moment": (MOMENT, 2.5 * RIGIDITY / LENGTH),
}


@cache
def exact(name):
    """Reference: tests.references.curved, which integrates the differential equation over y."""
    load, value = LOADS[name]
    if name == "moment":
        return bent(lambda y: 29.28 * y, "y", (0.0, 0.05), RIGIDITY, moment=value)
    direction = np.array(load["direction"]) / np.hypot(*load["direction"])
    return bent(lambda y: 29.28 * y, "y", (0.0, 0.05), RIGIDITY, force=tuple(value * direction))


def cprbm_answer(scene, n):
    return cprbm.answer(scene, cprbm.Settings(links=n))


def fea_answer(scene, n):
    return fea_reference.answer(scene, fea_reference.Settings(elements=n, kinematics="bending"))


def values(solve, data, n):
    answer = solve(scene_from(data), n)
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations[-1].values


def errors(solve, name, n):
    """Of the tip's place over the length, its rotation, and the moment at the clamp over that of the load."""
    load, value = LOADS[name]
    found, true = values(solve, cantilever(load, [value]), n), exact(name)
    return np.array(
        [
            np.hypot(*(found["T.displacement"] - true.displacement)) / LENGTH,
            abs(found["tip.rotation"][0] - true.rotation),
            abs(found["R.reaction_moment"][0] + true.clamp_moment) / abs(true.clamp_moment),
        ]
    )


@pytest.mark.parametrize(
    ("solve", "counts", "order", "last"),
    [(cprbm_answer, (20, 40, 80), 4.0, 2e-6), (fea_answer, (8, 16, 32), 4.0, 5e-7)],
    ids=["cprbm", "fea"],
)
@pytest.mark.parametrize("name", ["opened", "wound"])
def test_tip_forces(solve, counts, order, last, name):
    assert np.hypot(*exact(name).displacement) > 0.3 * LENGTH
    found = np.array([errors(solve, name, n) for n in counts])
    assert np.all(np.log2(found[0] / found[-1]) / 2.0 > order - 0.1)
    assert np.all(found[-1] < last)


@pytest.mark.parametrize(
    ("solve", "counts", "order", "last"),
    [(cprbm_answer, (20, 40, 80), 4.0, 2e-6), (fea_answer, (8, 16, 32), 4.0, 5e-7)],
    ids=["cprbm", "fea"],
)
def test_a_tip_moment(solve, counts, order, last):
    found = np.array([errors(solve, "moment", n) for n in counts])
    assert np.log2(found[:-1, 0] / found[1:, 0]) == pytest.approx([order, order], abs=0.06)
    assert found[-1, 0] < last
    # an even moment turns every element alike, whatever its shape
    assert np.all(found[:, 1:] < 1e-11)


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer], ids=["cprbm", "fea"])
def test_a_beam_of_degree_one_is_a_line(solve):
    slope = (TIP[0] - CLAMP[0]) / (TIP[1] - CLAMP[1])
    straight = {"kind": "polynomial", "axis": "y", "coefficients": [0.05, slope], "range": [0.0, 0.05]}
    load, value = LOADS["opened"]
    here = values(solve, cantilever(load, [value], straight), 20)
    line = values(solve, cantilever(load, [value], {"kind": "line", "start": CLAMP, "end": TIP}), 20)
    assert here.keys() == line.keys()
    for name, value in line.items():
        assert here[name] == pytest.approx(value, rel=1e-10, abs=1e-10 * np.max(np.abs(value))), name


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer], ids=["cprbm", "fea"])
def test_the_beam_may_run_against_its_axis(solve):
    load, value = LOADS["wound"]
    data = cantilever(load, [value])
    forwards = values(solve, data, 20)
    beam = data["beams"]["beam"]
    data["beams"]["beam"] = {**beam, "curve": {**PARABOLA, "range": [0.05, 0.0]}}
    data["beams"]["beam"] |= {"start": beam["end"], "end": beam["start"]}
    backwards = values(solve, data, 20)
    for name in ("T.displacement", "tip.rotation", "R.reaction_moment"):
        assert backwards[name] == pytest.approx(forwards[name], rel=1e-9, abs=1e-12)
    # curvature changes its sign with the direction of the beam
    stress = forwards["beam.bending_stress"]
    assert backwards["beam.bending_stress"][::-1] == pytest.approx(-stress, abs=1e-8 * np.max(np.abs(stress)))


@pytest.mark.parametrize("solve", [cprbm_answer, fea_answer], ids=["cprbm", "fea"])
def test_a_graph_over_x_is_the_mirror_image_of_one_over_y(solve):
    # x and y exchanged: a mirror image, so rotations and moments change their signs and the rest its axes
    load, value = LOADS["opened"]
    data = cantilever(load, [value])
    upright = values(solve, data, 20)
    for body in data["bodies"].values():
        body["points"] = {name: place[::-1] for name, place in body["points"].items()}
    data["loads"]["P"] = {**load, "direction": load["direction"][::-1]}
    data["beams"]["beam"]["curve"] = {**PARABOLA, "axis": "x"}
    level = values(solve, data, 20)
    assert level["T.displacement"][::-1] == pytest.approx(upright["T.displacement"], rel=1e-9)
    for name in ("tip.rotation", "R.reaction_moment", "beam.bending_stress"):
        assert level[name] == pytest.approx(-upright[name], rel=1e-9, abs=1e-9 * np.max(np.abs(upright[name])))


@pytest.mark.parametrize("data", [on_a_circle(8.0), on_a_beam(8.0)], ids=["circle", "beam"])
def test_contact(data):
    """A pull that closes the contact: the CPRBM nears the finite elements, and its own steps fall or are small."""
    reference = values(fea_answer, data, 80)
    assert reference["touch.force"][0] > 1.0
    for name, last in (("T.displacement", 3e-4), ("tip.rotation", 3e-4), ("touch.force", 1e-3)):
        found = [values(cprbm_answer, data, n)[name] for n in (20, 40, 80)]
        size = np.linalg.norm(reference[name])
        off = [np.linalg.norm(value - reference[name]) / size for value in found]
        assert off[-1] < last, name
        # of the CPRBM's own steps, which the finite elements' penalty does not blur
        steps = [np.linalg.norm(b - a) for a, b in pairwise(found)]
        assert steps[1] < max(steps[0] / 3.0, 0.01 * last * size), name
