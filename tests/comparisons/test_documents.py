"""The documented JSON."""

import json
import math

import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.plain import plain, text_of
from comparisons.present import json_document
from cprbm_scene import Answer, Certificate, Ending, StationAnswer
from tests.verdict.made_up import CERTIFICATE, MadeUp

NUMBER = (int, float)


@pytest.fixture
def case(hinge, right):
    data = json_document.comparison(compare(hinge, paired(hinge, Choices(), right)))
    return json.loads(text_of(data), parse_constant=lambda constant: pytest.fail(constant))


def test_a_case_has_the_documented_keys(case):
    assert {"case", "verdict", "sentence", "solvers", "rows"} <= set(case)
    assert case["case"] == "hinge"
    assert case["verdict"] == "AGREE"
    for solver in ("cprbm", "fea"):
        assert {"ending", "seconds", "settings", "certificate"} <= set(case["solvers"][solver])
        assert case["solvers"][solver]["ending"] == "COMPLETED"
        assert case["solvers"][solver]["certificate"]["holds"] is True


def test_a_row_has_the_documented_keys_and_kinds(case):
    for row in case["rows"]:
        assert {"probe", "stage", "station", "unit", "cprbm", "fea", "claim", "claim_met"} <= set(row)
        assert isinstance(row["station"], NUMBER)
        assert row["difference"] is None or row["difference"] >= 0.0
        assert {"cprbm", "fea", "theory"} <= set(row["uncertainty"])
        assert (row["other_theory"] is None) is (row["uncertainty"]["theory"] is None)
        assert row["contact_model"] is None or row["contact_model"] >= 0.0


def test_vectors_scalars_and_curves(case):
    rows = {row["probe"]: row for row in case["rows"] if row["station"] == 0.67}
    assert len(rows["B.displacement"]["cprbm"]) == 2
    assert isinstance(rows["BD.rotation"]["fea"], NUMBER)
    stress = rows["beam1.bending_stress"]
    assert len(stress["cprbm"]) == len(stress["fea"]) == len(stress["arc_length"]) == 81
    assert stress["arc_length"][-1] == pytest.approx(math.pi * 0.025)
    assert "arc_length" not in rows["BD.rotation"]


def test_an_open_contact_is_null(case):
    rows = {row["probe"]: row for row in case["rows"] if row["station"] == 0.067}
    centre = rows["contact.centre"]
    assert centre["cprbm"] is centre["fea"] is centre["difference"] is centre["verdict"] is None
    assert centre["uncertainty"] == dict.fromkeys(centre["uncertainty"])
    assert rows["contact.force"]["cprbm"] == 0.0


def test_claims_stand_at_their_station_only(case):
    claimed = {(row["probe"], row["station"]): row for row in case["rows"] if row["claim"] is not None}
    assert set(claimed) == {("B.displacement", 0.67), ("D.displacement", 0.67)}
    for row in claimed.values():
        assert row["claim_met"] is (row["difference"] <= row["claim"])


def test_fractions_are_of_the_denominator(case):
    row = next(row for row in case["rows"] if row["probe"] == "BD.rotation" and row["station"] == 0.67)
    assert row["difference"] * row["denominator"] == pytest.approx(abs(row["cprbm"] - row["fea"]), rel=1e-9)


def test_a_case_that_did_not_complete_has_no_rows_and_still_its_solvers(hinge, right):
    early = Solvers(MadeUp("cprbm", 0.0, until=0), right.fea)
    data = json_document.comparison(compare(hinge, paired(hinge, Choices(), early)))
    assert data["verdict"] == "UNDECIDED"
    assert data["rows"] == []
    assert data["solvers"]["cprbm"]["certificate"] is None


def test_solve_has_one_column_and_no_verdict(hinge, right):
    data = json_document.solution(hinge, right.cprbm(hinge, Choices()))
    assert set(data) == {"case", "solvers", "rows"}
    assert set(data["solvers"]) == {"cprbm"}
    assert all("fea" not in row and "verdict" not in row and "cprbm" in row for row in data["rows"])


def test_the_worst_of_certificates_is_taken_number_by_number():
    other = Certificate(1e-9, 1e-14, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1, 7, ("turned over",))
    stations = tuple(StationAnswer("load", 1.0, {}, {}, {}, each) for each in (CERTIFICATE, other))
    worst = json_document.worst_certificate(Answer("cprbm", "hinge", {}, Ending.COMPLETED, "", stations))
    assert worst is not None
    assert worst["residual"] == 1e-9
    assert worst["residual_floor"] == 1e-13
    assert worst["smallest_curvature"] == -0.1
    assert worst["iterations"] == 12
    assert worst["holds"] is False
    assert worst["failures"] == ["turned over"]


def test_no_number_that_is_not_finite_leaves_as_json():
    assert plain({"a": [math.nan, math.inf, 1.0]}) == {"a": [None, None, 1.0]}
    with pytest.raises(ValueError, match="JSON"):
        text_of({"a": math.nan})
