"""Today's numbers beside the accepted ones.

This is regression and counts as nothing else: the files hold what the solvers once gave.  They change by
``cprbm regress CASE --accept REASON --date DATE`` only.
"""

import json
from datetime import date
from pathlib import Path

import pytest

from comparisons import cases, regression
from comparisons.pairing import Solvers

FOLDER = Path(__file__).parent / "regression"


@pytest.mark.parametrize("case", cases.scenes())
def test_no_number_has_moved(case):
    found = regression.measured(cases.opened(case), Solvers())
    assert [str(departure) for departure in regression.departures(FOLDER / f"{case}.json", found)] == []


@pytest.mark.parametrize("case", cases.scenes())
def test_every_acceptance_has_a_date_and_a_reason(case):
    history = json.loads((FOLDER / f"{case}.json").read_text("utf-8"))["history"]
    assert history
    days = [date.fromisoformat(entry["date"]) for entry in history]
    assert days == sorted(days)
    assert all(entry["reason"].strip() for entry in history)


def test_every_file_belongs_to_a_case():
    assert {path.stem for path in FOLDER.glob("*.json")} == set(cases.scenes())
