"""Errors of pydantic as mistakes: the key in the file, the value found, the values allowed.

The annotations of the records tell the tags of unions, which are no keys, and the allowed keys of a table.
"""

from __future__ import annotations

import re
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, Tag
from pydantic_core import ErrorDetails

from cprbm_scene.mistakes import Mistake, SceneError, hint, unknown_name
from cprbm_scene.units import Record


def keys_at(loc: tuple[int | str, ...], root: type[Record]) -> tuple[str, ...]:
    """Keys of the table at ``loc``, a place in ``root`` as pydantic names it (tags of unions included)."""
    record = _bare(_place(loc, root))
    return tuple(key for key in record.model_fields if (record, key) != (root, "file"))


def is_tag(loc: tuple[int | str, ...], depth: int, root: type[Record]) -> bool:
    """True if ``loc`` has the tag of a union at ``depth``: a tag is no key of the file."""
    return get_origin(_bare(_place(loc[:depth], root))) in (Union, UnionType)


def tags_at(loc: tuple[int | str, ...], root: type[Record]) -> tuple[str, ...]:
    """Kinds, joints or motions of the table at ``loc``."""
    return tuple(tag for record in get_args(_bare(_place(loc, root))) for tag in _tags(record))


def _place(loc: tuple[int | str, ...], root: type[Record]) -> Any:  # noqa: ANN401 - annotations have no type
    """The annotation at ``loc``."""
    place: Any = root
    for part in loc:
        place = _below(_bare(place), part)
    return place


def _below(place: Any, part: int | str) -> Any:  # noqa: ANN401 - annotations have no type
    """The annotation one step below ``place``."""
    if isinstance(place, type) and issubclass(place, BaseModel):
        return place.model_fields[str(part)].annotation
    if get_origin(place) in (Union, UnionType):
        return next(record for record in get_args(place) if part in _tags(record))
    # of Mapping[Name, T] and tuple[T, ...], T
    return next(each for each in reversed(get_args(place)) if each is not ...)


def _bare(place: Any) -> Any:  # noqa: ANN401 - annotations have no type
    """An annotation without its metadata and without None."""
    while get_origin(place) is Annotated:
        place = get_args(place)[0]
    if get_origin(place) in (Union, UnionType):
        some = [each for each in get_args(place) if each is not NoneType]
        if len(some) == 1:
            return _bare(some[0])
    return place


def _tags(record: Any) -> tuple[str, ...]:  # noqa: ANN401 - annotations have no type
    """Tags of a member of a union."""
    if get_origin(record) is Annotated:
        return tuple(each.tag for each in get_args(record) if isinstance(each, Tag))
    fields = record.model_fields
    return get_args(next(fields[tag] for tag in ("kind", "joint", "motion") if tag in fields).annotation)


_QUOTED = re.compile(r"'([^']*)'")
_MEASURED = re.compile(r"\s*[-+]?[\d.]+(?:e[-+]?\d+)?\s*[^\d\s]{1,8}\s*", re.ASCII | re.IGNORECASE)
_UNITS = """units = { length = "mm" }"""
_NUMBERS = f"; numbers have no units of their own, and the file states its once, as {_UNITS}"
_LONGEST = 80
"""Longest value found that a message shows in full."""

_ALLOWED = {
    "finite_number": "a finite number",
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "dict_type": "a table",
    "mapping_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "string_unicode": "a text in quotes",
    "string_pattern_mismatch": "a name of letters, digits, '_' and '-' that starts with a letter or '_'",
    "greater_than": "a number greater than {gt:g}",
    "greater_than_equal": "a number of at least {ge:g}",
    "less_than": "a number less than {lt:g}",
    "less_than_equal": "a number of at most {le:g}",
    "too_short": "at least {min_length} of them",
    "too_long": "at most {max_length} of them",
    "string_too_long": "at most {max_length} characters",
    "literal_error": "one of {expected}",
}
"""Allowed values by the type of an error, with the fields of the error's context."""


def in_words(details: ErrorDetails, root: type[Record]) -> Mistake:
    """A mistake with the key below ``root`` and both halves of the message."""
    kind, loc, given = details["type"], details["loc"], details.get("input")
    key, context = _key_path(loc, root), details.get("ctx", {})
    found, allowed = shown(given), _ALLOWED[kind].format(**context) if kind in _ALLOWED else details["msg"]
    match kind:
        case "tuple_type" if loc[-1] == "points" and isinstance(given, str):
            allowed += ", or the name of a table of points in a scene file"
        case "extra_forbidden":
            return unknown_name(key, str(loc[-1]), "key here", keys_at(loc[:-1], root))
        case "string_pattern_mismatch" if "x00" in context["pattern"]:
            allowed = "a text without control characters"
        case "missing":
            found = "nothing"
            allowed = "an item here" if isinstance(loc[-1], int) else "a value: this key is required"
        case "too_long" if context["max_length"] == len(("x", "y")):
            allowed = allowed.removeprefix("at most ")
        case "literal_error":
            found += hint(given, _QUOTED.findall(context["expected"])) if isinstance(given, str) else ""
        case "float_type":
            allowed += ", or a table with the keys 'at' and 'values'" if loc[-1] == "number" else ""
            allowed += _NUMBERS if isinstance(given, str) and _MEASURED.fullmatch(given) else ""
        case "union_tag_invalid" | "union_tag_not_found":
            tag, tags = context["discriminator"].strip("'"), tags_at(loc, root)
            value = details["input"].get(tag)
            found = "nothing" if kind == "union_tag_not_found" else shown(value)
            found += hint(value, tags) if isinstance(value, str) else ""
            key, allowed = f"{key}.{tag}", f"one of {', '.join(map(repr, tags))}"
        case "model_type" if loc == ("units",):
            allowed += f", as {_UNITS}"
        case "value_error" if isinstance(error := context["error"], SceneError):
            (mistake,) = error.mistakes
            key, found, allowed = f"{key}.{mistake.key}".strip("."), mistake.found, mistake.allowed
    return Mistake(key, found, allowed)


def repeats_another(details: ErrorDetails) -> bool:
    """True if pydantic misses only items with mistakes of their own, or parameters with mistakes."""
    kind, given = details["type"], details.get("input")
    short = kind == "too_short" and isinstance(given, tuple) and len(given) >= details["ctx"]["min_length"]
    return short or kind == "repeats"


def shown(value: object) -> str:
    """The value in TOML's notation, cut if the value is long."""
    match value:
        case dict():
            text = f"a table with the keys {', '.join(map(repr, value))}" if value else "an empty table"
        case tuple():
            text = f"[{', '.join(shown(item) for item in value[:9])}]"
        case bool():
            text = str(value).lower()
        case int() if value.bit_length() > 64:  # Python refuses to write the longest integers
            text = f"a whole number of {value.bit_length()} bits"
        case None | str() | int() | float():
            text = repr(value)
        case _:
            text = str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _key_path(loc: tuple[int | str, ...], root: type[Record]) -> str:
    """``("beams", "b", "curve", "arc", "center")`` as ``beams.b.curve.center``: the tag of a union is no key."""
    path = ""
    for depth, part in enumerate(loc):
        if part != "[key]" and not is_tag(loc, depth, root):
            path += f"[{part}]" if isinstance(part, int) else f".{part}"
    return path.removeprefix(".")
