"""What the ten-minute guide has its readers write is a scene, and it gives what the guide says."""

import re

import pytest

from comparisons.cli.main import run
from cprbm_scene import read
from tests.documentation.pages import DOCS
from tests.documentation.test_tutorials import same_text

GUIDE = DOCS / "guide.md"


@pytest.fixture(scope="module")
def latch(tmp_path_factory):
    parts = re.findall(r"```toml\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL)
    path = tmp_path_factory.mktemp("guide") / "latch.toml"
    path.write_text("\n".join(parts), encoding="utf-8")
    return read(path)


def test_the_parts_of_the_guide_are_the_scene_of_the_gallery(latch):
    theirs = read(DOCS / "gallery" / "latch.toml")
    assert latch.model_dump(exclude={"file"}) == theirs.model_dump(exclude={"file"})


def test_the_guide_shows_what_the_command_prints(latch, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    assert run(["compare", latch.file]) == 0
    shown = re.search(r"^    latch: .*?\n    next[^\n]*", GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[
        0
    ]
    printed = capsys.readouterr().out
    assert same_text(shown, printed.replace(latch.file, "latch.toml")), printed
