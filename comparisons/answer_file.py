"""Answers as a file: compressed JSON in which every array stands as a number.

Equal arrays stand once.  The file has the shapes of all arrays, and the bytes of all their numbers: the first bytes of
all numbers, the second bytes, and so on.  Neighbours have mostly the same sign, exponent and first digits, and so these
bytes take less room together.
"""

import gzip
import json
import math
import zlib
from base64 import b64decode, b64encode
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np

from cprbm_scene import Answer, Array, frozendict

DAMAGES = (EOFError, zlib.error, gzip.BadGzipFile, KeyError, IndexError, TypeError, ValueError)
"""Errors of :func:`unpacked` on damaged bytes."""

_COMPRESSION = 4
"""Level of gzip: level 6 takes 2.5 times as long for two per cent."""

Places = dict[tuple[tuple[int, ...], bytes], int]
"""Numbers of arrays by shape and bytes."""


def packed(answers: Mapping[str, Answer]) -> bytes:
    """Answers by name as bytes; equal answers give equal bytes.

    A single number that is not finite becomes null, a member of an enumeration its name.
    """
    places: Places = {}
    data = {name: _plain(answer, places) for name, answer in answers.items()}
    numbers = np.frombuffer(b"".join(content for _, content in places), np.uint8)
    document = {
        "answers": data,
        "shapes": [shape for shape, _ in places],
        "bytes": b64encode(zlib.compress(numbers.reshape(-1, 8).T.tobytes())).decode("ascii"),
    }
    text = json.dumps(document, ensure_ascii=False, allow_nan=False)
    return gzip.compress(text.encode("utf-8"), _COMPRESSION, mtime=0)  # the header has no time


def unpacked(content: bytes) -> dict[str, Answer]:
    """The answers of :func:`packed` by name; fields that the content lacks have their defaults.

    Raises:
        ValueError: ``content`` has no answers; other errors of damaged bytes are in ``DAMAGES``.
    """
    document = json.loads(gzip.decompress(content))
    shapes, numbers = document["shapes"], np.frombuffer(zlib.decompress(b64decode(document["bytes"])), np.uint8)
    whole = np.ascontiguousarray(numbers.reshape(8, -1).T).view("<f8").ravel()
    whole.setflags(write=False)
    ends = np.cumsum([math.prod(shape) for shape in shapes], dtype=int)
    arrays = [part.reshape(shape) for part, shape in zip(np.split(whole, ends)[:-1], shapes, strict=True)]
    return {name: _value(Answer, data, arrays) for name, data in document["answers"].items()}


def read_answers(path: str | Path) -> dict[str, Answer]:
    """The answers of the file ``answers.json.gz`` in the folder of a report, by name of the run.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file is damaged; other errors of damaged files are in ``DAMAGES``.
    """
    return unpacked(Path(path).read_bytes())


def _plain(value: Any, places: Places) -> Any:  # noqa: ANN401 - a field of a record, and JSON
    """``value`` in the types of JSON; an array becomes its number in ``places``."""
    match value:
        case Enum():
            return value.name
        case Mapping():
            return {key: _plain(each, places) for key, each in value.items()}
        case np.ndarray():
            return places.setdefault((value.shape, np.asarray(value, "<f8").tobytes()), len(places))
        case tuple() | list():
            return [_plain(each, places) for each in value]
        case float():
            return float(value) if math.isfinite(value) else None
        case _ if is_dataclass(value):
            return {each.name: _plain(getattr(value, each.name), places) for each in fields(value)}
    return value


_hints = cache(get_type_hints)


def _value(kind: Any, data: Any, arrays: list[Array]) -> Any:  # noqa: ANN401 - a type of an annotation, and JSON
    """The value of plain ``data`` for a field with the annotation ``kind``."""
    parts = get_args(kind)
    if NoneType in parts:
        return None if data is None else _value(parts[0], data, arrays)
    origin = get_origin(kind)
    if origin is np.ndarray:
        return arrays[data]
    if origin is tuple:
        return tuple(_value(parts[0], each, arrays) for each in data)
    if origin is not None:
        return frozendict({key: _value(parts[1], each, arrays) for key, each in data.items()})
    if isinstance(kind, type) and is_dataclass(kind):
        hints = _hints(kind)
        return kind(**{key: _value(hints[key], each, arrays) for key, each in data.items()})
    if isinstance(kind, type) and issubclass(kind, Enum):
        return kind[data]
    return math.nan if kind is float and data is None else data
