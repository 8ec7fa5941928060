"""What the ten-minute guide has its readers write is a scene, and it gives what the guide says."""

import math
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
    """The guide's table at 15 mm; it shows five digits, of both solvers in shear, the default theory."""
    table = re.search(r"^    probe .*?\n    next", GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[0]
    chain = cprbm.answer(latch, cprbm.Settings(links=40)).stations[-1].values
    settings = fea_reference.Settings(elements=80, kinematics="shear")
    elements = fea_reference.answer(latch, settings).stations[-1].values
    shown = {}
    for line in table.splitlines():
        if found := re.match(r"    (\w+\.\w+)( [xy])? +\S+ +(-?[\d.]+) +(-?[\d.]+)", line):
            shown[found[1], (found[2] or "").strip()] = float(found[3]), float(found[4])
    for probe, component, place, factor in (
        ("tip.displacement", "x", 0, 1e3),
        ("tip.displacement", "y", 1, 1e3),
        ("tip.reaction", "y", 1, 1.0),
        ("hook.rotation", "", 0, math.degrees(1.0)),
        ("pin.force", "", 0, 1.0),
    ):
        answers = [factor * answer[probe][place] for answer in (chain, elements)]
        assert shown[probe, component] == pytest.approx(answers, rel=1e-4)
