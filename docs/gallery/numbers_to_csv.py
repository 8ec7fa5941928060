"""Numbers to a table.

Every number of an answer on a line of its own, with probe, unit and station: as records, which
``pandas.DataFrame(records)`` takes as they are, and as a file.
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
    print(f"{each['station']:6.1f} N on the tip: {each['value']:8.3f} {each['unit']} on the circle")

comparisons.write_csv("wrapped.csv", wrapped, answer)
print()
print("\n".join(Path("wrapped.csv").read_text(encoding="utf-8").splitlines()[:4]))
