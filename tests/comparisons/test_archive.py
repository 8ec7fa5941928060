"""What goes into an archive comes out of it."""

import json

import numpy as np
import pytest

from comparisons import archive
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Runs, paired
from comparisons.plain import text_of


def there_and_back(answer):
    return archive.unpacked(json.loads(text_of(archive.packed(answer))))


def test_an_answer_survives(hinge, right):
    answer = right.fea(hinge, Choices())
    back = there_and_back(answer)
    assert (back.solver, back.ending, back.events, back.seconds) == (
        answer.solver,
        answer.ending,
        answer.events,
        answer.seconds,
    )
    for old, new in zip(answer.stations, back.stations, strict=True):
        assert old.certificate == new.certificate
        assert set(old.values) == set(new.values)
        for name, values in old.values.items():
            np.testing.assert_array_equal(new.values[name], values)
        for name, places in old.touching.items():
            np.testing.assert_array_equal(new.touching[name], places)
            assert new.touching[name].shape == places.shape
        with pytest.raises(ValueError, match="read-only"):
            new.values["BD.rotation"][0] = 0.0


def test_a_verdict_needs_no_second_solve(hinge, right):
    runs = paired(hinge, Choices(), right)
    back = Runs(
        runs.kinematics,
        (there_and_back(runs.cprbm[0]), there_and_back(runs.cprbm[1])),
        {theory: tuple(there_and_back(one) for one in fea) for theory, fea in runs.fea.items()},
    )
    assert compare(hinge, back).verdict == compare(hinge, runs).verdict
