"""The runs of a comparison: questions to the solvers, refusals, processes, and answers kept in memory and in files."""

import gzip
import os
import signal
import time
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from comparisons import cases, store
from comparisons.answer_file import packed, unpacked
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
from comparisons.store import AnswerMemory
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


def test_the_rule_for_the_exact_reference_counts_pieces_times_stations(hinge, right):
    """Pieces are beams, contacts, and parts of a beam between kinks of its section: the tapered beam has five kinks."""
    covered = ("gripper", "gripper-driven", "hinge", "platform", "stack", "tapered", "wrapped")
    scenes = {case: cases.opened(case) for case in covered}
    for case, pieces in (("hinge", 3), ("stack", 6), ("wrapped", 2), ("tapered", 6)):
        assert exact_pieces(scenes[case]) == pieces, case
    products = [exact_pieces(scene) * sum(len(stage.stations) for stage in scene.stages) for scene in scenes.values()]
    assert max(products) == 160  # gripper-driven: two beams and two contacts at 40 stations
    assert max(products) <= EXACT_LIMIT
    found = [solvers_of(None, exact=asked).exact for asked in (None, True, False)]
    assert found == [exact_by_rule, exact_if_covered, None]
    planted = Solvers(exact=exact_by_rule)
    assert solvers_of(planted) is solvers_of(planted, exact=True) is planted
    assert solvers_of(planted, exact=False).exact is None
    (stage,) = hinge.stages
    stage = stage.model_copy(update={"stations": tuple(np.linspace(0.01, 0.6, 101))})
    runs = paired(hinge.model_copy(update={"stages": (stage,)}), Choices(), replace(right, exact=exact_by_rule))
    assert "exact" not in runs.answers
    assert runs.absences["exact"].startswith("3 pieces of beams at 101 stations are beyond the rule")
    assert "--exact" in runs.absences["exact"]
    notes = [sheet.note for sheet in tables_of(compare(runs))]
    assert sum(f"No exact values: {runs.absences['exact']}" in note for note in notes) == 1


class RefusingPaper:
    """A solver that lacks something for the formulation ``paper``."""

    def __call__(self, scene, choices):
        if choices.formulation == "paper":
            raise SceneError([Mistake("contacts.contact.paper", "nothing", "something", "file.toml")])
        return MadeUp("cprbm", 2e-3)(scene, choices)


@pytest.mark.parametrize("workers", [1, 2])
def test_both_formulations_are_there_whichever_was_chosen_unless_paper_is_refused(hinge, right, workers):
    solvers = Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    with crew_of(workers) as crew:
        runs = [paired(hinge, Choices(formulation=one), solvers, crew) for one in ("auto", "paper")]
        found = [[each.answers[name] for name in each.formulations] for each in runs]
        rotations = [[answer.stations[0].values["BD.rotation"] for answer in pair or ()] for pair in found]
        assert rotations[0] == rotations[1]
        assert rotations[0][0] != rotations[0][1]
        refusing = Solvers(RefusingPaper(), right.fea)
        assert "cprbm paper" not in paired(hinge, Choices(), refusing, crew).answers
        with pytest.raises(SceneError):
            paired(hinge, Choices(formulation="paper"), refusing, crew)
        assert "cprbm paper" not in paired(hinge, Choices(), refusing, crew).answers, "the crew is as it was"


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


def test_the_sizes_and_the_penetration_of_a_run_follow_n():
    assert Choices().of_size(40).penetration == Choices().penetration
    assert Choices().of_size(80).penetration == Choices().finer().penetration
    assert Choices().of_size(10).penetration == pytest.approx(256.0 * Choices().penetration)
    assert Choices().of_size(4).penetration == 0.05
    assert Choices().of_size(160).penetration / Choices().of_size(320).penetration == pytest.approx(4.0)
    assert (Choices().of_size(20).links, Choices().of_size(20).elements) == (20, 20)
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


class Refusing:
    """A solver that refuses every question; a class, since a process takes no local function."""

    def __call__(self, scene, choices):
        raise SceneError([Mistake("beams.beam1", "a beam", "another beam", "file.toml")])


def killed(scene, choices):
    os.kill(os.getpid(), signal.SIGKILL)


def test_refusals_and_killed_processes_are_errors_and_their_processes_work_on(hinge, right):
    with crew_of(2) as crew:
        with pytest.raises(SceneError) as caught:
            paired(hinge, Choices(), Solvers(MadeUp("cprbm", 0.0), Refusing()), crew)
        assert caught.value.mistakes == (Mistake("beams.beam1", "a beam", "another beam", "file.toml"),)
        with pytest.raises(SceneError):
            paired(hinge, Choices(), Solvers(Refusing(), right.fea), crew)
        assert paired(cases.opened("wrapped"), Choices(), right, crew).answers["fea"].scene == "wrapped"
        with pytest.raises(WorkerDiedError, match="ended with -9"):
            crew.answers([(killed, hinge, Choices())] * 2)
        assert crew.answers([(right.fea, hinge, Choices())] * 3)[2].solver == "fea"


def test_numbers_of_links_and_elements_are_refused(hinge, right):
    """Numbers by beam name every beam and no other; the real solvers take at least one link or element."""
    for links in ({"beam1": 30}, {"beam1": 30, "beam2": 30, "beam3": 30}, {}):
        with pytest.raises(SceneError, match=r"links.*beam1, beam2"):
            paired(hinge, Choices(links=links), right)
    for solver, choices in ((cprbm_answer, Choices(links=0)), (fea_answer, Choices(elements=0))):
        with pytest.raises(SceneError):
            solver(hinge, choices)


# -- Answers in memory and in files


@pytest.mark.parametrize(
    ("solver", "own", "calls"),
    [
        ("cprbm", Choices(elements=20, penetration=1e-5), 1),
        ("cprbm", Choices(links={"beam1": 40, "beam2": 40}), 2),
        ("fea", Choices(links=20, formulation="paper"), 1),
        ("fea", Choices(kinematics="bending"), 2),
    ],
)
def test_a_solver_does_not_heed_the_others_choices(hinge, right, solver, own, calls):
    found = []

    def counting(scene, choices):
        found.append(choices)
        return getattr(right, solver)(scene, choices)

    solvers = replace(right, **{solver: counting})
    AnswerMemory(solvers=solvers).answers([(counting, hinge, Choices()), (counting, hinge, own)])
    assert len(found) == calls


def there_and_back(answer):
    return unpacked(packed({"run": answer}))["run"]


def bits(value):
    """Every number of a record as its bits, with shapes and names."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, Mapping):
        return {name: bits(each) for name, each in value.items()}
    if isinstance(value, tuple):
        return tuple(map(bits, value))
    return {each.name: bits(getattr(value, each.name)) for each in fields(value)} if is_dataclass(value) else value


@pytest.mark.parametrize(
    "rows",
    [
        [[0.0, -0.0, np.inf, -np.inf, np.nan], [5e-324, -1.7976931348623157e308, 1 / 3, -np.pi, 1.0]],
        [[1.0], [1.0, 2.0], [], [-3.0], [1.0]],
        [[[1.0, -2.0]], np.zeros((0, 2)), [[1.0, -2.0], [0.1, 0.2]]],
        np.random.default_rng(905).integers(0, 2**64, (7, 5), np.uint64).view(float),
        np.linspace(1.0, 2.0, 40)[:, None] ** np.linspace(0.0, 3.0, 80),
    ],
    ids=["special", "shapes", "pairs", "any bits", "smooth"],
)
def test_every_bit_of_a_number_survives(hinge, right, rows):
    whole = right.fea(hinge, Choices())
    stations = tuple(replace(whole.stations[0], values={"q": np.array(row, float)}) for row in rows)
    answer = replace(whole, stations=stations)
    assert bits(there_and_back(answer)) == bits(answer)
    assert packed({"a": answer, "b": answer}) == packed({"a": there_and_back(answer), "b": answer})
    back = there_and_back(whole)
    assert bits(back) == bits(whole)
    with pytest.raises(ValueError, match="read-only"):
        back.stations[0].values["BD.rotation"][0] = 0.0


def test_smooth_numbers_take_a_third_of_their_room(hinge, right):
    """The orders of the differences follow the numbers: noise takes no more room than its bits."""
    (station, *_) = right.fea(hinge, Choices()).stations

    def size(rows):
        stations = tuple(replace(station, values={"q": row}) for row in rows)
        empty = replace(station, values={"q": np.zeros(0)})
        found = (replace(right.fea(hinge, Choices()), stations=each) for each in (stations, (empty,) * len(stations)))
        whole, rest = (len(packed({"run": each})) for each in found)
        return (whole - rest) / (8 * np.size(rows))

    noise = np.random.default_rng(905).integers(0, 2**64, (40, 200), np.uint64).view(float)
    assert size(np.linspace(1.0, 2.0, 40)[:, None] ** np.linspace(0.0, 3.0, 200)) < 1 / 3
    assert size(noise) < 1.03


class Counting:
    """A solver with a count of solves."""

    def __init__(self):
        self.solved = 0

    def __call__(self, scene, choices):
        self.solved += 1
        return MadeUp("cprbm", 2e-3)(scene, choices)


def kept_files(folder):
    return sorted(folder.rglob(".unfinished/*.json.gz"))


@pytest.mark.parametrize(
    "damage",
    [
        lambda file: file.write_bytes(file.read_bytes()[:200]),
        lambda file: file.write_bytes(b""),
        lambda file: file.write_bytes(gzip.compress(b'{"answer": {"solver": "cprbm"}}')),
        lambda file: file.write_bytes(gzip.compress(b"[1, 2")),
        lambda file: file.write_bytes(file.read_bytes()[:-60] + b"x" * 60),
    ],
    ids=["cut", "empty", "lacking", "no JSON", "changed"],
)
def test_a_damaged_file_is_solved_again_with_a_note(hinge, tmp_path, caplog, damage):
    counting = Counting()
    solvers = store.kept(Solvers(cprbm=counting), tmp_path / ".unfinished")
    solvers.cprbm(hinge, Choices())
    (file,) = kept_files(tmp_path)
    damage(file)
    with store.run_into(tmp_path, Solvers(cprbm=counting)) as run:
        again = run.solvers.cprbm(hinge, Choices())
        assert run.solvers.cprbm(hinge, Choices(elements=7)).seconds == again.seconds, "elements are no matter of links"
    assert counting.solved == 2
    assert len(caplog.records) == 1
    assert file.name in caplog.text
    assert "solved again" in caplog.text


def test_kept_answers_leave_no_folder_through_a_link(hinge, tmp_path):
    elsewhere, out = tmp_path / "elsewhere", tmp_path / "out"
    elsewhere.mkdir()
    out.mkdir()
    (elsewhere / "mine.txt").write_text("mine", "utf-8")
    (out / ".unfinished").symlink_to(elsewhere)
    (out / ".ended").symlink_to(elsewhere)
    with store.run_into(out, Solvers(cprbm=Counting())) as run:
        run.solvers.cprbm(hinge, Choices())
        assert len(kept_files(out)) == 1
    assert [file.name for file in elsewhere.iterdir()] == ["mine.txt"]
    assert not list(out.iterdir())
