"""The fuzzer of the reader sees what goes wrong, and where a file leads."""

from cprbm_scene import checks
from tests.cprbm_scene.conftest import HINGE
from tests.cprbm_scene.fuzzing import followed


def test_a_planted_fault_is_seen(monkeypatch):
    def faulty(scene):
        raise KeyError("planted")

    assert followed(HINGE)[1] == ""
    monkeypatch.setattr(checks, "_CHECKS", (faulty,))
    assert followed(HINGE)[1] == "KeyError: 'planted'"


def test_a_wrong_file_takes_a_way_of_its_own(tmp_path):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(HINGE.read_text("utf-8").replace('point = "B"', 'point = "D"', 1), "utf-8")
    ways, said = followed(wrong)
    assert said == ""
    assert ways - followed(HINGE)[0]
