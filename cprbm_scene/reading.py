"""TOML in; a :class:`~cprbm_scene.Scene` or an :class:`~cprbm_scene.OffsetQuestion` out, or every mistake."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from cprbm_scene.check_offset import mistakes_in_offset
from cprbm_scene.checks import mistakes_in
from cprbm_scene.keys import is_tag, keys_at, tags_at
from cprbm_scene.mistakes import Mistake, SceneError, first_of, hint, unknown_name
from cprbm_scene.offset import OffsetQuestion
from cprbm_scene.statement import Record, Scene
from cprbm_scene.units import in_si

Question = Scene | OffsetQuestion
Asked = TypeVar("Asked", Scene, OffsetQuestion)

LARGEST = 1_000_000
"""Bytes that a file may have: a hundred times those of the longest built-in case."""

PAIR = 2
DEEPEST = 32
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(rf"(?<![\w-])(?:{_PART}){{{DEEPEST}}}", re.ASCII)
"""A dotted key that no scene has: the parser's time and memory grow with the square of its parts."""

_QUOTED = re.compile(r"'([^']*)'")
_MEASURED = re.compile(r"\s*[-+]?[\d.]+(?:e[-+]?\d+)?\s*[^\d\s]{1,8}\s*", re.ASCII | re.IGNORECASE)
_UNITS = """units = { length = "mm" }"""
_AS_NUMBER = f"; numbers have no units of their own, and the file states its once, as {_UNITS}"

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
}


def read(path: str | Path) -> Scene:
    """Read a scene file.

    Args:
        path: a TOML file, in SI units or in those that it states.

    Returns:
        The scene, with ``file`` set to ``path``.

    Raises:
        SceneError: the file cannot be read, anything in it is wrong (all mistakes are named), or it asks
            something else than a scene does.

    Example:
        >>> from cprbm_scene import read
        >>> hinge = read("comparisons/cases/hinge.toml")
        >>> hinge.beams["beam1"].thickness, hinge.place_of("B")
        (0.002, (0.051, 0.02625))
    """
    found = read_question(path)
    if isinstance(found, OffsetQuestion):
        allowed = "a scene of beams; of an offset there is no equilibrium, and 'compare' answers it"
        raise SceneError([Mistake("question", repr(found.question), allowed, found.file)])
    return found


def read_question(path: str | Path) -> Question:
    """Read a file of any question: of a scene, or, where it says ``question = "offset"``, of an offset curve.

    Args:
        path: a TOML file, a scene's in SI units or in those that it states.

    Returns:
        The scene or the offset question, with ``file`` set to ``path``.

    Raises:
        SceneError: as :func:`read`.
    """
    path = Path(path)
    try:
        with path.open("rb") as stream:
            content = stream.read(LARGEST + 1)
        if len(content) > LARGEST:
            raise _file_error(path, "a file that is larger", f"at most {LARGEST // 1_000_000} MB of TOML in UTF-8")
        text = content.decode("utf-8")
    except SceneError:
        raise
    except UnicodeDecodeError as error:
        raise _file_error(path, f"bytes that are no UTF-8 text (at byte {error.start})") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise _file_error(path, f"a file that cannot be read ({reason})") from None
    if _DEEP_KEY.search(text):
        raise _file_error(path, f"a key of more than {DEEPEST} parts", "the keys of a scene")
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise _file_error(path, f"text that is no TOML ({error})") from None
    if "question" in data:
        return offset_from(data, file=str(path))
    return scene_from(data, file=str(path))


def scene_from(data: dict[str, Any], *, file: str = "") -> Scene:
    """A scene from plain data, checked as :func:`read` checks a file.

    Args:
        data: tables, lists, numbers and texts with the keys of a scene file, as ``tomllib.loads`` returns them. Numbers
            are in SI units or in the units that ``data["units"]`` states.
        file: the name of the file in messages and in ``Scene.file``; may be empty.

    Returns:
        The scene in SI units.

    Raises:
        SceneError: the data are no valid scene. The error names every mistake with its key.

    Example:
        >>> import tomllib
        >>> from pathlib import Path
        >>> from cprbm_scene import scene_from
        >>> data = tomllib.loads(Path("comparisons/cases/hinge.toml").read_text(encoding="utf-8"))
        >>> data["beams"]["beam1"]["thickness"] = 0.003
        >>> scene_from(data).beams["beam1"].thickness
        0.003
    """
    return _record(Scene, data, file, mistakes_in)


def offset_from(data: dict[str, Any], *, file: str = "") -> OffsetQuestion:
    """Make an offset question of plain data.

    Raises:
        SceneError: anything in it is wrong; all mistakes are named.
    """
    return _record(OffsetQuestion, data, file, mistakes_in_offset)


def _record(
    kind: type[Asked], data: dict[str, Any], file: str, mistakes_between: Callable[[Asked], list[Mistake]]
) -> Asked:
    if "file" in data:
        raise SceneError([replace(unknown_name("file", "file", "key here", keys_at((), kind)), file=file)])
    try:
        record = kind.model_validate({**_tuples(data), "file": file})
    except ValidationError as error:
        mistakes = (_mistake(details, file, kind) for details in error.errors() if not _says_it_again(details))
        raise SceneError(first_of(mistakes, file)) from None
    except RecursionError:
        raise SceneError([Mistake("", "tables nested too deeply", "a scene", file)]) from None
    if isinstance(record, Scene):
        record = in_si(record)
    found = mistakes_between(record)
    if found:
        raise SceneError(found)
    return record


def _file_error(path: Path, found: str, allowed: str = "a readable TOML file in UTF-8") -> SceneError:
    return SceneError([Mistake("", found, allowed, str(path))])


def _tuples(value: Any) -> Any:  # noqa: ANN401 - whatever TOML holds
    """Lists made tuples, all the way down: strict validation takes nothing else for a frozen record."""
    if isinstance(value, dict):
        return {key: _tuples(item) for key, item in value.items()}
    if isinstance(value, list):
        return tuple(_tuples(item) for item in value)
    return value


def _mistake(details: ErrorDetails, file: str, root: type[Record]) -> Mistake:
    """Pydantic's finding in the house's words."""
    kind, loc = details["type"], details["loc"]
    key = _key_path(loc, root)
    context = details.get("ctx", {})
    found = _shown(details.get("input"))
    match kind:
        case "extra_forbidden":
            return replace(unknown_name(key, str(loc[-1]), "key here", keys_at(loc[:-1], root)), file=file)
        case "missing":
            found = "nothing"
            allowed = "an item here" if isinstance(loc[-1], int) else "a value: this key is required"
        case "greater_than":
            allowed = f"a number greater than {context['gt']:g}"
        case "greater_than_equal":
            allowed = f"a number of at least {context['ge']:g}"
        case "less_than":
            allowed = f"a number less than {context['lt']:g}"
        case "less_than_equal":
            allowed = f"a number of at most {context['le']:g}"
        case "too_short":
            allowed = f"at least {context['min_length']} of them"
        case "too_long":
            exactly = context["max_length"] == PAIR
            allowed = f"{'' if exactly else 'at most '}{context['max_length']} of them"
        case "string_too_long":
            allowed = f"at most {context['max_length']} characters"
        case "literal_error":
            allowed = f"one of {context['expected']}"
            found += _meant(details.get("input"), _QUOTED.findall(context["expected"]))
        case "float_type" if loc[-1] == "number":
            allowed = "a number, or a table with the keys 'at' and 'values'"
            allowed += _AS_NUMBER if _with_unit(details.get("input")) else ""
        case "float_type" if _with_unit(details.get("input")):
            allowed = _ALLOWED[kind] + _AS_NUMBER
        case "union_tag_invalid" | "union_tag_not_found":
            tag = context["discriminator"].strip("'")
            key = f"{key}.{tag}"
            given = details["input"].get(tag)
            found = "nothing" if kind == "union_tag_not_found" else _shown(given)
            allowed = f"one of {', '.join(map(repr, tags_at(loc, root)))}"
            found += _meant(given, tags_at(loc, root))
        case "model_type" if loc == ("units",):
            allowed = f"a table, as {_UNITS}"
        case _:
            allowed = _ALLOWED.get(kind, details["msg"])
    return Mistake(key, found, allowed, file)


def _meant(given: object, known: Iterable[str]) -> str:
    return hint(given, known) if isinstance(given, str) else ""


def _with_unit(given: object) -> bool:
    """Whether a text looks like a number with its unit."""
    return isinstance(given, str) and _MEASURED.fullmatch(given) is not None


def _says_it_again(details: ErrorDetails) -> bool:
    """Whether pydantic misses only items that were given and are named on their own."""
    context = details.get("ctx", {})
    given = details.get("input")
    return details["type"] == "too_short" and isinstance(given, tuple) and len(given) >= context["min_length"]


def _shown(value: object) -> str:
    """The value as TOML shows it, cut where it is long."""
    match value:
        case dict():
            text = f"a table with the keys {', '.join(map(repr, value))}" if value else "an empty table"
        case tuple():
            text = f"[{', '.join(_shown(item) for item in value[:9])}]"
        case bool():
            text = str(value).lower()
        case int() if value.bit_length() > 64:  # Python refuses to write the longest ones
            text = f"a whole number of {value.bit_length()} bits"
        case None | str() | int() | float():
            text = repr(value)
        case _:
            text = str(value)
    return text if len(text) <= 80 else text[:77] + "..."


def _key_path(loc: tuple[int | str, ...], root: type[Record]) -> str:
    """``("beams", "b", "curve", "arc", "center")`` as ``beams.b.curve.center``: a tag is no key."""
    path = ""
    for depth, part in enumerate(loc):
        if part == "[key]" or is_tag(loc, depth, root):
            continue
        path += f"[{part}]" if isinstance(part, int) else f".{part}"
    return path.removeprefix(".")
