"""The built-in cases: one TOML file each, with the scene, its source and what the source claims about it."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from importlib.resources import as_file, files
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from cprbm_scene import Question, Scene

T = TypeVar("T")


def data(case: str) -> dict[str, Any]:
    """The plain data, in SI, of a built-in case's name or of a file, as far as :func:`asked` finds it a question.

    Raises:
        SceneError: as :func:`asked`.
    """
    question = asked(case)
    found = _data(case) if case in names() else tomllib.loads(Path(case).read_text(encoding="utf-8"))
    if "units" in found:
        return question.model_dump(mode="json", exclude_unset=True, exclude={"file", "units"})
    return found


def names() -> tuple[str, ...]:
    """Names of the built-in cases, in alphabetical order."""
    found = (entry.name for entry in files(__name__).iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml")))


def described() -> tuple[tuple[str, str, str], ...]:
    """Name, title and source of every built-in case, read without checking the scenes."""
    found = []
    for name in names():
        data = _data(name)
        found.append((name, str(data.get("title", "")), str(data.get("source", ""))))
    return tuple(found)


def scenes() -> tuple[str, ...]:
    """Names of the built-in cases that are scenes of beams."""
    return tuple(name for name in names() if "question" not in _data(name))


def opened(case: str) -> Scene:
    """The scene of a built-in case's name or of a file, as :func:`asked` finds it.

    Raises:
        SceneError: there is no such case, or the file is no valid scene.
    """
    from cprbm_scene import read  # loaded when a scene is asked, not to list the cases

    return _found(case, read)


def asked(case: str) -> Question:
    """The question of a built-in case's name or of a file.

    Args:
        case: a name of :func:`names`, or the path of a TOML file (anything that ends in ``.toml`` or holds
            a path separator).

    Raises:
        SceneError: there is no such case, or the file is no valid question.
    """
    from cprbm_scene import read_question

    return _found(case, read_question)


def argument(question: Question) -> str:
    """Name of a built-in case, or path of the file of a question, as the command line takes it."""
    file = Path(question.file)
    return file.stem if file.parent == Path(str(files(__name__))) else str(file)


def _found(case: str, reader: Callable[[str | Path], T]) -> T:
    if case in names():
        with as_file(files(__name__) / f"{case}.toml") as path:
            return reader(path)
    if case.endswith(".toml") or "/" in case or "\\" in case:
        return reader(case)
    from cprbm_scene import Mistake, SceneError
    from cprbm_scene.mistakes import hint

    here = Path(f"{case}.toml")
    meant = f" (is the file {here} meant?)" if here.is_file() else hint(case, names())
    allowed = f"a built-in case ({', '.join(names())}) or the path of a file that ends in .toml"
    raise SceneError([Mistake("case", repr(case) + meant, allowed)])


def _data(name: str) -> dict[str, Any]:
    return tomllib.loads((files(__name__) / f"{name}.toml").read_text(encoding="utf-8"))
