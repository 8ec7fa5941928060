"""Plain data of a scene as the TOML text that reads back to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_LISTS = ("stages", "probes", "claims")
_ONE_TABLE = ("units", "pins", "assembly")


def toml_of(data: Mapping[str, Any]) -> str:
    """The text of a scene's ``data``: a table for each thing that has a name, and what is in it on a line for each."""
    blocks = ["\n".join(f"{key} = {_value(value)}" for key, value in data.items() if _is_plain(value))]
    for key, value in data.items():
        if key in _LISTS:
            blocks += [f"[[{key}]]\n{_lines(each)}" for each in value]
        elif key in _ONE_TABLE:
            blocks.append(f"[{key}]\n{_lines(value)}")
        elif not _is_plain(value):
            blocks += [f"[{key}.{name}]\n{_lines(each)}" for name, each in value.items()]
    return "\n\n".join(blocks) + "\n"


def _is_plain(value: object) -> bool:
    return isinstance(value, str | bool | int | float)


def _lines(table: Mapping[str, Any]) -> str:
    return "\n".join(f"{key} = {_value(value)}" for key, value in table.items())


def _value(value: object) -> str:
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return f'"{value}"'  # names and sentences of the generator: nothing to escape
        case int() | float():
            return repr(value)
        case Mapping():
            return "{ " + ", ".join(f"{key} = {_value(each)}" for key, each in value.items()) + " }" if value else "{}"
        case list():
            return "[" + ", ".join(map(_value, value)) + "]"
    raise TypeError(f"{type(value).__name__} is nothing that a scene is written with")
