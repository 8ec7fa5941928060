"""TOML in, :class:`~scene.statement.Scene` out, or every mistake at once."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from scene.checks import mistakes_in
from scene.mistakes import Mistake, SceneError
from scene.statement import Scene

_ALLOWED = {
    "extra_forbidden": "no such key here",
    "missing": "this key is required",
    "finite_number": "a finite number",
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
    "string_pattern_mismatch": "a name of letters, digits, '_' and '-' that starts with a letter or '_'",
}


def read(path: str | Path) -> Scene:
    """Read a scene file.

    Args:
        path: a TOML file in SI units.

    Returns:
        The scene, with ``file`` set to ``path``.

    Raises:
        SceneError: the file cannot be read, or anything in it is wrong; all mistakes are named.
    """
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise _file_error(path, f"bytes that are no UTF-8 text (at byte {error.start})") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise _file_error(path, f"a file that cannot be read ({reason})") from None
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise _file_error(path, f"text that is no TOML ({error})") from None
    return scene_from(data, file=str(path))


def scene_from(data: dict[str, Any], *, file: str = "") -> Scene:
    """Make a scene of plain data, as :func:`read` does of a file's.

    Raises:
        SceneError: anything in it is wrong; all mistakes are named.
    """
    if "file" in data:
        raise SceneError([Mistake("file", repr(data["file"]), "no such key here", file)])
    try:
        scene = Scene.model_validate({**_tuples(data), "file": file})
    except ValidationError as error:
        raise SceneError([_mistake(details, file) for details in error.errors()]) from None
    except RecursionError:
        raise SceneError([Mistake("", "tables nested too deeply", "a scene", file)]) from None
    found = mistakes_in(scene)
    if found:
        raise SceneError(found)
    return scene


def _file_error(path: Path, found: str) -> SceneError:
    return SceneError([Mistake("", found, "a readable TOML file in UTF-8", str(path))])


def _tuples(value: Any) -> Any:  # noqa: ANN401 - whatever TOML holds
    """Lists made tuples, all the way down: strict validation takes nothing else for a frozen record."""
    if isinstance(value, dict):
        return {key: _tuples(item) for key, item in value.items()}
    if isinstance(value, list):
        return tuple(_tuples(item) for item in value)
    return value


def _mistake(details: ErrorDetails, file: str) -> Mistake:
    """Pydantic's finding in the house's words."""
    kind = details["type"]
    key = _key_path(details["loc"])
    given = details.get("input")
    if kind == "extra_forbidden":
        found = "an unknown key"
    elif kind == "missing":
        found = "nothing"
    else:
        found = _shown(given)
    context = details.get("ctx", {})
    match kind:
        case "greater_than":
            allowed = f"a number greater than {context['gt']:g}"
        case "greater_than_equal":
            allowed = f"a number of at least {context['ge']:g}"
        case "less_than":
            allowed = f"a number less than {context['lt']:g}"
        case "less_than_equal":
            allowed = f"a number of at most {context['le']:g}"
        case "literal_error":
            allowed = str(context["expected"])
        case "union_tag_invalid":
            allowed = f"{context['discriminator'].strip(chr(39))} = one of {context['expected_tags']}"
            found = f"'{context['tag']}'"
        case "union_tag_not_found":
            allowed = f"a table with the key {context['discriminator']}"
        case _:
            allowed = _ALLOWED.get(kind, details["msg"])
    return Mistake(key, found, allowed, file)


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def _key_path(loc: tuple[int | str, ...]) -> str:
    """``("beams", "b", "curve", "arc", "radius")`` as ``beams.b.curve.radius``: tags of unions are no keys."""
    path = ""
    for depth, part in enumerate(loc):
        if part == "[key]" or _is_tag(loc, depth):
            continue
        path += f"[{part}]" if isinstance(part, int) else f".{part}"
    return path.removeprefix(".")


def _is_tag(loc: tuple[int | str, ...], depth: int) -> bool:
    """Whether pydantic put the tag of a union there: below a load, and below a beam's curve and ends."""
    if loc[0] == "loads":
        return depth == 2 and loc[2] in {"moment", "force"}
    in_beam = loc[0] == "beams" and depth == 3
    return (
        in_beam and loc[2] in {"curve", "start", "end"} and loc[3] in {"line", "arc", "weld", "pin", "free"}
    )
