"""What the ten-minute guide has its readers write is a scene, and it gives what the guide says."""

import re

import pytest

import cprbm
import fea_reference
from cprbm_scene import read
from tests.documentation.pages import DOCS

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


def test_the_numbers_of_the_guide_come_out(latch):
    """The guide's table at 15 mm; it shows five digits."""
    table = re.search(r"^    probe .*?\n\n", GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[0]
    chain = cprbm.answer(latch, cprbm.Settings(links=40)).stations[-1].values
    elements = fea_reference.answer(latch, fea_reference.Settings(elements=80)).stations[-1].values
    told = {line.split()[0]: re.findall(r"-?\d+\.\d+", line) for line in table.splitlines()[1:] if line.strip()}
    assert float(told["tip.displacement"][0]) == pytest.approx(1e3 * chain["tip.displacement"][0], rel=1e-4)
    assert float(told["tip.displacement"][2]) == pytest.approx(1e3 * elements["tip.displacement"][0], rel=1e-4)
    for probe in ("hook.rotation", "pin.force"):
        assert [float(each) for each in told[probe][:2]] == pytest.approx(
            [chain[probe][0], elements[probe][0]], rel=1e-4
        )
    pressed = [float(each) for each in told["tip.reaction"][:2]]
    assert pressed == pytest.approx([chain["tip.reaction"][1], elements["tip.reaction"][1]], rel=1e-4)
