"""The page of edges names tests that there are."""

import re
from pathlib import Path

from cprbm_scene import read

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "edges.md"


def test_every_test_that_the_page_names_is_there():
    page = PAGE.read_text(encoding="utf-8")
    known = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    for path in (ROOT / "tests").rglob("test_*.py"):
        known.update(re.findall(r"^def (test_\w+)", path.read_text(encoding="utf-8"), re.MULTILINE))
    named = set(re.findall(r"\btest_\w+", page))
    assert len(named) > 20
    assert named <= known, named - known
    files = re.findall(r"`((?:cprbm|fea_reference|together|scene)/\w+\.py)(?:::(\w+))?`", page)
    for file, test in files:
        path = ROOT / "tests" / file
        assert path.is_file(), file
        assert not test or f"def {test}(" in path.read_text(encoding="utf-8"), f"{file}::{test}"
    rare = set(re.findall(r"`(scenes/rare/[\w-]+\.toml)`", page))
    assert len(rare) > 10
    assert [file for file in sorted(rare) if not (ROOT / "tests" / file).is_file()] == []


def test_scenes_that_are_kept_for_the_pages_are_read():
    kept = sorted((ROOT / "docs" / "scenes").glob("*.toml"))
    assert kept
    assert [read(path).name for path in kept] == [path.stem for path in kept]
