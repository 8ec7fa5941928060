"""The JSON schema of a scene file, by which editors complete keys and mark mistakes as they are typed.

It is made from the records, and says of keys and kinds what they say.  What ties records together is beyond a schema,
and told by reading.
"""

from __future__ import annotations

from typing import Any

from cprbm_scene.statement import Scene

DIALECT = "http://json-schema.org/draft-07/schema#"
"""What editors of TOML know best; nothing here needs a later one."""


def schema() -> dict[str, Any]:
    """The schema as plain data."""
    found = Scene.model_json_schema(mode="validation")
    # where a scene was read from is no key of a file
    found["properties"].pop("file")
    return {"$schema": DIALECT, **found, "title": "Scene"}
