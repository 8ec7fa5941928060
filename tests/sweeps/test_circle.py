"""The radius of a circle for a given fall of a cantilever on the circle, against the closed form."""

import json

import pytest

from comparisons.cli.main import run
from tests.sweeps.circle import drop, radius_of
from tests.sweeps.elastica import tip

SCENE = """
name = "round"
theory = "bending"
[parameters]
rho = { value = 1.0, unit = "m", range = [0.6, 1.2] }
t = { value = 0.01, unit = "m" }
[materials.m]
youngs_modulus = 1.2e9 # E I = 1
poisson_ratio = 0.3
[bodies]
ground = { motion = "fixed", points = { C = [0.0, 0.0] } }
tip = { motion = "free", points = { T = [1.0, 0.0] } }
[beams.b]
curve = { kind = "line", start = [0.0, 0.0], end = [1.0, 0.0] }
thickness = "= t"
width = 0.01
material = "m"
start = { joint = "weld", point = "C" }
end = { joint = "weld", point = "T" }
[loads.F]
kind = "force"
point = "T"
direction = [0.0, -1.0]
[contacts.contact]
kind = "beam-circle"
beam = "b"
body = "ground"
center = [0.0, "= -rho"]
radius = "= rho - t/2"
[[stages]]
name = "load"
steps = "F"
stations = [3.0]
[[probes]]
of = "T"
quantity = "displacement"
"""

GOAL = '[goal]\nprobe = "T.displacement"\ncomponent = "y"\naim = "reach"\nvalue = -0.5\n'


def test_the_closed_form_meets_the_elastica_without_a_circle_and_a_wide_circle():
    """At ρ = 0.45 the wrap just begins (Bisshopp and Drucker without a circle); a wide circle is a parabola."""
    assert drop(0.45, 3.0) == pytest.approx(tip(3.0)[1], abs=3e-5)
    assert drop(100.0, 3.0) == pytest.approx(1.0 / 200.0, abs=1e-6)


def test_the_radius_for_a_fall_of_half_the_length(tmp_path):
    (tmp_path / "round.toml").write_text(SCENE, "utf-8")
    (tmp_path / "goal.toml").write_text(GOAL, "utf-8")
    out = tmp_path / "out"
    options = ["-n", "60", "--elements", "20", "--starts", "1", "--quiet", "--out", str(out)]
    run(["optimise", str(tmp_path / "round.toml"), "--goal", str(tmp_path / "goal.toml"), *options])
    found = json.loads((out / "optimum.json").read_text("utf-8"))
    assert found["goal"]["value"] == pytest.approx(-0.5, abs=1e-4)
    assert found["parameters"]["rho"] == pytest.approx(radius_of(0.5, 3.0), abs=1e-4)
