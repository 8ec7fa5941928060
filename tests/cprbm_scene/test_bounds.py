"""Files that would take the reader's time or memory are refused, with a sentence."""

import copy
from contextlib import suppress
from pathlib import Path

import pytest

from cprbm_scene import OffsetQuestion, Scene, SceneError, read, read_question, scene_from
from cprbm_scene.mistakes import MOST
from cprbm_scene.reading import DEEPEST, LARGEST
from tests.cprbm_scene.editing import HINGE, mistakes

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
