"""Altered files: every one is a question or a wrong question, within a second."""

import copy
import math
from contextlib import suppress

from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Scene, SceneError, read, reading, scene_from
from tests.cprbm_scene.conftest import HINGE as FILE
from tests.cprbm_scene.editing import HINGE
from tests.cprbm_scene.fuzzing import followed

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 3),
    st.integers(),
    st.floats(),
    st.sampled_from([1e-308, 1e-200, 1e-9, 1e9, 1e154, 1e308, 10**400]),
    st.text(max_size=6),
    st.sampled_from(
        [
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
    ),
    st.dates(),
)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=6), inner, max_size=3)),
    max_leaves=6,
)


def _places(value, path=()):
    """Every path into the data, parents first."""
    steps = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in steps:
        yield (*path, key)
        yield from _places(item, (*path, key))


PLACES = list(_places(HINGE))
NUMBERS = [path for path in PLACES if path[0] in ("beams", "bodies") and not isinstance(path[-1], str)] + [
    ("beams", beam, key) for beam in ("beam1", "beam2") for key in ("thickness", "width")
]


def _put(data, path, change):
    place = data
    # an earlier edit may have taken this place away: then there is nothing to do
    with suppress(KeyError, IndexError, TypeError, AttributeError):
        for key in path[:-1]:
            place = place[key]
        change(place, path[-1])


def _scene_or_error(data):
    with suppress(SceneError):
        assert isinstance(scene_from(data), Scene)


@settings(max_examples=250, deadline=None, derandomize=True)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(PLACES),
            st.sampled_from(["set", "drop", "rename", "swap"]),
            values,
            st.sampled_from(PLACES),
            st.text(max_size=5),
        ),
        min_size=1,
        max_size=3,
    )
)
def test_random_edits_of_the_hinge(edits):
    data = copy.deepcopy(HINGE)
    for path, kind, value, other, text in edits:
        if kind == "set":
            _put(data, path, lambda place, key, value=value: place.__setitem__(key, value))
        elif kind == "drop":
            _put(data, path, lambda place, key: place.__delitem__(key))
        elif kind == "rename":
            _put(data, path, lambda place, key, text=text: place.__setitem__(text, place.pop(key)))
        else:
            source = []
            _put(data, other, lambda place, key, source=source: source.append(copy.deepcopy(place[key])))
            _put(data, path, lambda place, key, source=source: place.__setitem__(key, source[0]))
    _scene_or_error(data)


@settings(max_examples=120, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.sampled_from(NUMBERS), st.floats(allow_nan=False)), min_size=1, max_size=4))
def test_random_numbers_in_the_geometry(edits):
    data = copy.deepcopy(HINGE)
    for path, value in edits:
        _put(data, path, lambda place, key, value=value: place.__setitem__(key, value))
    _scene_or_error(data)


numbers = st.one_of(
    st.floats(allow_nan=False),
    st.floats(-3.0, 3.0),
    st.sampled_from([0.0, 1e-308, 1e-160, 1e-9, 1e3, 1e9, 1e154, 1e308, -1e308, math.inf]),
)


@settings(max_examples=250, deadline=None, derandomize=True)
@given(
    axis=st.sampled_from(["x", "y"]),
    coefficients=st.lists(numbers, max_size=24),
    ends=st.tuples(numbers, numbers),
    free=st.booleans(),
)
def test_random_polynomials_in_the_hinge(axis, coefficients, ends, free):
    """With a free end, or with the points of the bodies put where the curve begins and ends."""
    data = copy.deepcopy(HINGE)
    data["beams"]["beam1"]["curve"] = {
        "kind": "polynomial",
        "axis": axis,
        "coefficients": coefficients,
        "range": list(ends),
    }
    if free:
        data["beams"]["beam1"]["end"] = {"joint": "free"}
    else:
        for body, point, v in (("AC", "A", ends[0]), ("BD", "B", ends[1])):
            value = 0.0
            for coefficient in reversed(coefficients):
                value = value * v + coefficient
            data["bodies"][body]["points"][point] = [v, value] if axis == "x" else [value, v]
    _scene_or_error(data)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(exponent=st.integers(-140, 140))
def test_the_hinge_at_any_scale_is_the_same_question(exponent):
    """All lengths times a power of two: no bound stands on a length, so nothing may change."""
    factor = math.ldexp(1.0, exponent)

    def scaled(value):
        return [scaled(item) for item in value] if isinstance(value, list) else value * factor

    data = copy.deepcopy(HINGE)
    for beam in data["beams"].values():
        for key in ("thickness", "width"):
            beam[key] = scaled(beam[key])
        for key in ("center", "start", "end"):
            beam["curve"][key] = scaled(beam["curve"][key])
    for body in data["bodies"].values():
        body["points"] = {name: scaled(place) for name, place in body["points"].items()}
    assert scene_from(data).name == "hinge"


@settings(max_examples=100, deadline=None, derandomize=True)
@given(start=st.integers(0, 4000), junk=st.binary(max_size=12), cut=st.integers(0, 12))
def test_random_bytes_in_the_file(tmp_path_factory, start, junk, cut):
    good = FILE.read_bytes()
    path = tmp_path_factory.getbasetemp() / "fuzz.toml"
    path.write_bytes(good[:start] + junk + good[start + cut :])
    with suppress(SceneError):
        assert isinstance(read(path), Scene)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(junk=st.binary(max_size=200))
def test_nothing_but_random_bytes(tmp_path_factory, junk):
    path = tmp_path_factory.getbasetemp() / "noise.toml"
    path.write_bytes(junk)
    with suppress(SceneError):
        read(path)


def test_a_planted_fault_is_seen(monkeypatch):
    def faulty(scene):
        raise KeyError("planted")

    assert followed(FILE)[1] == ""
    monkeypatch.setattr(reading, "_BY_NAME", (faulty,))
    assert followed(FILE)[1] == "KeyError: 'planted'"


def test_a_wrong_file_takes_a_way_of_its_own(tmp_path):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(FILE.read_text("utf-8").replace('point = "B"', 'point = "D"', 1), "utf-8")
    ways, said = followed(wrong)
    assert said == ""
    assert ways - followed(FILE)[0]
