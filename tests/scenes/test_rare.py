"""Rare scenes against the expected lines."""

from dataclasses import replace

import pytest

from cprbm_scene import Ending
from tests.scenes.rare_scenes import ASKED, FOLDER, Expected, departures, expectations, result, scene

EXPECTED = expectations()

ZONE = "the step to a wide zone is refused as a jump"
OPEN = {
    "bypassed-fold": "the set of closed places returns, and no step leads to the fold",
    "zone-off-the-clamp-wide": ZONE,
    "zone-off-the-clamp-backwards": ZONE,
}
"""Scenes that the CPRBM does not answer as expected, and why."""


def marked(name):
    """The name, as an expected failure if the scene is open."""
    return pytest.param(name, marks=pytest.mark.xfail(strict=True, reason=OPEN[name])) if name in OPEN else name


@pytest.mark.rare
@pytest.mark.parametrize("name", [marked(name) for name in EXPECTED])
def test_a_rare_scene_gives_its_expected_result(name):
    expected = EXPECTED[name]
    assert departures(expected, result(scene(name), expected)) == []


def test_every_scene_has_an_expected_line_and_a_comment():
    files = {path.stem: path for path in FOLDER.glob("*.toml") if path.stem != "expected"}
    assert set(files) == set(EXPECTED)
    assert all(path.read_text(encoding="utf-8").startswith("# ") for path in files.values())
    assert [scene(name).name for name in files] == list(files)


@pytest.mark.parametrize("name", EXPECTED)
def test_an_expected_line_names_known_words_solvers_and_endings(name):
    expected = EXPECTED[name]
    assert (expected.word is None) != (expected.ends is None)
    assert expected.word in {None, "agree", "undecided"}
    assert set(expected.endings or {}) <= set(ASKED)
    assert {Ending[ending] for ending in (expected.endings or {}).values()} <= set(Ending)
    if expected.of is not None:
        assert 0.0 < expected.within <= 0.05 * abs(expected.value)
        assert expected.reference


@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("free-beside-its-pin", {"word": "undecided"}),
        ("carried-round-a-tip", {"ends": {"cprbm": "COMPLETED", "fea": "BRANCH_ENDS"}}),
        ("carried-round-a-tip", {"value": 1.01 * EXPECTED["carried-round-a-tip"].value}),
        ("carried-round-a-tip", {"of": "critical load"}),
    ],
    ids=["word", "ending", "number", "absent number"],
)
def test_a_wrong_expectation_is_noticed(name, wrong):
    right = EXPECTED[name]
    found = result(scene(name), replace(right, of=wrong.get("of", right.of)))
    assert departures(replace(right, **wrong), found) != []


def test_a_right_expectation_departs_in_nothing():
    expected = Expected(ends={"cprbm": "COMPLETED"})
    assert departures(expected, result(scene("free-beside-its-pin"), expected)) == []
