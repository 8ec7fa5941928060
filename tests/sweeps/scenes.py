"""Scenes with parameters: a cantilever, also with tolerances or on a circle; tables without the seconds."""

import csv

CANTILEVER = """
name = "cantilever"
theory = "bending"
units = {{ length = "mm", stress = "MPa" }}
[parameters]
t = {{ value = 2.0, unit = "mm", range = [1.0, 3.0] }}
L = {{ value = 100.0, unit = "mm" }}
P = {{ value = 1.0, unit = "N" }}
[materials.plastic]
youngs_modulus = 2000.0
poisson_ratio = 0.3
[bodies]
ground = {{ motion = "fixed", points = {{ A = [0.0, 0.0] }} }}
tip = {{ motion = "free", points = {{ B = ["= L", 0.0] }} }}
[beams.b]
curve = {{ kind = "line", start = [0.0, 0.0], end = ["= L", 0.0] }}
thickness = "= t"
width = 10.0
material = "plastic"
start = {{ joint = "weld", point = "A" }}
end = {{ joint = "weld", point = "B" }}
[loads]
F = {{ kind = "force", point = "B", direction = [0.0, 1.0] }}
[[stages]]
name = "load"
steps = "F"
stations = {stations}
[[probes]]
of = "B"
quantity = "displacement"
"""

LINEAR = CANTILEVER.format(stations="['= P']").replace("P = { value = 1.0", "P = { value = 0.01")
"""The cantilever in the linear range, with the stress of the beam."""
LINEAR += '\n[[probes]]\nof = "b"\nquantity = "bending_stress"\npoints = 5\n'

SCATTERING = (
    CANTILEVER.format(stations="['= P']")
    .replace("range = [1.0, 3.0]", "range = [1.0, 3.0], tolerance = { normal = 0.02 }")
    .replace("[materials.plastic]\nyoungs_modulus = 2000.0", '[materials.plastic]\nyoungs_modulus = "= E"')
    .replace("width = 10.0", 'width = "= b"')
    .replace("[parameters]", '[parameters]\nE = { value = 2000.0, unit = "MPa" }\nb = { value = 10.0, unit = "mm" }')
)
"""The cantilever with a tolerance of the thickness."""

ROUND = """
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
"""A cantilever on a circle."""


def table(folder, name="numbers.csv"):
    """Rows of a table without the seconds."""
    with (folder / name).open(newline="") as stream:
        return [{key: value for key, value in row.items() if key != "seconds"} for row in csv.DictReader(stream)]
