"""Rows of made-up answers: differences, stated uncertainties, steps of theory and divisors.

Expected numbers follow from the planted law: a rotation of 0.9·m·f before contact at the moment m, with
f = 1 + e (40/N)² + theory.  Once the contact is closed the rotation is 0.8·m·f and a constant.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.opinions import contact_model
from comparisons.pairing import Solvers, paired
from comparisons.verdict.rows import rows_of
from comparisons.verdict.runs import other_theory
from cprbm_scene import Mistake, Probe, SceneError, Stage
from tests.verdict.comparing import altered, compared, counted, ending, only, row_of, said_of, word_of
from tests.verdict.made_up import CLOSES, THEORY, MadeUp, with_value

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
    assert row.bounds.fea == pytest.approx(S * rotation * 2e-3, rel=1e-9)
    assert row.difference == pytest.approx(rotation * (4e-3 - fea_error), rel=1e-9)
    assert row.theory == pytest.approx(rotation * 0.005, rel=1e-9)
    assert row.fraction(row.theory) == pytest.approx(0.005 / (1.0 + fea_error), rel=1e-9)


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_an_uneven_error_is_stated_though_two_grids_meet(last, solver):
    """N and 2N give one value, and the grid at 8/7 N a value 1 % smaller: S times the rest, transferred to N."""
    right, other = (replace(each, solver=solver) for each in UNEVEN)
    planted = only(right, other, lambda choices: 46 in (choices.links, choices.elements))
    pair = {"cprbm": C, "fea": F, solver: planted}
    found = compared(last, pair["cprbm"], pair["fea"], Choices(elements=40))
    stated = S * 0.8 * 0.67 * (1.0 - 1.0 / 1.01) * (46 / 40) ** 2
    assert getattr(row_of(found, ROTATION).bounds, solver) == pytest.approx(stated, rel=1e-9)


def test_a_stage_states_one_uncertainty_of_a_probe_though_two_grids_meet_at_a_station(hinge):
    """The change between both grids vanishes at 0.335: the statement is that of the last station all the same."""
    at = 0.8 * 0.335 * 1.002 + 0.1 * CLOSES
    meeting = altered(C, with_value(ROTATION, [at]), 0.335)
    found = compared(hinge, meeting, F)
    stated = [row.bounds.cprbm for row in found.rows if row.probe.name == ROTATION]
    assert stated == pytest.approx([S * 0.8 * 0.67 * 2e-3] * 10, rel=1e-9)


def test_an_even_error_is_stated_alike_with_and_without_a_third_grid(hinge):
    runs = paired(hinge, Choices(), Solvers(C, F))
    assert list(runs.sizes.values()) == pytest.approx([46 / 40, 91 / 80, 2.0, 2.0])
    bare = replace(runs, answers={name: each for name, each in runs.answers.items() if "beside" not in name})
    for row, other in zip(rows_of(runs), rows_of(bare), strict=True):
        if row.bounds is not None:
            own, without = (np.array([each.bounds.cprbm, each.bounds.fea]) for each in (row, other))
            assert own == pytest.approx(without, rel=0.02, abs=1e-12 * row.scale)


@pytest.mark.parametrize("theory", ["bending", "stretch", "shear"])
def test_both_formulations_and_both_theories_are_planted(hinge, theory):
    """f is 1e-3 larger in ``paper``, and 0, 0.002 and 0.005 larger in the three theories."""
    for formulation in ("auto", "paper"):
        choices = Choices(formulation=formulation, theory=theory)
        found = compared(hinge, replace(C, paper=1e-3), MadeUp("fea", 0.0), choices)
        rotation, row = 0.9 * 0.067, row_of(found, ROTATION, 0.067)
        assert contact_model(found.runs, row) == pytest.approx(1e-3 * rotation, rel=1e-9)
        assert row.theory == pytest.approx(
            rotation * abs(THEORY[other_theory(found.runs.theory)] - THEORY[theory]), rel=1e-9
        )


@pytest.mark.parametrize("option", ["theory", "kinematics"])
@pytest.mark.parametrize("theory", ["bending", "stretch", "shear"])
def test_right_solvers_agree_in_every_theory(hinge, theory, option):
    """The scene's theory, or the option's: both solvers answer in this theory, and the chain also in another one."""
    for scene, choices in (
        (hinge.model_copy(update={"theory": theory}), Choices()),
        (hinge, Choices(**{option: theory})),
    ):
        found = compared(scene, C, F, choices)
        assert (word_of(found), found.runs.theory) == ("AGREE", theory)
        assert other_theory(found.runs.theory) == ("shear" if theory == "bending" else "bending")
        assert row_of(found, ROTATION, 0.067).fea == pytest.approx([0.9 * 0.067 * (1.0 - 1.25e-4 + THEORY[theory])])


def test_a_contact_force_tilts_in_shear_whatever_the_mesh(last):
    # F/(4 GA_s) of the most slender beam in contact, with GA_s = 5/6 E A/(2 (1 + ν)) of a rectangle
    fea = MadeUp("fea", 0.0)
    rows = {theory: row_of(compared(last, C, fea, Choices(theory=theory)), ROTATION) for theory in ("stretch", "shear")}
    beams = [last.beams[beam] for beam in last.contacts["contact"].beams]
    stiffness = min(
        5.0
        / 6.0
        * last.materials[beam.material].youngs_modulus
        * beam.thickest
        * float(beam.width_at(np.zeros(1))[0])
        / (2.0 * (1.0 + last.materials[beam.material].poisson_ratio))
        for beam in beams
    )
    force = 20.0 * (0.67 * (1.0 + THEORY["shear"]) - CLOSES)
    assert rows["stretch"].bounds.fea == 0.0
    assert rows["shear"].bounds.fea == pytest.approx(rows["shear"].scale * 0.25 * force / stiffness, rel=1e-9)


def test_an_open_contact_has_no_force_no_place_and_no_uncertainty(hinge):
    found = compared(hinge, C, F)
    force, centre = (row_of(found, f"contact.{name}", 0.067) for name in ("force", "centre"))
    assert (force.difference, force.bounds.total) == (0.0, 0.0)
    assert (centre.bounds, centre.fraction(centre.difference)) == (None, None)
    assert (said_of(found, "contact.force", 0.067), said_of(found, "contact.centre", 0.067)) == ("AGREE", "")
    assert row_of(found, "contact.closing_load").cprbm == pytest.approx([CLOSES / 1.002])


@pytest.mark.parametrize(
    ("solver", "size", "agreeing"),
    [("cprbm", 80, False), ("cprbm", 46, True), ("fea", 160, False), ("fea", 91, True)],
    ids=["2N", "8/7 N", "2n", "8/7 n"],
)
def test_a_helper_run_that_ends_early_leaves_both_values(hinge, solver, size, agreeing):
    """Without a run at 2N no uncertainty is known."""
    pair = {"cprbm": C, "fea": F}
    kind = "links" if solver == "cprbm" else "elements"
    pair[solver] = only(pair[solver], ending(pair[solver], 4), lambda choices: getattr(choices, kind) == size)
    found = compared(hinge, pair["cprbm"], pair["fea"])
    assert found.verdict.completed
    assert word_of(found) == ("AGREE" if agreeing else "UNDECIDED RUN_ENDED"), found.verdict.sentence
    row = row_of(found, "scene.potential_energy")
    assert row.missing
    assert all(name.startswith(solver) for name in row.missing)
    assert row.difference == pytest.approx(abs(float(row.cprbm[0] - row.fea[0])), rel=1e-12)
    assert found.verdict.sentence.count("It stuck.") == 1
    if row.bounds is None:
        assert said_of(found, "scene.potential_energy") == "UNDECIDED RUN_ENDED"
    assert said_of(found, "scene.potential_energy", 0.067) == "AGREE"


@pytest.mark.parametrize("stations", [0, 4])
def test_a_chain_that_ends_early_in_the_other_theory_leaves_the_verdict(hinge, stations):
    cprbm = only(C, ending(C, stations), lambda choices: choices.theory == "shear")
    found = compared(hinge, cprbm, F)
    assert word_of(found) == "AGREE"
    assert "In shear the CPRBM has no complete answer: it ended early: It stuck." in found.verdict.sentence
    assert math.isnan(row_of(found, ROTATION).theory)
    assert math.isfinite(row_of(found, ROTATION, 0.067).theory) is (stations == 4)


def test_a_chain_that_refuses_the_other_theory_leaves_the_verdict_and_is_named(hinge):
    def refusing(scene, choices):
        if choices.theory == "shear":
            raise SceneError([Mistake("theory", "'shear'", "'bending'", "file.toml")])
        return C(scene, choices)

    found = compared(hinge, refusing, F)
    assert (word_of(found), found.runs.other) == ("AGREE", None)
    absence = "The CPRBM does not answer in shear: file.toml: theory: found 'shear'; allowed: 'bending'."
    assert absence in found.verdict.sentence
    assert all(math.isnan(row.theory) for row in found.rows)


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

    row = row_of(compared(last, altered(C, spoilt), F), "beam1.bending_stress")
    assert row.difference == pytest.approx(5e6, rel=0.02)


def test_shown_fractions_are_of_the_value_of_a_displacement_and_of_the_scale_of_a_force(hinge):
    found = compared(hinge, C, F)
    early = row_of(found, "B.displacement", 0.067)
    assert early.denominator == pytest.approx(float(np.linalg.norm(early.fea)))
    assert early.denominator < early.scale
    force = row_of(found, "contact.force", 0.268)
    assert force.denominator == force.scale == pytest.approx(float(row_of(found, "contact.force").cprbm[0]))
    vanishing = compared(hinge, C, altered(F, with_value("B.displacement", [1e-7, 0.0]), 0.067))
    row = row_of(vanishing, "B.displacement", 0.067)
    assert row.denominator == row.scale


def test_the_ends_of_a_contact_are_two_places_on_a_beam(hinge):
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    row = row_of(compared(asked, C, F), "contact.ends")
    assert (row.cprbm.shape, row.fea.shape, row.unit) == ((2,), (2,), "m")
    assert row.scale == row.denominator == pytest.approx(math.pi * 0.025)
