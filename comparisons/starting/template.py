"""Texts of a scene to start from, and of the schema of scenes."""

from __future__ import annotations

import json
from importlib.resources import files

from cprbm_scene.reading import schema

SCHEMA = "scene.schema.json"
"""Name of the schema's file, beside the scene that refers to it."""


def text(name: str, file: str) -> str:
    """The first scene, commented, under a ``name``, with commands for a ``file``."""
    template = files("comparisons.starting").joinpath("scene.toml").read_text(encoding="utf-8")
    return template.replace("{schema}", SCHEMA).replace("{name}", name).replace("{file}", file)


def schema_text() -> str:
    """The JSON schema of scene files, with a line end."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"
