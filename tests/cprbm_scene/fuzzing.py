"""Coverage-guided fuzzing of the scene reader: ``python -m tests.cprbm_scene.fuzzing --runs 2000 --seed 905``.

The fuzzer begins with the built-in cases and earlier finds, alters a file at places drawn from the seed (numbers,
names, lines, whole tables, bytes), reads the altered file, and keeps files that lead the reader from line to line on a
new way.  A file without a scene or a SceneError, or beyond ``SECONDS`` of the processor or ``MEMORY``, goes into
``found/`` beside this module, and a test reads the file ever after; the exit code is then 1.
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from cprbm_scene import SceneError, read_question

CASES = Path(__file__).parents[2] / "comparisons" / "cases"
FOUND = Path(__file__).parent / "found"
ROOM = str(Path(__file__).parents[2] / "cprbm_scene")
SECONDS = 10.0
MEMORY = 2 * 10**9
"""Bytes of address space."""

NUMBERS = (
    *("0", "-0.0", "1", "-1", "3", "0.37", "1e-9", "1e-308", "5e-324", "1e9", "1e154", "1e308", "-1e308", "inf", "nan"),
    *("true", "9" * 30, "9" * 5000, "0x1F", "1979-05-27", "[]", "{}", '""', "[0.0, 0.0]", "[[0.0, 0.0]]"),
)
JUNK = (b"", b"[", b"]", b"{", b"}", b"=", b".", b'"', b"'", b"\\u", b"\x00", b"\xff", b"\n", b"#", b",")
NUMBER = re.compile(rb"(?<![\w.\"-])-?\d[\d_]*\.?\d*(?:[eE][+-]?\d+)?(?![\w.])")
NAME = re.compile(rb"\"[A-Za-z_][\w.-]*\"|\b[A-Za-z_]\w*\b")
Lines = set[tuple[CodeType, int, int]]


def numbers_altered(text: bytes, others: list[bytes], drawn: random.Random) -> bytes:
    """A number replaced by a bad number, by a multiple, or by another number of the text."""
    places = list(NUMBER.finditer(text))
    if not places:
        return text
    place = drawn.choice(places)
    match drawn.randrange(3):
        case 0:
            new = drawn.choice(NUMBERS).encode()
        case 1:
            new = repr(float(place[0].replace(b"_", b"")) * drawn.choice([-1.0, 1.0 + 1e-12, 1.7, 1e-7, 1e7])).encode()
        case _:
            new = drawn.choice(places)[0]
    return text[: place.start()] + new + text[place.end() :]


def names_altered(text: bytes, others: list[bytes], drawn: random.Random) -> bytes:
    """A name or word in the place of another, from this text or a further one."""
    places = list(NAME.finditer(text))
    words = NAME.findall(drawn.choice([text, drawn.choice(others)]))
    if not places or not words:
        return text
    place = drawn.choice(places)
    return text[: place.start()] + drawn.choice(words) + text[place.end() :]


def lines_altered(text: bytes, others: list[bytes], drawn: random.Random) -> bytes:
    """Some lines dropped, told twice, moved, or brought from a further text."""
    lines = text.splitlines(keepends=True) or [b"\n"]
    first = drawn.randrange(len(lines))
    some = lines[first : first + drawn.choice([1, 1, 2, 5, 12])]
    rest = lines[:first] + lines[first + len(some) :]
    there = drawn.randrange(len(rest) + 1)
    match drawn.randrange(4):
        case 0:
            return b"".join(rest)
        case 1:
            return b"".join(rest[:there] + some + rest[there:])
        case 2:
            return b"".join(lines[:there] + some + lines[there:])
        case _:
            more = drawn.choice(others).splitlines(keepends=True) or [b"\n"]
            begin = drawn.randrange(len(more))
            return b"".join(lines[:there] + more[begin : begin + drawn.choice([1, 3, 9])] + lines[there:])


def bytes_altered(text: bytes, others: list[bytes], drawn: random.Random) -> bytes:
    """Some bytes in the place of others."""
    first = drawn.randrange(len(text) + 1)
    junk = drawn.choice(
        [b"", b"[", b"]", b"{", b"}", b"=", b".", b'"', b"'", b"\\u", b"\x00", b"\xff", b"\n", b"#", b","]
    )
    return text[:first] + junk * drawn.choice([1, 1, 1, 3, 400]) + text[first + drawn.choice([0, 0, 1, 2, 7]) :]


ALTERED: tuple[Callable[[bytes, list[bytes], random.Random], bytes], ...] = (
    *(numbers_altered, numbers_altered, names_altered, names_altered, lines_altered, lines_altered, bytes_altered),
)


def followed(path: Path) -> tuple[Lines, str]:
    """The ways of the reader from line to line while a file is read, and the error, if any."""
    ways: Lines = set()
    last: dict[FrameType, int] = {}

    def local(frame: FrameType, event: str, argument: object) -> Any:
        if event == "line":
            ways.add((frame.f_code, last.get(frame, 0), frame.f_lineno))
            last[frame] = frame.f_lineno
        elif event == "return":
            last.pop(frame, None)
        return local

    def entered(frame: FrameType, event: str, argument: object) -> Any:
        return local if frame.f_code.co_filename.startswith(ROOM) else None

    wrong, begun = "", time.process_time()
    sys.settrace(entered)
    try:
        read_question(path)
    except SceneError:
        pass
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        wrong = f"{type(error).__name__}: {error}"
    finally:
        sys.settrace(None)
    taken = time.process_time() - begun
    return ways, wrong or (f"{taken:.1f} s" if taken > SECONDS else "")


def main() -> int:
    """Fuzz; 1 if anything was found."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--runs", type=int, default=2000)
    asked.add_argument("--seed", type=int, default=905)
    options = asked.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.RLIM_INFINITY))
    drawn = random.Random(options.seed)
    kept = [file.read_bytes() for file in [*sorted(CASES.glob("*.toml")), *sorted(FOUND.glob("*.toml"))]]
    given = len(kept)
    known: Lines = set()
    file = Path(f".fuzzed-{options.seed}.toml")
    found = 0
    try:
        for run in range(given + options.runs):
            if run < given:
                text = kept[run]
            else:
                text = drawn.choice(kept)
                for _ in range(drawn.choice([1, 1, 2, 3, 6])):
                    with suppress(ValueError, OverflowError):  # of a number that Python itself does not take
                        text = drawn.choice(ALTERED)(text, kept, drawn)
            file.write_bytes(text)
            ways, wrong = followed(file)
            if wrong:
                found += 1
                FOUND.mkdir(exist_ok=True)
                (FOUND / f"{sha256(text).hexdigest()[:12]}.toml").write_bytes(text)
                sys.stdout.write(f"run {run}: {wrong[:200]}\n")
            if not ways <= known:
                known |= ways
                if len(text) < 100_000:
                    kept.append(text)
    finally:
        file.unlink(missing_ok=True)
    sys.stdout.write(f"{options.runs} runs, {len(kept)} texts kept, {len(known)} ways, {found} found\n")
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main())
