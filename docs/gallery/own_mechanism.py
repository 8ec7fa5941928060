"""A mechanism of one's own.

The scene ``latch.toml`` is written in mm, N and degrees; a verdict is one call, and its rows are records.
"""

from pathlib import Path

import comparisons
import scene
from comparisons.choices import Choices

latch = scene.read(Path(__file__).with_name("latch.toml"))
found = comparisons.compare(latch, Choices(links=40, elements=40))

print(found.verdict.word.value)
print(found.verdict.sentence)
print()
print("with the tip 15 mm down          CPRBM        FEA  difference    may be")
for row in found.rows:
    if row.station == 0.015 and row.bounds is not None and row.probe.quantity != "bending_stress":
        chain, elements = (1e3 * values[-1] if row.unit == "m" else values[-1] for values in (row.cprbm, row.fea))
        unit = "mm" if row.unit == "m" else row.unit
        parts = f"{row.difference / row.scale:11.3%} {row.bounds.total / row.scale:9.3%}"
        print(f"{row.probe.name:20} {unit:>4} {chain:10.4f} {elements:10.4f} {parts}")
