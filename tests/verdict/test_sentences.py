"""Sentences of a verdict: the deciding row, the uncertain solver, and the next command."""

import re
from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.present.brief import brief
from cprbm_scene import Ending, Loss
from tests.verdict.comparing import altered, compared, ending, only, word_of
from tests.verdict.jumping import Jumping
from tests.verdict.made_up import MadeUp, with_value

C, F = MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)


COARSE = MadeUp("cprbm", 2e-2), MadeUp("fea", -8e-2)


@pytest.fixture
def away(hinge):
    """The hinge without the station 0.201, beside the closing of the contact."""
    (stage,) = hinge.stages
    stations = tuple(value for value in stage.stations if value != 0.201)
    return hinge.model_copy(update={"stages": (stage.model_copy(update={"stations": stations}),)})


@pytest.mark.parametrize(
    ("cprbm", "fea", "options"),
    [(COARSE[0], F, {"-n"}), (MadeUp("cprbm", 1e-3), COARSE[1], {"--elements"}), (*COARSE, {"-n", "--elements"})],
)
def test_the_size_of_the_hint_makes_the_limit(away, cprbm, fea, options):
    """Errors of second order: the sizes of the command make AGREE, half of the sizes make UNDECIDED."""
    found = compared(away, cprbm, fea)
    assert word_of(found) == "UNDECIDED COARSE"
    command = re.search(r"`([^`]*)` would do", found.verdict.because)[1].split()
    sizes = dict(zip(command[::2], map(int, command[1::2]), strict=True))
    assert set(sizes) == options
    for share, word in ((1.0, "AGREE"), (0.5, "UNDECIDED")):
        asked = {name: int(share * size) for name, size in sizes.items()}
        choices = Choices(links=asked.get("-n", 40), elements=asked.get("--elements", 80))
        assert word_of(compared(away, cprbm, fea, choices)).split()[0] == word


def test_the_sentence_names_the_row_that_decides_or_the_closest_row(hinge):
    found = compared(hinge, altered(C, with_value("BD.rotation", [0.9]), 0.67), F)
    assert found.verdict.because.startswith("1 of 126 rows differ, first of all BD.rotation at load 0.67 N·m: ")
    assert "--solver cprbm,fea,solid" in found.verdict.because
    assert found.verdict.sentence.startswith(found.verdict.because)
    assert compared(hinge, C, F).verdict.because.startswith("All 126 rows agree; the closest is ")
    (stage,) = hinge.stages
    stage = stage.model_copy(update={"stations": (0.67,), "shown": ()})
    probes = tuple(probe for probe in hinge.probes if probe.quantity == "rotation")
    alone = hinge.model_copy(update={"stages": (stage,), "probes": probes, "claims": ()})
    assert compared(alone, C, F).verdict.because.startswith("The only row agrees, BD.rotation at load 0.67 N·m: ")


def test_whose_uncertainty_is_too_large(away):
    assert "most of it of the CPRBM" in compared(away, COARSE[0], F).verdict.because
    assert "most of it of the finite elements" in compared(away, C, COARSE[1]).verdict.because


def test_a_problem_of_several_runs_is_told_once(hinge):
    """All runs of the finite elements end alike, a run of the CPRBM for another reason."""

    def stuck(scene, choices):
        found = ending(C, 5)(scene, choices)
        return replace(found, ending=Ending.STEP_TOO_SMALL, sentence="It lacks air.")

    cprbm = only(C, stuck, lambda choices: choices.links == 80)
    sentence = compared(hinge, cprbm, ending(F, 5)).verdict.sentence
    assert sentence.count("It stuck") == sentence.count("It lacks air") == 1
    assert "fea, fea finer, fea beside: " in sentence
    assert "cprbm finer: it ended early: It lacks air" in sentence


def test_no_sentence_is_said_twice_and_the_worst_comes_first(crank):
    """Critical points with DIFFER and with AGREE, and an ended run."""
    found = compared(crank, Jumping("cprbm", stops=True), Jumping("fea"))
    assert found.verdict.because.startswith("The branch ends in back at nowhere in the CPRBM and 0.44")
    assert len(set(found.verdict.sentences)) == len(found.verdict.sentences)
    assert "70.41°" in found.verdict.sentence
    assert found.verdict.sentence.count("The branch ends in forward") == 1


def test_a_critical_point_is_told_in_degrees_with_its_mechanism(crank):
    """70.4057° and 70.4014°, 0.0043° apart against a stated 0.0091°; 0.1·0.005 rad of theory."""
    pair = (replace(Jumping(name), what="stopB") for name in ("cprbm", "fea"))
    (first, *_) = compared(crank, *pair).verdict.sentences
    assert first.startswith(
        "The branch ends in forward at 1.2288 rad (70.41°) (stopB: fold) in the CPRBM and 1.2287 rad"
    )
    assert "0.0043° apart against a stated 0.0091°, 0.30° allowed; the theories are 0.029° apart: AGREE." in first


@pytest.mark.parametrize(("loss", "remedy"), [(Loss.FOLD, 'beyond = "jump"'), (Loss.BIFURCATION, "imperfection")])
def test_runs_that_end_before_the_first_station_name_the_critical_point_and_a_remedy(crank, loss, remedy):
    cprbm, fea = Jumping("cprbm", stops=True, loss=loss), Jumping("fea", stops=True, loss=loss)
    pair = (lambda scene, choices, own=own: replace(own(scene, choices), stations=()) for own in (cprbm, fea))
    printed = " ".join(brief(compared(crank, *pair), "crank.toml").split())
    assert ": UNDECIDED (RUN_ENDED). No station has a row that can be compared. The branch ends in forward" in printed
    assert remedy in printed


def test_an_agreement_up_to_a_critical_point_counts_the_unreached_stations(crank):
    """Both solvers stop at one critical point: the rows before the point agree."""
    found = compared(crank, Jumping("cprbm", stops=True), Jumping("fea", stops=True))
    assert word_of(found) == "AGREE"
    asked = sum(len(stage.stations) for stage in crank.stages)
    left = asked - len({row.where for row in found.rows})
    assert 0 < left < asked
    end = found.runs.answers["cprbm"].critical[-1]
    sentence = f"The case ends early, at forward {end.value:.6g} rad ({np.degrees(end.value):.2f}°) (fold): "
    sentence += f"{left} of {asked} stations are not reached."
    assert sentence in found.verdict.sentence
    assert sentence in " ".join(brief(found, "crank.toml").split())


def test_runs_of_one_solver_that_disagree_on_a_mechanism_are_named(crank):
    """All runs stop at one critical point, which one run of the finite elements names a bifurcation."""
    stops = Jumping("fea", stops=True)
    fea = only(stops, replace(stops, loss=Loss.BIFURCATION), lambda choices: choices.elements == 91)
    found = compared(crank, Jumping("cprbm", stops=True), fea)
    assert word_of(found) == "UNDECIDED BRANCH"
    assert "bifurcation in fea beside)" in found.verdict.because
    assert "fold in cprbm, cprbm finer, fea, fea finer, cprbm beside; " in found.verdict.because
    assert "Runs without a complete answer" not in found.verdict.sentence


def test_a_run_that_ends_where_the_other_goes_on_makes_no_agreement(crank):
    """The CPRBM stops at a critical point on which both solvers agree; the finite elements go on."""
    stops = Jumping("cprbm", stops=True)

    def first_stage_alone(scene, choices):
        found = Jumping("fea")(scene, choices)
        return replace(found, critical=found.critical[:1])

    found = compared(crank, stops, first_stage_alone)
    assert found.verdict.word.value != "AGREE"
    assert not found.verdict.completed


def test_a_passed_critical_point_stands_beside_the_critical_point_of_the_other_solver(crank):
    fea = Jumping("fea", stops=True, loss=Loss.BIFURCATION)
    found = compared(crank, Jumping("cprbm", over=0.29), fea)
    assert word_of(found) == "DIFFER EVENTS"
    assert found.verdict.because.startswith(
        "The branch ends in forward at nowhere in the CPRBM, which passed 1.2288 rad"
    )
    assert "(fold) and went on, and 1.2287 rad (70.40°) (bifurcation) in the finite elements" in found.verdict.because
