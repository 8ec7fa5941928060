"""Regression files: what counts as a departure, and how one is accepted."""

import json
from dataclasses import replace

import pytest

from comparisons import cases, regression
from comparisons.pairing import Solvers
from tests.comparisons.jumping import Jumping
from tests.comparisons.made_up import MadeUp, with_value


@pytest.fixture
def file(tmp_path, hinge, right):
    path = tmp_path / "hinge.json"
    regression.accept(path, regression.measured(hinge, right), date="2025-01-31", reason="first numbers")
    return path


def test_the_same_numbers_do_not_depart(file, hinge, right):
    assert regression.departures(file, regression.measured(hinge, right)) == ()


def test_a_number_that_moves_departs_by_name(file, hinge, right):
    moved = Solvers(replace(right.cprbm, spoilt=with_value("BD.rotation", [0.9])), right.fea)
    (departure,) = regression.departures(file, regression.measured(hinge, moved))
    assert departure.place == "cprbm BD.rotation load 0.67"
    assert departure.found == [0.9]


def test_rounding_does_not_depart_and_a_little_more_does(file, hinge, right):
    value = float(right.cprbm(hinge, regression.Choices()).stations[-1].values["BD.rotation"][0])
    for factor, count in ((1 + 1e-7, 0), (1 + 3e-6, 1)):
        moved = Solvers(replace(right.cprbm, spoilt=with_value("BD.rotation", [factor * value])), right.fea)
        assert len(regression.departures(file, regression.measured(hinge, moved))) == count


def test_a_probe_that_goes_or_comes_departs(file, hinge, right):
    fewer = hinge.model_copy(update={"probes": hinge.probes[1:], "claims": ()})
    places = {departure.place for departure in regression.departures(file, regression.measured(fewer, right))}
    assert any("B.displacement" in place for place in places)


def test_other_settings_depart(file, hinge, right):
    data = json.loads(file.read_text("utf-8"))
    data["settings"]["cprbm"] = {"n": 41}
    file.write_text(json.dumps(data), "utf-8")
    (departure,) = regression.departures(file, regression.measured(hinge, right))
    assert departure.place == "settings"


def test_an_acceptance_adds_to_the_history(file, hinge):
    softer = Solvers(MadeUp("cprbm", 3e-3), MadeUp("fea", -5e-4))
    found = regression.measured(hinge, softer)
    assert regression.departures(file, found)
    regression.accept(file, found, date="2025-03-01", reason="a better rule")
    assert regression.departures(file, found) == ()
    history = json.loads(file.read_text("utf-8"))["history"]
    assert history == [
        {"date": "2025-01-31", "reason": "first numbers"},
        {"date": "2025-03-01", "reason": "a better rule"},
    ]


def test_an_answer_that_is_not_whole_is_nothing_to_keep(hinge, right):
    with pytest.raises(RuntimeError, match="no station"):
        regression.measured(hinge, Solvers(replace(right.cprbm, until=3), right.fea))


def test_of_a_long_stage_only_what_is_kept_is_solved():
    """The stations to show and the last; where none is shown the middle one and the last; critical values too."""
    scene = cases.opened("prestressed")
    asked = []

    def noting(solver):
        def answer(scene, choices):
            asked.append([stage.stations for stage in scene.stages])
            return Jumping(solver)(scene, choices)

        return answer

    found = regression.measured(scene, Solvers(noting("cprbm"), noting("fea")))
    forward, back = scene.stages
    kept = [forward.shown, (back.stations[45], 0.0)]
    assert asked == [kept, kept]
    assert list(found["values"]["fea"]["D.displacement"]) == [
        *(f"forward {value:g}" for value in forward.shown),
        f"back {back.stations[45]:g}",
        "back 0",
    ]
    assert len(found["values"]["cprbm"]["critical"]) == 2
