"""The studies beside planted solvers whose errors are known in closed form."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.studies import table1
from cprbm_scene import Answer, Ending, Mistake, Scene, SceneError
from cprbm_scene.frozendict import frozendict

MACHINE = {
    "cpu": "a", "cores": 1, "system": "b", "python": "c", "numpy": "d", "scipy": "e", "scikit-fem": "f",
}  # fmt: skip


@dataclass
class Clocked:
    """Answers at once, refuses or breaks off on request; counts the solves."""

    base: Callable[[Scene, Choices], Answer]
    refuses: str = ""
    ending: Ending = Ending.COMPLETED
    until: int = 10**6
    solves: int = 0

    def __call__(self, scene, choices):
        self.solves += 1
        if self.solves > self.until:
            raise KeyboardInterrupt
        if self.refuses == f"{scene.name} {choices.formulation}":
            raise SceneError([Mistake("contacts.circle.paper", "nothing", "a boundary")])
        return replace(self.base(scene, choices), ending=self.ending, sentence="It fell short.")


def nothing(scene, choices):
    """An answer without stations, for tests of times."""
    return Answer("made up", scene.name, frozendict(), Ending.COMPLETED, "", ())


def quick(**faults):
    return Solvers(Clocked(nothing, **faults), Clocked(nothing))


@pytest.fixture
def three_cells(monkeypatch):
    """The command measures three cells of the gripper: a study of all cells draws a figure per cell."""
    sizes = 80, {"beam1": 40, "beam2": 30}
    cells = [cell for cell in table1.CELLS if cell.case == "gripper" and cell.contact and cell.size in sizes]
    for name in ("session", "result_of", "pictures"):
        monkeypatch.setattr(table1, name, partial(getattr(table1, name), cells=tuple(cells)))
    return cells


def test_table1_has_the_papers_discretisations_and_times():
    """Table 1 of the paper, and the gripper's (30, 40) of section 3.3."""
    theirs = {(cell.case, cell.method, cell.contact, cell.size_text): cell.theirs for cell in table1.CELLS}
    assert theirs == {
        ("hinge", "fea", True, "80"): 4.0,
        ("hinge", "fea", True, "160"): 5.0,
        ("hinge", "fea", False, "80"): 4.0,
        ("hinge", "cprbm", True, "(40, 40)"): 5.0,
        ("hinge", "cprbm", True, "(60, 60)"): 11.75,
        ("gripper", "fea", True, "80"): 23.0,
        ("gripper", "fea", True, "160"): 40.0,
        ("gripper", "fea", False, "80"): 4.0,
        ("gripper", "cprbm", True, "(40, 30)"): 4.32,
        ("gripper", "cprbm", True, "(30, 40)"): None,
        ("gripper", "cprbm", True, "(60, 50)"): 19.56,
    }
    assert {cell.formulation for cell in table1.CELLS if cell.method == "cprbm"} == {"auto", "paper"}


def test_a_cell_is_asked_at_its_last_load_alone_and_without_contact_where_it_says_so():
    for cell in table1.CELLS:
        scene = table1.question(cell)
        assert [stage.stations for stage in scene.stages] == [((0.67,) if cell.case == "hinge" else (16.0,))]
        assert bool(scene.contacts) is cell.contact
        if not cell.contact:
            assert {probe.of for probe in scene.probes}.isdisjoint(cases.opened(cell.case).contacts)
            assert scene.probes


def test_every_cell_is_solved_as_often_as_asked_and_a_refusal_is_said():
    solvers = quick(refuses="gripper paper")
    session = table1.session(solvers, MACHINE, repeat=2, at_most=60.0)
    for job in session.jobs():
        session.do(job)
    result = table1.result_of(session)
    assert result.complete
    for cell, row in zip(table1.CELLS, result.data["rows"], strict=True):
        if (cell.case, cell.formulation) == ("gripper", "paper"):
            assert (row["repeats"], row["seconds"], row["ended"]) == (0, None, None)
            assert row["why"] == "contacts.circle.paper: found nothing; allowed: a boundary"
        else:
            assert (row["repeats"], row["ended"], row["why"]) == (2, "COMPLETED", None)
            assert row["seconds"] > 0.0
    assert [row[-1] for row in result.tables[0].rows].count("refused") == 3
    assert sum("found nothing" in sentence for sentence in result.sentences) == 3
    assert "i5-8500" in result.tables[0].note
    # a quick solve runs twice and the second run counts; one solve warms up; a refused cell is not tried again
    assert solvers.cprbm.solves == 1 + 2 * 2 * 7 + 3


def test_a_slow_cell_is_not_repeated_and_stops_no_other():
    session = table1.session(quick(), MACHINE, repeat=4, at_most=0.0)
    for job in session.jobs():
        session.do(job)
    assert {len(timing.seconds) for timing in session.rows()} == {1}
    assert len(session.rows()) == len(table1.CELLS)


def test_study_without_a_name_lists_the_studies(capsys):
    assert run(["study"]) == 0
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert names == ["calibration", "relations", "table1"]


@pytest.mark.usefixtures("printed")
def test_table1_writes_a_page_numbers_and_a_figure(capsys, tmp_path, three_cells):
    out = tmp_path / "new" / "out"
    arguments = ["study", "table1", "--repeat", "1", "--out", str(out), "--json", str(tmp_path / "t.json")]
    assert run(arguments, quick(refuses="gripper paper")) == 0
    captured = capsys.readouterr()
    assert "theirs / ours" in captured.out
    assert captured.err == ""
    data = json.loads((tmp_path / "t.json").read_text("utf-8"))
    assert data == json.loads((out / "table1.json").read_text("utf-8"))
    assert data["machine"]["cpu"]
    assert len(data["rows"]) == len(three_cells) == 3
    row = next(row for row in data["rows"] if row["case"] == "gripper" and row["formulation"] == "auto")
    assert row["size"] == {"beam1": 40, "beam2": 30}
    assert row["paper_seconds"] == 4.32
    assert row["repeats"] == 1
    page = (out / "table1.html").read_text("utf-8")
    assert "data:image/svg+xml," in page
    assert 'href="table1.png"' in page
    assert (out / "table1.png").is_file()


def test_json_on_standard_output_is_alone_there(capsys, three_cells):
    assert run(["study", "table1", "--repeat", "1", "--json", "-"], quick()) == 0
    assert len(json.loads(capsys.readouterr().out)["rows"]) == len(three_cells)


@pytest.mark.usefixtures("three_cells")
def test_quiet_prints_nothing(capsys):
    assert run(["study", "table1", "--repeat", "1", "--quiet"], quick()) == 0
    captured = capsys.readouterr()
    assert captured.out == captured.err == ""


@pytest.mark.usefixtures("three_cells")
def test_an_interrupted_study_keeps_what_was_finished(capsys, tmp_path):
    file = tmp_path / "found.json"
    assert run(["study", "table1", "--json", str(file), "--out", str(tmp_path)], quick(until=3)) == 130
    data = json.loads(file.read_text("utf-8"))
    measured = [row for row in data["rows"] if row["seconds"] is not None]
    assert measured
    assert len(measured) < 3
    assert (tmp_path / "table1.html").is_file()
    assert "Interrupted" in capsys.readouterr().err


@pytest.mark.usefixtures("three_cells")
def test_a_solve_that_does_not_complete_ends_with_1(capsys):
    assert run(["study", "table1", "--repeat", "1"], quick(ending=Ending.STEP_TOO_SMALL)) == 1
    captured = capsys.readouterr()
    assert "STEP_TOO_SMALL" in captured.out
    assert "It fell short." in captured.out
