"""Random scenes: the same whatever else is drawn, readable, and of all kinds."""

import tomllib
from collections import Counter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from comparisons.stress import strata
from comparisons.stress.drawing import drawn
from comparisons.stress.toml import toml_of
from scene.reading import read, scene_from

COUNTERS = st.integers(0, 2**64 - 1)


def test_a_scene_depends_on_its_counters_alone():
    forwards = [drawn(7, index).text for index in (3, 11, 12)]
    backwards = [drawn(7, index).text for index in (12, 11, 3)]
    assert forwards == backwards[::-1]


def test_seeds_and_indices_give_different_scenes():
    texts = {drawn(seed, index).text.split("\n", 1)[1] for seed in (0, 1, 5) for index in (0, 1)}
    assert len(texts) == 6


@settings(max_examples=12, deadline=None)
@given(seed=COUNTERS, index=COUNTERS)
def test_every_counter_gives_a_scene_that_reads_back(seed, index):
    one = drawn(seed, index)
    assert tomllib.loads(one.text) == one.data
    assert scene_from(one.data).name == one.name


def test_the_text_is_a_file_of_the_scene(tmp_path):
    one = drawn(3, 1)
    (tmp_path / "scene.toml").write_text(one.text, encoding="utf-8")
    found = read(tmp_path / "scene.toml")
    assert found.model_copy(update={"file": ""}) == scene_from(one.data)


def test_every_kind_stands_in_some_scenes():
    counted = Counter()
    scenes = 150
    for index in range(scenes):
        counted.update(strata.stated(scene_from(drawn(11, index).data)))
    rare = {kind: counted[kind] for kind in strata.KINDS if counted[kind] < 0.03 * scenes}
    assert rare == {}
    assert all(counted[f"beams: {n}"] for n in (1, 2, 3, 4))
    assert all(counted[f"contacts: {n}"] for n in (1, 2, 3, 4))


def test_text_of_what_no_scene_is_written_with_is_refused():
    with pytest.raises(TypeError, match="complex"):
        toml_of({"name": "x", "stages": [{"stations": [1j]}]})
