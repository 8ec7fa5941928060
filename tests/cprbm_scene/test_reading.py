"""Files: what can be read, tables of points, units, and the immutable scene."""

import copy
import math
import pickle
from contextlib import suppress
from pathlib import Path
from typing import Annotated, get_args, get_origin, get_type_hints

import pytest
from pydantic import BaseModel, ValidationError

from comparisons import cases
from cprbm_scene import OffsetQuestion, Scene, SceneError, read, read_question, scene_from, statement
from cprbm_scene.fields import Measured
from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import MOST
from cprbm_scene.reading import DEEPEST
from cprbm_scene.solving import notes
from cprbm_scene.statement import Record, Units
from cprbm_scene.units import LONGEST
from tests.cprbm_scene.conftest import HINGE as FILE
from tests.cprbm_scene.editing import HINGE, REMOVED, edited, mistakes, two_lines
from tests.robustness.toml import toml_of


def _refusal(path):
    with pytest.raises(SceneError) as caught:
        read(path)
    (mistake,) = caught.value.mistakes
    assert mistake.file == str(path)
    return mistake.found


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


def test_a_missing_file(tmp_path):
    assert "No such file" in _refusal(tmp_path / "none.toml")


def test_a_folder(tmp_path):
    assert "directory" in _refusal(tmp_path)


def test_a_name_that_is_no_path():
    assert "cannot be read" in _refusal("a\0b.toml")


def test_a_binary_file(tmp_path):
    path = tmp_path / "binary.toml"
    path.write_bytes(b"\x7fELF\x80\xff\xfe")
    assert "no UTF-8 text (at byte 4)" in _refusal(path)


@pytest.mark.parametrize("text", ["name = ", "[beams", "a = 1\na = 2", "\0", "x = " + "[" * 5000])
def test_broken_toml(tmp_path, text):
    path = tmp_path / "broken.toml"
    path.write_text(text)
    assert "no TOML" in _refusal(path)


def test_an_empty_file_names_every_required_key(tmp_path):
    path = tmp_path / "empty.toml"
    path.write_text("")
    with pytest.raises(SceneError) as caught:
        read(path)
    required = {"name", "materials", "beams", "bodies", "stages", "probes"}
    assert {mistake.key for mistake in caught.value.mistakes} == required


def test_the_message_names_file_key_finding_and_what_is_allowed(tmp_path, hinge_text):
    path = tmp_path / "case.toml"
    path.write_text(hinge_text.replace('thickness = "= t"', "thickness = -0.002", 1))
    with pytest.raises(SceneError) as caught:
        read(path)
    assert str(caught.value) == (f"{path}: beams.beam1.thickness: found -0.002; allowed: a number greater than 0")


def test_a_claim_without_a_station_is_about_every_station():
    scene = scene_from(edited(("claims/0/station", REMOVED)))
    assert [claim.station for claim in scene.claims] == [None, 0.67]
    assert set(mistakes(("claims/0/station", REMOVED), ("claims/0/probe", "B.rotation"))) == {"claims[0].probe"}


FOUND = sorted((Path(__file__).parent / "found").glob("*.toml"))


def refused(tmp_path, text):
    path = tmp_path / "large.toml"
    path.write_bytes(text)
    with pytest.raises(SceneError) as caught:
        read(path)
    return str(caught.value)


def test_a_file_is_read_no_further_than_it_may_be_long(tmp_path):
    assert "a file that is larger; allowed: at most 1 MB" in refused(tmp_path, b"#" * (LONGEST + 1))
    assert "larger" not in refused(tmp_path, b"#" * LONGEST)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="the system has no file without end")
def test_a_file_without_end_is_refused():
    with pytest.raises(SceneError, match="a file that is larger"):
        read("/dev/zero")


@pytest.mark.parametrize("part", [b"a", b'"a b"', b"'c'", b"a "])
def test_a_key_of_many_parts_is_refused_before_it_is_parsed(tmp_path, part):
    """The parser would take the square of their number; it reads what has just as many as are allowed."""
    many = b".".join([part] * 100_000)
    for text in (many + b" = 1", b"[" + many + b"]", b"x = {" + many + b" = 1}"):
        assert f"a key of more than {DEEPEST} parts" in refused(tmp_path, text)
    assert "a key of more" not in refused(tmp_path, b".".join([part] * DEEPEST) + b" = 1")


@pytest.mark.parametrize("text", [b"a = " + b"[" * 99_999, b"a = " + b"{a=" * 99_999, b"a = " + b"9" * 99_999])
def test_what_the_parser_gives_up_is_no_toml(tmp_path, text):
    assert "text that is no TOML" in refused(tmp_path, text)


@pytest.mark.parametrize(("table", "most"), [("beams", 256), ("bodies", 256), ("contacts", 1000)])
def test_a_scene_has_so_many_at_most(table, most):
    one = next(iter(HINGE[table].values()))
    found = mistakes((table, {f"n{k}": one for k in range(most + 1)}))
    assert found[table].endswith(f"at most {most} of them")


def test_a_stage_has_so_many_stations_at_most_and_none_of_them_twice():
    data = copy.deepcopy(HINGE)
    data["claims"] = []
    data["stages"][0].pop("shown", None)
    data["stages"][0]["stations"] = [0.00067 * k for k in range(1, 10_002)]
    assert len(scene_from(data).stages[0].stations) == 10_001
    data["stages"][0]["stations"].append(0.37)
    with pytest.raises(SceneError, match="at most 10001 of them"):
        scene_from(data)
    data["stages"][0]["stations"] = [0.3, 0.1, 0.2, 0.1 * (1.0 + 3e-10), 0.3 * (1.0 + 3e-9)]
    with pytest.raises(SceneError, match=r"stages\[0\].stations\[3\]: found 0.1 again") as caught:
        scene_from(data)
    assert len(caught.value.mistakes) == 1


def test_of_very_many_mistakes_the_first_are_told():
    data = copy.deepcopy(HINGE)
    data["probes"] = [{"of": f"nobody{k}", "quantity": "displacement"} for k in range(5000)]
    with pytest.raises(SceneError) as caught:
        scene_from(data)
    assert len(caught.value.mistakes) == MOST + 1
    assert "more mistakes" in str(caught.value)


@pytest.mark.parametrize("file", [pytest.param(file, id=file.stem) for file in FOUND])
def test_what_a_fuzzer_has_found_is_a_question_or_a_wrong_one(file):
    with suppress(SceneError):
        assert isinstance(read_question(file), Scene | OffsetQuestion)


def through_a_table(path, text, *edits):
    """Mistakes of a cantilever through the points of a table, and the points."""
    path.write_bytes(text)
    base = two_lines(0.01)
    del base["beams"]["upper"], base["contacts"], base["bodies"]["ground"]["points"]["P"]
    base["beams"]["lower"]["curve"] = {"kind": "spline", "points": path.name}
    try:
        scene = scene_from(edited(*edits, base=base), file=str(path.parent / "scene.toml"))
    except SceneError as error:
        (mistake,) = error.mistakes
        return mistake
    return scene.beams["lower"].curve.points


PLACES = ((0.0, 0.0), (0.03, 0.008), (0.07, 0.004), (0.1, 0.0))


@pytest.mark.parametrize(
    "text",
    [
        b"x [mm], y [mm]\n0,0\n30,8\n70,4\n100,0\n",
        b"# measured\r\ns;y (m);x (cm)\r\n1;0;0\r\n1;0.008;3\r\n\r\n1;0.004;7\r\n1;0;10",
        b'\xef\xbb\xbf"x/mm"\t"Y in mm"\n0\t0\n30\t8\n70\t4\n1e2\t0',
        b"y,x\n0,0\n.008,.03\n.004,.07\n0,.1",
    ],
)
def test_points_of_a_table_have_the_units_of_the_header(tmp_path, text):
    assert through_a_table(tmp_path / "p.csv", text) == PLACES


def test_a_column_without_a_unit_has_the_unit_of_the_scene(tmp_path):
    edits = [("units", {"length": "mm"}), ("bodies/block/points/Q", [100, 0]), ("beams/lower/thickness", 2)]
    found = through_a_table(tmp_path / "p.csv", b"x,y [cm]\n0,0\n30,.8\n70,.4\n100,0\n", *edits)
    assert found == PLACES


WRONG_TABLES = [
    (b"0,0\n1,1\n2,0\n", "'0,0' in p.csv, row 1; allowed: a header with the columns x and y"),
    (b"x [ft],y\n0,0\n", "'x [ft],y' in p.csv, row 1"),
    (b"", "'' in p.csv, row 1"),
    (b"x,y\n0,0\n\n1,a\n", "'a' in p.csv, row 4, column y; allowed: a finite number with a decimal point"),
    (b"x;y\n0;0\n1,5;2\n", "'1,5' in p.csv, row 3, column x"),
    (b"x,y\n0,0\n1\n", "'' in p.csv, row 3, column y"),
    (b"x,y\n0,nan\n", "'nan' in p.csv, row 2, column y"),
    (b"x,y\n0,0\n1,1e400\n", "'1e400' in p.csv, row 3, column y"),
    (b"x,y\n0,0\n1,1\n", "at least 3 of them"),
    (b"\xff\xfe", "p.csv', bytes that are no UTF-8 text (at byte 0); allowed: a table of points"),
    (b"x,y\n" + b"0,0\n" * 300_000, "p.csv', a file that is larger; allowed: at most 1 MB of points"),
]


def test_a_wrong_table_is_named_with_row_and_column(tmp_path):
    for text, words in WRONG_TABLES:
        mistake = through_a_table(tmp_path / "p.csv", text)
        assert mistake.key == "beams.lower.curve.points"
        assert words in str(mistake)
    missing = through_a_table(tmp_path / "p.csv", b"", ("beams/lower/curve/points", "q.csv"))
    assert "q.csv', a file that cannot be read (No such file or directory)" in missing.found


def test_a_named_free_end_is_a_weld_to_a_body_of_one_point():
    by_hand = two_lines(0.01)
    by_hand["bodies"]["T-body"] = {"motion": "free", "points": {"T": [0.1, 0.01]}}
    by_hand["beams"]["upper"]["end"] = {"joint": "weld", "point": "T"}
    probe = {"of": "T", "quantity": "displacement"}
    named = edited(("beams/upper/end/point", "T"), ("probes/1", probe), base=two_lines(0.01))
    assert scene_from(named) == scene_from(edited(("probes/1", probe), base=by_hand))
    found = mistakes(("bodies/T-body", by_hand["bodies"]["T-body"]), base=named)
    assert "another body with the name 'T-body'" in found["beams.upper.end.point"]
    asked = ("probes/0", {"of": "upper", "quantity": "displacement"})
    assert "end = { joint = 'free', point = 'NAME' }" in mistakes(asked, base=two_lines(0.01))["probes[0]"]


def test_a_fixed_body_without_points_has_a_point_at_its_edge():
    edge = {"kind": "beam-circle", "beam": "lower", "body": "wall", "center": [0.05, -0.02], "radius": 0.01}
    data = edited(("bodies/wall", {"motion": "fixed"}), ("contacts/edge", edge), base=two_lines(0.01))
    assert scene_from(data).bodies["wall"].points == {"wall-point": (0.05, -0.02)}
    assert scene_from(edited(("contacts", {}), base=data)).bodies["wall"].points == {"wall-point": (0.0, 0.0)}


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("loads/M/kind", "gravity", "is 'distributed' meant?"),
        ("gravity", 9.81, "is a load of kind 'distributed' meant?"),
        ("beams/beam1/weight", 1.0, "is a load of kind 'distributed' meant?"),
        ("beams/beam1/friction", 0.3, "friction is not modelled"),
        ("contacts/contact/friction_coefficient", 0.3, "friction_coefficient is not modelled"),
        ("materials/abs/yield_stress", 4e7, "yield_stress is not modelled"),
        ("loads/M/kind", "temperature", "temperature is not modelled"),
    ],
)
def test_a_word_of_another_program_is_answered_by_meaning(path, value, words):
    assert any(words in sentence for sentence in mistakes((path, value)).values())


@pytest.mark.parametrize(("modulus", "written"), [(2.3e15, "2.3e+15"), (2.3e3, "2.3e+03")])
def test_an_implausible_modulus_has_a_note_where_no_load_has(modulus, written):
    """The number of the hinge in gigapascals written as megapascals, and a soft beam under a faint moment."""
    stages = ("stages/0/stations", [1e-6 * modulus / 2.3e9]), ("claims", []), ("stages/0/shown", [])
    (note,) = notes(scene_from(edited(("materials/abs/youngs_modulus", modulus), *stages)))
    assert note.startswith(f"materials.abs: youngs_modulus is {written} Pa, implausible below 1e+06 and above 1.5e+12")
    assert note.endswith("Is the number in Pa, the file's unit of stress?")


@pytest.mark.parametrize(
    ("edits", "words"),
    [
        # reference: M L/(E I) of the hinge is 4.3 with its 2.3 GPa and 0.67 N m, a million times as much with 2.1 kPa
        ([("materials/abs/youngs_modulus", 2.1e3)], "Is a stress in MPa written as Pa?"),
        ([("materials/abs/youngs_modulus", 2.1)], "Is a stress in GPa written as Pa?"),
        ([("stages/0/stations", [670000.0]), ("claims", []), ("stages/0/shown", [])], "Is a force in uN written as N?"),
    ],
)
def test_an_implausible_load_has_a_note_with_the_mix_up_of_units(edits, words):
    (note,) = notes(scene_from(edited(*edits)))
    assert note.startswith("loads.M: M L/(E I) is ")
    assert note.endswith(words)
    assert not list(notes(scene_from(HINGE)))


def test_beams_that_cross_without_a_contact_have_a_note():
    crossed = edited(("contacts", {}), base=two_lines(0.0, second=((0.0, -0.01), (0.1, 0.01))))
    (note,) = notes(scene_from(crossed))
    assert note.startswith("beams.upper: crosses the beam 'lower' at the start, at (0.05, ")
    assert not list(notes(scene_from(crossed | {"may_cross": [["lower", "upper"]]})))
    assert not list(notes(scene_from(edited(("contacts", {}), base=two_lines(0.01)))))


def test_a_thickness_above_the_radius_is_refused_with_its_place():
    bowl = {"kind": "polynomial", "axis": "x", "coefficients": [0.0, -4.0, 40.0], "range": [0.0, 0.1]}
    found = mistakes(
        ("beams/lower/curve", bowl), ("beams/lower/thickness", 0.0126), ("contacts", {}), base=two_lines(1.0)
    )
    assert (
        "half of which is 0.504 of the radius of curvature at 0.5 of the length, near (0.05, -0.1) m"
        in (found["beams.lower.thickness"])
    )
    found = mistakes(("beams/beam1/thickness", 2.0))["beams.beam1.thickness"]
    assert "(in mm in place of m, or in um in place of mm?)" in found


def units(annotation):
    """The units that an annotation states for its numbers, None for numbers without a unit."""
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


def test_a_scene_that_states_si_is_the_scene():
    units = {"length": "m", "force": "N", "angle": "rad", "stress": "Pa"}
    for data in map(cases.data, cases.scenes()):
        assert scene_from({**data, "units": units}) == scene_from(data)


def test_the_data_of_a_file_in_other_units_are_those_of_the_scene(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(toml_of({**DATA, "drives": {"turn": DATA["drives"]["turn"]}}), encoding="utf-8")
    assert scene_from(cases.data(str(path)), file=str(path)) == cases.opened(str(path))


def test_a_unit_that_there_is_not_is_refused():
    with pytest.raises(SceneError, match=r"units\.length: found 'inch' \(is 'in' meant\?\); allowed: .*'mm'.*'in'"):
        scene_from({**DATA, "units": {"length": "inch"}})
    with pytest.raises(SceneError, match=r"units\.mass"):
        scene_from({**DATA, "units": {"mass": "kg"}})


def test_a_claim_that_may_be_of_moments_and_angles_is_to_say_its_stage():
    claims = [{"probe": "T.displacement", "station": 0.0013, "bound": 0.03}]
    with pytest.raises(SceneError, match=r"claims\[0\]\.station: found a number in the unit of several stages"):
        scene_from({**DATA, "claims": claims})


@pytest.mark.parametrize("modulus", [1e300, 1e100, 1e-100])
def test_a_modulus_beyond_all_materials_is_refused_with_the_allowed_range(modulus):
    materials = {"steel": {"youngs_modulus": modulus, "poisson_ratio": 0.29}}
    with pytest.raises(SceneError, match=r"materials\.steel\.youngs_modulus: .*between 1e-50 and 1e\+50 in SI units"):
        scene_from({**DATA, "materials": materials})


def test_what_a_mistake_in_the_scene_is_called_is_told_in_other_units_too():
    data = {**DATA, "stages": [{"name": "one", "steps": "nothing", "stations": [1.0]}]}
    with pytest.raises(SceneError, match=r"stages\[0\]\.steps: found 'nothing'"):
        scene_from({**data, "claims": []})


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


def test_every_method_of_a_dict_that_changes_it_is_among_the_ways():
    """What a ``dict`` has and a mapping that is only read has not."""
    from types import MappingProxyType

    changing = set(dir(dict)) - set(dir(MappingProxyType)) - {"__getattribute__", "fromkeys"}
    changing = {name for name in changing if getattr(frozendict, name) is getattr(dict, name)}
    assert not changing


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
