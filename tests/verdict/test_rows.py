"""Rows of made-up answers: differences, stated uncertainties, steps and divisors.

Expected numbers follow from the planted law: a rotation of 0.9·m·f before contact at the moment m, with
f = 1 + e (40/N)² + theory.  Once the contact is closed the rotation is 0.8·m·f and a constant.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.steps import contact_model, steps_of
from comparisons.verdict.rows import rows_of
from cprbm_scene import Probe, Stage
from tests.verdict.comparing import altered, compared, counted, ending, in_bending, only, row_of, said_of, word_of
from tests.verdict.made_up import CLOSES, MadeUp, with_value

S = 1.25
C, F = MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)
UNEVEN = MadeUp("cprbm", 0.0), MadeUp("cprbm", 0.0, stiffness=1.01)
ROTATION = "BD.rotation"


@pytest.fixture
def first(hinge):
    """The hinge at one station before contact: no other station widens an uncertainty."""
    return hinge.model_copy(update={"stages": (Stage(name="load", steps="M", stations=(0.067,)),), "claims": ()})


@pytest.fixture
def last(hinge):
    """The hinge at one station behind the closing."""
    return hinge.model_copy(update={"stages": (Stage(name="load", steps="M", stations=(0.67,)),), "claims": ()})


def test_every_probe_has_a_row_at_every_station(hinge):
    rows = compared(hinge, C, F).rows
    assert len(rows) == len(hinge.probes) * len(hinge.stages[0].stations)
    assert [row.station for row in rows] == sorted(row.station for row in rows)


def test_planted_second_order_errors_are_stated_with_a_quarter_more(first):
    row = row_of(compared(first, MadeUp("cprbm", 4e-3), MadeUp("fea", -8e-3)), ROTATION, 0.067)
    rotation, fea_error = 0.9 * 0.067, -8e-3 / 4  # at 80 elements a quarter of the error at 40
    assert row.bounds.cprbm == pytest.approx(S * rotation * 4e-3, rel=1e-9)
    assert row.bounds.bending == pytest.approx(S * rotation * 2e-3, rel=1e-9)
    assert row.bounds.fea == pytest.approx(row.bounds.bending, rel=1e-9)
    assert row.bounds.theory == pytest.approx(rotation * 0.005, rel=1e-9)
    assert row.difference == pytest.approx(rotation * abs(4e-3 - 0.005 - fea_error), rel=1e-9)
    assert row.same_theory == pytest.approx(rotation * (4e-3 - fea_error), rel=1e-9)
    assert row.fraction(row.bounds.theory) == pytest.approx(0.005 / (1.005 + fea_error), rel=1e-9)


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_an_uneven_error_is_stated_though_two_grids_meet(last, solver):
    """N and 2N give one value, and the grid at 8/7 N a value 1 % smaller: S times the rest, transferred to N."""
    right, other = (replace(each, solver=solver) for each in UNEVEN)
    planted = only(right, other, lambda choices: 46 in (choices.links, choices.elements))
    pair = {"cprbm": C, "fea": F, solver: planted}
    found = compared(last, pair["cprbm"], pair["fea"], Choices(elements=40, kinematics="bending"))
    stated = S * 0.8 * 0.67 * (1.0 - 1.0 / 1.01) * (46 / 40) ** 2
    assert getattr(row_of(found, ROTATION).bounds, solver) == pytest.approx(stated, rel=1e-9)


def test_the_third_grid_in_the_chosen_theory_counts_in_bending(last):
    exact = MadeUp("fea", 0.0)
    fea = only(exact, replace(exact, stiffness=1.01), lambda choices: choices.elements == 46)
    bounds = row_of(compared(last, C, fea, Choices(elements=40)), ROTATION).bounds
    stated = S * 0.8 * 0.67 * 1.005 * (1.0 - 1.0 / 1.01) * (46 / 40) ** 2
    assert bounds.bending == pytest.approx(stated, rel=1e-9)
    assert bounds.fea == pytest.approx(stated, rel=1e-9)


def test_a_larger_error_in_bending_counts_in_the_chosen_theory(first):
    fea = only(MadeUp("fea", -1e-4), MadeUp("fea", -2e-3), lambda choices: choices.kinematics == "bending")
    bounds = row_of(compared(first, C, fea, Choices(elements=40)), ROTATION, 0.067).bounds
    assert bounds.fea == bounds.bending == pytest.approx(S * 0.9 * 0.067 * 2e-3, rel=1e-9)


def test_a_stage_states_one_uncertainty_of_a_probe_though_two_grids_meet_at_a_station(hinge):
    """The change between both grids vanishes at 0.335: the statement is that of the last station all the same."""
    at = 0.8 * 0.335 * 1.002 + 0.1 * CLOSES
    meeting = altered(C, with_value(ROTATION, [at]), 0.335)
    found = compared(hinge, meeting, F, Choices(kinematics="bending"))
    stated = [row.bounds.cprbm for row in found.rows if row.probe.name == ROTATION]
    assert stated == pytest.approx([S * 0.8 * 0.67 * 2e-3] * 10, rel=1e-9)


def test_an_even_error_is_stated_alike_with_and_without_a_third_grid(hinge):
    runs = paired(hinge, Choices(), Solvers(C, F))
    assert (runs.ratio, runs.fea_ratio) == (pytest.approx(40 / 46), pytest.approx(80 / 91))
    bare = replace(runs, beside=None, fea_beside=None)
    for row, other in zip(rows_of(hinge, runs), rows_of(hinge, bare), strict=True):
        if row.bounds is not None:
            own, without = (np.array([each.bounds.cprbm, each.bounds.fea]) for each in (row, other))
            assert own == pytest.approx(without, rel=0.02, abs=1e-12 * row.scale)


@pytest.mark.parametrize(("formulation", "step"), [("auto", 0.0), ("paper", -1e-3)])
def test_steps_are_planted_and_add_up(hinge, formulation, step):
    """f is 1.002 in ``auto``, 1.003 in ``paper``, 1 and 1.005 in the finite elements: steps along v_c − v_f < 0."""
    found = compared(hinge, replace(C, paper=1e-3), MadeUp("fea", 0.0), Choices(formulation=formulation))
    rotation, row = 0.9 * 0.067, row_of(found, ROTATION, 0.067)
    assert contact_model(found.runs, row) == pytest.approx(1e-3 * rotation, rel=1e-9)
    expected = [part * rotation for part in (step, -2e-3, 2e-3, 3e-3)]
    assert parts_of(steps_of(found.runs, row)) == pytest.approx(expected, rel=1e-9)
    steps = [(row, steps_of(found.runs, row)) for row in found.rows]
    assert sum(each is not None for _, each in steps) > 100
    for row, each in steps:
        if each is not None:
            assert sum(parts_of(each)) == pytest.approx(row.difference, rel=1e-9)


def parts_of(steps):
    return [steps.contact, steps.own, steps.stretch, steps.shear]


@pytest.mark.parametrize(("kinematics", "theories"), [("bending", 1), ("stretch", 2), ("shear", 3)])
def test_right_solvers_agree_in_every_theory(hinge, kinematics, theories):
    found = compared(hinge, C, F, Choices(kinematics=kinematics))
    assert (word_of(found), len(found.runs.fea)) == ("AGREE", theories)
    if kinematics == "bending":
        assert all(row.bounds.theory == 0.0 for row in found.rows if row.bounds is not None)


def test_an_open_contact_has_no_force_no_place_and_no_uncertainty(hinge):
    found = compared(hinge, C, F)
    force, centre = (row_of(found, f"contact.{name}", 0.067) for name in ("force", "centre"))
    assert (force.difference, force.bounds.total) == (0.0, 0.0)
    assert (centre.bounds, centre.fraction(centre.difference)) == (None, None)
    assert (said_of(found, "contact.force", 0.067), said_of(found, "contact.centre", 0.067)) == ("AGREE", "")
    assert row_of(found, "contact.closing_load").cprbm == pytest.approx([CLOSES / 1.002])


@pytest.mark.parametrize(
    ("solver", "missing", "agreeing"),
    [
        ("cprbm", lambda choices: choices.links == 80, False),
        ("cprbm", lambda choices: choices.links == 46, True),
        ("fea", lambda choices: choices.kinematics == "shear" and choices.elements == 160, False),
        ("fea", lambda choices: choices.kinematics == "shear" and choices.elements == 91, True),
        ("fea", lambda choices: choices.kinematics == "stretch", True),
        ("fea", lambda choices: choices.kinematics == "bending" and choices.elements == 160, True),
        ("fea", lambda choices: choices.kinematics == "bending", False),
    ],
    ids=["2N", "8/7 N", "2n", "8/7 n", "stretch", "2n in bending", "bending"],
)
def test_a_helper_run_that_ends_early_leaves_both_values(hinge, solver, missing, agreeing):
    """Without a run at 2N no uncertainty is known, without ``bending`` no step of theory, here half a per cent."""
    pair = {"cprbm": C, "fea": F}
    pair[solver] = only(pair[solver], ending(pair[solver], 4), missing)
    found = compared(hinge, pair["cprbm"], pair["fea"])
    assert found.verdict.completed
    assert word_of(found) == ("AGREE" if agreeing else "UNDECIDED RUN_ENDED"), found.verdict.sentence
    row = row_of(found, "scene.potential_energy")
    assert row.missing
    assert all(name.startswith(solver) for name in row.missing)
    assert row.difference == pytest.approx(abs(float(row.cprbm[0] - row.fea[0])), rel=1e-12)
    assert found.verdict.sentence.count("It stuck.") == 1
    if not agreeing and row.bounds is None:
        assert said_of(found, "scene.potential_energy") == "UNDECIDED RUN_ENDED"
    assert said_of(found, "scene.potential_energy", 0.067) == "AGREE"


def test_without_bending_a_row_agrees_if_the_values_do(hinge):
    same = in_bending(F)
    fea = only(same, ending(same, 0), lambda choices: choices.kinematics == "bending")
    found = compared(hinge, C, fea)
    assert (word_of(found), row_of(found, ROTATION).bounds.bending) == ("AGREE", None)


@pytest.mark.parametrize(("off", "word"), [(1e-9, "AGREE"), (1e-8, "DIFFER VALUES")])
def test_more_than_round_off_is_a_difference(last, off, word):
    """Values of 3.6 N that no grid changes: nothing but 3.6e-9 N of round-off is stated."""
    pair = [altered(solver, with_value("C.reaction", [2.01 + own, 3.0])) for solver, own in ((C, off), (F, 0.0))]
    assert said_of(compared(last, *pair), "C.reaction") == word


def test_round_off_at_zero_load_is_no_difference(hinge):
    still = hinge.model_copy(update={"stages": (Stage(name="load", steps="M", stations=(0.0,)),), "claims": ()})
    trembling = altered(C, with_value(ROTATION, [3e-16]))
    assert set(counted(compared(still, trembling, F))) == {"AGREE"}
    wrong = altered(C, with_value(ROTATION, [1e-9]))
    assert said_of(compared(still, wrong, F), ROTATION, 0.0) == "DIFFER VALUES"


def test_a_stress_differs_by_the_place_that_is_worst(last):
    def spoilt(station):
        stress = np.array(station.values["beam1.bending_stress"])
        stress[20] -= 5e6  # away from clamps and contact, and not the largest stress
        return with_value("beam1.bending_stress", stress)(station)

    row = row_of(compared(last, altered(C, spoilt), F, Choices(kinematics="bending")), "beam1.bending_stress")
    assert row.difference == pytest.approx(5e6, rel=0.02)


def test_shown_fractions_are_of_the_value_of_a_displacement_and_of_the_scale_of_a_force(hinge):
    found = compared(hinge, C, F)
    early = row_of(found, "B.displacement", 0.067)
    assert early.denominator == pytest.approx(float(np.linalg.norm(early.fea)))
    assert early.denominator < early.scale
    force = row_of(found, "contact.force", 0.268)
    assert force.denominator == force.scale == pytest.approx(float(row_of(found, "contact.force").fea[0]))
    vanishing = compared(hinge, C, altered(F, with_value("B.displacement", [1e-7, 0.0]), 0.067))
    row = row_of(vanishing, "B.displacement", 0.067)
    assert row.denominator == row.scale


def test_the_ends_of_a_contact_are_two_places_on_a_beam(hinge):
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    row = row_of(compared(asked, C, F), "contact.ends")
    assert (row.cprbm.shape, row.fea.shape, row.unit) == ((2,), (2,), "m")
    assert row.scale == row.denominator == pytest.approx(math.pi * 0.025)
