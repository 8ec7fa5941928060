"""The rotational hinge: what the two solvers must show of each other.

The bounds are those that the project set itself before there was a second solver, and the paper's claims.
"""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import fea_answer
from comparisons.stations import station_of
from comparisons.verdict import Word
from comparisons.verdict.rows import rows_of


@pytest.fixture(scope="module")
def comparison(hinge, hinge_runs):
    return compare(hinge_runs)


def row(comparison, probe, station=0.67):
    return next(row for row in comparison.rows if row.probe.name == probe and row.station == station)


def test_the_verdict_is_agree(comparison):
    assert comparison.verdict.word is Word.AGREE, comparison.verdict.sentence


@pytest.mark.parametrize(
    ("probe", "bound"),
    [
        ("B.displacement", 3e-3),
        ("D.displacement", 3e-3),
        ("contact.force", 1e-2),
        ("beam1.bending_stress", 1e-2),
        ("beam2.bending_stress", 1e-2),
    ],
)
def test_within_one_theory_the_methods_are_close(comparison, probe, bound):
    found = row(comparison, probe)
    assert found.fraction(found.difference) < bound


@pytest.mark.parametrize("probe", ["B.displacement", "D.displacement"])
def test_the_chains_step_of_theory_is_the_finite_elements_own(comparison, hinge, probe):
    """The chain in bending has errors of discretisation up to a tenth of the step."""
    found = row(comparison, probe)
    sheared = fea_answer(hinge, Choices(theory="shear")).stations[-1].values[probe]
    assert found.theory == pytest.approx(np.linalg.norm(sheared - found.fea), rel=0.15)


def test_the_paper_stays_beside_and_not_inside(comparison):
    """Claims change nothing: without them the verdict is the same."""
    unclaimed = comparison.scene.model_copy(update={"claims": ()})
    assert compare(replace(comparison.runs, scene=unclaimed)).verdict == comparison.verdict


def test_both_agree_where_the_beams_first_touch(comparison):
    found = row(comparison, "contact.closing_load")
    assert found.fraction(found.difference) < 5e-3


def test_below_that_load_there_is_no_force_and_above_it_contact_at_one_place(comparison):
    closing = row(comparison, "contact.closing_load").fea[0]
    stations = comparison.scene.stages[0].stations
    assert min(stations) < closing < max(stations)
    for answer in (comparison.runs.answers["cprbm"], comparison.runs.answers["fea"]):
        for value in stations:
            station = station_of(answer, "load", value)
            if value < closing:
                assert station.values["contact.force"] == 0.0
                assert station.values["contact.centre"].size == 0
                assert "contact" not in station.touching
            else:
                assert station.values["contact.force"] > 0.0
                places = station.touching["contact"]
                # One place: what touches is no longer than a thickness.
                assert np.max(np.linalg.norm(places - places[0], axis=1)) < 0.002


def test_what_supports_and_contacts_carry_balances_the_load(comparison):
    for answer in comparison.runs.same_theory.values():
        for station in answer.stations:
            assert station.certificate.force_balance < 1e-8
            assert station.certificate.moment_balance < 1e-8


def test_the_reactions_balance_by_the_answers_own_numbers(comparison):
    """ΣF = 0 and ΣM = 0 about the origin: AC is all that is held, BD all that is loaded."""
    points = {name: np.array(place) for name, place in comparison.scene.bodies["AC"].points.items()}
    for answer in (comparison.runs.answers["cprbm"], comparison.runs.answers["fea"]):
        for station in answer.stations:
            forces = {name: station.values[f"{name}.reaction"] for name in points}
            largest = max(np.linalg.norm(force) for force in forces.values())
            assert np.linalg.norm(sum(forces.values())) <= 1e-8 * max(largest, station.value / 0.05)
            moment = station.value + sum(
                points[name][0] * force[1] - points[name][1] * force[0] for name, force in forces.items()
            )
            moment += sum(station.values[f"{name}.reaction_moment"][0] for name in points)
            assert abs(moment) <= 1e-8 * station.value


def test_every_row_of_the_case_is_there(hinge, hinge_runs):
    assert len(rows_of(hinge_runs)) == 13 * 10
