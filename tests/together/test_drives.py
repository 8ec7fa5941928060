"""Slides and drives: the two solvers through the verdict, and wrong ones that it must catch."""

from dataclasses import replace
from math import hypot

import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, cprbm_answer, paired
from comparisons.present.curves import curve_figures
from comparisons.quantities import load_unit, natural_value
from comparisons.verdict import Reason, Word
from tests.cprbm.driven import driven_hinge
from tests.together.driven import GAP, gripper_like, punched, snapping


def curves_of(compared):
    return curve_figures(compared.scene, compared.runs.answers["fea"], compared.runs.answers["cprbm"])


@pytest.fixture(scope="module")
def scene():
    return gripper_like()


def agreed(scene):
    """Both solvers' answers at standard choices, which must agree."""
    runs = paired(scene, Choices(), Solvers())
    verdict = compare(runs).verdict
    assert verdict.word is Word.AGREE, verdict.sentence
    return runs.answers["cprbm"], runs.answers["fea"]


def test_the_verdict_is_agree(scene):
    """Slide, driven point, driven rotation and a load on the slide, in all three theories."""
    found = compare(paired(scene, Choices(), Solvers()))
    assert found.verdict.word is Word.AGREE, found.verdict.sentence
    assert {row.probe.name for row in found.rows} == {probe.name for probe in scene.probes}


@pytest.mark.parametrize("probe", ["M.reaction", "block.reaction_moment", "S.displacement"])
def test_a_drives_reaction_or_a_slide_that_is_two_per_cent_wrong_is_caught(scene, probe):
    def wrong(scene, choices):
        answer = cprbm_answer(scene, choices)
        stations = tuple(
            replace(station, values={k: 1.02 * v if k == probe else v for k, v in station.values.items()})
            for station in answer.stations
        )
        return replace(answer, stations=stations)

    found = compare(paired(scene, Choices(), Solvers(cprbm=wrong)))
    assert found.verdict.word is Word.DIFFER
    assert probe in found.verdict.sentence


def test_the_solvers_agree_on_a_driven_hinge_but_for_the_theory_and_its_stations_are_angles():
    # at a prescribed angle shear changes the contact force by more than the scene allows
    scene = driven_hinge(0.6)
    found = compare(paired(scene, Choices(kinematics="bending"), Solvers()))
    assert {row.reason for row in found.rows} == {None, Reason.THEORY}, found.verdict.sentence
    closing = next(row for row in found.rows if row.probe.quantity == "closing_load")
    assert closing.unit == "rad"
    assert load_unit(scene, scene.stages[0].name) == "rad"


def test_units_and_natural_scales_of_what_stages_step(scene):
    assert [load_unit(scene, stage.name) for stage in scene.stages] == ["m", "rad", "N"]
    ell = hypot(0.09, 0.05)  # of the straight beam, m
    EI = 2.3e9 * 0.0083 * 0.0021**3 / 12.0
    natural = [natural_value(scene, "closing_load", stage, contact="") for stage in scene.stages]
    assert natural == pytest.approx([ell, 1.0, EI / ell**2], rel=1e-12)


@pytest.mark.usefixtures("unprinted")
def test_curves_against_different_loads_are_figures_of_their_own(scene):
    found = compare(paired(scene, Choices(kinematics="bending", links=8, elements=8), Solvers()))
    names = [figure.name for figure in curves_of(found)]
    stations = {}
    for stage in scene.stages:
        stations.setdefault(stage.steps, set()).update(stage.stations)
    assert names == [f"path-{steps}" for steps, values in stations.items() if len(values) > 1]


def test_a_driven_circle_presses_a_beam_and_lets_it_go():
    """Open stations without any force among them; the drive pushes with what the wall holds against."""
    for answer in agreed(punched()):
        first, *pressed, last = answer.stations
        for station in (first, last):
            assert station.values["circle.force"][0] == 0.0
            assert station.values["circle.closing_load"].size == 0
        for station in pressed:
            assert station.values["circle.closing_load"][0] == pytest.approx(GAP, rel=1e-6)
            drive, wall, push = (station.values[name] for name in ("K.reaction", "R.reaction", "circle.force"))
            assert drive[0] == pytest.approx(0.0, abs=1e-12 * push[0])  # the slide holds the rest
            assert drive[1] == pytest.approx(-wall[1], rel=1e-8)
            assert push[0] == pytest.approx(float(wall @ wall) ** 0.5, rel=1e-8)


def test_a_drive_goes_through_a_limit_point():
    """The push grows, falls and becomes a pull; a load would have jumped. Both supports share it."""
    for answer in agreed(snapping()):
        pushes = [station.values["T.reaction"][1] for station in answer.stations]
        assert pushes[1] < pushes[0] < pushes[2] < 0.0 < pushes[3]
        for station, push in zip(answer.stations, pushes, strict=True):
            assert station.values["A.reaction"][1] == pytest.approx(-0.5 * push, rel=1e-6)
