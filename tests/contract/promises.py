"""A recording of promises: items and values as JSON, an item a line.

An item is a string that names a part of the program: ``cprbm solve option --json``.
The value is an exit code, a default, a kind, or ``""`` where the promise is the existence of the item.
A list of strings holds demands on the user, such as required options: a program may drop demands, and add none.
"""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

Value = str | int | list[str]
Promises = dict[str, Value]

RECORDED = Path(__file__).parent / "promises.json"


def merged(parts: Iterable[Mapping[str, Value]]) -> Promises:
    """All items of several recordings.

    Raises:
        ValueError: two values of one item.
    """
    items: Promises = {}
    for part in parts:
        for item, value in part.items():
            if items.setdefault(item, value) != value:
                raise ValueError(f"{item}: recorded as {items[item]!r} and as {value!r}")
    return items


def text(promises: Mapping[str, Value]) -> str:
    """A recording as sorted JSON, an item a line."""
    lines = [
        f" {json.dumps(item, ensure_ascii=False)}: {json.dumps(value, ensure_ascii=False)}"
        for item, value in sorted(promises.items())
    ]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def recorded(file: Path = RECORDED) -> Promises:
    """The recording in a file."""
    items: Promises = json.loads(file.read_text("utf-8"))
    return items
