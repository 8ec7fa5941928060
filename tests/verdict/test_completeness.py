"""Answers that are not complete: every problem is named, and the case is undecided."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.stations import complete_stations, problems
from cprbm_scene import Ending, Probe
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.comparing import altered, compared, ending, word_of
from tests.verdict.jumping import Jumping
from tests.verdict.made_up import MadeUp, with_value

C, F = MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)


def certified(**fields):
    return lambda station: replace(station, certificate=replace(station.certificate, **fields))


def without(probe):
    def change(station):
        return replace(station, values=frozendict({k: v for k, v in station.values.items() if k != probe}))

    return change


def drawn(**fields):
    """The first beam's shape with non-finite numbers, or no shape."""

    def change(station):
        shape = station.shapes["beam1"]
        spoilt = {name: frozen_array(np.full(shape.x.shape, value)) for name, value in fields.items()}
        shapes = {"beam2": station.shapes["beam2"]} | ({"beam1": replace(shape, **spoilt)} if fields else {})
        return replace(station, shapes=frozendict(shapes))

    return change


def touching(station):
    return replace(station, touching=frozendict({"contact": frozen_array([[0.0, np.nan]])}))


def last(size, value):
    return [0.0] * (size - 1) + [value]


STATIONS = {
    "missing probe": (without("BD.rotation"), "BD.rotation is missing"),
    "shape of a probe": (with_value("A.reaction", [1.0, 2.0, 3.0]), "A.reaction has the shape (3,)"),
    "empty probe": (with_value("BD.rotation", []), "BD.rotation has the shape (0,)"),
    "descending ends": (with_value("contact.ends", [0.05, 0.02]), "contact.ends are not ascending"),
    "certificate": (certified(failures=("not in balance",)), "its certificate does not hold: not in balance"),
    "number of the certificate": (certified(residual=np.nan), "its certificate holds a number that is not finite"),
    "shape": (drawn(x=np.nan), "beam1 has no shape of finite numbers"),
    "no shape": (drawn(), "beam1 has no shape of finite numbers"),
    "place of contact": (touching, "a place of contact is not finite"),
} | {
    f"{probe} {value}": (with_value(probe, last(size, value)), f"{probe} is not finite")
    for probe, size in (("B.displacement", 2), ("contact.force", 1), ("beam2.bending_stress", 81))
    for value in (np.nan, np.inf, -np.inf)
}


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize(("change", "problem"), STATIONS.values(), ids=STATIONS)
def test_a_station_with_a_problem_is_not_reached(hinge, solver, change, problem):
    """A problem at 0.603 in every run: nine stations are compared, and the problem is told once."""
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    pair = {"cprbm": C, "fea": F}
    pair[solver] = altered(pair[solver], change, 0.603)
    found = compared(asked, pair["cprbm"], pair["fea"])
    assert (word_of(found), found.verdict.completed) == ("UNDECIDED RUN_ENDED", False)
    assert found.verdict.sentence.count(f"at load 0.603 N·m {problem}") == 1
    assert len({row.station for row in found.rows}) == 9


def ended(scene, choices):
    return replace(C(scene, choices), ending=Ending.STEP_TOO_SMALL, sentence="The step is too small.")


def repeated(scene, choices):
    found = C(scene, choices)
    return replace(found, stations=(*found.stations, found.stations[-1]))


@pytest.mark.parametrize(
    ("cprbm", "problem", "stations"),
    [
        (replace(C, until=7), "it has no station load 0.536 N·m (and 2 more)", 7),
        (replace(C, until=0), "it has no station load 0.067 N·m (and 9 more)", 0),
        (ended, "it ended early: The step is too small.", 10),
        (ending(C, 4), "it ended early: It stuck.", 4),
        (repeated, "it has 11 stations where 10 were asked", 10),
    ],
    ids=["stops unsaid", "nothing", "says so", "stops", "more stations"],
)
def test_a_compared_run_without_all_stations_leaves_the_case_undecided(hinge, cprbm, problem, stations):
    found = compared(hinge, cprbm, F)
    assert (word_of(found), found.verdict.completed) == ("UNDECIDED RUN_ENDED", False)
    assert found.verdict.sentence.count(problem) == 1
    assert len({row.station for row in found.rows}) == stations


def test_a_fault_before_the_end_differs(hinge):
    found = compared(hinge, replace(C, stiffness=1.02, until=7), F)
    assert (word_of(found), found.verdict.completed) == ("DIFFER VALUES", False)


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda one, two: (), "critical values say otherwise"),
        (lambda one, two: (one,), "critical values say otherwise"),
        (lambda one, two: (two, one), "critical values say otherwise"),
        (lambda one, two: (replace(one, value=1.0), two), "critical values say otherwise"),
        (lambda one, two: (replace(one, stage="back"), two), "critical values say otherwise"),
        (lambda one, two: (replace(one, value=np.nan), two), "its critical value in forward is not finite"),
        (lambda one, two: (one, replace(two, energy=np.inf)), "its critical value in back is not finite"),
    ],
    ids=["none", "one", "order", "value", "stage", "NaN", "energy"],
)
def test_branch_numbers_that_contradict_the_critical_points(crank, change, problem):
    answer = Jumping("cprbm")(crank, Choices())
    assert problems(crank, answer) == ()
    assert problem in problems(crank, replace(answer, critical=change(*answer.critical)))[0]


def test_complete_stations_are_those_without_a_problem(hinge):
    answer = altered(C, certified(residual=np.nan), 0.134)(hinge, Choices())
    assert list(complete_stations(hinge, answer))[:2] == [("load", 0.067), ("load", 0.201)]
