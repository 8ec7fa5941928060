"""The wrapped beam: both solvers agree from few links to many, and each with the closed form."""

import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.verdict import Word
from tests.references.wrapped import Wrapped


def test_wrapped_agrees_at_an_odd_number_of_links():
    scene = cases.opened("wrapped")
    comparison = compare(paired(scene, Choices(links=41), Solvers(), bare=True))
    assert comparison.verdict.word is Word.AGREE, comparison.verdict.sentence


def test_line_pressure_and_lift_off_follow_from_force_and_zone():
    # reference: tests.references.wrapped. Resultant of a line pressure p up to the zone's end and of the force at
    # lift-off, whose parts no probe tells: p from the clamp's reaction (tension over radius), the other from it
    # The chain has the zone's end between two joints: 1.2e-4 m with nine joints in the zone, 1e-5 m with more.
    scene = cases.opened("wrapped")
    for solve, share in ((cprbm_answer, 1.0 / 700.0), (fea_answer, 1e-4)):
        answer = solve(scene, Choices(kinematics="bending"))
        assert answer.completed, answer.sentence
        for station in answer.stations:
            reference = Wrapped(0.0973, 0.0711, 0.00103, 0.0097, 2.07e11, station.value)
            if not reference.wrapped:
                assert station.values["contact.force"][0] == 0.0
                continue
            begin, end = station.values["contact.ends"]
            assert begin == pytest.approx(0.0, abs=1e-9)
            assert end == pytest.approx(reference.wrap_length, abs=share * reference.length)
            pressure = -station.values["C.reaction"][0] / reference.neutral_radius
            assert pressure == pytest.approx(reference.line_pressure, rel=3e-3)
            angle = end / reference.neutral_radius
            lift_off = station.value * np.cos(angle)
            assert lift_off == pytest.approx(reference.lift_off_force, rel=10.0 * share)
