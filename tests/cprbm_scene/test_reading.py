"""Files: what can be read, how long, how deep, and how many parts a scene has."""

import copy
from contextlib import suppress
from pathlib import Path

import pytest
from pydantic import ValidationError

from cprbm_scene import OffsetQuestion, Scene, SceneError, read, read_question, scene_from
from cprbm_scene.mistakes import MOST
from cprbm_scene.reading import DEEPEST, LARGEST
from tests.cprbm_scene.conftest import HINGE as FILE
from tests.cprbm_scene.editing import HINGE, REMOVED, edited, mistakes


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
    assert scene.contacts["contact"].paper.related["beam1"].x == (0.01975, 0.03225)
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
    assert "a file that is larger; allowed: at most 1 MB" in refused(tmp_path, b"#" * (LARGEST + 1))
    assert "larger" not in refused(tmp_path, b"#" * LARGEST)


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
