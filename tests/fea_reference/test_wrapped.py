"""The beam pressed round a circle at every fineness, against its closed form, tests.references.wrapped."""

import numpy as np
import pytest

from comparisons import cases
from cprbm_scene import Ending
from fea_reference import Settings, answer
from tests.references.wrapped import Wrapped

LENGTH = 0.0973


@pytest.fixture(scope="module")
def scene():
    return cases.opened("wrapped")


def exact(load):
    """The closed form at a load, with the numbers that the case states."""
    return Wrapped(length=LENGTH, radius=0.0711, thickness=0.00103, width=0.0097, youngs_modulus=2.07e11, force=load)


def solved(scene, elements, kinematics="bending", penetration=1e-4):
    got = answer(scene, Settings(elements=elements, kinematics=kinematics, penetration=penetration))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got


def at_loads(scene, *loads):
    """The scene at some of its loads."""
    stages = tuple(stage.model_copy(update={"stations": loads}) for stage in scene.stages)
    return scene.model_copy(update={"stages": stages})


def errors(got):
    """Of tip, force, centre, end and reaction, each over its own size or the beam's length: (stations, 5)."""
    found = []
    for station in got.stations:
        truth, values = exact(station.value), station.values
        if not truth.wrapped:
            assert values["contact.force"][0] == 0.0
            assert values["contact.ends"].size == 0
            continue
        assert values["contact.ends"][0] == 0.0
        found.append(
            [
                np.hypot(*(values["T.displacement"] - truth.displacement)) / np.hypot(*truth.displacement),
                abs(values["contact.force"][0] / np.hypot(*truth.contact_force) - 1.0),
                abs(values["contact.centre"][0] - truth.contact_centre) / LENGTH,
                abs(values["contact.ends"][1] - truth.wrap_length) / LENGTH,
                np.hypot(*(values["C.reaction"] - truth.reaction)) / station.value,
            ]
        )
    return np.array(found)


def test_every_error_falls_with_the_element(scene):
    """From 20 to 160 elements by at least 2.5 for each of three halvings, on average, down to a part in a million."""
    found = np.array([errors(solved(scene, n)).max(axis=0) for n in (20, 160)])
    assert (found[0] < [1e-4, 2e-4, 1e-4, 3e-4, 2e-4]).all()  # the penalty is what 20 elements can follow
    assert (found[-1] < 2e-6).all()
    assert (found[0] / found[-1] > 2.5**3).all()


def test_shear_is_even_in_the_elements(scene):
    """The resultant of a stretching beam does not depend on how the elements' lengths compare with its thickness."""
    coarse, middle, fine = (
        np.array(
            [
                station.values["contact.force"][0]
                for station in solved(at_loads(scene, 43.0, 191.0), n, "shear").stations
            ]
        )
        for n in (40, 80, 160)
    )
    change, next_change = np.abs(middle - coarse) / coarse, np.abs(fine - middle) / middle
    assert change.max() < 5e-4
    assert (next_change < np.maximum(change, 1e-5)).all()


def test_fine_meshes_are_certified(scene):
    """Round-off leaves the balance of a thousand elements where it was, and iterations hardly grow."""
    coarse, fine = (solved(at_loads(scene, 97.0), n) for n in (40, 1280))
    for station in fine.stations:
        assert station.certificate.force_balance < 1e-8
        assert station.certificate.moment_balance < 1e-8
    iterations = [sum(station.certificate.iterations for station in got.stations) for got in (coarse, fine)]
    assert iterations[1] <= 2.0 * iterations[0]
    mu = [got.stations[-1].certificate.smallest_curvature for got in (coarse, fine)]
    assert mu[1] == pytest.approx(mu[0], rel=5e-3)
