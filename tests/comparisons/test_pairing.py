"""Which runs a comparison asks for, and what becomes of refusals."""

import os
import signal
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.executor import WorkerDiedError, crew_of
from comparisons.pairing import (
    EXACT_LIMIT,
    Solvers,
    cprbm_answer,
    exact_by_rule,
    exact_if_covered,
    exact_pieces,
    fea_answer,
    paired,
    solvers_of,
)
from comparisons.verdict import Word
from cprbm_scene import Critical, Ending, Loss, Mistake, SceneError
from tests.tables import tables_of
from tests.verdict.made_up import MadeUp


def test_every_run_is_asked_for_once(hinge, right):
    asked = []

    def noting(name, solver):
        def answer(scene, choices):
            asked.append((name, choices))
            return solver(scene, choices)

        return answer

    paired(hinge, Choices(), Solvers(noting("cprbm", right.cprbm), noting("fea", right.fea)))
    assert [(choices.theory, choices.links, choices.formulation) for name, choices in asked if name == "cprbm"] == [
        ("bending", 40, "auto"),
        ("bending", 46, "auto"),
        ("bending", 80, "auto"),
        ("shear", 40, "auto"),
        ("bending", 40, "paper"),
    ]
    assert [
        (choices.kinematics, choices.elements, choices.penetration) for name, choices in asked if name == "fea"
    ] == [
        ("bending", 80, 1e-4),
        ("bending", 91, pytest.approx(1e-4 * (80 / 91) ** 4)),
        ("bending", 160, 6.25e-6),
    ]


@dataclass(frozen=True)
class Noted:
    """A solver without stations; finer runs take a minute without a critical value. Calls leave files in a folder."""

    solver: str
    folder: Path
    critical: tuple = ()

    def __call__(self, scene, choices):
        count = choices.links if self.solver == "cprbm" else choices.elements
        (self.folder / f"{self.solver}-{choices.theory}-{choices.formulation}-{count}").touch()
        if count > (40 if self.solver == "cprbm" else 80) and not self.critical:
            time.sleep(60.0)
        answer = MadeUp(self.solver, 0.0, until=0)(scene, choices)
        return replace(answer, ending=Ending.STEP_TOO_SMALL, critical=self.critical)


@pytest.mark.parametrize("workers", [1, 2])
def test_without_a_common_station_no_other_run_is_waited_for(hinge, tmp_path, workers):
    solvers = Solvers(Noted("cprbm", tmp_path), Noted("fea", tmp_path), exact=exact_by_rule)
    began = time.perf_counter()
    with crew_of(workers) as crew:
        runs = paired(hinge, Choices(), solvers, crew)
    assert time.perf_counter() - began < 30.0
    assert [*runs.same_theory] == ["cprbm", "fea"]
    assert not {"cprbm paper", "exact"} & runs.answers.keys()
    assert runs.other.ending is Ending.STEP_TOO_SMALL
    asked = {path.name for path in tmp_path.iterdir()}
    assert {"cprbm-bending-auto-40", "fea-bending-auto-80", "cprbm-shear-auto-40"} <= asked
    if workers == 1:
        assert len(asked) == 3
    verdict = compare(runs).verdict
    assert verdict.word is Word.UNDECIDED
    assert "it ended early" in verdict.because


def test_a_critical_value_and_a_failed_helper_run_keep_all_runs(hinge, tmp_path, right):
    critical = (Critical("load", 0.1, 1e-6, Loss.FOLD, "", 0.0, 0.0, 1.0, None),)
    solvers = Solvers(Noted("cprbm", tmp_path, critical), Noted("fea", tmp_path, critical))
    assert len(paired(hinge, Choices(), solvers).same_theory) == 6

    def coarse(scene, choices):
        answer = right.cprbm(scene, choices)
        return answer if choices.links == 40 else replace(answer, ending=Ending.STEP_TOO_SMALL, stations=())

    runs = paired(hinge, Choices(), Solvers(coarse, right.fea)).same_theory
    assert runs["cprbm finer"].ending is Ending.STEP_TOO_SMALL
    assert len(runs) == 6


@pytest.mark.parametrize(("case", "pieces"), [("hinge", 3), ("stack", 6), ("wrapped", 2), ("tapered", 6)])
def test_pieces_of_the_exact_equations(case, pieces):
    """Beams and contacts of these cases; the section of the tapered beam has kinks at five places between the ends."""
    assert exact_pieces(cases.opened(case)) == pieces


def test_built_in_cases_are_within_the_rule_for_the_exact_reference():
    covered = ("gripper", "gripper-driven", "hinge", "platform", "stack", "tapered", "wrapped")
    products = [
        exact_pieces(scene) * sum(len(stage.stations) for stage in scene.stages) for scene in map(cases.opened, covered)
    ]
    assert max(products) == 160  # gripper-driven: two beams and two contacts at 40 stations
    assert max(products) <= EXACT_LIMIT


def test_a_scene_beyond_the_rule_has_no_exact_values_and_says_so(hinge, right):
    stage = hinge.stages[0]
    long = hinge.model_copy(
        update={"stages": (stage.model_copy(update={"stations": tuple(np.linspace(0.01, 0.6, 101))}),)}
    )
    runs = paired(long, Choices(), replace(right, exact=exact_by_rule))
    assert "exact" not in runs.answers
    assert runs.absences["exact"].startswith("3 pieces of beams at 101 stations are beyond the rule")
    assert "--exact" in runs.absences["exact"]
    notes = [sheet.note for sheet in tables_of(compare(runs))]
    assert sum(f"No exact values: {runs.absences['exact']}" in note for note in notes) == 1


def test_what_is_asked_of_the_exact_reference():
    found = [solvers_of(None, exact=asked).exact for asked in (None, True, False)]
    assert found == [exact_by_rule, exact_if_covered, None]
    planted = Solvers(exact=exact_by_rule)
    assert solvers_of(planted) is solvers_of(planted, exact=True) is planted
    assert solvers_of(planted, exact=False).exact is None


def test_both_formulations_are_there_whichever_was_chosen(hinge):
    solvers = Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    runs = [paired(hinge, Choices(formulation=one), solvers) for one in ("auto", "paper")]
    found = [[each.answers[name] for name in each.formulations] for each in runs]
    rotations = [[answer.stations[0].values["BD.rotation"] for answer in pair or ()] for pair in found]
    assert rotations[0] == rotations[1]
    assert rotations[0][0] != rotations[0][1]


@pytest.mark.parametrize(
    ("case", "links", "asked"),
    [
        ("hinge", 160, True),
        ("hinge", 161, False),
        ("hinge", {"beam1": 20, "beam2": 200}, False),
        ("wrapped", 40, True),
        ("prestressed", 40, False),  # it asks where branches end
    ],
)
def test_paper_stands_beside_auto_where_it_was_told_all_and_is_quick(right, case, links, asked):
    runs = paired(cases.opened(case), Choices(links=links), right)
    assert ("cprbm paper" in runs.answers) is asked
    assert "cprbm paper" not in runs.same_theory


@pytest.mark.parametrize("workers", [1, 2])
def test_a_refusal_of_paper_alone_is_none(hinge, right, workers):
    solvers = Solvers(RefusingPaper(), right.fea)
    with crew_of(workers) as crew:
        runs = paired(hinge, Choices(), solvers, crew)
        assert "cprbm paper" not in runs.answers
        with pytest.raises(SceneError):
            paired(hinge, Choices(formulation="paper"), solvers, crew)
        assert "cprbm paper" not in paired(hinge, Choices(), solvers, crew).answers, "the crew is as it was"


class RefusingPaper:
    """A solver that lacks something for the formulation ``paper``."""

    def __call__(self, scene, choices):
        if choices.formulation == "paper":
            raise SceneError([Mistake("contacts.contact.paper", "nothing", "something", "file.toml")])
        return MadeUp("cprbm", 2e-3)(scene, choices)


def test_counts_by_beam_are_doubled_beam_by_beam():
    finer = Choices(links={"beam1": 30, "beam2": 40}, elements={"beam1": 7, "beam2": 8}).finer()
    assert finer.links == {"beam1": 60, "beam2": 80}
    assert finer.elements == {"beam1": 14, "beam2": 16}


@pytest.mark.parametrize("semaphores", [True, False])
def test_two_processes_give_the_answers_of_one(hinge, right, monkeypatch, semaphores):
    """Also on a machine with a read-only ``/dev/shm``, where Python refuses semaphores."""

    def refused(*_):
        raise PermissionError(13, "Permission denied")

    if not semaphores:
        monkeypatch.setattr("multiprocessing.synchronize.SemLock.__init__", refused)
    with crew_of(2) as crew:
        one, two = paired(hinge, Choices(), right), paired(hinge, Choices(), right, crew)
    assert [*one.same_theory] == [*two.same_theory]
    for mine, theirs in zip(one.same_theory.values(), two.same_theory.values(), strict=True):
        assert mine.settings == theirs.settings
        for a, b in zip(mine.stations, theirs.stations, strict=True):
            assert {name: values.tolist() for name, values in a.values.items()} == {
                name: values.tolist() for name, values in b.values.items()
            }


def test_a_refusal_keeps_its_words_and_leaves_the_processes_to_the_next_question(hinge, right):
    with crew_of(2) as crew:
        with pytest.raises(SceneError):
            paired(hinge, Choices(), Solvers(Refusing(), right.fea), crew)
        assert paired(cases.opened("wrapped"), Choices(), right, crew).answers["fea"].scene == "wrapped"
    with crew_of(2) as crew, pytest.raises(SceneError) as caught:
        paired(hinge, Choices(), Solvers(MadeUp("cprbm", 0.0), Refusing()), crew)
    assert caught.value.mistakes == (Mistake("beams.beam1", "a beam", "another beam", "file.toml"),)


def killed(scene, choices):
    os.kill(os.getpid(), signal.SIGKILL)


def test_killed_processes_are_errors_and_their_successors_work(hinge, right):
    with crew_of(2) as crew:
        with pytest.raises(WorkerDiedError, match="ended with -9"):
            crew.answers([(killed, hinge, Choices())] * 2)
        assert crew.answers([(right.fea, hinge, Choices())] * 3)[2].solver == "fea"


class Refusing:
    """A solver that refuses every question; a class, since a process takes no local function."""

    def __call__(self, scene, choices):
        raise SceneError([Mistake("beams.beam1", "a beam", "another beam", "file.toml")])


@pytest.mark.parametrize("links", [{"beam1": 30}, {"beam1": 30, "beam2": 30, "beam3": 30}, {}])
def test_counts_must_name_every_beam_and_no_other(hinge, right, links):
    with pytest.raises(SceneError, match=r"links.*beam1, beam2"):
        paired(hinge, Choices(links=links), right)


@pytest.mark.parametrize(("solver", "choices"), [(cprbm_answer, Choices(links=0)), (fea_answer, Choices(elements=0))])
def test_the_real_solvers_refuse_no_links_and_no_elements(hinge, solver, choices):
    with pytest.raises(SceneError):
        solver(hinge, choices)
