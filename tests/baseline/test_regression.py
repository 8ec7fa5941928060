"""Both solvers on every built-in case beside the newest record in ``tests/baseline/records``.

The record is no reference: a difference shows a change, and agreement proves nothing. A change of method packs a new
record.
"""

from pathlib import Path

import pytest

from comparisons import cases
from tests.baseline.changes import Change, compare_records
from tests.baseline.measuring import Program, measure
from tests.baseline.record import Record, read
from tests.baseline.runs import Run

NEWEST = max((Path(__file__).parent / "records").glob("*.jsonl.xz"))
SIZE = 20
LONG = ("gripper-driven", "prestressed")
"""Cases that take seconds; ``python -m tests.baseline record`` runs these too."""
ROUNDING = 1e-6
"""Share of a probe's scale by which the rounding of another processor may move a value."""


@pytest.fixture(scope="module")
def record():
    return read(NEWEST)


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize("case", [case for case in cases.scenes() if case not in LONG])
def test_no_number_moves(record, case, solver):
    entry = measure(Run(case, solver, SIZE), Program())
    old = Record(record.about, {entry["run"]: record.entries[entry["run"]]})
    (finding,) = compare_records(old, Record(record.about, {entry["run"]: entry}), same=ROUNDING)
    assert finding.change is Change.SAME, finding.sentence


def test_a_record_fits_into_the_repository():
    assert NEWEST.stat().st_size < 5e6
