"""Commands of the tutorials print the words and the numbers on the pages."""

import re
import shlex
import shutil

import pytest

from comparisons.cli.main import run
from tests.documentation.pages import DOCS, blocks

pytestmark = pytest.mark.usefixtures("unprinted")

FOLDER = DOCS / "tutorials"
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
COMMANDS = [
    (page.stem, *(part.strip() for part in body.removeprefix("$ cprbm ").split("\n", 1)))
    for page in sorted(FOLDER.glob("*.md"))
    for body in blocks(page, "console")
]


@pytest.fixture
def beside_the_scenes(tmp_path, monkeypatch):
    for path in FOLDER.glob("*.toml"):
        shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


def same_text(shown, printed):
    """Whether two outputs have the same words, and numbers within the rounding of five digits."""
    words = [NUMBER.sub("#", "".join(text.split())) for text in (shown, printed)]
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (shown, printed)]
    return words[0] == words[1] and numbers[0] == pytest.approx(numbers[1], rel=2e-2, abs=1e-4)


def test_a_planted_word_and_a_planted_number_are_found():
    assert same_text("force N 11.285 AGREE", "force  N\n11.286 AGREE")
    assert not same_text("force N 11.285 AGREE", "force N 11.285 DIFFER")
    assert not same_text("force N 11.285 AGREE", "force N 11.985 AGREE")


@pytest.mark.parametrize(("page", "command", "shown"), COMMANDS, ids=[f"{each[0]}: {each[1]}" for each in COMMANDS])
def test_a_command_prints_what_its_page_shows(page, command, shown, beside_the_scenes, capsys):
    run(shlex.split(command))
    out, err = capsys.readouterr()
    assert same_text(shown, out + err), out + err


def test_every_tutorial_shows_a_command():
    pages = {path.stem for path in FOLDER.glob("*.md")} - {"index"}
    assert {each[0] for each in COMMANDS} == pages


def test_the_remedy_of_the_parallel_guide_makes_the_case_agree(beside_the_scenes, capsys):
    page = (FOLDER / "parallel-guide.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^ +(verdict_limit = .+)$", page, re.MULTILINE)
    path = beside_the_scenes / "guide.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace('quantity = "rotation"', f'quantity = "rotation"\n{line}'), encoding="utf-8")
    assert run(["compare", "guide.toml"]) == 0
    assert "guide: AGREE" in capsys.readouterr().out
