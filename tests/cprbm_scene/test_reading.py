"""Files: good ones are read into frozen records, unreadable ones are refused in a sentence."""

import pytest
from pydantic import ValidationError

from cprbm_scene import SceneError, read, scene_from
from tests.cprbm_scene.conftest import HINGE
from tests.cprbm_scene.editing import REMOVED, edited, mistakes


def _refusal(path):
    with pytest.raises(SceneError) as caught:
        read(path)
    (mistake,) = caught.value.mistakes
    assert mistake.file == str(path)
    return mistake.found


def test_the_hinge_reads_as_it_is_written():
    scene = read(HINGE)
    assert scene.file == str(HINGE)
    assert scene.beams["beam1"].curve.center == pytest.approx((0.026, 0.02625), rel=1e-15)
    assert scene.beams["beam2"].thickness == 0.002
    assert scene.body_of("D") == "BD"
    assert scene.stages[0].stations[-1] == 0.67
    assert scene.probes[0].name == "B.displacement"
    assert scene.contacts["contact"].paper.related["beam1"].x == (0.01975, 0.03225)
    with pytest.raises(KeyError):
        scene.body_of("nowhere")


def test_a_scene_is_frozen_all_the_way_down():
    scene = read(HINGE)
    with pytest.raises(ValidationError):
        scene.beams["beam1"].thickness = 1.0
    with pytest.raises(TypeError):
        scene.beams["third"] = scene.beams["beam1"]
    with pytest.raises(TypeError):
        scene.bodies["BD"].points["B"] = (0.0, 0.0)
    with pytest.raises(TypeError):
        scene.stages[0].stations[0] = 1.0
    assert hash(scene) == hash(read(HINGE))


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
