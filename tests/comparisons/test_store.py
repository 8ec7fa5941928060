"""The store: answers as files come back whole, damaged files are solved again, and no file leaves the folder."""

import gzip
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from comparisons import store
from comparisons.answer_file import packed, unpacked
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from tests.verdict.made_up import MadeUp


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
    answer = right.fea(hinge, Choices())
    stations = tuple(replace(answer.stations[0], values={"q": np.array(row, float)}) for row in rows)
    answer = replace(answer, stations=stations)
    assert bits(there_and_back(answer)) == bits(answer)
    assert packed({"a": answer, "b": answer}) == packed({"a": there_and_back(answer), "b": answer})


def test_an_answer_survives(hinge, right):
    answer = right.fea(hinge, Choices())
    back = there_and_back(answer)
    assert bits(back) == bits(answer)
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


def test_a_verdict_needs_no_second_solve(hinge, right):
    runs = paired(hinge, Choices(), right)
    back = replace(runs, answers={name: there_and_back(answer) for name, answer in runs.answers.items()})
    assert compare(back).verdict == compare(runs).verdict


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
