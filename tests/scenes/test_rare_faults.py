"""Rare scenes with silent faults: a wrong CPRBM must still DIFFER, and critical points have a record."""

from dataclasses import replace

import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import cprbm_answer, paired, solvers_of
from comparisons.verdict import Word
from cprbm_scene import Loss, Scene
from fea_reference import Settings, answer
from tests.scenes.rare_scenes import ASKED, scene
from tests.together.planted import asked_of, stiffer, without_contact

CHOICES = Choices(links=40, elements=40, kinematics="bending")


def word(question: Scene, wrong):
    """The verdict's word where the CPRBM is replaced."""
    solvers = replace(solvers_of(None), cprbm=wrong)
    return compare(paired(question, CHOICES, solvers, bare=True)).verdict.word


@pytest.mark.parametrize("name", ["two-corners-at-one-place", "flat-beside-its-pin"])
def test_a_stiffer_material_differs_although_the_share_of_a_contact_is_indeterminate(name):
    assert word(scene(name), asked_of(cprbm_answer, stiffer)) is Word.DIFFER


def test_an_ignored_contact_is_not_an_open_contact():
    # 0.05 rad beyond the closing angle, 0.045 rad beyond the scene's own station
    question = scene("rolled-hardly-closed")
    (stage,) = question.stages
    farther = stage.model_copy(update={"stations": (stage.stations[0] + 0.045,)})
    question = question.model_copy(update={"stages": (farther,)})
    assert word(question, without_contact(cprbm_answer)) is Word.DIFFER


@pytest.mark.parametrize("solver", ASKED)
def test_two_corners_at_one_place_carry_the_force_of_a_single_corner(solver):
    # both scenes are the same mechanics; two penalties at the same corner act as a penalty twice as stiff
    both, alone = (ASKED[solver](scene(name)) for name in ("two-corners-at-one-place", "one-corner-alone"))
    assert both.completed, both.sentence
    for pair, single in zip(both.stations, alone.stations, strict=True):
        force = pair.values["flat.force"][0] + pair.values["steep.force"][0]
        assert single.values["flat.force"][0] > 0.1
        assert force == pytest.approx(single.values["flat.force"][0], rel=1e-4)
        energy = "scene.potential_energy"
        assert pair.values[energy][0] == pytest.approx(single.values[energy][0], rel=1e-5)


@pytest.mark.parametrize("elements", [40, 80])
def test_a_beam_does_not_pass_the_end_of_a_line_in_silence(elements):
    # the limit of the CPRBM in shear: 0.8197 rad.  At 40 elements a step led round the end of the line without a
    # contact, and at 80 a tighter penalty led off the end
    (slip,) = answer(scene("end-past-a-line"), Settings(elements=elements, kinematics="shear")).critical
    assert (slip.loss, slip.what) == (Loss.SLIP, "contact1")
    assert slip.value == pytest.approx(0.8197, abs=3e-4)
