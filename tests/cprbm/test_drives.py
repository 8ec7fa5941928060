"""Slides and drives against the elastica and against the same mechanism under loads."""

import numpy as np
import pytest

import cprbm
from cprbm import Settings
from cprbm_scene import Ending
from tests.cprbm.driven import TURN, UNIT_FORCE, UNIT_MOMENT, driven_cantilever, driven_hinge, guided, push
from tests.cprbm.scenes import LENGTH, MODULUS, THICKNESS, cantilever, force, hinge
from tests.references.elastica import cantilever_under_tip_force, roll_up
from tests.references.guided import guided_beam


def stages(*steps):
    return [{"name": f"stage{i}", "steps": name, "stations": list(values)} for i, (name, *values) in enumerate(steps)]


def last(scene, links=40):
    answer = cprbm.answer(scene, Settings(links=links))
    assert answer.ending is Ending.COMPLETED, answer.sentence
    return answer.stations[-1]


@pytest.mark.parametrize("alpha", [0.5, -3.0, 10.0])
def test_a_driven_tip_gives_back_the_elasticas_force(alpha):
    """Fourth order in the links, to the force under which the elastica has that deflection."""
    tip = cantilever_under_tip_force(alpha)
    errors = []
    for links in (20, 40, 80):
        scene = driven_cantilever({"d": push(0.0, 7.0)}, stages(("d", tip.y * LENGTH)))
        values = last(scene, links).values
        assert values["T.displacement"][1] == pytest.approx(tip.y * LENGTH, rel=1e-12)
        assert values["T.reaction"][0] == pytest.approx(0.0, abs=1e-12 * UNIT_FORCE)
        assert values["R.reaction"] == pytest.approx(-values["T.reaction"], abs=1e-9 * UNIT_FORCE)
        assert values["tip.rotation"][0] == pytest.approx(tip.rotation, rel=0.5 / links)
        errors.append(abs(values["T.reaction"][1] / UNIT_FORCE - alpha))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(16.0, rel=0.1)
    assert errors[2] < 1e-6 * abs(alpha)


@pytest.mark.parametrize("angle", [0.7, -2.0, 5.0])
def test_a_driven_rotation_rolls_the_cantilever_up(angle):
    """M = EI φ/L, exactly in every discretisation; 5 rad need more than one step."""
    values = last(driven_cantilever({"d": TURN}, stages(("d", angle)))).values
    assert values["tip.reaction_moment"][0] == pytest.approx(angle * UNIT_MOMENT, rel=1e-10)
    assert values["R.reaction_moment"][0] == pytest.approx(-angle * UNIT_MOMENT, rel=1e-10)
    exact = np.array([roll_up(angle).x - 1.0, roll_up(angle).y])
    assert values["T.displacement"] / LENGTH == pytest.approx(exact, abs=2e-3)
    assert values["scene.potential_energy"][0] == pytest.approx(0.5 * angle**2 * UNIT_MOMENT, rel=1e-10)


@pytest.mark.parametrize("load", [4.0, -25.0])
def test_a_beam_between_two_slides_is_two_elasticas(load):
    """Under a load and driven to the same offset: offset, slide, clamping moment and force."""
    exact = guided_beam(load)
    loaded = last(guided(drive=False, station=load * UNIT_FORCE), 160).values
    driven = last(guided(drive=True, station=exact.offset * LENGTH), 160).values
    for values in (loaded, driven):
        assert values["T.displacement"] / LENGTH == pytest.approx([0.0, exact.offset], rel=2e-4, abs=1e-12)
        assert values["R.displacement"] / LENGTH == pytest.approx([exact.shortening, 0.0], rel=5e-4, abs=1e-12)
        assert values["far.displacement"] == pytest.approx(values["R.displacement"], abs=1e-12 * LENGTH)
        assert values["tip.rotation"][0] == pytest.approx(0.0, abs=1e-12)
        stress = MODULUS * THICKNESS / 2.0 / LENGTH * exact.moment
        assert values["beam.bending_stress"] == pytest.approx(stress * np.array([1, 0, -1]), abs=1e-3 * abs(stress))
    assert driven["T.reaction"] / UNIT_FORCE == pytest.approx([0.0, load], rel=5e-4, abs=1e-9)
    # a dead load's work is in the potential energy, a drive's is not
    work = load * exact.offset * UNIT_FORCE * LENGTH
    stored = driven["scene.potential_energy"][0]
    assert loaded["scene.potential_energy"][0] == pytest.approx(stored - work, rel=1e-3)


def test_the_hinge_turned_by_a_drive_is_the_hinge_turned_by_a_moment():
    """With its contact closed: the reaction is the moment, and everything else the same."""
    loaded = last(hinge(stages=stages(("M", 0.4)))).values
    driven = last(driven_hinge(float(loaded["BD.rotation"][0]))).values
    assert driven["BD.reaction_moment"][0] == pytest.approx(0.4, rel=1e-8)
    assert driven["contact.force"][0] > 1.0
    for name, value in loaded.items():
        if name.endswith(("closing_load", "potential_energy")):
            continue
        assert driven[name] == pytest.approx(value, rel=1e-7, abs=1e-7 * np.max(np.abs(value))), name


def test_the_closing_load_is_a_value_of_the_drive():
    """The rotation that the hinge has, without a contact force yet, under the moment at which it closes."""
    closing = last(hinge(stages=stages(("M", 0.4)))).values["contact.closing_load"][0]
    rotation = last(hinge(stages=stages(("M", closing)))).values["BD.rotation"][0]
    driven = last(driven_hinge(0.45)).values
    assert driven["contact.closing_load"][0] == pytest.approx(rotation, rel=1e-8)


def test_the_reaction_is_the_slope_of_the_energy():
    """dE/dd of the strain energy by the drive's displacement: work and energy, without any multiplier."""
    d, h = 0.3 * LENGTH, 1e-4 * LENGTH
    energies = [
        last(driven_cantilever({"d": push(1.0, 2.0)}, stages(("d", value)))).values["scene.potential_energy"][0]
        for value in (d - h, d + h)
    ]
    values = last(driven_cantilever({"d": push(1.0, 2.0)}, stages(("d", d)))).values
    along = values["T.reaction"] @ np.array([1.0, 2.0]) / np.sqrt(5.0)
    assert along == pytest.approx((energies[1] - energies[0]) / (2 * h), rel=1e-6)
    assert values["T.reaction"] @ np.array([-2.0, 1.0]) == pytest.approx(0.0, abs=1e-12 * abs(along))


def test_a_drive_that_no_stage_has_stepped_holds():
    """A tip that does not turn, then pushed: the guided beam again, with the drive's moment at its end."""
    exact = guided_beam(5.0)
    drives = {"hold": TURN, "d": push(0.0, 1.0)}
    values = last(driven_cantilever(drives, stages(("d", exact.offset * LENGTH))), 160).values
    assert values["tip.rotation"][0] == pytest.approx(0.0, abs=1e-13)
    assert values["T.reaction"][1] / UNIT_FORCE == pytest.approx(5.0, rel=1e-3)
    assert values["tip.reaction_moment"][0] / UNIT_MOMENT == pytest.approx(-exact.moment, rel=1e-3)


def test_a_drive_keeps_its_last_value_and_the_way_there_does_not_matter():
    drives = {"a": push(0.0, 1.0), "t": TURN}
    one = last(driven_cantilever(drives, stages(("a", 0.3 * LENGTH), ("t", 0.2))))
    other = last(driven_cantilever(drives, stages(("t", -0.5, 0.2), ("a", 0.1 * LENGTH, 0.3 * LENGTH))))
    assert one.values["T.displacement"][1] / LENGTH == pytest.approx(0.3, rel=1e-12)
    assert one.values["tip.rotation"][0] == pytest.approx(0.2, rel=1e-12)
    for name, value in one.values.items():
        assert other.values[name] == pytest.approx(value, rel=1e-8, abs=1e-8 * np.max(np.abs(value))), name


def test_a_drive_back_to_zero_leaves_nothing():
    values = last(driven_cantilever({"d": push(0.0, 1.0)}, stages(("d", 0.5 * LENGTH), ("d", 0.0)))).values
    assert values["T.reaction"] == pytest.approx([0.0, 0.0], abs=1e-9 * UNIT_FORCE)


def test_a_drive_that_stretches_an_inextensible_beam_ends_in_a_sentence():
    answer = cprbm.answer(driven_cantilever({"d": push(1.0, 0.0)}, stages(("d", 1e-3 * LENGTH))))
    assert answer.ending is Ending.STEP_TOO_SMALL
    assert "d is 0" in answer.sentence
    assert not answer.stations


def test_load_and_drive_together_balance():
    """A force along the beam beside a drive across: the wall takes both, and what the drive gives is its share."""
    pull = force(1.0, 0.0)
    station = last(
        driven_cantilever(
            {"d": push(0.0, 1.0)}, stages(("d", 0.3 * LENGTH), ("F", 2.0 * UNIT_FORCE)), loads={"F": pull}
        )
    )
    values = station.values
    assert values["R.reaction"] + values["T.reaction"] == pytest.approx([-2.0 * UNIT_FORCE, 0.0], abs=1e-9 * UNIT_FORCE)
    assert station.certificate.force_balance < 1e-12
    assert station.certificate.moment_balance < 1e-9
    both = last(
        cantilever(
            force(2.0 * UNIT_FORCE, values["T.reaction"][1]), [np.hypot(2.0 * UNIT_FORCE, values["T.reaction"][1])]
        )
    )
    assert both.values["T.displacement"] == pytest.approx(values["T.displacement"], rel=1e-7)
