"""What a run has finished, line by line in a file that only grows, so that a run that is killed loses none of it.

A line is written when a scene has ended, and is whole or, where writing it was cut short, the last and without its
end; that one is dropped when the file is opened again.  The file's name holds a digest of what an outcome depends on:
the seed, the effort, the limits, and the sources of all rooms and of this folder.  So a run goes on from its own
outcomes alone, and what another program or another question has found stays beside them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from comparisons.present.columns import Plain
from comparisons.provenance import program
from comparisons.writing import append_line, whole_lines
from tests.robustness.outcomes import Outcome, packed, unpacked


def digest(question: object) -> str:
    """Of a record, by what it shows of itself, and of the program that answers it: eight hexadecimal digits."""
    return hashlib.sha256(f"{question!r}\n{program('tests.robustness')}".encode()).hexdigest()[:8]


@dataclass(frozen=True, slots=True)
class Kept:
    """A file of outcomes by the index of the scene, and of the files in which scenes were saved."""

    path: Path

    def read(self) -> tuple[dict[int, Outcome], dict[int, str]]:
        """Outcomes and names of files, each by index; none where there is no file yet.

        Raises:
            OSError: the file cannot be read, or not be cut to its whole lines.
        """
        lines: list[Mapping[str, Plain]] = [json.loads(line) for line in whole_lines(self.path)]
        outcomes = {_index(line): unpacked(line["ended"]) for line in lines if "ended" in line}
        saved = {_index(line): str(line["saved"]) for line in lines if "saved" in line}
        return outcomes, saved

    def ended(self, index: int, outcome: Outcome) -> None:
        """Keep how a scene ended.

        Raises:
            OSError: the file cannot be written.
        """
        self._add({"index": index, "ended": packed(outcome)})

    def saved(self, index: int, file: str) -> None:
        """Keep in which file a scene was saved.

        Raises:
            OSError: as above.
        """
        self._add({"index": index, "saved": file})

    def _add(self, line: Plain) -> None:
        append_line(self.path, json.dumps(line, ensure_ascii=False, allow_nan=False))


def _index(line: Mapping[str, object]) -> int:
    index = line["index"]
    assert isinstance(index, int)
    return index
