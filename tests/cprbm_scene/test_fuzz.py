"""Altered files: every file is a question or a wrong question, within a second."""

import copy
import math
from contextlib import suppress
from functools import reduce

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Scene, SceneError, read, reading, scene_from
from tests.cprbm_scene.editing import BOTH, CIRCULAR, FILE, HINGE, edited, mistakes
from tests.cprbm_scene.fuzzing import followed

SCENES = [HINGE, BOTH, CIRCULAR]
NAMES = [
    "A",
    "B",
    "AC",
    "beam1",
    "beam2",
    "scene",
    "contact",
    "line",
    "arc",
    "polynomial",
    "spline",
    "free",
    "force",
    "M",
]
NUMBERS = st.one_of(
    st.floats(),
    st.floats(-3.0, 3.0),
    st.sampled_from([0.0, 5e-324, 1e-308, 1e-160, 1e-9, 1e3, 1e9, 1e154, 1e308, -1.7e308, 10**400]),
)
VALUES = st.recursive(
    st.one_of(
        *(st.none(), st.booleans(), st.integers(-3, 3), st.integers(), NUMBERS, st.text(max_size=6)),
        *(st.sampled_from(NAMES), st.dates()),
    ),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=6), inner, max_size=3)),
    max_leaves=6,
)


def places(value, path=()):
    """Every path into the data, parents first."""
    steps = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in steps:
        yield (*path, key)
        yield from places(item, (*path, key))


PLACES = [list(places(data)) for data in SCENES]
GEOMETRY = [
    [path for path in paths if path[0] in ("beams", "bodies", "contacts", "drives", "loads")] for paths in PLACES
]
VECTORS = [[path for path in paths if isinstance(path[-1], int)] for paths in GEOMETRY]


def change(data, path, action, value):
    """Set, drop or rename the item at a path; an earlier change may have taken the place away."""
    place = data
    with suppress(KeyError, IndexError, TypeError, AttributeError):
        for key in path[:-1]:
            place = place[key]
        item = place.pop(path[-1]) if action != "set" or isinstance(place, dict) else None
        if action == "set":
            place[path[-1]] = value
        elif action == "rename":
            place[value] = item


def scene_or_error(data):
    with suppress(SceneError):
        assert isinstance(scene_from(data), Scene)


@pytest.mark.parametrize("k", range(len(SCENES)), ids=["arcs", "drives", "circle"])
def test_random_edits(k):
    @settings(max_examples=60, deadline=None, derandomize=True)
    @given(
        st.lists(st.tuples(st.sampled_from(PLACES[k]), st.sampled_from(["set", "drop", "rename"]), VALUES), max_size=3)
    )
    def altered(edits):
        data = copy.deepcopy(SCENES[k])
        for path, action, value in edits:
            change(data, path, action, value)
        scene_or_error(data)

    @settings(max_examples=40, deadline=None, derandomize=True)
    @given(st.lists(st.tuples(st.sampled_from(VECTORS[k]), NUMBERS), min_size=1, max_size=4))
    def with_numbers(edits):
        data = copy.deepcopy(SCENES[k])
        for path, value in edits:
            change(data, path, "set", value)
        scene_or_error(data)

    altered()
    with_numbers()


@settings(max_examples=80, deadline=None, derandomize=True)
@given(center=st.lists(NUMBERS, min_size=2, max_size=2), radius=NUMBERS, thick=st.booleans())
def test_a_wrong_circle_is_a_mistake_of_the_circle(center, radius, thick):
    circle = CIRCULAR["contacts"]["touch"] | {"center": center, "radius": radius, "thick": thick}
    assert all(key.startswith("contacts.touch") for key in mistakes(("contacts/touch", circle), base=CIRCULAR))


@settings(max_examples=120, deadline=None, derandomize=True)
@given(
    axis=st.sampled_from(["x", "y"]),
    coefficients=st.lists(st.one_of(NUMBERS, st.just(math.inf)), max_size=24),
    ends=st.tuples(NUMBERS, NUMBERS),
    free=st.booleans(),
)
def test_random_polynomials_in_the_hinge(axis, coefficients, ends, free):
    """With a free end, or with the points of the bodies put where the curve begins and ends."""
    curve = {"kind": "polynomial", "axis": axis, "coefficients": coefficients, "range": list(ends)}
    data = edited(("beams/beam1/curve", curve))
    if free:
        data["beams"]["beam1"]["end"] = {"joint": "free"}
    for body, point, v in (("AC", "A", ends[0]), ("BD", "B", ends[1])):
        with suppress(OverflowError):
            value = reduce(lambda total, coefficient: total * v + coefficient, reversed(coefficients), 0.0)
            data["bodies"][body]["points"][point] = [v, value] if axis == "x" else [value, v]
    scene_or_error(data)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(start=st.integers(0, 4000), junk=st.binary(max_size=200), cut=st.one_of(st.integers(0, 12), st.just(10_000)))
def test_random_bytes_in_the_file(tmp_path_factory, start, junk, cut):
    good = FILE.read_bytes()
    path = tmp_path_factory.getbasetemp() / "fuzz.toml"
    path.write_bytes(good[:start] + junk + good[start + cut :])
    with suppress(SceneError):
        assert isinstance(read(path), Scene)


def test_the_fuzzer_sees_a_planted_fault_and_the_way_of_a_wrong_file(monkeypatch, tmp_path):
    def faulty(scene):
        raise KeyError("planted")

    ways, said = followed(FILE)
    assert said == ""
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(FILE.read_text("utf-8").replace('point = "B"', 'point = "D"', 1), "utf-8")
    other, said = followed(wrong)
    assert said == ""
    assert other - ways
    monkeypatch.setattr(reading, "_BY_NAME", (faulty,))
    assert followed(FILE)[1] == "KeyError: 'planted'"
