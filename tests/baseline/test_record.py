"""A record on disk, the file of accepted changes, and the program's exit codes."""

import json
import lzma

import pytest
from click.testing import CliRunner

from tests.baseline import record as records
from tests.baseline.__main__ import main
from tests.baseline.accepted import Accepted, AcceptedError, read_accepted
from tests.baseline.changes import Change, Finding
from tests.baseline.report import failing
from tests.baseline.runs import planned_runs
from tests.baseline.test_changes import ABOUT, comparison_entry, record_of, solver_entry


def written(folder, *entries):
    records.start(folder, ABOUT)
    for entry in entries:
        records.add(folder, entry)
    return folder


def test_a_folder_and_a_packed_file_hold_the_same_record(tmp_path):
    folder = written(tmp_path / "a", solver_entry(80), solver_entry(), comparison_entry())
    records.pack(records.read(folder), tmp_path / "a.jsonl.xz")
    assert records.read(tmp_path / "a.jsonl.xz") == records.read(folder)
    assert set(records.read(folder).entries) == {"arm cprbm 40", "arm cprbm 80", "arm comparison"}


def test_a_further_case_joins_a_record(tmp_path):
    first, second = record_of(solver_entry(), solver_entry(80)), record_of(solver_entry(tip=0.6))
    joined = records.join([first, second])
    assert joined.entries == {**first.entries, **second.entries}
    assert joined.about == ABOUT


def test_a_stopped_record_goes_on(tmp_path):
    folder = written(tmp_path / "a", solver_entry())
    with (folder / "entries.jsonl").open("a") as file:
        file.write('{"run": "arm cprbm 80", "sce')  # the stop cuts a line short
    assert records.start(folder, ABOUT) == {"arm cprbm 40"}
    records.add(folder, solver_entry(80))
    assert set(records.read(folder).entries) == {"arm cprbm 40", "arm cprbm 80"}


def test_a_record_of_other_sources_is_not_continued(tmp_path):
    folder = written(tmp_path / "a", solver_entry())
    other = records.About(ABOUT.built_in, 0, 905, None, "another digest")
    with pytest.raises(records.RecordError, match=r"about\.json: program: found 'digest', asked for 'another digest'"):
        records.start(folder, other)


@pytest.mark.parametrize("name", ["nothing", "text.txt", "other.jsonl.xz"])
def test_what_is_no_record_is_named(tmp_path, name):
    (tmp_path / "text.txt").write_text("")
    with lzma.open(tmp_path / "other.jsonl.xz", "wt") as file:
        file.write(json.dumps({"format": 0}) + "\n")
    with pytest.raises(records.RecordError, match=name):
        records.read(tmp_path / name)


def test_the_runs_of_a_record():
    """A built-in case has eight runs (four sizes of links, three of elements, a comparison), a random scene five."""
    runs = [run.name for run in planned_runs(["hinge"], 2, 905, None)]
    assert runs[:8] == [
        *(f"hinge cprbm {links}" for links in (20, 40, 41, 80)),
        *(f"hinge fea {elements}" for elements in (20, 40, 80)),
        "hinge comparison",
    ]
    assert runs[8:13] == [
        *(f"random-905-0 {solver} {size}" for solver in ("cprbm", "fea") for size in (40, 80)),
        "random-905-0 comparison",
    ]
    assert len(runs) == len(set(runs)) == 18


def accepted_file(tmp_path, text):
    path = tmp_path / "accepted.toml"
    path.write_text(text, encoding="utf-8")
    return path


def entry_of(number, kind="lost"):
    return f'[[change]]\nscene = "random-905-{number}"\nclass = "{kind}"\nreason = "a fold of the scene"\n'


def test_an_accepted_change_does_not_fail(tmp_path):
    accepted = read_accepted(accepted_file(tmp_path, entry_of(1)))
    lost = [Finding(Change.LOST, f"random-905-{number} cprbm 40", f"random-905-{number}") for number in (1, 2)]
    beyond = Finding(Change.BEYOND, "random-905-1 fea 40", "random-905-1")
    assert failing([*lost, beyond], accepted) == [lost[1], beyond]


def test_a_wrong_answer_and_a_crash_are_never_accepted(tmp_path):
    accepted = read_accepted(accepted_file(tmp_path, entry_of(1, "word changed")))
    words = [Finding(Change.WORD, "random-905-1 comparison", "random-905-1", word=word) for word in ("DIFFER", "AGREE")]
    assert failing(words, accepted) == words[:1]
    with pytest.raises(AcceptedError, match=r"change\[0\]\.class: found 'crashed', allowed: lost"):
        read_accepted(accepted_file(tmp_path, entry_of(1, "crashed")))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("".join(map(entry_of, range(11))), "change: found 11 scenes, allowed: at most 10"),
        ('[[change]]\nscene = "a"\nclass = "lost"\n', r"change\[0\]: found no key 'reason'"),
        ('[[change]]\nscene = "a"\nclass = "lost"\nreason = " "\n', r"change\[0\]\.reason: found nothing"),
        ("[improved]\nlinks = 'finer'\n", "improved: found the unknown key 'links'"),
        ("changes = []\n", "found the unknown key 'changes'"),
        ("[[change\n", "accepted.toml"),
    ],
)
def test_a_mistake_in_the_file_of_accepted_changes_is_named(tmp_path, text, message):
    with pytest.raises(AcceptedError, match=message):
        read_accepted(accepted_file(tmp_path, text))


def test_no_file_accepts_nothing():
    assert read_accepted(None) == Accepted()


@pytest.mark.parametrize(
    ("after", "code", "said"),
    [
        (solver_entry(), 0, "same                                     2"),
        (solver_entry(tip=0.5002), 0, "moved within the stated uncertainty      1: arm cprbm 40"),
        (solver_entry(tip=0.6), 1, "arm cprbm 40: stage load at 1: tip.displacement moved by 0.1 of its scale"),
        (solver_entry(outcome="crashed", sentence="IndexError"), 1, "crashed: arm cprbm 40: IndexError"),
        (solver_entry(seconds=0.1, iterations=5), 0, "seconds 0.750, median of the runs 0.75; iterations 0.750"),
    ],
)
def test_compare_prints_the_classes_and_fails_by_its_exit_code(tmp_path, after, code, said):
    finer = solver_entry(80, tip=0.501)
    old, new = written(tmp_path / "old", solver_entry(), finer), written(tmp_path / "new", after, finer)
    result = CliRunner().invoke(main, ["compare", str(old), str(new)])
    assert (result.exit_code, said in result.output) == (code, True), result.output


def test_a_record_is_made_from_the_command_line(tmp_path):
    """The smallest record: one built-in case and no random scene; packed, it compares as the same."""
    folder, file = str(tmp_path / "a"), str(tmp_path / "a.jsonl.xz")
    made = CliRunner().invoke(main, ["record", folder, "--only", "tapered", "--scenes", "0", "--workers", "1"])
    assert (made.exit_code, "8 runs (8 answered)" in made.output) == (0, True), made.output
    assert CliRunner().invoke(main, ["pack", folder, file]).exit_code == 0
    assert CliRunner().invoke(main, ["compare", folder, file]).exit_code == 0
    assert record_of(*records.read(tmp_path / "a").entries.values()).entries["tapered comparison"]["verdict"] == "AGREE"


@pytest.mark.parametrize("arguments", [["compare", "no/such/record", "other"], ["record"], ["pack", ".", "a.txt"]])
def test_a_wrong_question_has_exit_code_2(arguments):
    assert CliRunner().invoke(main, arguments).exit_code == 2
