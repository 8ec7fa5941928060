"""From Python: a verdict, an answer as a table of numbers, and the same as a file, each in one call."""

import csv
from dataclasses import replace

import numpy as np
import pytest

import comparisons
import cprbm
from comparisons import cases
from comparisons.choices import Choices
from comparisons.present.csv_table import contact_csv


def test_contact_forces_sum_up_to_the_resultant_of_the_probe(wrapped):
    scene, answer = wrapped
    rows = list(csv.DictReader(contact_csv(scene, [answer]).splitlines()))
    assert {(row["contact"], row["beam"], row["arc_length_unit"]) for row in rows} == {("contact", "beam", "m")}
    for station in answer.stations:
        mine = [row for row in rows if float(row["station"]) == station.value]
        resultant = np.hypot(*(sum(float(row[key]) for row in mine) for key in ("force_x", "force_y")))
        assert resultant == pytest.approx(station.values["contact.force"][0], rel=1e-9)
        assert max((float(row["arc_length"]) for row in mine), default=0.0) < 0.0973  # the length of the beam


@pytest.fixture(scope="module")
def wrapped():
    scene = cases.opened("wrapped")
    return scene, cprbm.answer(scene, cprbm.Settings(links=23))


def test_every_number_of_an_answer_is_in_the_table_once_with_what_it_is_of(wrapped):
    scene, answer = wrapped
    found = comparisons.records(scene, answer)
    assert len(found) == sum(values.size for station in answer.stations for values in station.values.values())
    last = {(each["probe"], each["component"], each["arc_length"]): each for each in found if each["station"] == 191.0}
    values = answer.stations[-1].values
    assert last["T.displacement", "y", None]["value"] == values["T.displacement"][1]
    assert last["contact.ends", "last", None]["value"] == values["contact.ends"][1]
    assert last["contact.force", "", None]["value"] == values["contact.force"][0]
    places = sorted(place for probe, _, place in last if probe == "beam.bending_stress")
    np.testing.assert_allclose(places, np.linspace(0.0, 0.0973, 81), rtol=1e-12)
    assert {(each["probe"], each["unit"]) for each in last.values()} >= {
        ("T.displacement", "m"),
        ("tip.rotation", "rad"),
        ("beam.bending_stress", "Pa"),
        ("C.reaction_moment", "N·m"),
    }
    assert {(each["scene"], each["solver"], each["stage"]) for each in found} == {("wrapped", "cprbm", "load")}


def test_the_file_reads_back_to_the_table(wrapped, tmp_path):
    scene, answer = wrapped
    path = tmp_path / "numbers.csv"
    comparisons.write_csv(path, scene, answer, answer)
    with path.open(encoding="utf-8", newline="") as stream:
        lines = list(csv.DictReader(stream))
    found = comparisons.records(scene, answer)
    assert len(lines) == 2 * len(found)
    for line, each in zip(lines, [*found, *found], strict=True):
        assert float(line["value"]) == each["value"]
        assert line["arc_length"] == ("" if each["arc_length"] is None else repr(each["arc_length"]))
        assert {key: line[key] for key in ("probe", "component", "unit")} == {
            key: each[key] for key in ("probe", "component", "unit")
        }


def test_a_file_without_stations_keeps_its_headers(wrapped, tmp_path):
    scene, answer = wrapped
    for name, stations in (("all", answer.stations), ("none", ())):
        comparisons.write_csv(tmp_path / name, scene, replace(answer, stations=stations))
    (headers,) = (tmp_path / "none").read_text(encoding="utf-8").splitlines()
    assert headers == (tmp_path / "all").read_text(encoding="utf-8").splitlines()[0]


def test_a_verdict_is_one_call():
    scene = cases.opened("wrapped")
    stage = scene.stages[0].model_copy(update={"stations": (43.0,)})
    scene = scene.model_copy(update={"stages": (stage,)})
    found = comparisons.compare(scene, Choices(links=23, elements=23))
    assert found.verdict.word.value == "AGREE"
    assert {row.probe.name for row in found.rows} == {probe.name for probe in scene.probes}
