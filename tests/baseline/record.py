"""A record on disk: a growing folder or a compressed file.

A folder holds ``about.json`` (options and digest of the program) and ``entries.jsonl`` (an entry a line, in the order
of the runs' ends). A packed record has the same lines in one file with the ending ``.jsonl.xz``.
"""

from __future__ import annotations

import json
import lzma
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from hashlib import sha256
from pathlib import Path

from tests.baseline.measuring import Entry

FORMAT = 1
ROOT = Path(__file__).parents[2]
PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
PACKED = ".jsonl.xz"


class RecordError(ValueError):
    """A record cannot be read or continued; the text names the file, the fault and the remedy."""


@dataclass(frozen=True, slots=True)
class About:
    """What a record holds.

    Attributes:
        built_in: names of the built-in cases.
        scenes: number of random scenes.
        seed: their seed.
        theory: beam theory asked for, None for the program's default.
        program: digest of the sources that answered.
        format: version of the format.
    """

    built_in: tuple[str, ...]
    scenes: int
    seed: int
    theory: str | None
    program: str
    format: int = FORMAT


@dataclass(frozen=True, slots=True)
class Record:
    """A whole record: entries by the names of their runs."""

    about: About
    entries: Mapping[str, Entry]


def program_digest() -> str:
    """A digest of the Python and TOML sources of all packages."""
    digest = sha256()
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*")):
            if path.suffix in {".py", ".toml"}:
                digest.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def start(folder: Path, about: About) -> set[str]:
    """Names of the runs in a folder; a new folder gets an ``about.json``.

    Raises:
        RecordError: the folder holds another record.
        OSError: the folder cannot be written.
    """
    file = folder / "about.json"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(asdict(about), indent=1) + "\n", encoding="utf-8")
        return set()
    found = _about(json.loads(file.read_text(encoding="utf-8")), file)
    for key, value in asdict(about).items():
        if getattr(found, key) != value:
            raise RecordError(
                f"{file}: {key}: found {getattr(found, key)!r}, asked for {value!r}; "
                "continue with the same options and sources, or record into another folder"
            )
    file = folder / "entries.jsonl"
    if file.exists() and not file.read_text(encoding="utf-8").endswith("\n"):
        with file.open("a", encoding="utf-8") as cut:
            cut.write("\n")  # ends the line that a stop cut short
    return set(_entries(_lines(file)))


def add(folder: Path, entry: Entry) -> None:
    """Append an entry to a folder's record.

    Raises:
        OSError: the folder cannot be written.
    """
    with (folder / "entries.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps(entry, allow_nan=True) + "\n")


def read(path: Path) -> Record:
    """The record of a folder or of a packed file.

    Raises:
        RecordError: no record is there, or its format is another one.
    """
    if path.is_dir() and (path / "about.json").exists():
        about = json.loads((path / "about.json").read_text(encoding="utf-8"))
        return Record(_about(about, path), _entries(_lines(path / "entries.jsonl")))
    if path.is_file() and path.name.endswith(PACKED):
        with lzma.open(path, "rt", encoding="utf-8") as file:
            first, *rest = file
        return Record(_about(json.loads(first), path), _entries(rest))
    raise RecordError(f"{path}: no record; allowed: a folder written by 'record', or a file that ends in {PACKED}")


def join(parts: Sequence[Record]) -> Record:
    """A record of all runs; of a run in several parts the last entry counts."""
    names = sorted({name for part in parts for name in part.about.built_in})
    entries = {name: entry for part in parts for name, entry in part.entries.items()}
    return Record(replace(parts[-1].about, built_in=tuple(names)), entries)


def pack(record: Record, path: Path) -> None:
    """Write a record as one compressed file, entries by name.

    Raises:
        OSError: the file cannot be written.
    """
    lines = [asdict(record.about), *(record.entries[name] for name in sorted(record.entries))]
    with lzma.open(path, "wt", preset=9, encoding="utf-8") as file:
        file.writelines(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)


def _about(data: dict[str, object], path: Path) -> About:
    if data.get("format") != FORMAT:
        raise RecordError(f"{path}: format: found {data.get('format')!r}, allowed: {FORMAT}")
    return About(**{**data, "built_in": tuple(data["built_in"])})


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines() if path.exists() else []


def _entries(lines: Iterable[str]) -> dict[str, Entry]:
    """Entries by name, without a line cut short by a stop: the run is then made again."""

    def parsed() -> Iterator[Entry]:
        for line in lines:
            try:
                yield json.loads(line)
            except json.JSONDecodeError:
                continue

    return {entry["run"]: entry for entry in parsed()}
