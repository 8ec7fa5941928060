"""One bad input each: the key path it is named by, and a word of the sentence."""

import pytest

from tests.cprbm_scene.editing import HINGE, REMOVED, edited, mistakes, two_lines

INF, NAN = float("inf"), float("nan")
BEAM = "beams/beam1"
START = HINGE["beams"]["beam1"]["curve"]["start"]
HUGE = 1 << 40_000
TWO = two_lines(0.01)

RECORDS = [
    (f"{BEAM}/thicknes", 0.002, "beams.beam1.thicknes", "is 'thickness' meant"),
    (
        f"{BEAM}/curve/radius",
        0.1,
        "beams.beam1.curve.radius",
        "'kind', 'center', 'start', 'end', 'direction'",
    ),
    (f"{BEAM}/thickness", REMOVED, "beams.beam1.thickness", "required"),
    (f"{BEAM}/thickness", -0.002, "beams.beam1.thickness", "greater than 0"),
    (f"{BEAM}/thickness", 0.0, "beams.beam1.thickness", "greater than 0"),
    (f"{BEAM}/thickness", INF, "beams.beam1.thickness", "finite"),
    (f"{BEAM}/width", NAN, "beams.beam1.width", "finite"),
    (f"{BEAM}/width", "8 mm", "beams.beam1.width", "'8 mm'; a number"),
    (f"{BEAM}/width", True, "beams.beam1.width", "true; a number"),
    (f"{BEAM}/curve", 3, "beams.beam1.curve", "a table"),
    (f"{BEAM}/curve/kind", "spiral", "beams.beam1.curve.kind", "one of 'line', 'arc'"),
    (f"{BEAM}/curve/kind", REMOVED, "beams.beam1.curve.kind", "nothing; one of 'line', 'arc'"),
    (f"{BEAM}/curve/start", [0.0], "beams.beam1.curve.start[1]", "an item"),
    (f"{BEAM}/curve/start", [0.0, 1.0, 2.0], "beams.beam1.curve.start", "[0.0, 1.0, 2.0]; 2 of them"),
    (f"{BEAM}/curve/start", 0.0, "beams.beam1.curve.start", "a list"),
    (f"{BEAM}/curve/direction", "left", "beams.beam1.curve.direction", "'counterclockwise' or 'clockwise'"),
    (f"{BEAM}/start/joint", "glue", "beams.beam1.start.joint", "one of 'weld', 'pin', 'free'"),
    ("beams", {}, "beams", "at least 1"),
    ("beams/my beam", {}, "beams.my beam", "letters"),
    ("name", "n" * 65, "name", "64 characters"),
    ("loads/M/kind", "torque", "loads.M.kind", "one of 'moment', 'force'"),
    ("loads/M/value", 1.0, "loads.M.value", "'kind', 'body'"),
    ("materials/abs/poisson_ratio", 0.6, "materials.abs.poisson_ratio", "at most 0.5"),
    ("materials/abs/youngs_modulus", HUGE, "materials.abs.youngs_modulus", "40001 bits; a number"),
    ("contacts/contact/thick", 1, "contacts.contact.thick", "true or false"),
    ("contacts/contact/paper/axes", "y", "contacts.contact.paper.axes", "is 'axis' meant"),
    ("contacts/contact/paper/related/beam1/z", [0, 1], "contacts.contact.paper.related.beam1.z", "'x', 'y'"),
    ("stages/0/stations", [], "stages[0].stations", "at least 1"),
    ("stages", [3], "stages[0]", "a table"),
    ("may_cross", ["beam1"], "may_cross[0]", "a list"),
    ("probes/0/points", 2.5, "probes[0].points", "a whole number"),
    ("probes/0/stages", [], "probes[0].stages", "at least 1"),
    ("probes/0/quantity", "speed", "probes[0].quantity", "'rotation'"),
    ("theory", "plastic", "theory", "'bending', 'stretch' or 'shear'"),
    ("file", "x.toml", "file", "no key here"),
]

TIES = [
    (f"{BEAM}/material", "asb", "beams.beam1.material", "is 'abs' meant"),
    (f"{BEAM}/end/point", "E", "beams.beam1.end.point", "'A', 'C', 'B', 'D'"),
    ("loads/M/body", "DB", "loads.M.body", "'AC', 'BD'"),
    ("loads/F", {"kind": "force", "point": "X", "direction": [1, 0]}, "loads.F.point", "names no point"),
    ("contacts/contact/between", ["beam1", "beam3"], "contacts.contact.between[1]", "names no beam"),
    ("stages/0/steps", "N", "stages[0].steps", "names no load"),
    ("may_cross", [["beam1", "beam3"]], "may_cross[0][1]", "a beam or contact with a rigid edge: 'beam1', 'beam2'"),
    ("may_cross", [["beam1", "beam1"]], "may_cross[0]", "two different names"),
    ("drives", {"D": {"kind": "rotation", "body": "BD", "from": "loud"}}, "drives.D.from", "is 'load' meant"),
    ("stages/0/steps", ["M", "F"], "stages[0].steps[1]", "names no load"),
    ("stages/0/steps", ["M", "M"], "stages[0].steps", "different loads, each once"),
    ("probes/0/stages", ["loud"], "probes[0].stages[0]", "the name of a stage: 'load'"),
    ("probes/0/of", "b", "probes[0].of", "names no point, body, beam, contact or stop"),
    ("loads/A", {"kind": "moment", "body": "BD"}, "loads.A", "bodies.AC.points.A has too"),
    ("bodies/BD/points/scene", [0.0, 0.0], "bodies.BD.points.scene", "the scene itself"),
    (f"{BEAM}/thickness", 0.0199, "beams.beam1.thickness", "0.253 of the beam's length"),
    (f"{BEAM}/thickness", 1e-7, "beams.beam1.thickness", "of the beam's length"),
    (f"{BEAM}/curve/end", START, "beams.beam1.curve", "same place"),
    (f"{BEAM}/curve/center", START, "beams.beam1.curve", "own center"),
    (f"{BEAM}/curve/center", [0.0261, 0.02625], "beams.beam1.curve", "no common circle"),
    (
        "bodies/BD/points/B",
        [0.05101, 0.02625],
        "beams.beam1.end",
        "(0.051, 0.02625) m, the point 'B' at (0.05101",
    ),
    (f"{BEAM}/end/point", "D", "beams.beam1.end", "meets no body"),
    ("bodies/AC/motion", "free", "bodies", "no fixed body"),
    ("bodies/loose", {"motion": "free", "points": {"Z": [0, 0]}}, "bodies.loose", "no beam meets"),
    ("loads/M/body", "AC", "loads.M.body", "moment on the fixed body 'AC'; a body that can move: 'BD'"),
    ("loads/F", {"kind": "force", "point": "A", "direction": [1, 0]}, "loads.F.point", "fixed body 'AC'"),
    ("loads/F", {"kind": "force", "point": "B", "direction": [0, 0]}, "loads.F.direction", "not zero"),
    ("contacts/contact/between", ["beam1", "beam1"], "contacts.contact.between", "two different beams"),
    ("contacts/own", {"kind": "beam-self", "beam": "beam3"}, "contacts.own.beam", "beam3"),
    (
        "contacts/more",
        {"kind": "beam-beam", "between": ["beam2", "beam1"]},
        "contacts.more.between",
        "the pair of contacts.contact again",
    ),
    (
        "contacts/again",
        {"kind": "beam-beam", "between": ["beam1", "beam2"], "thick": False},
        "contacts.again.between",
        "the pair of contacts.contact again",
    ),
    ("contacts/contact/paper/boundary", "BD", "contacts.contact.paper.boundary", "'beam1', 'beam2'"),
    (
        "contacts/contact/paper/related/AC",
        {"x": [0, 1]},
        "contacts.contact.paper.related.AC",
        "one of the pair",
    ),
    ("contacts/contact/paper/related/beam1", {}, "contacts.contact.paper.related.beam1", "neither x nor y"),
    (
        "contacts/contact/paper/related/beam1/y",
        [0, 1],
        "contacts.contact.paper.related.beam1",
        "both x and y",
    ),
    (
        "contacts/contact/paper/related/beam1/x",
        [0.03, 0.02],
        "contacts.contact.paper.related.beam1.x",
        "from the smaller to the larger",
    ),
    ("stages/1", {"name": "load", "steps": "M", "stations": [1]}, "stages[1].name", "'load' again"),
    ("stages/0/stations", [0.67, 0.67], "stages[0].stations[1]", "0.67 again"),
    ("stages/0/stations", [0.67, 0.0, 0.67], "stages[0].stations[2]", "a further stage may go back"),
    ("probes/0/quantity", "rotation", "probes[0]", "'rotation' of a body: 'AC', 'BD'"),
    (
        "probes/0/quantity",
        "reaction",
        "probes[0]",
        "point of a fixed body at which a beam ends, a pivot, a driven point, or a body that slides: 'A', 'C'",
    ),
    ("probes/0/points", 11, "probes[0].points", "'combined_stress' only"),
    ("probes/1/of", "B", "probes[1]", "'B.displacement' again"),
    ("claims/0/probe", "B.displacment", "claims[0].probe", "is 'B.displacement' meant"),
    ("claims/0/station", 0.68, "claims[0].station", "0.603, 0.67"),
    ("claims/0/stage", "lod", "claims[0].stage", "is 'load' meant"),
    ("claims/0/value", 0.01, "claims[0].value", "which has several"),
    ("claims/0/probe", "critical", "claims[0].station", "the first of a stage is meant"),
    ("stages/0/shown", [0.67, 0.5], "stages[0].shown[1]", "one of the stage's stations"),
]


RECORDS += [
    ("title", "a\u0007b", "title", "control characters"),
    ("source", "a\u0000", "source", "control characters"),
    ("bodies/a\u001bb", {"motion": "fixed", "points": {"Z": [0, 0]}}, "bodies.a\u001bb", "letters"),
]
ALL = RECORDS + TIES
ONE = [row for row in RECORDS if row[0] != "beams/my beam"]  # an empty beam misses its keys too


@pytest.mark.parametrize(("path", "value", "key", "words"), ALL, ids=[row[2] for row in ALL])
def test_a_mistake_is_named_by_its_key(path, value, key, words):
    found = mistakes((path, value))
    assert words in found[key]


@pytest.mark.parametrize(("path", "value", "key", "words"), ONE, ids=[row[2] for row in ONE])
def test_a_mistake_in_one_record_is_the_only_one(path, value, key, words):
    assert list(mistakes((path, value))) == [key]


def test_names_have_latin_and_greek_letters():
    body = {"motion": "fixed", "points": {"Füße": [0.0, 0.2], "φ_1": [0.1, 0.2]}}
    assert mistakes(("bodies/Träger", body)) == {}


def test_several_mistakes_are_reported_at_once():
    found = mistakes((f"{BEAM}/thicknes", 1), (f"{BEAM}/width", -1), ("name", 3), ("stages/0/stations", [NAN]))
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
