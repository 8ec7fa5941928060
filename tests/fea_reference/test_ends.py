"""Where a zone of contact ends, against the closed form of the wrapped beam."""

from dataclasses import replace

import numpy as np
import pytest

from cprbm_scene import Ending
from fea_reference import Settings, answer
from tests.fea_reference.test_circle import on_circle
from tests.references.wrapped import Wrapped

T, WIDTH, RADIUS = 0.01, 0.05, 0.5
EXACT = Wrapped(
    length=1.0, radius=RADIUS - T / 2, thickness=T, width=WIDTH, youngs_modulus=12 / (WIDTH * T**3), force=1.0
)


def asked(scene):
    return scene.model_copy(update={"probes": (*scene.probes, scene.probes[3].model_copy(update={"quantity": "ends"}))})


def ends(scene, **settings):
    got = answer(asked(scene), Settings(**{"kinematics": "bending", "elements": 80, **settings}))
    assert got.ending is Ending.COMPLETED, got.sentence
    return [station.values["contact.ends"] for station in got.stations]


def test_a_wrap_ends_where_the_closed_form_says_to_second_order():
    """An overlap would end a layer's width, a third of an element, beyond or before."""
    loads = (5.0, 7.0, 11.0)
    exact = [replace(EXACT, force=load).wrap_length for load in loads]
    errors = []
    for n in (20, 40, 80, 160):
        found = ends(on_circle(loads), elements=n)
        assert all(first == 0.0 for first, _ in found)
        errors.append(np.abs([last for _, last in found] - np.array(exact)).max())
    assert errors[0] < 1e-3
    assert np.log2(errors[0] / errors[-1]) / 3 > 1.8


@pytest.mark.parametrize("kinematics", ["bending", "stretch", "shear"])
def test_a_circle_that_props_in_a_point_has_both_ends_there(kinematics):
    (found,) = ends(on_circle((1e-3,), center=(0.4, -0.01 - T / 2), circle=0.01), kinematics=kinematics)
    assert found == pytest.approx([0.4, 0.4], abs=1.0 / 80)
    assert found[0] == found[1]


def test_an_open_contact_has_no_ends():
    (found,) = ends(on_circle((1e-3,), center=(0.4, -0.3), circle=0.1))
    assert found.size == 0
