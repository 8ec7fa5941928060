"""Plain data in the types of JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

Plain = dict[str, Any]


def text_of(data: Mapping[str, Any], indent: int | None = 1) -> str:
    """``data`` as JSON with a line end; without an ``indent`` in a single line.

    Raises:
        ValueError: a number in ``data`` is not finite.
    """
    return (
        json.dumps(data, indent=indent, ensure_ascii=False, allow_nan=False, separators=None if indent else (",", ":"))
        + "\n"
    )


def plain(value: object) -> Any:  # noqa: ANN401 - all types of JSON
    """``value`` in the types of JSON; None for a number without a finite value."""
    match value:
        case Mapping():
            return {str(key): plain(item) for key, item in value.items()}
        case list() | tuple():
            return [plain(item) for item in value]
        case np.ndarray():
            whole = value.dtype.kind != "f" or bool(np.isfinite(value).all())
            return value.tolist() if whole else plain(value.tolist())
        case bool() | int() | str() | None:
            return value
        case float() | np.floating():
            return float(value) if math.isfinite(value) else None
        case _:
            return str(value)
