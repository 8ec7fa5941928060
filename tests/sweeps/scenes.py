"""Scene of a cantilever with parameters, and tables without the seconds."""

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


def table(folder, name="numbers.csv"):
    """Rows of a table without the seconds."""
    with (folder / name).open(newline="") as stream:
        return [{key: value for key, value in row.items() if key != "seconds"} for row in csv.DictReader(stream)]
