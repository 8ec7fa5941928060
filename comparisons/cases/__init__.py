"""The built-in cases: one TOML file each, with the scene, its source and what the source claims about it."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from functools import partial
from importlib.resources import as_file, files
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from cprbm_scene import Question, Scene

T = TypeVar("T")


def data(case: str) -> dict[str, Any]:
    """Plain data of a built-in case or of a file, in SI and with numbers for expressions.

    Raises:
        SceneError: as :func:`asked`.
    """
    return asked(case).model_dump(mode="json", exclude_unset=True, exclude={"file", "units", "parameters"})


def names() -> tuple[str, ...]:
    """Names of the built-in cases, in alphabetical order."""
    return tuple(
        sorted(entry.name.removesuffix(".toml") for entry in files(__name__).iterdir() if entry.name.endswith(".toml"))
    )


def described() -> tuple[tuple[str, str, str], ...]:
    """Name, title and source of every built-in case, read without checking the scenes."""
    return tuple(
        (name, str(data.get("title", "")), str(data.get("source", "")))
        for name, data in ((name, _data(name)) for name in names())
    )


def scenes() -> tuple[str, ...]:
    """Names of the built-in cases that are scenes of beams."""
    return tuple(name for name in names() if "question" not in _data(name))


def opened(case: str, parameters: Mapping[str, float | str] | None = None) -> Scene:
    """The scene of a built-in case's name or of a file, as :func:`asked` finds it.

    Args:
        case: as of :func:`asked`.
        parameters: as of :func:`asked`.

    Returns:
        The scene.

    Raises:
        SceneError: there is no such case, or the file is no valid scene.
    """
    from cprbm_scene import read  # loaded when a scene is asked, not to list the cases

    return _found(case, partial(read, parameters=parameters))


def asked(case: str, parameters: Mapping[str, float | str] | None = None) -> Question:
    """The question of a built-in case's name or of a file.

    Args:
        case: a name of :func:`names`, or the path of a TOML file (anything that ends in ``.toml`` or holds
            a path separator).
        parameters: values of the scene's parameters by name, numbers in SI units or texts such as ``1.9mm``.

    Returns:
        The question.

    Raises:
        SceneError: there is no such case, or the file is no valid question.
    """
    from cprbm_scene import read_question

    return _found(case, partial(read_question, parameters=parameters))


def _found(case: str, reader: Callable[[str | Path], T]) -> T:
    if case in names():
        with as_file(files(__name__) / f"{case}.toml") as path:
            return reader(path)
    if case.endswith(".toml") or "/" in case or "\\" in case:
        return reader(case)
    from cprbm_scene import Mistake, SceneError
    from cprbm_scene.mistakes import hint

    file = f"{case}.toml"
    found = repr(case) + (f" (is the file {file} meant?)" if Path(file).is_file() else hint(case, names()))
    raise SceneError(
        [Mistake("case", found, f"a built-in case ({', '.join(names())}) or the path of a file that ends in .toml")]
    )


def _data(name: str) -> dict[str, Any]:
    return tomllib.loads((files(__name__) / f"{name}.toml").read_text(encoding="utf-8"))
