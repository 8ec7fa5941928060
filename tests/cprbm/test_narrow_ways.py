"""Ways that could not be gone: from a place of contact to joints, and along a residual that is round-off."""

from pathlib import Path

import pytest

import cprbm
from cprbm_scene import read

PRESSED_FLAT = """
name = "pressed-flat"
theory = "bending"
[materials.polypropylene]
youngs_modulus = 1370000000.0
poisson_ratio = 0.42
[bodies.wall]
motion = "fixed"
points = { R = [0.0, 0.0] }
[bodies.tip]
motion = "slides"
along = [0.981, 0.1942]
points = { T = [0.0313197, 0.0062005] }
[beams.beam1]
curve = { kind = "arc", center = [-0.07957186742052817, 0.484130621759651], start = [0.0, 0.0], \
end = [0.0313197, 0.0062005], direction = "counterclockwise" }
thickness = 0.000197
width = 0.00748
material = "polypropylene"
start = { joint = "weld", point = "R" }
end = { joint = "weld", point = "T" }
[drives.press]
kind = "displacement"
point = "T"
direction = [-0.981, -0.1942]
[contacts.plate]
kind = "beam-half-plane"
beam = "beam1"
body = "wall"
point = [0.0173981, -0.0056798]
normal = [-0.1942, 0.981]
[[stages]]
name = "press"
steps = "press"
stations = [0.005688, 0.008532, 0.009479]
[[probes]]
of = "plate"
quantity = "ends"
[[probes]]
of = "plate"
quantity = "centre"
"""

LINKED = """
name = "linked"
theory = "bending"
[materials.polypropylene]
youngs_modulus = 1370000000.0
poisson_ratio = 0.42
[bodies.wall]
motion = "fixed"
points = { R = [0.0, -0.0] }
[bodies.tip]
motion = "free"
points = { T = [0.071097, -0.232849], Q = [0.089042, -0.246362] }
[bodies.car]
motion = "slides"
along = [-0.1111, -0.9938]
turns = true
about = "K"
points = { J = [0.089042, -0.246362], K = [0.168568, -0.302571] }
[pins]
joint = { points = ["Q", "J"] }
[beams.beam1]
curve = { kind = "polynomial", axis = "y", coefficients = [0.0, 0.612855665727263, 3.9432889253166477], \
range = [-0.0, -0.232849] }
thickness = 0.00456
width = 0.0441
material = "polypropylene"
start = { joint = "weld", point = "R" }
end = { joint = "weld", point = "T" }
[loads.act1]
kind = "beam_moment"
beam = "beam1"
at = 0.88
[[stages]]
name = "stage1"
steps = "act1"
stations = [1.47, 2.94, 4.41]
[[probes]]
of = "tip"
quantity = "rotation"
"""


@pytest.fixture
def asked(tmp_path: Path):
    def of(text):
        file = tmp_path / "scene.toml"
        file.write_text(text, encoding="utf-8")
        return read(file)

    return of


def test_a_place_of_contact_becomes_a_zone_on_even_elements(asked):
    # reference: an arc that is symmetric between clamps stays so, and lies on the plate beside its middle
    answer = cprbm.answer(asked(PRESSED_FLAT), cprbm.Settings(links=40))
    assert answer.completed, answer.sentence
    length = float(answer.stations[0].shapes["beam1"].s[-1])
    assert answer.stations[1].values["plate.centre"][0] == pytest.approx(0.5 * length, rel=1e-4)
    first, last = answer.stations[2].values["plate.ends"]
    assert last - first > 0.01 * length
    assert first + last == pytest.approx(length, rel=1e-4)


def test_a_residual_of_round_off_that_comes_back_is_no_circle(asked):
    # a mechanism that no force holds: what is left is of the closure alone, and Newton's method is quadratic in it
    answer = cprbm.answer(asked(LINKED), cprbm.Settings(links=40))
    assert answer.completed, answer.sentence
    assert max(station.certificate.iterations for station in answer.stations) <= 20
