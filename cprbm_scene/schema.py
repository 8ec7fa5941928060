"""JSON schema of a scene file: editors complete keys and mark mistakes with it.

The schema follows from the records.  Rules between records need the reader.
"""

from __future__ import annotations

from typing import Any

from cprbm_scene.statement import Scene

DIALECT = "http://json-schema.org/draft-07/schema#"
"""Dialect of the schema that editors of TOML know."""


def schema() -> dict[str, Any]:
    """The schema as plain data."""
    found = Scene.model_json_schema(mode="validation")
    # the name of the file is no key of the file
    found["properties"].pop("file")
    return {"$schema": DIALECT, **found, "title": "Scene"}
