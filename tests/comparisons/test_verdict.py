"""The verdict on made-up answers, right ones and wrong ones."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from comparisons.choices import Choices
from comparisons.verdict.bounds import Bounds
from comparisons.verdict.rows import Row
from comparisons.pairing import Solvers, paired
from comparisons.GONE_verdict import judged
from comparisons.case import compare
from comparisons.verdict.words import Word
from cprbm_scene import Ending, Probe, Stage
from cprbm_scene.answer import frozen_array
from tests.comparisons.made_up import MadeUp, with_value

ROTATION = Probe(of="BD", quantity="rotation")


def verdict(scene, cprbm, fea, **choices):
    return compared(scene, paired(scene, Choices(**choices), Solvers(cprbm, fea))).verdict


def row(difference, same_theory, bounds, *, scale=1.0):
    values = frozen_array([1.0])
    return Row(ROTATION, "load", 1.0, "rad", values, values, scale, scale, difference, same_theory, bounds)


RIGHT = MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)


def test_right_solvers_agree(hinge):
    said = verdict(hinge, *RIGHT)
    assert said.word is Word.AGREE, said.sentence
    assert said.completed
    assert None in said.words  # before contact there is no centre to compare


@pytest.mark.parametrize("kinematics", ["bending", "stretch", "shear"])
def test_right_solvers_agree_in_every_theory(hinge, kinematics):
    assert verdict(hinge, *RIGHT, kinematics=kinematics).word is Word.AGREE


@pytest.mark.parametrize(
    "fault",
    [
        {"stiffness": 1.02},
        {"stiffness": 0.98},
        {"contact": False},
        {"sign": -1.0},
    ],
    ids=["2 % too stiff", "2 % too soft", "contact ignored", "contact sign"],
)
@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_a_wrong_solver_differs(hinge, fault, solver):
    cprbm, fea = RIGHT
    wrong = (replace(cprbm, **fault), fea) if solver == "cprbm" else (cprbm, replace(fea, **fault))
    assert verdict(hinge, *wrong).word is Word.DIFFER


def test_no_wrong_cprbm_hides_behind_the_step_between_the_theories(hinge):
    """0.5 % too soft is just what the theories differ by: against the default it looks perfect."""
    soft = MadeUp("cprbm", 1e-4, stiffness=1 / 1.005)
    fea = MadeUp("fea", -1e-5)
    said = verdict(hinge, soft, fea)
    assert said.word is Word.DIFFER
    assert "within one theory" in said.sentence


def test_a_solver_that_stops_early_is_undecided_even_if_it_says_that_it_completed(hinge):
    said = verdict(hinge, replace(RIGHT[0], until=7), RIGHT[1])
    assert said.word is Word.UNDECIDED
    assert not said.completed
    assert "no station load 0.536" in said.sentence


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(("probe", "size"), [("B.displacement", 2), ("contact.force", 1), ("beam2.bending_stress", 81)])
def test_a_number_that_is_not_finite_is_undecided(hinge, bad, probe, size):
    for solver in (0, 1):
        values = np.zeros(size)
        values[-1] = bad
        pair = list(RIGHT)
        pair[solver] = replace(pair[solver], spoilt=with_value(probe, values))
        said = verdict(hinge, *pair)
        assert said.word is Word.UNDECIDED
        assert f"{probe} is not finite" in said.sentence


def test_an_answer_of_another_shape_is_undecided(hinge):
    wrong = replace(RIGHT[0], spoilt=with_value("A.reaction", [1.0, 2.0, 3.0]))
    assert "A.reaction has the shape (3,)" in verdict(hinge, wrong, RIGHT[1]).sentence


def test_ends_that_descend_are_undecided(hinge):
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    wrong = replace(RIGHT[1], spoilt=with_value("contact.ends", [0.05, 0.02]))
    assert "contact.ends are not ascending" in verdict(asked, RIGHT[0], wrong).sentence


def test_a_missing_probe_is_undecided(hinge):
    def spoilt(station):
        return replace(station, values={k: v for k, v in station.values.items() if k != "BD.rotation"})

    said = verdict(hinge, RIGHT[0], replace(RIGHT[1], spoilt=spoilt))
    assert said.word is Word.UNDECIDED
    assert "BD.rotation is missing" in said.sentence


def test_a_certificate_that_fails_is_undecided(hinge):
    def spoilt(station):
        return replace(station, certificate=replace(station.certificate, failures=("not in balance",)))

    said = verdict(hinge, RIGHT[0], replace(RIGHT[1], spoilt=spoilt))
    assert said.word is Word.UNDECIDED
    assert "not in balance" in said.sentence


def test_a_certificate_without_a_number_is_undecided(hinge):
    def spoilt(station):
        return replace(station, certificate=replace(station.certificate, residual=math.nan))

    assert verdict(hinge, RIGHT[0], replace(RIGHT[1], spoilt=spoilt)).word is Word.UNDECIDED


def test_a_shape_of_nan_is_undecided(hinge):
    def spoilt(station):
        shape = station.shapes["beam1"]
        bad = replace(shape, x=frozen_array(np.full(shape.x.shape, np.nan)))
        return replace(station, shapes={**station.shapes, "beam1": bad})

    assert verdict(hinge, RIGHT[0], replace(RIGHT[1], spoilt=spoilt)).word is Word.UNDECIDED


def test_one_run_that_ends_early_leaves_the_case_undecided(hinge):
    def stopping(scene, choices):
        answer = RIGHT[1](scene, choices)
        return replace(answer, ending=Ending.STEP_TOO_SMALL) if choices.elements == 160 else answer

    said = verdict(hinge, RIGHT[0], stopping)
    assert said.word is Word.UNDECIDED
    assert "fea bending finer" in said.sentence


def test_a_crude_discretisation_is_undecided(hinge):
    said = verdict(hinge, MadeUp("cprbm", 2e-2), MadeUp("fea", -5e-4))
    assert said.word is Word.UNDECIDED
    assert said.completed
    assert "more than 1.50 %" in said.sentence


def test_the_scene_may_ask_for_more(hinge):
    strict = hinge.model_copy(update={"verdict_limit": 1e-4})
    assert verdict(strict, *RIGHT).word is Word.UNDECIDED


def test_a_probe_may_be_allowed_more_than_the_scene_and_the_sentence_says_so(hinge):
    crude = MadeUp("cprbm", 2e-2), MadeUp("fea", -5e-4)
    wider = tuple(probe.model_copy(update={"verdict_limit": 0.2}) for probe in hinge.probes)
    said = verdict(hinge.model_copy(update={"probes": wider}), *crude)
    assert said.word is Word.AGREE
    assert "20.0 % for C.reaction" in said.sentence
    one = tuple(probe.model_copy(update={"verdict_limit": 1e-4 if probe.of == "C" else None}) for probe in hinge.probes)
    said = verdict(hinge.model_copy(update={"probes": one}), *RIGHT)
    assert said.word is Word.UNDECIDED
    assert "least of all C." in said.sentence
    assert "more than 0.0100 %" in said.sentence


def test_identical_numbers_agree_though_every_uncertainty_is_zero(hinge):
    exact = MadeUp("cprbm", 0.0), MadeUp("fea", 0.0)
    said = verdict(hinge, *exact, kinematics="bending")
    assert said.word is Word.AGREE


def test_round_off_in_a_number_that_vanishes_by_symmetry_is_no_difference(hinge):
    cprbm = replace(RIGHT[0], spoilt=with_value("C.reaction", [2.01 + 1e-14, 3.0]))
    fea = replace(RIGHT[1], spoilt=with_value("C.reaction", [2.01, 3.0]))
    assert verdict(hinge, cprbm, fea).word is Word.AGREE


def test_but_more_than_round_off_is_one(hinge):
    last = Stage(name="load", steps="M", stations=(0.67,))  # alone, so that no other station's uncertainty counts
    hinge = hinge.model_copy(update={"stages": (last,)})
    cprbm = replace(RIGHT[0], spoilt=with_value("C.reaction", [2.01 + 1e-9, 3.0]))
    fea = replace(RIGHT[1], spoilt=with_value("C.reaction", [2.01, 3.0]))
    assert verdict(hinge, cprbm, fea).word is Word.DIFFER


def test_a_centre_in_one_answer_only_is_left_to_the_force(hinge):
    said = verdict(hinge, replace(RIGHT[0], contact=False), RIGHT[1])
    assert said.word is Word.DIFFER
    assert "contact.force" in said.sentence or "displacement" in said.sentence or "reaction" in said.sentence


@pytest.mark.parametrize("quantity", ["centre", "ends", "closing_load"])
def test_without_a_force_probe_a_place_in_one_answer_only_is_undecided(hinge, quantity):
    place_only = hinge.model_copy(update={"probes": (Probe(of="contact", quantity=quantity),), "claims": ()})
    assert verdict(place_only, replace(RIGHT[0], contact=False), RIGHT[1]).word is Word.UNDECIDED


def test_the_sentence_names_the_row_that_decided(hinge):
    wrong = replace(RIGHT[0], spoilt=with_value("BD.rotation", [0.9]))
    said = verdict(hinge, wrong, RIGHT[1])
    assert said.word is Word.DIFFER
    assert said.sentence.startswith("1 of ")
    assert "BD.rotation at load 0.67" in said.sentence


def test_no_rows_are_undecided(hinge):
    assert judged(hinge, ()).word is Word.UNDECIDED


SHARES = st.floats(min_value=0.0, max_value=0.1)


@settings(max_examples=300)
@given(SHARES, SHARES, SHARES, SHARES, SHARES, SHARES, SHARES)
def test_a_word_follows_its_definition(difference, same_theory, c, f, b, theory, round_off):
    """The definition once more, written as in docs/verdict.md."""
    from comparisons import cases

    scene = cases.opened("hinge")
    said = judged(scene, (row(difference, same_theory, Bounds(c, f, b, theory, round_off)),)).word
    total, tight = c + f + theory + round_off, c + b + round_off
    if difference > total or same_theory > tight:
        assert said is Word.DIFFER
    elif total > 0.015 or tight > 0.015:
        assert said is Word.UNDECIDED
    else:
        assert said is Word.AGREE


@settings(max_examples=300)
@given(SHARES, SHARES, SHARES, SHARES, SHARES, st.sampled_from([-1.0, 1.0]), st.sampled_from([-1.0, 1.0]))
def test_what_agrees_within_one_theory_does_not_differ_by_the_step_between_them(own, c, f, b, step, first, second):
    """v_c − v_f is the sum of v_c − v_b and of v_b − v_f, and the second is known."""
    from comparisons import cases

    difference, same_theory = abs(first * own + second * step), own
    bounds = Bounds(c, max(f, b), b, step, 1e-15)  # as rows_of makes them
    said = judged(cases.opened("hinge"), (row(difference, same_theory, bounds),)).word
    assert (said is Word.DIFFER) is (same_theory > c + b + 1e-15)


def test_differing_weighs_more_than_undecided(hinge):
    differing = row(0.01, 0.01, Bounds(1e-3, 1e-3, 1e-3, 1e-3, 0.0))
    blurred = row(0.01, 0.01, Bounds(0.1, 0.1, 0.1, 0.1, 0.0))
    fine = row(1e-4, 1e-4, Bounds(1e-3, 1e-3, 1e-3, 1e-3, 0.0))
    assert judged(hinge, (fine, blurred, differing)).word is Word.DIFFER
    assert judged(hinge, (fine, blurred)).word is Word.UNDECIDED
    assert judged(hinge, (fine,)).word is Word.AGREE
