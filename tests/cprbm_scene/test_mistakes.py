"""Mistakes of scenes: the key and a part of the sentence, from the table; scenes without mistakes."""

import math
import re

import pytest

from cprbm_scene import scene_from
from cprbm_scene.solving import requirements
from tests.cprbm_scene.editing import (
    ACROSS,
    ASSEMBLED,
    BELOW,
    BOTH,
    CIRCULAR,
    DRIVEN,
    HINGE,
    HUNG,
    LINE,
    LINES,
    LINKAGE,
    LOADED,
    OWN,
    PUSH,
    REMOVED,
    SLIDING,
    SLOTTED,
    STOPPED,
    TURN,
    TURNED,
    WITH_FORCE,
    edited,
    mistakes,
    over,
    straight,
    two_lines,
    weld,
)
from tests.cprbm_scene.mistakes_table import SECTIONS

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


PUNCH = {"motion": "slides", "along": [0.0, 1.0], "points": {"P": [0.026, 0.2]}}
VARYING = {"at": [0.0, 1.0], "values": [0.002, 0.001]}
GOOD = [
    *((base, []) for base in (DRIVEN, TURNED, SLIDING, WITH_FORCE, SLOTTED, BOTH, LINKAGE, STOPPED, ASSEMBLED)),
    (HINGE, [("bodies/Träger", {"motion": "fixed", "points": {"Füße": [0.0, 0.2], "φ_1": [0.1, 0.2]}})]),
    # contacts: a beam beside its other contacts, several circles, all quantities of a circle, a moment about a pin
    (HINGE, [("contacts/own", OWN), ("contacts/other", {**OWN, "beam": "beam2"})]),
    *(
        (
            HINGE,
            [("beams/beam1/thickness", VARYING), ("contacts/contact/thick", False), ("contacts/own", {**OWN, **more})],
        )
        for more in ({}, {"thick": False})
    ),
    (CIRCULAR, [("contacts/more", {**CIRCULAR["contacts"]["touch"], "center": [0.06, 0.032]})]),
    (CIRCULAR, [("contacts/more", {**CIRCULAR["contacts"]["touch"], "body": "block"})]),
    (
        CIRCULAR,
        [("probes", [{"of": "touch", "quantity": each} for each in ("force", "centre", "ends", "closing_load")])],
    ),
    (over(LINE, start="pin"), [("probes/1", {"of": "touch", "quantity": "moment"})]),
    # what a drive, a pin in a slot, a weld or a contact holds
    (DRIVEN, [("probes/0", {"of": "B", "quantity": "reaction"})]),
    *((TURNED, [("probes", [{"of": of, "quantity": "reaction_moment"}])]) for of in ("A", "BD")),
    (DRIVEN, [("drives/e", {**PUSH, "direction": [1.0, 0.0]}), ("drives/t", TURN)]),
    (DRIVEN, [("loads/F", ACROSS)]),
    (DRIVEN, [("bodies/punch", PUNCH), ("drives/p", {**PUSH, "point": "P"})]),
    (SLOTTED, [("drives/t", TURN)]),
    (SLOTTED, [("loads/M", {"kind": "moment", "body": "BD"})]),
    (SLOTTED, [("drives/e", {**PUSH, "point": "D", "direction": [1.0, 0.0]})]),
    (LINKAGE, [("loads", {}), ("stages/0/steps", "phi"), ("drives/phi", {"kind": "rotation", "body": "crank"})]),
    (LINKAGE, [("probes/1", {"of": "O", "quantity": "reaction"})]),
    (HUNG, [("beams/low/start/joint", "weld"), ("beams/low/end/joint", "weld")]),
    (HUNG, [("drives", {"D": {"kind": "rotation", "body": "plate"}})]),
    (HUNG, [("contacts", {"below": BELOW})]),
    *((LOADED, [("loads/F/beam", beam), ("loads/F/at", 1.0)]) for beam in ("upper", "lower")),
    # the length of a direction has no meaning
    *(
        (
            BOTH,
            [
                ("drives/d/direction", [3.0 * factor, 4.0 * factor]),
                ("bodies/slider/along", [3.0 * factor, 4.0 * factor]),
                ("loads/F/direction", [-4.0 * factor, 3.0 * factor]),
            ],
        )
        for factor in (math.ldexp(1.0, -290), math.ldexp(1.0, 290))
    ),
]
"""Scenes, and edits that make no mistake."""


@pytest.mark.parametrize(("base", "edits"), GOOD)
def test_a_good_question_has_no_mistakes(base, edits):
    assert mistakes(*edits, base=base) == {}


def test_drives_alone_can_hold_a_mechanism():
    """All three freedoms of a body on beams, without a fixed body; with two of them solvers refuse the turn."""
    data = edited(("bodies/AC/motion", "free"), ("drives/e", {**PUSH, "direction": [1.0, 0.0]}), base=DRIVEN)
    data["probes"] = [{"of": "B", "quantity": "reaction"}]
    for edits, support in (((), 2), ((("drives/t", TURN),), 0)):
        found = requirements(scene_from(edited(*edits, base=data)))
        assert {kind: len([*mistakes]) for kind, mistakes in found.items()} == {
            **dict.fromkeys(found, 0),
            "support": support,
        }


ONE_ROUND = [
    # a record with several mistakes, and several references
    ({"beams/lower/thicknes": 1, "beams/lower/width": -1, "name": 3, "stages/0/stations": [float("nan")]},
     {"beams.lower.thicknes", "beams.lower.width", "name", "stages[0].stations[0]"}),
    ({"beams/lower/material": "gold", "loads/F/point": "O", "claims": [
        {"probe": "Q.displacement", "station": 9.0, "bound": 1.0}]},
     {"beams.lower.material", "loads.F.point", "claims[0].station"}),
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
    # names that are no texts, from Python
    ({"bodies/block/points": {7: [0.1, 0.0], "Q": [0.1, 0.0]}, "materials/steel/poisson_ratio": 2.0},
     {"bodies.block.points[7]", "materials.steel.poisson_ratio"}),
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


def test_suggestions_are_allowed_names_each_once():
    edits = ("materials/steel/poisson_ratio", 2.0), ("beams/lower/material", "stel")
    assert "is 'steel' meant" in mistakes(*edits, base=TWO)["beams.lower.material"]
    forbidden = ("bodies/a  b", {"motion": "free", "points": {"S": [0.1, 0.0]}}), ("probes/0/of", "ab")
    found = mistakes(*forbidden, base=TWO)
    assert set(found) == {"bodies.a  b", "probes[0].of"}
    assert "a  b" not in found["probes[0].of"]
    repeated = ("bodies/block/points/O", [0.1, 0.0]), ("beams/upper/start/point", "Z")
    assert mistakes(*repeated, base=TWO)["beams.upper.start.point"].count("'O'") == 1


@pytest.mark.parametrize(
    ("edits", "key", "words"),
    [
        ([("beams/upper/start", {"joint": "free"})], "beams.upper", "two free ends"),
        ([("beams/upper/start/joint", "pin")], "beams.upper", "turns freely"),
        ([("bodies/block/points/S", [0, 0]), ("beams/lower/start/point", "S")], "bodies.block", "no fixed body holds"),
    ],
)
def test_a_part_without_support_needs_a_contact_or_a_load(edits, key, words):
    far = {
        **TWO["beams"]["lower"],
        "curve": straight((0.0, 0.5), (0.1, 0.5)),
        "start": weld("far0"),
        "end": weld("far1"),
    }
    elsewhere = [
        ("bodies/wall", {"motion": "fixed", "points": {"far0": [0.0, 0.5]}}),
        ("bodies/far", {"motion": "free", "points": {"far1": [0.1, 0.5]}}),
        ("beams/far", far),
        ("loads/F/point", "far1"),
    ]
    assert mistakes(*edits, base=TWO) == {}
    assert words in mistakes(*edits, *elsewhere, ("contacts", {}), base=TWO)[key]
