"""Numbers to a table.

Every number of an answer on a line of its own, with probe, unit and station: as
records, which ``pandas.DataFrame(records)`` takes as they are, and as a file.
"""

from pathlib import Path

import comparisons
import cprbm
from comparisons.cases import opened

wrapped = opened("wrapped")
answer = cprbm.answer(wrapped, cprbm.Settings(links=20))

records = comparisons.records(wrapped, answer)
forces = [each for each in records if each["probe"] == "contact.force"]
for each in forces:
    told = f"{each['value']:8.3f} {each['unit']} on the circle"
    print(f"{each['station']:6.1f} N on the tip: {told}")

comparisons.write_csv("wrapped.csv", wrapped, answer)
print()
with Path("wrapped.csv").open(encoding="utf-8") as lines:
    for _ in range(4):
        print(next(lines).rstrip())
