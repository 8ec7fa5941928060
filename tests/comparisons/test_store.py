"""The store: answers as files come back whole, damaged files are solved again, and no file leaves the folder."""

import gzip
import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons import store
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.plain import text_of
from tests.verdict.made_up import MadeUp


def there_and_back(answer):
    return store.unpacked(json.loads(text_of(store.packed(answer))))


def test_an_answer_survives(hinge, right):
    answer = right.fea(hinge, Choices())
    back = there_and_back(answer)
    assert (back.solver, back.ending, back.events, back.seconds) == (
        answer.solver,
        answer.ending,
        answer.events,
        answer.seconds,
    )
    for old, new in zip(answer.stations, back.stations, strict=True):
        assert old.certificate == new.certificate
        assert set(old.values) == set(new.values)
        for name, values in old.values.items():
            np.testing.assert_array_equal(new.values[name], values)
        for name, places in old.touching.items():
            np.testing.assert_array_equal(new.touching[name], places)
            assert new.touching[name].shape == places.shape
        with pytest.raises(ValueError, match="read-only"):
            new.values["BD.rotation"][0] = 0.0


def test_a_verdict_needs_no_second_solve(hinge, right):
    runs = paired(hinge, Choices(), right)
    single = {
        name: there_and_back(getattr(runs, name)) for name in ("beside", "fea_beside", "other") if getattr(runs, name)
    }
    several = {name: tuple(map(there_and_back, getattr(runs, name))) for name in ("cprbm", "fea")}
    back = replace(runs, **single, **several)
    assert compare(hinge, back).verdict == compare(hinge, runs).verdict


class Counting:
    """A solver that counts its solves."""

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
