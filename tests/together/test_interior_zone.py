"""A beam that lies on a circle away from its clamp: the zone's ends, drawn from either side and beside exact ones."""

import numpy as np
import pytest

import cprbm
import elastica_reference
from tests.cprbm.test_circle import BEAM, RADIUS, scene_of

LENGTH = BEAM["length"]
PLACES = [(0.02, 137.0), (0.04, 300.0), (0.04, 600.0)]


def ends(solver, scene, *settings):
    answer = solver.answer(scene, *settings)
    assert answer.completed, answer.sentence
    return answer.stations[-1].values["circle.ends"] / LENGTH


def lying(place, load):
    return scene_of([load], center=[place, -RADIUS - BEAM["thickness"] / 2.0])


def drawn_backwards(scene):
    beam = scene.beams["beam"]
    curve = beam.curve.model_copy(update={"start": beam.curve.end, "end": beam.curve.start})
    backwards = beam.model_copy(update={"curve": curve, "start": beam.end, "end": beam.start})
    return scene.model_copy(update={"beams": {"beam": backwards}})


@pytest.mark.parametrize(("place", "load"), PLACES)
def test_the_ends_are_those_of_the_beam_drawn_from_its_other_end(place, load):
    forwards, settings = lying(place, load), cprbm.Settings(links=40)
    one, other = ends(cprbm, forwards, settings), 1.0 - ends(cprbm, drawn_backwards(forwards), settings)[::-1]
    # as closely as the mesh is fitted to them
    assert other == pytest.approx(one, abs=0.02 / 40)


@pytest.mark.parametrize(("place", "load"), PLACES)
def test_the_ends_converge_evenly(place, load):
    # reference: the beam's differential equations, integrated to round-off
    scene, counts = lying(place, load), np.array([30, 40, 57])
    truth = ends(elastica_reference, scene)
    errors = np.array([np.abs(ends(cprbm, scene, cprbm.Settings(links=n)) - truth) for n in counts.tolist()])
    assert np.all(errors < 2.0 / counts[:, None] ** 2)
    orders = -np.diff(np.log(errors[:, 0])) / np.diff(np.log(counts))
    assert orders == pytest.approx([2.0, 2.0], abs=0.6)
