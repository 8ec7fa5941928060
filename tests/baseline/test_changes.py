"""Classes of change between two records, by made-up entries and by planted faults of the solvers.

Reference: numbers and classes are written by hand; a comment gives the arithmetic.
"""

from copy import deepcopy
from dataclasses import replace

import pytest

from cprbm_scene import Ending
from tests.baseline.changes import FAILING, WEIGHT, Change, compare_records
from tests.baseline.measuring import Program, answer_of_cprbm, measure
from tests.baseline.record import About, Record
from tests.baseline.runs import Run

ABOUT = About(("arm",), 0, 905, None, "digest")
STATED = {"cprbm": 1e-3, "fea": 1e-4, "theory": 0.0}


def solver_entry(size=40, tip=0.5, force=10.0, **changes):
    """A cantilever's answer at two stations, m and N."""
    stations = [
        {"stage": "load", "load": load, "values": {"tip.displacement": [share * tip, 0.0], "c.force": [share * force]}}
        for load, share in ((1.0, 0.5), (2.0, 1.0))
    ]
    entry = {
        "run": f"arm cprbm {size}",
        "scene": "arm",
        "solver": "cprbm",
        "size": size,
        "outcome": "answered",
        "sentence": "",
        "ending": "COMPLETED",
        "seconds": 0.2,
        "iterations": 10,
        "natural": {"displacement": 1.0, "force": 10.0},
        "critical": [],
        "stations": stations,
    }
    return entry | changes


def comparison_entry(**changes):
    rows = [
        {
            "probe": "tip.displacement",
            "stage": "load",
            "load": load,
            "verdict": "AGREE",
            "scale": 0.5,
            "difference": 5e-4,
            "uncertainty": dict(STATED),
        }
        for load in (1.0, 2.0)
    ]
    entry = {
        "run": "arm comparison",
        "scene": "arm",
        "solver": "comparison",
        "size": 0,
        "outcome": "answered",
        "sentence": "",
        "verdict": "AGREE",
        "seconds": 1.0,
        "iterations": 50,
        "critical": [],
        "rows": rows,
    }
    return entry | changes


def record_of(*entries):
    return Record(ABOUT, {entry["run"]: entry for entry in entries})


def change_of(before, after, run="arm cprbm 40", **options):
    """The weightiest class of a run."""
    return max(changes_of(before, after, run, **options), key=WEIGHT.index)


def changes_of(before, after, run, **options):
    return [finding.change for finding in compare_records(before, after, **options) if finding.run == run]


OLD = record_of(solver_entry(), solver_entry(80), comparison_entry())


@pytest.mark.parametrize(
    ("after", "change"),
    [
        (solver_entry(), Change.SAME),
        (solver_entry(tip=0.5 * (1 + 0.9e-9)), Change.SAME),
        (solver_entry(tip=0.5 * (1 + 2e-9)), Change.WITHIN),
        (solver_entry(tip=0.5 + 0.9e-3), Change.WITHIN),
        (solver_entry(tip=0.5 + 1.1e-3), Change.BEYOND),
        (solver_entry(tip=float("nan")), Change.BEYOND),
        (solver_entry(ending="STEP_TOO_SMALL", stations=solver_entry()["stations"][:1]), Change.LOST),
        (solver_entry(outcome="out of time"), Change.LOST),
        (solver_entry(outcome="refused"), Change.LOST),
        (solver_entry(outcome="crashed"), Change.CRASHED),
        (solver_entry(critical=[{"stage": "load", "kind": "fold", "load": 1.5, "uncertainty": 0.1}]), Change.BEYOND),
    ],
)
def test_the_class_of_a_solvers_run(after, change):
    assert change_of(OLD, record_of(after)) is change


def test_the_uncertainty_of_another_size_follows_the_second_order():
    """At 80 links the comparison's 1e-3 at 40 links is 2.5e-4."""
    for moved, change in ((2.4e-4, Change.WITHIN), (2.6e-4, Change.BEYOND)):
        assert change_of(OLD, record_of(solver_entry(80, tip=0.5 + moved)), "arm cprbm 80") is change


def test_two_sizes_tell_an_uncertainty_that_no_row_states():
    """Forces of 10 N at 40 and 10.03 N at 80 links: 1.25 · 0.03/(1 − 1/4) = 0.05 N at 40 links."""
    old = record_of(solver_entry(), solver_entry(80, force=10.03), comparison_entry())
    for moved, change in ((0.049, Change.WITHIN), (0.051, Change.BEYOND)):
        assert change_of(old, record_of(solver_entry(force=10.0 + moved))) is change


def test_a_critical_load_moves_within_its_own_uncertainty():
    def at(load):
        return solver_entry(critical=[{"stage": "load", "kind": "fold", "load": load, "uncertainty": 0.1}])

    for load, change in ((1.5, Change.SAME), (1.55, Change.WITHIN), (1.7, Change.BEYOND)):
        assert change_of(record_of(at(1.5)), record_of(at(load))) is change


def test_an_absent_place_is_decided_by_the_force():
    def with_centre(centre, probe="c.centre"):
        entry = solver_entry()
        for station in entry["stations"]:
            station["values"][probe] = centre
        entry["natural"] |= {"centre": 1.0}
        return record_of(entry)

    assert change_of(with_centre([0.3]), with_centre([])) is Change.SAME
    assert change_of(with_centre([0.3], "d.centre"), with_centre([], "d.centre")) is Change.BEYOND


@pytest.mark.parametrize(
    ("changes", "change"),
    [
        ({}, Change.SAME),
        ({"difference": 5e-4 + 1.0e-3}, Change.WITHIN),
        ({"difference": 5e-4 + 1.2e-3}, Change.BEYOND),
        ({"uncertainty": STATED | {"cprbm": 0.5e-3}}, Change.LESS),
        ({"uncertainty": STATED | {"cprbm": 0.9e-3}}, Change.WITHIN),
        ({"uncertainty": STATED | {"cprbm": 5e-3}}, Change.WITHIN),
        ({"uncertainty": {}, "difference": None}, Change.LOST),
    ],
)
def test_the_class_of_a_comparison(changes, change):
    after = comparison_entry()
    after["rows"][1] |= changes
    assert change_of(OLD, record_of(after), "arm comparison") is change


def test_a_smaller_uncertainty_passes_where_it_is_declared():
    after = comparison_entry()
    after["rows"][0]["uncertainty"]["cprbm"] = 1e-5
    assert change_of(OLD, record_of(after), "arm comparison", improved={"cprbm"}) is Change.WITHIN
    assert change_of(OLD, record_of(after), "arm comparison", improved={"fea"}) is Change.LESS


def test_another_word_outweighs_numbers():
    assert change_of(OLD, record_of(comparison_entry(verdict="DIFFER")), "arm comparison") is Change.WORD
    assert change_of(OLD, record_of(comparison_entry(rows=[])), "arm comparison") is Change.LOST


def test_an_accepted_class_hides_no_other_class():
    after = comparison_entry(verdict="UNDECIDED")
    after["rows"] = after["rows"][1:]
    assert changes_of(OLD, record_of(after), "arm comparison") == [Change.LOST, Change.WORD]


def test_a_run_that_answers_at_last_is_won():
    old = record_of(solver_entry(outcome="out of time"))
    assert change_of(old, record_of(solver_entry())) is Change.WON
    assert change_of(old, old) is Change.SAME


def test_a_missing_run_is_lost():
    assert change_of(OLD, record_of(), "arm comparison") is Change.LOST


# planted faults of the real solvers, on the hinge


def stiffer(scene, links, theory):
    """The CPRBM with a bending stiffness 0.5 % too large."""
    materials = {
        name: material.model_copy(update={"youngs_modulus": 1.005 * material.youngs_modulus})
        for name, material in scene.materials.items()
    }
    return answer_of_cprbm(scene.model_copy(update={"materials": materials}), links, theory)


def without_contact(scene, links, theory):
    """The CPRBM with the contact ignored: zero force, no place and no closing load."""
    (contact,) = scene.contacts
    probes = tuple(probe for probe in scene.probes if probe.of != contact)
    answer = answer_of_cprbm(scene.model_copy(update={"contacts": {}, "probes": probes}), links, theory)
    open_contact = {
        probe.name: [0.0] if probe.quantity == "force" else [] for probe in scene.probes if probe.of == contact
    }
    stations = tuple(replace(station, values={**station.values, **open_contact}) for station in answer.stations)
    return replace(answer, stations=stations)


def ended(scene, links, theory):
    """The CPRBM's answer without its last station."""
    answer = answer_of_cprbm(scene, links, theory)
    return replace(answer, ending=Ending.STEP_TOO_SMALL, stations=answer.stations[:-1])


@pytest.fixture(scope="module")
def hinge():
    """The hinge at 20 and 40 links, and its comparison."""
    runs = (Run("hinge", "cprbm", 20), Run("hinge", "cprbm", 40), Run("hinge", "comparison", 0))
    return record_of(*(measure(run, Program()) for run in runs))


def planted(hinge, solver):
    entry = measure(Run("hinge", "cprbm", 40), Program(cprbm=solver))
    return Record(ABOUT, {**hinge.entries, entry["run"]: entry})


def test_two_records_of_one_program_are_the_same(hinge):
    again = planted(hinge, answer_of_cprbm)
    assert {finding.change for finding in compare_records(hinge, again)} == {Change.SAME}


@pytest.mark.parametrize(
    ("solver", "change"), [(stiffer, Change.BEYOND), (without_contact, Change.BEYOND), (ended, Change.LOST)]
)
def test_a_planted_fault_is_reported(hinge, solver, change):
    assert change in FAILING
    assert change_of(hinge, planted(hinge, solver), "hinge cprbm 40") is change


def test_a_halved_uncertainty_is_reported(hinge):
    entry = deepcopy(hinge.entries["hinge comparison"])
    for row in entry["rows"]:
        row["uncertainty"] = {part: 0.5 * bound for part, bound in row["uncertainty"].items()}
    assert Change.LESS in FAILING
    assert change_of(hinge, Record(ABOUT, {**hinge.entries, entry["run"]: entry}), "hinge comparison") is Change.LESS
