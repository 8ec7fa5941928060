"""Files and data: what can be read, units, parameters, tables of points, notes, and the immutable scene."""

import copy
import math
import pickle
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, get_args, get_origin, get_type_hints

import pytest
from pydantic import BaseModel, ValidationError

from comparisons import cases
from cprbm_scene import OffsetQuestion, Scene, SceneError, read, read_question, scene_from, statement
from cprbm_scene.fields import Measured
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import MOST
from cprbm_scene.notes import notes
from cprbm_scene.reading import DEEPEST
from cprbm_scene.statement import BeamForce, DisplacementDrive, DistributedLoad, Record, Units
from cprbm_scene.units import LONGEST, SIZES
from tests.cprbm_scene.editing import (
    BOWED,
    CIRCULAR,
    DRIVEN,
    FILE,
    HINGE,
    LINKAGE,
    LOADED,
    PARABOLA,
    PARAMETRIC,
    POINTS,
    REMOVED,
    SLIDING,
    THROUGH_POINTS,
    TIP,
    TURN,
    A,
    R,
    cantilever,
    edited,
    mistakes,
    two_lines,
)
from tests.robustness.toml import toml_of


def refused(question, *arguments, **options):
    """The error of a question that is refused."""
    with pytest.raises(SceneError) as caught:
        question(*arguments, **options)
    return caught.value


MANY_PARTS = f"a key of more than {DEEPEST} parts"
REFUSED = [
    *((text, "no TOML") for text in (b"name = ", b"[beams", b"a = 1\na = 2", b"\0")),
    *((b"a = " + text * 99_999, "text that is no TOML") for text in (b"[", b"{a=", b"9")),
    (b"\x7fELF\x80\xff\xfe", "no UTF-8 text (at byte 4)"),
    (b"#" * (LONGEST + 1), "a file that is larger; allowed: TOML in UTF-8"),
    # the parser takes the square of the number of parts
    *(
        (begin + b".".join([name] * 100_000) + end, MANY_PARTS)
        for name in (b"a", b'"a b"', b"'c'", b"a ")
        for begin, end in ((b"", b" = 1"), (b"[", b"]"), (b"x = {", b" = 1}"))
    ),
]


def test_a_file_that_cannot_be_read_is_refused_with_its_name(tmp_path):
    path = tmp_path / "file.toml"
    for text, words in REFUSED:
        path.write_bytes(text)
        assert words in str(refused(read, path))
        assert [mistake.file for mistake in refused(read, path).mistakes] == [str(path)]
    for name, words in (
        (tmp_path / "none.toml", "No such file"),
        (tmp_path, "directory"),
        ("a\0.toml", "cannot be read"),
    ):
        assert words in str(refused(read, name))
    for text in (b"#" * LONGEST, b".".join([b"a"] * DEEPEST) + b" = 1"):
        path.write_bytes(text)
        assert not any(words in str(refused(read, path)) for words in ("larger", MANY_PARTS))


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="the system has no file without end")
def test_a_file_without_end_is_refused():
    assert "a file that is larger" in str(refused(read, "/dev/zero"))


def test_the_message_names_file_key_finding_and_what_is_allowed(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(FILE.read_text("utf-8").replace('thickness = "= t"', "thickness = -0.002", 1), "utf-8")
    words = "beams.beam1.thickness: found -0.002; allowed: a number greater than 0"
    assert str(refused(read, path)) == f"{path}: {words}"
    path.write_text("")
    required = {"name", "materials", "beams", "bodies", "stages", "probes"}
    assert {mistake.key for mistake in refused(read, path).mistakes} == required


def test_the_hinge_reads_as_it_is_written():
    scene = read(FILE)
    assert scene.file == str(FILE)
    assert scene.beams["beam1"].curve.center == pytest.approx((0.026, 0.02625), rel=1e-15)
    assert scene.beams["beam2"].thickness == 0.002
    assert scene.body_of("D") == "BD"
    assert scene.stages[0].stations[-1] == 0.67
    assert scene.probes[0].name == "B.displacement"
    assert scene.contacts["contact"].paper.related["beam1"].x == pytest.approx((0.01975, 0.03225), rel=1e-15)
    with pytest.raises(KeyError):
        scene.body_of("nowhere")


def test_a_scene_is_frozen_all_the_way_down():
    scene = read(FILE)
    with pytest.raises(ValidationError):
        scene.beams["beam1"].thickness = 1.0
    with pytest.raises(TypeError):
        scene.beams["third"] = scene.beams["beam1"]
    with pytest.raises(TypeError):
        scene.bodies["BD"].points["B"] = (0.0, 0.0)
    with pytest.raises(TypeError):
        scene.stages[0].stations[0] = 1.0
    assert hash(scene) == hash(read(FILE))


WRITTEN = [
    (LINKAGE, lambda scene: scene.pins["at_A"].points, ("A", "A1")),
    (CIRCULAR, lambda scene: scene.contacts["touch"].center, (0.0, -R)),
    (CIRCULAR, lambda scene: (scene.contacts["touch"].beams, scene.contacts["touch"].radius), (("beam",), R)),
    (edited(("contacts/touch/thick", REMOVED), base=CIRCULAR), lambda scene: scene.contacts["touch"].thick, True),
    (BOWED, lambda scene: scene.beams["lower"].curve.coefficients, tuple(PARABOLA["coefficients"])),
    (BOWED, lambda scene: scene.beams["lower"].curve.end, (0.05 + A / 2 * TIP**2, TIP)),
    (THROUGH_POINTS, lambda scene: scene.beams["lower"].curve.points, tuple(map(tuple, POINTS))),
    (SLIDING, lambda scene: [body.motion for body in scene.bodies.values()], ["fixed", "slides"]),
    (DRIVEN, lambda scene: type(scene.stepped(scene.stages[0])), DisplacementDrive),
    (edited(("drives/d", TURN), base=DRIVEN), lambda scene: scene.stepped(scene.stages[0]).kind, "rotation"),
    (
        LOADED,
        lambda scene: scene.loads["F"],
        BeamForce(kind="beam_force", beam="lower", at=0.3, direction=(0.0, -2.0)),
    ),
    (
        edited(("loads/q/along", [0, 0.25]), base=LOADED),
        lambda scene: scene.loads["q"],
        DistributedLoad(kind="distributed", beam="upper", direction=(0.0, -1.0), along=(0.0, 0.25)),
    ),
    (LOADED, lambda scene: scene.loads["q"].along, (0.0, 1.0)),
    # a claim without a station is about every station
    (edited(("claims/0/station", REMOVED)), lambda scene: [claim.station for claim in scene.claims], [None, 0.67]),
]


@pytest.mark.parametrize(("data", "part", "expected"), WRITTEN)
def test_a_record_reads_as_it_is_written(data, part, expected):
    assert part(scene_from(data)) == expected


def test_a_stage_has_so_many_stations_at_most_and_none_of_them_twice():
    data = edited(
        ("claims", []), ("stages/0/shown", []), ("stages/0/stations", [0.00067 * k for k in range(1, 10_002)])
    )
    assert len(scene_from(data).stages[0].stations) == 10_001
    more = ("stages/0/stations/10001", 0.37)
    assert "at most 10001 items" in mistakes(more, base=data)["stages[0].stations"]
    again = ("stages/0/stations", [0.3, 0.1, 0.2, 0.1 * (1.0 + 3e-10), 0.3 * (1.0 + 3e-9)])
    found = mistakes(again, base=data)
    assert list(found) == ["stages[0].stations[3]"]
    assert found["stages[0].stations[3]"].startswith("0.1 again")


def test_of_very_many_mistakes_the_first_are_told():
    probes = [{"of": f"nobody{k}", "quantity": "displacement"} for k in range(5000)]
    error = refused(scene_from, edited(("probes", probes)))
    assert len(error.mistakes) == MOST + 1
    assert "more mistakes" in str(error)


FOUND = sorted((Path(__file__).parent / "found").glob("*.toml"))


@pytest.mark.parametrize("file", [pytest.param(file, id=file.stem) for file in FOUND])
def test_what_a_fuzzer_has_found_is_a_question_or_a_wrong_one(file):
    with suppress(SceneError):
        assert isinstance(read_question(file), Scene | OffsetQuestion)


def through_a_table(path, text, *edits):
    """Points of a cantilever through the points of a table."""
    path.write_bytes(text)
    base = cantilever({"kind": "spline", "points": path.name}, (0.0, 0.0), (0.1, 0.0))
    return scene_from(edited(*edits, base=base), file=str(path.parent / "scene.toml")).beams["lower"].curve.points


PLACES = ((0.0, 0.0), (0.03, 0.008), (0.07, 0.004), (0.1, 0.0))


MILLIMETRES = [("units", {"length": "mm"}), ("bodies/block/points/Q", [100, 0]), ("beams/lower/thickness", 2)]
TABLES = [
    (b"x [mm], y [mm]\n0,0\n30,8\n70,4\n100,0\n", []),
    (b"# measured\r\ns;y (m);x (cm)\r\n1;0;0\r\n1;0.008;3\r\n\r\n1;0.004;7\r\n1;0;10", []),
    (b'\xef\xbb\xbf"x/mm"\t"Y in mm"\n0\t0\n30\t8\n70\t4\n1e2\t0', []),
    (b"y,x\n0,0\n.008,.03\n.004,.07\n0,.1", []),
    # a column without a unit has the unit of the scene
    (b"x,y [cm]\n0,0\n30,.8\n70,.4\n100,0\n", [*MILLIMETRES, ("beams/lower/width", 10)]),
]


@pytest.mark.parametrize(("text", "edits"), TABLES)
def test_points_of_a_table_have_the_units_of_the_header(tmp_path, text, edits):
    assert through_a_table(tmp_path / "p.csv", text, *edits) == PLACES


WRONG_TABLES = [
    (b"0,0\n1,1\n2,0\n", "'0,0' in p.csv, row 1; allowed: a header with the columns x and y"),
    (b"x [ft],y\n0,0\n", "'x [ft],y' in p.csv, row 1"),
    (b"", "'' in p.csv, row 1"),
    (b"x,y\n0,0\n\n1,a\n", "'a' in p.csv, row 4, column y; allowed: a finite number with a decimal point"),
    (b"x;y\n0;0\n1,5;2\n", "'1,5' in p.csv, row 3, column x"),
    (b"x,y\n0,0\n1\n", "'' in p.csv, row 3, column y"),
    (b"x,y\n0,nan\n", "'nan' in p.csv, row 2, column y"),
    (b"x,y\n0,0\n1,1e400\n", "'1e400' in p.csv, row 3, column y"),
    (b"x,y\n0,0\n1,1\n", "at least 3 items"),
    (b"\xff\xfe", "p.csv', bytes that are no UTF-8 text (at byte 0); allowed: a table of points"),
    (b"x,y\n" + b"0,0\n" * 300_000, "p.csv', a file that is larger; allowed: a table of points in UTF-8"),
]


def test_a_wrong_table_is_named_with_row_and_column(tmp_path):
    for text, words in WRONG_TABLES:
        error = refused(through_a_table, tmp_path / "p.csv", text)
        assert [mistake.key for mistake in error.mistakes] == ["beams.lower.curve.points"]
        assert words in str(error)
    missing = refused(through_a_table, tmp_path / "p.csv", b"", ("beams/lower/curve/points", "q.csv"))
    assert "q.csv', a file that cannot be read (No such file or directory)" in str(missing)


def test_free_ends_and_fixed_bodies_have_points():
    by_hand, probe = two_lines(0.01), ("probes/1", {"of": "T", "quantity": "displacement"})
    by_hand["bodies"]["T-body"] = {"motion": "free", "points": {"T": [0.1, 0.01]}}
    by_hand["beams"]["upper"]["end"] = {"joint": "weld", "point": "T"}
    named = edited(("beams/upper/end/point", "T"), probe, base=two_lines(0.01))
    assert scene_from(named) == scene_from(edited(probe, base=by_hand))
    edge = {"kind": "beam-circle", "beam": "lower", "body": "wall", "center": [0.05, -0.02], "radius": 0.01}
    data = edited(("bodies/wall", {"motion": "fixed"}), ("contacts/edge", edge), base=two_lines(0.01))
    assert scene_from(data).bodies["wall"].points == {"wall-point": (0.05, -0.02)}
    assert scene_from(edited(("contacts", {}), base=data)).bodies["wall"].points == {"wall-point": (0.0, 0.0)}


BESIDE = edited(("contacts", {}), base=two_lines(0.0018))
CROSSED = edited(("contacts", {}), base=two_lines(0.0, second=((0.0, -0.01), (0.1, 0.01))))
NOTES = [
    # reference: M L/(E I) of the hinge is 4.3 with its 2.3 GPa and 0.67 N m, a million times as much with 2.1 kPa
    (edited(("materials/abs/youngs_modulus", 2.1e3)), "loads.M: M L/(E I) is ", "Is a stress in MPa written as Pa?"),
    (edited(("materials/abs/youngs_modulus", 2.1)), "loads.M: M L/(E I) is ", "Is a stress in GPa written as Pa?"),
    (
        edited(("stages/0/stations", [670000.0]), ("claims", []), ("stages/0/shown", [])),
        "loads.M: M L/(E I) is ",
        "Is a force in uN written as N?",
    ),
    (BESIDE, "beams.upper: overlaps the beam 'lower' at the start by 0.0002 m: without a contact", "needs no note."),
    (CROSSED, "beams.upper: crosses the beam 'lower' at the start, at (0.05, ", "a pair in may_cross needs no note."),
]


@pytest.mark.parametrize(("data", "begin", "end"), NOTES)
def test_an_implausible_scene_has_a_note(data, begin, end):
    (note,) = notes(scene_from(data))
    assert note.startswith(begin)
    assert note.endswith(end)


@pytest.mark.parametrize(("modulus", "written"), [(2.3e15, "2.3e+15"), (2.3e3, "2.3e+03")])
def test_an_implausible_modulus_has_a_note_where_no_load_has(modulus, written):
    """The number of the hinge in gigapascals written as megapascals, and a soft beam under a faint moment."""
    stages = ("stages/0/stations", [1e-6 * modulus / 2.3e9]), ("claims", []), ("stages/0/shown", [])
    (note,) = notes(scene_from(edited(("materials/abs/youngs_modulus", modulus), *stages)))
    assert note.startswith(f"materials.abs: youngs_modulus is {written} Pa, implausible below 1e+06 and above 1.5e+12")
    assert note.endswith("Is the number in Pa, the file's unit of stress?")


def test_a_plausible_scene_has_no_note():
    allowed = {"may_cross": [["lower", "upper"]]}
    apart = (edited(("contacts", {}), base=two_lines(gap)) for gap in (0.01, 0.0019999))
    for data in (HINGE, CROSSED | allowed, BESIDE | allowed, *apart):
        assert not list(notes(scene_from(data)))


def units(annotation):
    """Units of an annotation's numbers, None for numbers without a unit."""
    if annotation is float:
        return {None}
    if get_origin(annotation) is Annotated:
        inner, *metadata = get_args(annotation)
        stated = {each for each in metadata if isinstance(each, Measured)}
        return stated or units(inner)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return set()
    return set().union(*(units(each) for each in get_args(annotation)))


def records():
    return [each for each in vars(statement).values() if isinstance(each, type) and issubclass(each, Record)]


def test_every_number_of_a_record_states_a_unit():
    hints = {record: get_type_hints(record, include_extras=True) for record in records()}
    assert len(hints) > 40
    bare = {r for r in hints for name in r.model_fields if None in units(hints[r][name])}
    # the file states a parameter's own unit
    assert bare == {statement.Parameter, statement.Tolerance}


DATA = {
    "name": "measured",
    "units": {"length": "mm", "force": "kN", "angle": "deg", "stress": "GPa"},
    "theory": "bending",
    "materials": {"steel": {"youngs_modulus": 207.3, "poisson_ratio": 0.29}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"A": [9.7, -2.9], "P": [0.0, 0.0], "Q": [0.0, 31.7]}},
        "tip": {"motion": "free", "points": {"T": [110.4, -2.9]}},
        "knee": {"motion": "slides", "along": [0.0, 1.0], "points": {"K": [1.46509, 20.9]}},
        "crank": {"motion": "turns", "about": "C", "points": {"C": [-71.3, 0.0], "D": [-71.3, 20.9]}},
    },
    "beams": {
        "straight": {
            "curve": {"kind": "line", "start": [9.7, -2.9], "end": [110.4, -2.9]},
            "thickness": {"at": [0.0, 0.43, 1.0], "values": [1.1, 1.3, 0.9]},
            "width": 9.7,
            "material": "steel",
            "start": {"joint": "weld", "point": "A"},
            "end": {"joint": "weld", "point": "T"},
        },
        "curved": {
            "curve": {"kind": "polynomial", "axis": "y", "coefficients": [0.0, 0.3, -0.011], "range": [0.0, 20.9]},
            "thickness": 0.7,
            "width": 9.7,
            "material": "steel",
            "start": {"joint": "pin", "point": "P"},
            "end": {"joint": "weld", "point": "K"},
        },
    },
    "loads": {
        "M": {"kind": "moment", "body": "tip"},
        "F": {"kind": "force", "point": "T", "direction": [0.3, -0.7]},
        "q": {"kind": "distributed", "beam": "straight", "direction": [0.0, -1.0]},
    },
    "drives": {
        "turn": {"kind": "rotation", "body": "crank"},
        "push": {"kind": "displacement", "point": "T", "direction": [1.0, 0.0]},
    },
    "stops": {"stop": {"beam": "curved", "end": "start", "towards": "Q", "least": -107.0, "most": 61.0}},
    "contacts": {
        "wall": {
            "kind": "beam-function",
            "beam": "straight",
            "body": "ground",
            "axis": "x",
            "coefficients": [-20.3, 0.07, 0.0009, 0.000003],
            "range": [11.0, 83.0],
            "side": "above",
        },
        "ball": {
            "kind": "beam-circle", "beam": "straight", "body": "ground", "center": [61.0, 17.0], "radius": 7.3
        },
    },
    "stages": [
        {"name": "one", "steps": "M", "stations": [0.0013, 0.0029], "shown": [0.0013]},
        {"name": "two", "steps": "turn", "stations": [11.0, 37.0], "critical_limit": 0.3},
        {"name": "three", "steps": "q", "stations": [0.0007]},
    ],
    "probes": [
        {"of": "T", "quantity": "displacement"},
        {"of": "tip", "quantity": "rotation"},
        {"of": "scene", "quantity": "potential_energy"},
        {"of": "wall", "quantity": "closing_load"},
        {"of": "wall", "quantity": "force"},
        {"of": "straight", "quantity": "bending_stress"},
    ],
    "claims": [
        {"probe": "tip.rotation", "stage": "two", "station": 37.0, "value": 41.0, "bound": 0.03},
        {"probe": "scene.potential_energy", "value": 0.0017, "bound": 0.03},
        {"probe": "wall.force", "stage": "one", "station": 0.0029, "value": 0.031, "bound": 0.03},
        {"probe": "wall.closing_load", "stage": "three", "value": 0.0005, "bound": 0.03},
    ],
}  # fmt: skip


def test_a_scene_in_millimetres_kilonewtons_degrees_and_gigapascals_is_read_in_si():
    scene = scene_from({**DATA, "drives": {"turn": DATA["drives"]["turn"]}})
    degree = math.pi / 180.0
    assert scene.units == Units()
    assert scene.materials["steel"].youngs_modulus == 207.3e9
    assert scene.materials["steel"].poisson_ratio == 0.29
    assert scene.bodies["ground"].points["A"] == (0.0097, -0.0029)
    beam = scene.beams["straight"]
    assert (beam.thickness.at, beam.thickness.values) == ((0.0, 0.43, 1.0), (0.0011, 0.0013, 0.0009))
    assert (beam.width, beam.curve.end) == (0.0097, (0.1104, -0.0029))
    # x = f(y): 0.3 y − 0.011 y² in mm is 0.3 y − 11 y² in m
    assert scene.beams["curved"].curve.coefficients == pytest.approx((0.0, 0.3, -11.0), rel=1e-15)
    assert scene.beams["curved"].curve.range == (0.0, 0.0209)
    assert scene.contacts["wall"].coefficients == pytest.approx((-0.0203, 0.07, 0.9, 3.0), rel=1e-15)
    assert (scene.contacts["ball"].center, scene.contacts["ball"].radius) == ((0.061, 0.017), 0.0073)
    assert scene.stops["stop"].least == pytest.approx(-107.0 * degree, rel=1e-15)
    assert scene.loads["F"].direction == (0.3, -0.7)
    one, two, three = scene.stages
    # kN·mm are N·m, and kN/mm a million N/m
    assert (one.stations, one.shown) == ((0.0013, 0.0029), (0.0013,))
    assert two.stations == pytest.approx((11.0 * degree, 37.0 * degree), rel=1e-15)
    assert two.critical_limit == pytest.approx(0.3 * degree, rel=1e-15)
    assert three.stations == pytest.approx((700.0,), rel=1e-15)
    rotation, energy, force, closing = scene.claims
    assert (rotation.station, rotation.value) == pytest.approx((37.0 * degree, 41.0 * degree), rel=1e-15)
    assert (energy.station, energy.value) == (None, 0.0017)
    assert (force.station, force.value) == (0.0029, 31.0)
    assert closing.value == pytest.approx(500.0, rel=1e-15)
    assert all(claim.bound == 0.03 for claim in scene.claims)


def test_a_psi_is_a_pound_on_a_square_inch():
    sizes = {name: float(SIZES[name]) for name in ("in", "lbf", "psi")}
    assert sizes == {"in": 0.0254, "lbf": 4.4482216152605, "psi": pytest.approx(6894.757293168, rel=1e-13)}  # NIST
    data = edited(("units", {"force": "lbf", "stress": "psi"}), base=two_lines(0.01))
    name = next(iter(data["materials"]))
    data["materials"][name]["youngs_modulus"] = "= 330000*p"
    data["parameters"] = {"p": {"value": 1.0, "unit": "lbf/in^2"}}
    assert scene_from(data).materials[name].youngs_modulus == pytest.approx(330e3 * sizes["psi"], rel=1e-13)


def test_a_scene_that_states_si_is_the_scene():
    units = {"length": "m", "force": "N", "angle": "rad", "stress": "Pa"}
    for data in map(cases.data, cases.scenes()):
        assert scene_from({**data, "units": units}) == scene_from(data)


def test_the_data_of_a_file_in_other_units_are_those_of_the_scene(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(toml_of({**DATA, "drives": {"turn": DATA["drives"]["turn"]}}), encoding="utf-8")
    assert scene_from(cases.data(str(path)), file=str(path)) == cases.opened(str(path))


def test_a_mistake_is_told_in_other_units_too():
    claims = [{"probe": "T.displacement", "station": 0.0013, "bound": 0.03}]
    words = "claims[0].station: found a number in the unit of several stages"
    assert words in str(refused(scene_from, {**DATA, "claims": claims}))
    stages = [{"name": "one", "steps": "nothing", "stations": [1.0]}]
    assert "stages[0].steps: found 'nothing'" in str(refused(scene_from, {**DATA, "stages": stages, "claims": []}))


VALUES = [
    ("= t", 0.002),
    ("= 2*half", 0.002),
    ("=0.001 + half", 0.002),
    ("= 50e-4*sqrt(0.16) - t/2 + half", 0.002),
    ("= 2*t*sin(slope)", 0.002),
    ("= t*tan(slope)*sqrt(3)", 0.002),
    ("= hypot(0.6*t, 0.8*t)", 0.002),
    ("= min(t, L, 1)", 0.002),
    ("= abs(max(-t, -L))", 0.002),
    ("= t**2/L*50", 0.002),
    ("= sqrt(t*L/50)", 0.002),
    ("= k*0.004", 0.002),
    ("= t*pi/3.141592653589793", 0.002),
    ("= L*atan2(t, L)", 0.1 * math.atan2(0.002, 0.1)),
    ("= 1000*sqrt(M/(E*L*k))", 1000.0 * math.sqrt(0.04 / (200e9 * 0.1 * 0.5))),
]


def test_an_expression_has_the_value_of_its_arithmetic():
    for expression, thickness in VALUES:
        assert scene_from(edited(("beams/lower/thickness", expression), base=PARAMETRIC)).beams[
            "lower"
        ].thickness == pytest.approx(thickness, rel=1e-14)


def test_words_of_python_are_names_and_units_like_others():
    """``in`` is the inch, and a parameter may be called lambda."""
    parameters = {"lambda": {"value": 0.04, "unit": "in"}, "is": {"value": "= 2*lambda"}}
    data = edited(("parameters", parameters), ("beams/lower/thickness", "= is - lambda"), base=PARAMETRIC)
    assert scene_from(data).beams["lower"].thickness == pytest.approx(0.04 * 0.0254, rel=1e-14)
    halved = scene_from(data, parameters={"lambda": "0.02in"})
    assert halved.beams["lower"].thickness == pytest.approx(0.02 * 0.0254, rel=1e-14)


def test_literals_have_the_unit_of_the_key():
    """The same two cantilevers in millimetres, degrees and kilonewtons: 50 is 50 mm, sin takes degrees."""
    data = edited(("beams/lower/thickness", "= 4*sin(30) + k*0"), base=PARAMETRIC)
    data["units"] = {"length": "mm", "angle": "deg"}
    for beam in data["beams"].values():
        beam["width"] = "= 5*t"
    data["beams"]["upper"] |= {"curve": {"kind": "line", "start": [0, 20], "end": [100, 20]}, "thickness": "= t"}
    data["bodies"]["ground"]["points"]["P"] = [0, "= 10*t"]
    data["bodies"]["block"]["points"]["Q"] = ["= L", 0]
    data["beams"]["lower"]["curve"] |= {"start": ["= L - 100", 0.0], "end": ["= 50 + 25*t", "= 0*t"]}
    lower = scene_from(data).beams["lower"]
    assert (lower.thickness, lower.width) == (pytest.approx(0.002, rel=1e-15), pytest.approx(0.01, rel=1e-15))
    assert lower.curve.end == (pytest.approx(0.1, rel=1e-15), 0.0)


@pytest.mark.parametrize(
    ("setting", "thickness"), [("1.9mm", 0.0019), (" 1900 um ", 0.0019), ("1.9", 0.0019), (0.0019, 0.0019)]
)
def test_a_setting_replaces_a_value(setting, thickness):
    scene = scene_from(edited(("beams/lower/thickness", "= 2*half"), base=PARAMETRIC), parameters={"t": setting})
    assert scene.beams["lower"].thickness == pytest.approx(thickness, rel=1e-15)
    assert scene.parameters["t"].value == pytest.approx(thickness, rel=1e-15)


WRONG_SETTINGS = [
    ({"x": 1.0}, "parameters.x: found 'x', which names no parameter"),
    ({"t": "3mm"}, "parameters.t.value: found 3 mm; allowed: a number from 1.6 to 2.4 mm"),
    ({"t": "2deg"}, "parameters.t: found '2deg'; allowed: a finite number, as 1.9mm"),
    ({"t": "thin"}, "parameters.t: found 'thin'; allowed: a finite number, as 1.9mm"),
    ({"t": math.nan}, "parameters.t: found nan; allowed: a finite number"),
    ({"t": "1e400mm"}, "parameters.t: found '1e400mm'; allowed: a finite number"),
    ({"half": "1mm"}, "an expression alone; an expression takes no other value"),
]


def test_a_wrong_setting_is_refused():
    for settings, words in WRONG_SETTINGS:
        assert words in str(refused(scene_from, PARAMETRIC, parameters=settings))
    words = "names no parameter; allowed: the name of a parameter: there is none"
    assert words in str(refused(scene_from, two_lines(0.01), parameters={"t": 1.0}))


def test_a_scene_with_other_parameters_is_checked_like_a_file():
    scene = read(FILE)
    thin = scene.with_parameters(t=1.9e-3)
    assert thin.beams["beam1"].thickness == 0.0019
    assert thin.beams["beam1"].curve.center[1] == pytest.approx(0.025 + (0.0019 + 0.0005) / 2, rel=1e-15)
    assert pickle.loads(pickle.dumps(thin)).with_parameters(t=2e-3).beams == scene.beams
    with pytest.raises(SceneError, match=r"parameters\.t\.value"):
        scene.with_parameters(t=3e-3)
    with pytest.raises(SceneError, match="overlap at the start"):
        scene.with_parameters(gap=-1e-3)
    with pytest.raises(ValueError, match="without parameters"):
        scene_from(two_lines(0.01)).with_parameters(t=1e-3)
    with pytest.raises(ValueError, match="altered after reading"):
        scene.model_copy(update={"claims": ()}).with_parameters(t=1e-3)


@pytest.mark.parametrize("name", ["hinge", "gripper", "prestressed"])
def test_every_parameter_of_a_built_in_case_may_change_by_two_percent(name):
    scene = cases.opened(name)
    for parameter, record in scene.parameters.items():
        for factor in (0.98, 1.02):
            changed = scene.with_parameters(**{parameter: factor * record.value})
            assert changed.parameters[parameter].value == factor * record.value


TODAY = {
    "hinge": lambda scene: (scene.place_of("D"), (0.051, -0.02625)),
    "gripper": lambda scene: (
        (*scene.place_of("A"), *scene.place_of("O"), scene.contacts["circle"].radius),
        (0.08560254037844386, 0.05173205080756888, -0.001, 0.0017320508075688774, 0.019),
    ),
    "prestressed": lambda scene: (
        (*scene.place_of("O1"), *scene.beams["beam2"].curve.end),
        (-0.0005, 0.0, 0.0005, 0.06),
    ),
}
"""Numbers of the cases before parameters, at commit cffdfe7."""


@pytest.mark.parametrize("name", TODAY)
def test_the_built_in_cases_keep_their_numbers(name):
    ours, before = TODAY[name](cases.opened(name))
    assert ours == pytest.approx(before, rel=1e-15)
    opened = cases.opened(name, {"t": "1.05mm" if name == "prestressed" else "2.1mm"})
    assert opened.beams["beam1"].thickness == pytest.approx(1.05 * cases.opened(name).beams["beam1"].thickness)


WAYS = {
    "item": lambda it: it.__setitem__("a", 5),
    "delete": lambda it: it.__delitem__("a"),
    "update": lambda it: it.update(b=5),
    "in place": lambda it: it.__ior__({"b": 5}),
    "setdefault": lambda it: it.setdefault("b", 5),
    "pop": lambda it: it.pop("a"),
    "popitem": lambda it: it.popitem(),
    "clear": lambda it: it.clear(),
}


def test_no_method_changes_a_frozendict():
    one = frozendict({"a": 3})
    for change in WAYS.values():
        with pytest.raises(TypeError, match="stays as it is"):
            change(one)
    assert one == {"a": 3}
    # methods of a ``dict`` beyond a mapping for reading only
    changing = set(dir(dict)) - set(dir(MappingProxyType)) - {"__getattribute__", "fromkeys"}
    assert not {name for name in changing if getattr(frozendict, name) is getattr(dict, name)}


def test_order_has_no_part_in_hash_and_equality():
    one, other = frozendict({"a": 3, "b": 7}), frozendict({"b": 7, "a": 3})
    assert one == other
    assert {one: "found"}[other] == "found"
    assert hash(one) != hash(frozendict({"a": 3, "b": 8}))


def test_a_value_without_a_hash_has_none():
    with pytest.raises(TypeError, match="unhashable"):
        hash(frozendict({"a": [3]}))


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))], ids=["copy", "deepcopy", "pickle"]
)
def test_another_of_it_is_of_its_kind(again):
    one = frozendict({"a": frozendict({"b": (1, 2)})})
    other = again(one)
    assert other == one
    assert type(other) is frozendict
    assert type(other["a"]) is frozendict
    assert hash(other) == hash(one)
