"""A scene file to start from."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

from comparisons.writing import write
from cprbm_scene.reading import schema

SCHEMA = "scene.schema.json"
"""Name of the schema's file, beside the scene that refers to it."""


def text(name: str) -> str:
    """The first scene, commented, under a ``name`` of letters, digits, ``_`` and ``-``."""
    template = files("comparisons.starting").joinpath("scene.toml").read_text(encoding="utf-8")
    return template.replace("{schema}", SCHEMA).replace("{name}", name).replace("{file}", f"{name}.toml")


def begin(name: str, folder: Path) -> Path:
    """Write the first scene and its schema into a ``folder``; the scene's file.

    Raises:
        FileExistsError: there is a file of that name already, which is left as it is.
        OSError: the folder cannot be written to.
    """
    path = folder / f"{name}.toml"
    if path.exists():
        raise FileExistsError(path)
    write(path, text(name))
    write(folder / SCHEMA, json.dumps(schema(), indent=1, ensure_ascii=False) + "\n")
    return path
