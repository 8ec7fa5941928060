"""Your own mechanism.

The scene ``latch.toml`` is in mm, N and degrees. A single call gives the verdict
and rows as records in SI.
"""

import textwrap
from pathlib import Path

import comparisons
import cprbm_scene
from comparisons.choices import Choices

latch = cprbm_scene.read(Path(__file__).with_name("latch.toml"))
found = comparisons.compare(latch, Choices(links=40, elements=40))

print(found.verdict.word.value)
print(textwrap.fill(found.verdict.sentence, 76))
print()
print("with the tip 15 mm down     CPRBM        FEA  difference    may be")
for row in found.rows:
    if row.station != 0.015 or row.bounds is None:
        continue
    difference, bound = row.difference / row.scale, row.bounds.total / row.scale
    last = f"{row.cprbm[-1]:10.5g} {row.fea[-1]:10.5g}"  # y of a vector
    if row.probe.quantity == "bending_stress":
        last = f"{max(abs(row.cprbm)):10.4g} {max(abs(row.fea)):10.4g}"
    print(f"{row.probe.name:18} {row.unit:>3} {last} {difference:11.3%} {bound:9.3%}")
