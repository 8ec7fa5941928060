"""Mistakes of scenes: the key and a part of the sentence, from the table and from scenes of their own."""

import re

import pytest

from tests.cprbm_scene.editing import edited, mistakes, two_lines
from tests.cprbm_scene.mistakes_table import SECTIONS
from tests.cprbm_scene.scenes import LINES

BEAM = "beams/beam1"
TWO = two_lines(0.01)


def rows_of(section):
    """Edits, key and words of the rows of a section."""
    _, begin, _, rows = SECTIONS[section]
    for first, *rest, words in rows:
        if isinstance(first, list):
            yield first, rest[0], words
        else:
            path, value, *key = f"{begin}{first}", *rest
            yield [(path, value)], *(key or [re.sub(r"/(\d+)(?=/|$)", r"[\1]", path).replace("/", ".")]), words


@pytest.mark.parametrize("section", SECTIONS)
def test_every_mistake_of_the_table_is_named_by_its_key(section):
    base, _, alone, _ = SECTIONS[section]
    wrong = []
    for edits, key, words in rows_of(section):
        found = mistakes(*edits, base=base)
        if words not in found.get(key, "") or (alone and list(found) != [key]):
            wrong.append((edits, key, words, found))
    assert not wrong


def test_a_width_along_a_beam_has_the_mistakes_of_a_thickness():
    for edits, key, words in rows_of("a thickness along a beam"):
        found = mistakes(*((path.replace("thickness", "width"), value) for path, value in edits), base=LINES)
        assert words in found[key.replace("thickness", "width")]


def test_names_have_latin_and_greek_letters():
    body = {"motion": "fixed", "points": {"Füße": [0.0, 0.2], "φ_1": [0.1, 0.2]}}
    assert mistakes(("bodies/Träger", body)) == {}


def test_several_mistakes_are_reported_at_once():
    found = mistakes((f"{BEAM}/thicknes", 1), (f"{BEAM}/width", -1), ("name", 3), ("stages/0/stations", [float("nan")]))
    assert set(found) == {"beams.beam1.thicknes", "beams.beam1.width", "name", "stages[0].stations[0]"}


def test_several_wrong_ties_are_reported_at_once():
    found = mistakes((f"{BEAM}/material", "gold"), ("loads/M/body", "AC"), ("claims/1/station", 9.0))
    assert set(found) == {"beams.beam1.material", "loads.M.body", "claims[1].station"}


def test_a_thickness_near_the_radius():
    """A quarter of a full circle has t/L below the bound on t/L and t/(2R) above its own at t = 1.05 R."""
    arc = {"kind": "arc", "center": [0, 0], "start": [1, 0], "end": [0.9, -(0.19**0.5)]}
    base = edited(
        (f"{BEAM}/curve", {**arc, "direction": "counterclockwise"}),
        (f"{BEAM}/thickness", 1.05),
        ("bodies/AC/points/A", arc["start"]),
        ("bodies/BD/points/B", arc["end"]),
    )
    assert "radius of curvature" in mistakes(base=base)["beams.beam1.thickness"]


def test_a_beam_lost_in_large_coordinates():
    found = mistakes(base=two_lines(0.0, second=((1e6, 0.0), (1e6 + 0.1, 0.0))))
    assert "at coordinates up to 1e+06" in found["beams.upper.curve"]


@pytest.mark.parametrize(
    ("edits", "key", "words"),
    [
        ([("beams/upper/start", {"joint": "free"})], "beams.upper", "two free ends"),
        ([("beams/upper/start/joint", "pin")], "beams.upper", "turns freely"),
        ([("bodies/block/points/S", [0, 0]), ("beams/lower/start/point", "S")], "bodies.block", "no fixed body holds"),
    ],
)
def test_a_part_without_support_needs_a_contact_or_a_load(edits, key, words):
    bent = {**TWO["beams"]["lower"], "curve": {"kind": "line", "start": [0.0, 0.5], "end": [0.1, 0.5]}}
    bent |= {"start": {"joint": "weld", "point": "far0"}, "end": {"joint": "weld", "point": "far1"}}
    elsewhere = [
        ("bodies/wall", {"motion": "fixed", "points": {"far0": [0.0, 0.5]}}),
        ("bodies/far", {"motion": "free", "points": {"far1": [0.1, 0.5]}}),
        ("beams/far", bent),
        ("loads/F/point", "far1"),
    ]
    assert mistakes(*edits, base=TWO) == {}
    assert words in mistakes(*edits, *elsewhere, ("contacts", {}), base=TWO)[key]
