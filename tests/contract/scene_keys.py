"""Promises of the scene format: keys and kinds in the schema, and readable files."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from .promises import Promises

FILES = Path(__file__).parent / "files"
"""Scene files as they stood at 3c78333: the built-in cases, scenes of the pages, and a file with all other keys."""

Schema = Mapping[str, Any]


def promised_by_schema(schema: Schema) -> Promises:
    """Keys, kinds and required keys of a JSON schema; ``*`` is a name of the user, ``[]`` an item of a list."""
    promises: Promises = {}
    demands: dict[str, set[str]] = {}
    for path, part in _parts(schema, schema, "", ()):
        if path:
            promises[f"scene key {path}"] = ""
        for value in (*part.get("enum", ()), *([part["const"]] if "const" in part else ())):
            promises[f"scene choice {path} {value}"] = ""
        if "properties" in part:
            needed = {f"{path}.{key}".lstrip(".") for key in part.get("required", ())}
            # of several records at the same place only the common required keys are required
            demands[path] = demands[path] & needed if path in demands else needed
    return promises | {f"scene requires {path or '(file)'}": sorted(needed) for path, needed in demands.items()}


def _parts(part: Schema, whole: Schema, path: str, above: tuple[str, ...]) -> Iterator[tuple[str, Schema]]:
    """Every part of a schema with a path; references ``above`` are not followed again."""
    if "$ref" in part:
        name = part["$ref"]
        if name in above:
            return
        target: Any = whole
        for step in name.removeprefix("#/").split("/"):
            target = target[step]
        yield from _parts(target, whole, path, (*above, name))
        return
    yield path, part
    for union in ("anyOf", "oneOf", "allOf"):
        for each in part.get(union, ()):
            yield from _parts(each, whole, path, above)
    for key, each in part.get("properties", {}).items():
        yield from _parts(each, whole, f"{path}.{key}" if path else key, above)
    named = [part.get("additionalProperties"), *part.get("patternProperties", {}).values()]
    for each in (each for each in named if isinstance(each, Mapping)):
        yield from _parts(each, whole, f"{path}.*", above)
    for each in (part.get("items"), *part.get("prefixItems", ())):
        if isinstance(each, Mapping):
            yield from _parts(each, whole, f"{path}[]", above)


def keys_of(data: object, known: frozenset[str], path: str = "") -> Iterator[str]:
    """Paths of keys in a file, with ``*`` for names of the user where ``known`` has such a path."""
    if isinstance(data, Mapping):
        for key, value in data.items():
            deeper = f"{path}.*" if f"{path}.*" in known else f"{path}.{key}".lstrip(".")
            yield deeper
            yield from keys_of(value, known, deeper)
    elif isinstance(data, list):
        for item in data:
            if isinstance(item, Mapping | list):
                yield from keys_of(item, known, f"{path}[]")


def promised_by_file(item: str, read: Callable[[], object]) -> Promises:
    """The promise about a scene file: the kind of question, or the reason of a refusal."""
    try:
        question = read()
    except Exception as error:  # any error of a reader breaks the promise
        return {item: f"refused: {error}"}
    return {item: type(question).__name__}
