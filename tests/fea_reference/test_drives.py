"""Slides and drives of the finite elements against the elastica, bars, and the same mechanism under loads."""

import numpy as np
import pytest

from cprbm_scene import Ending, Loss
from fea_reference import Settings, answer
from fea_reference.contacts import contacts
from fea_reference.curvature import softest
from fea_reference.march import begin
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble
from fea_reference.travel import Course, reach
from tests.cprbm.driven import TURN, UNIT_FORCE, UNIT_MOMENT, driven_cantilever, driven_hinge, guided, push
from tests.cprbm.scenes import LENGTH, MODULUS, THICKNESS, WIDTH, hinge
from tests.fea_reference.cantilever import elastica
from tests.fea_reference.test_curvature import dense
from tests.references.elastica import roll_up
from tests.references.guided import guided_beam
from tests.together.driven import gripper_like


def stages(*steps):
    return [{"name": f"stage{i}", "steps": name, "stations": list(values)} for i, (name, *values) in enumerate(steps)]


def last(scene, elements=40, kinematics="bending", penetration=1e-4):
    got = answer(scene, Settings(elements=elements, kinematics=kinematics, penetration=penetration))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got.stations[-1]


@pytest.mark.parametrize("alpha", [0.5, 3.0, 10.0])
def test_a_driven_tip_gives_back_the_elasticas_force(alpha):
    """Fourth order in the elements."""
    x, y, rotation = elastica(alpha)
    errors = []
    for elements in (10, 20):
        values = last(driven_cantilever({"d": push(0.0, 7.0)}, stages(("d", y * LENGTH))), elements).values
        assert values["T.displacement"][1] == pytest.approx(y * LENGTH, rel=1e-12)
        assert values["T.displacement"][0] / LENGTH == pytest.approx(x - 1.0, abs=3e-5)
        assert values["tip.rotation"][0] == pytest.approx(rotation, rel=1e-4)
        assert values["R.reaction"] == pytest.approx(-values["T.reaction"], abs=1e-9 * UNIT_FORCE)
        errors.append(abs(values["T.reaction"][1] / UNIT_FORCE - alpha))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.15)
    assert errors[1] < 1e-5 * alpha


@pytest.mark.parametrize("angle", [0.7, -2.0, 5.0])
def test_a_driven_rotation_rolls_the_cantilever_up(angle):
    """M = EI φ/L."""
    values = last(driven_cantilever({"d": TURN}, stages(("d", angle)))).values
    assert values["tip.reaction_moment"][0] == pytest.approx(angle * UNIT_MOMENT, rel=1e-9)
    assert values["R.reaction_moment"][0] == pytest.approx(-angle * UNIT_MOMENT, rel=1e-9)
    exact = np.array([roll_up(angle).x - 1.0, roll_up(angle).y])
    assert values["T.displacement"] / LENGTH == pytest.approx(exact, abs=1e-5)
    assert values["scene.potential_energy"][0] == pytest.approx(0.5 * angle**2 * UNIT_MOMENT, rel=1e-9)


@pytest.mark.parametrize("load", [4.0, -25.0])
def test_a_beam_between_two_slides_is_two_elasticas(load):
    """Under a load and driven to the same offset."""
    exact = guided_beam(load)
    loaded = last(guided(drive=False, station=load * UNIT_FORCE)).values
    driven = last(guided(drive=True, station=exact.offset * LENGTH)).values
    for values in (loaded, driven):
        assert values["T.displacement"] / LENGTH == pytest.approx([0.0, exact.offset], rel=1e-5, abs=1e-12)
        assert values["R.displacement"] / LENGTH == pytest.approx([exact.shortening, 0.0], rel=1e-5, abs=1e-12)
        assert values["far.displacement"] == pytest.approx(values["R.displacement"], abs=1e-12 * LENGTH)
        assert values["tip.rotation"][0] == pytest.approx(0.0, abs=1e-12)
        stress = MODULUS * THICKNESS / 2.0 / LENGTH * exact.moment
        assert values["beam.bending_stress"] == pytest.approx(stress * np.array([1, 0, -1]), abs=1e-5 * abs(stress))
    assert driven["T.reaction"] / UNIT_FORCE == pytest.approx([0.0, load], rel=1e-5, abs=1e-9)


def test_a_driven_bar_stretches():
    """EA/L per length, of the theory with stretch, for a tenth of a per mille."""
    strain = 1e-4
    values = last(driven_cantilever({"d": push(1.0, 0.0)}, stages(("d", strain * LENGTH))), 7, "stretch").values
    assert values["T.reaction"] == pytest.approx([strain * MODULUS * WIDTH * THICKNESS, 0.0], rel=1e-9, abs=1e-9)


def test_the_hinge_turned_by_a_drive_is_the_hinge_turned_by_a_moment():
    """With its contact closed: the reaction is the moment, and the rest the same.

    How deep the contact may be hangs on what is felt of it, which is less where a drive holds the rest: here the depth
    is a tenth of the standard one.
    """
    loaded = last(hinge(stages=stages(("M", 0.4))), penetration=1e-5).values
    driven = last(driven_hinge(float(loaded["BD.rotation"][0])), penetration=1e-5).values
    assert driven["BD.reaction_moment"][0] == pytest.approx(0.4, rel=1e-6)
    assert driven["contact.force"][0] > 1.0
    for name, value in loaded.items():
        if not name.endswith(("closing_load", "potential_energy")):
            assert driven[name] == pytest.approx(value, rel=1e-5, abs=1e-5 * np.max(np.abs(value))), name


def test_the_closing_load_is_a_value_of_the_drive():
    """The rotation that the hinge has under the moment at which it closes."""
    closing = last(hinge(stages=stages(("M", 0.4)))).values["contact.closing_load"][0]
    rotation = last(hinge(stages=stages(("M", closing * (1.0 - 1e-9))))).values["BD.rotation"][0]
    assert last(driven_hinge(0.45)).values["contact.closing_load"][0] == pytest.approx(rotation, rel=1e-6)


def test_a_drive_that_stretches_an_inextensible_beam_ends_in_a_sentence():
    scene = driven_cantilever({"d": push(1.0, 0.0)}, stages(("d", 1e-3 * LENGTH)))
    got = answer(scene, Settings(elements=10, kinematics="bending"))
    assert got.ending is Ending.STEP_TOO_SMALL
    assert "d = 0" in got.sentence
    assert not got.stations


def test_a_strut_that_is_driven_beyond_eulers_load_is_no_minimum():
    """A clamped strut with a free end, pushed straight: π² t²/48L² of strain is Euler's, and beyond nothing holds."""
    euler = np.pi**2 * THICKNESS**2 / (48.0 * LENGTH)
    scene = driven_cantilever({"d": push(-1.0, 0.0)}, stages(("d", 0.9 * euler, 1.1 * euler)))
    got = answer(scene, Settings(elements=20, kinematics="stretch"))
    assert got.ending is Ending.BRANCH_ENDS
    assert [critical.loss for critical in got.critical] == [Loss.BIFURCATION]
    # the strain itself, some 1e-5, changes length and load by shares as small
    assert got.critical[0].value == pytest.approx(euler, rel=1e-4)
    assert len(got.stations) == 1


def disturbed(scene):
    model = build(scene, Settings(elements=3))
    random = np.random.default_rng(5)
    z = model.start.values + 0.1 * random.standard_normal(model.size)
    return model, z, random.standard_normal(len(model.stepped))


def test_the_whole_tangent_with_guides_drives_and_loads():
    model, z, values = disturbed(gripper_like())
    assert (len(model.guides), len(model.drives), len(model.loads)) == (2, 2, 1)

    def at(z):
        return assemble(model, {}, 6, values, State.of(z), model.initial_constraints)

    bodies = np.concatenate([body.dofs for body in model.bodies if body.dofs is not None])
    tangent = at(z).tangent.matrix.toarray()
    assert tangent == pytest.approx(tangent.T, abs=1e-12 * np.abs(tangent).max())
    for i in range(model.size):
        step = np.zeros(model.size)
        step[i] = 1e-6
        slope = (at(z + step).residual - at(z - step).residual) / 2e-6
        assert tangent[:, i] == pytest.approx(slope, abs=1e-6 * np.abs(tangent).max())
        # beside the elements' stiffness the bodies' own entries are small
        assert tangent[bodies, i] == pytest.approx(slope[bodies], abs=1e-7)


@pytest.mark.parametrize("stations", [1, 2, 4])
def test_the_smallest_curvature_is_on_what_guides_and_drives_leave_free(stations):
    scene, settings = gripper_like(), Settings(elements=10, kinematics="bending")
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    names = [part.name for part in model.stepped]
    asked = [(names.index(stage.steps), value) for stage in scene.stages for value in stage.stations]
    for number, value in asked[:stations]:
        reach(march, Course(number, 1.0), value / model.stepped[number].unit)
    assert softest(model, march.system).curvature == pytest.approx(dense(model, march.system), rel=1e-3)
