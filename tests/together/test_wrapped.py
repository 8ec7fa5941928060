"""The beam pressed round a circle: both solvers beside its closed form, tests.references.wrapped."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.measures import rows_of, station_of
from comparisons.pairing import Runs, Solvers, paired
from comparisons.spots import clear_of_spots
from scene import Scene
from tests.references.wrapped import Wrapped

LOADS = (43.0, 97.0, 191.0)


@pytest.fixture(scope="module")
def scene() -> Scene:
    whole = cases.opened("wrapped")
    stages = tuple(stage.model_copy(update={"stations": LOADS}) for stage in whole.stages)
    return whole.model_copy(update={"stages": stages})


@pytest.fixture(scope="module")
def runs(scene) -> Runs:
    return paired(scene, Choices(links=80, kinematics="bending"), Solvers())


def truth(load: float) -> Wrapped:
    """The closed form at a load; the numbers are those that ``comparisons/cases/wrapped.toml`` states."""
    return Wrapped(length=0.0973, radius=0.0711, thickness=0.00103, width=0.0097, youngs_modulus=2.07e11, force=load)


def test_the_case_is_the_closed_forms_own_question():
    case, exact = cases.opened("wrapped"), truth(191.0)
    beam, circle = case.beams["beam"], case.contacts["contact"]
    assert np.subtract(beam.curve.end, beam.curve.start) == pytest.approx([exact.length, 0.0], abs=1e-15)
    assert (beam.thickness, beam.width, circle.radius) == (exact.thickness, exact.width, exact.radius)
    assert np.subtract(beam.curve.start, circle.center) == pytest.approx([0.0, exact.neutral_radius], abs=1e-15)
    stations = case.stages[0].stations
    assert stations[0] < exact.closing_load < stations[1]
    assert exact.wrap_length > 0.7 * exact.length


def test_the_ends_are_those_of_the_wrap_to_two_elements(runs):
    for answer in (runs.cprbm[0], runs.reference):
        for load in LOADS:
            first, last = station_of(answer, "load", load).values["contact.ends"]
            size = truth(load).length / 80.0
            assert -1e-12 <= first <= 2.0 * size, answer.solver
            assert last == pytest.approx(truth(load).wrap_length, abs=2.0 * size), answer.solver


def test_the_stress_is_compared_inside_the_wrap(scene, runs):
    s = np.linspace(0.0, truth(1.0).length, 81)
    for load in LOADS:
        inside = s < truth(load).wrap_length
        stations = tuple(station_of(answer, "load", load) for _, answer in runs.everything())
        clear = clear_of_spots(scene, "beam", s, stations)
        # all but the clamp's and the lift-off's surroundings, in which the runs' own ends lie
        assert np.sum(~clear & inside) <= 8
        assert np.sum(~clear) <= 12


def test_the_stress_agrees_with_the_closed_form_where_it_is_compared(scene, runs):
    for row in rows_of(scene, runs):
        if row.probe.quantity != "bending_stress":
            continue
        assert row.bounds is not None
        exact = truth(row.station).bending_stress(81)
        stations = tuple(station_of(answer, "load", row.station) for _, answer in runs.everything())
        clear = clear_of_spots(scene, "beam", row.arc_length, stations)
        for value, stated in ((row.cprbm, row.bounds.cprbm), (row.fea, row.bounds.fea)):
            assert np.max(np.abs(value - exact)[clear]) <= max(2.0 * stated, 0.005 * row.scale)
