"""Mistakes of scenes: the key and a part of the sentence, from the table and from scenes of their own."""

import re

import pytest

from tests.cprbm_scene.editing import REMOVED, edited, mistakes, two_lines
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


ONE_ROUND = [
    # values, places and names: a record with a wrong value takes part in no check of places
    ({"beams/lower/width": -1.0, "beams/upper/curve/start": [0.0, 0.02], "probes/0/of": "K"},
     {"beams.lower.width", "beams.upper.start", "probes[0].of"}),
    # a beam of a wrong body has no place, and the mechanism no support: names alone are checked
    ({"bodies/ground/motion": "welded", "beams/upper/start/point": "Z", "bodies/block/points/Q": [0.2, 0.0]},
     {"bodies.ground.motion", "beams.upper.start.point"}),
    ({"materials": REMOVED, "loads/F/body": "block", "stages/0/steps": "G", "contacts/touch/between": ["lower", "k"]},
     {"materials", "loads.F.body", "stages[0].steps", "contacts.touch.between[1]"}),
    # numbers in lists are those of the file
    ({"stages/0/stations": [], "stages/1": {"name": "more", "steps": "K", "stations": [1.0]}, "claims": [
        {"probe": "Q.displacement", "station": 7.0, "bound": 0.1},
        {"probe": "Q.displacement", "stage": "load", "station": 7.0, "bound": 0.1},
        {"probe": "Q.rotation", "stage": "lode", "bound": 0.1}]},
     {"stages[0].stations", "stages[1].steps", "claims[2].probe", "claims[2].stage"}),
    ({"probes/0/quantity": "speed", "probes/1": {"of": "P", "quantity": "rotation"},
      "claims": [{"probe": "Q.speed", "bound": 0.1}]}, {"probes[0].quantity", "probes[1]"}),
    # with a mistake in the units names can be checked, places cannot
    ({"units": {"length": "km"}, "beams/upper/start/point": "Z", "bodies/block/points/Q": [0.2, 0.0]},
     {"units.length", "beams.upper.start.point"}),
    ({"parameters": {"a": {"value": "= b"}, "b": {"value": "= a"}, "c": {"value": 1.0, "unit": "ell"},
                     "d": {"value": "= 2*c"}, "e": {"value": 3.0, "unit": "mm", "range": [1.0, 2.0]}},
      "beams/lower/thickness": "= d/1000", "beams/upper/thickness": "= f", "bodies/block/points/Q": [0.2, 0.0]},
     {"parameters.b.value", "parameters.c.unit", "parameters.e.value", "beams.upper.thickness"}),
    # an assembly with a mistake may bring an end to its point
    ({"assembly": {"moments": {"lower": "1"}}, "beams/lower/end": {"joint": "pin", "point": "Q"},
      "bodies/block/points/Q": [0.1, 0.05], "probes/0/points": 7}, {"assembly.moments.lower", "probes[0].points"}),
    # a free end of a beam with a mistake is a point
    ({"beams/upper/end/point": "T", "beams/upper/width": 0.0, "probes/1": {"of": "T", "quantity": "displacement"},
      "probes/2": {"of": "T-body", "quantity": "rotation"}, "probes/3": {"of": "S", "quantity": "rotation"}},
     {"beams.upper.width", "probes[3].of"}),
    # a misspelled key is no missing key
    ({"beams/lower/width": REMOVED, "beams/lower/widht": 0.01, "stages/0/name": REMOVED, "stages/0/nme": "load"},
     {"beams.lower.widht", "stages[0].nme"}),
    # the names of a misspelled table are unknown
    ({"body": TWO["bodies"], "bodies": REMOVED, "probes/0/points": 7}, {"body", "probes[0].points"}),
    ({"contact": TWO["contacts"], "contacts": REMOVED, "probes/0": {"of": "touch", "quantity": "force"}}, {"contact"}),
    # parameters have units of their own: beside lengths in wrong units they have no size
    ({"units": {"length": "mmm"}, "parameters": {"t": {"value": 0.2, "unit": "um"}},
      "beams/lower/thickness": "= t", "beams/upper/thickness": "= u"}, {"units.length", "beams.upper.thickness"}),
]  # fmt: skip
"""Edits of two beams, and the keys of all mistakes."""


@pytest.mark.parametrize(("edits", "keys"), ONE_ROUND)
def test_all_mistakes_come_in_one_round(edits, keys):
    assert set(mistakes(*edits.items(), base=TWO)) == keys


def test_a_name_near_that_of_a_wrong_record_has_a_hint():
    edits = ("materials/steel/poisson_ratio", 2.0), ("beams/lower/material", "stel")
    assert "is 'steel' meant" in mistakes(*edits, base=TWO)["beams.lower.material"]


def test_a_forbidden_name_is_no_suggestion():
    edits = ("bodies/a  b", {"motion": "free", "points": {"S": [0.1, 0.0]}}), ("probes/0/of", "ab")
    found = mistakes(*edits, base=TWO)
    assert set(found) == {"bodies.a  b", "probes[0].of"}
    assert "a  b" not in found["probes[0].of"]


def test_a_message_lists_a_repeated_name_once():
    edits = ("bodies/block/points/O", [0.1, 0.0]), ("beams/upper/start/point", "Z")
    assert mistakes(*edits, base=TWO)["beams.upper.start.point"].count("'O'") == 1


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
