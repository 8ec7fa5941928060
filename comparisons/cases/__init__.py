"""The built-in cases: one TOML file each, with the scene, its source and what the source claims about it."""

from __future__ import annotations

import tomllib
from importlib.resources import as_file, files

from scene import Mistake, Scene, SceneError, read


def names() -> tuple[str, ...]:
    """Names of the built-in cases, in alphabetical order."""
    found = (entry.name for entry in files(__name__).iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml")))


def described() -> tuple[tuple[str, str, str], ...]:
    """Name, title and source of every built-in case, read without checking the scenes."""
    found = []
    for name in names():
        data = tomllib.loads((files(__name__) / f"{name}.toml").read_text(encoding="utf-8"))
        found.append((name, str(data.get("title", "")), str(data.get("source", ""))))
    return tuple(found)


def opened(case: str) -> Scene:
    """The scene of a built-in case's name or of a file.

    Args:
        case: a name of :func:`names`, or the path of a TOML file (anything that ends in ``.toml`` or holds
            a path separator).

    Raises:
        SceneError: there is no such case, or the file is no valid scene.
    """
    if case in names():
        with as_file(files(__name__) / f"{case}.toml") as path:
            return read(path)
    if case.endswith(".toml") or "/" in case or "\\" in case:
        return read(case)
    allowed = f"a built-in case ({', '.join(names())}) or the path of a file that ends in .toml"
    raise SceneError([Mistake("case", repr(case), allowed)])
