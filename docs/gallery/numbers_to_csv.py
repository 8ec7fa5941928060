"""Numbers to a table.

A line per number of an answer, with probe, unit and station: as records for
``pandas.DataFrame(records)``, and as a file.
"""

from pathlib import Path

import comparisons
import cprbm
from comparisons.cases import opened

wrapped = opened("wrapped")
answer = cprbm.answer(wrapped, cprbm.Settings(links=20))

records = comparisons.records(wrapped, answer)
forces = [row for row in records if row["probe"] == "contact.force"]
for row in forces:
    force = f"{row['value']:8.3f} {row['unit']} on the circle"
    print(f"{row['station']:6.1f} N on the tip: {force}")

comparisons.write_csv("wrapped.csv", wrapped, answer)
print()
with Path("wrapped.csv").open(encoding="utf-8") as lines:
    for _ in range(4):
        print(next(lines).rstrip())
