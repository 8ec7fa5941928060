"""Answers as a file: compressed JSON in which every array stands as a row of a column of integers.

A column has the arrays of one name and shape, in the order of the stations.  Let b[k, i] be the 64 bits of number i at
station k, read as an integer.  The integer grows with the number, so it is as smooth along stations and places as the
number.  The differences along both have mostly zero leading bits:

    d = Δᵢᑫ Δₖᵖ b  (mod 2⁶⁴),    z = 2d for d ≥ 0,  -2d - 1 for d < 0.

The orders p and q belong to the column: they grow by one, along the better axis, as long as z has fewer bits.  Integers
of fixed size add and subtract without rounding: the sums of the differences are the bits of the numbers.  The file has
the orders, then the first bytes of all z, the second bytes, and so on, compressed.  Equal arrays stand once.
"""

import gzip
import json
import math
import zlib
from base64 import b64decode, b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import Answer, Array, frozendict
from cprbm_scene.answer import frozen_array

DAMAGES = (EOFError, zlib.error, gzip.BadGzipFile, KeyError, IndexError, TypeError, ValueError)
"""Errors of :func:`unpacked` on damaged bytes."""

_COMPRESSION = 4
"""Level of gzip: level 6 takes 2.5 times as long for two per cent."""

Integers = NDArray[np.int64]


def packed(answers: Mapping[str, Answer]) -> bytes:
    """Answers by name as bytes; equal answers give equal bytes.

    A single number that is not finite becomes null, a member of an enumeration its name.
    """
    columns = _Columns()
    data = {name: columns.plain(answer, (name,)) for name, answer in answers.items()}
    text = json.dumps({"answers": data, **columns.document()}, ensure_ascii=False, allow_nan=False)
    return gzip.compress(text.encode("utf-8"), _COMPRESSION, mtime=0)  # the header has no time


def unpacked(content: bytes) -> dict[str, Answer]:
    """The answers of :func:`packed` by name; fields that the content lacks have their defaults.

    Raises:
        ValueError: ``content`` has no answers; other errors of damaged bytes are in ``DAMAGES``.
    """
    document = json.loads(gzip.decompress(content))
    arrays = _read_columns(document)
    return {name: _value(Answer, data, arrays) for name, data in document["answers"].items()}


def read_answers(path: str | Path) -> dict[str, Answer]:
    """The answers of the file ``answers.json.gz`` in the folder of a report, by name of the run.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file is damaged; other errors of damaged files are in ``DAMAGES``.
    """
    return unpacked(Path(path).read_bytes())


@dataclass(frozen=True, slots=True)
class _Columns:
    """Number and rows of every column by name and shape, and the place of every array by its shape and bytes."""

    arrays: dict[tuple[tuple[str, ...], tuple[int, ...]], tuple[int, list[Array]]] = field(default_factory=dict)
    places: dict[tuple[tuple[int, ...], bytes], tuple[int, int]] = field(default_factory=dict)

    def plain(self, value: Any, name: tuple[str, ...]) -> Any:  # noqa: ANN401 - a field of a record, and JSON
        """``value`` in the types of JSON; an array becomes the number of its column and its row there."""
        match value:
            case Enum():
                return value.name
            case Mapping():
                return {key: self.plain(each, (*name, key)) for key, each in value.items()}
            case np.ndarray():
                return self._place(np.asarray(value, "<f8"), name)
            case tuple() | list():
                return [self.plain(each, name) for each in value]
            case float():
                return float(value) if math.isfinite(value) else None
            case _ if is_dataclass(value):
                return {each.name: self.plain(getattr(value, each.name), (*name, each.name)) for each in fields(value)}
        return value

    def _place(self, array: Array, name: tuple[str, ...]) -> tuple[int, int]:
        content = array.shape, array.tobytes()
        if content not in self.places:
            number, rows = self.arrays.setdefault((name, array.shape), (len(self.arrays), []))
            self.places[content] = number, len(rows)
            rows.append(array)
        return self.places[content]

    def document(self) -> dict[str, Any]:
        """Number of rows and shape of every column, and the differences of all."""
        columns = [np.array(rows) for _, rows in self.arrays.values()]
        found = [_differences(each.view("<i8")) for each in columns]
        joined = np.concatenate([each.ravel() for each, _ in found], dtype="<i8") if found else np.zeros(0, "<i8")
        planes = _signless(joined).view(np.uint8).reshape(-1, 8).T.tobytes()
        return {
            "columns": [each.shape for each in columns],
            "orders": [orders for _, orders in found],
            "differences": b64encode(zlib.compress(planes)).decode("ascii"),
        }


def _read_columns(document: Mapping[str, Any]) -> list[Array]:
    """The read-only columns of :meth:`_Columns.document`."""
    shapes, orders, differences = (document[key] for key in ("columns", "orders", "differences"))
    planes = np.frombuffer(zlib.decompress(b64decode(differences)), np.uint8)
    signless = np.ascontiguousarray(planes.reshape(8, -1).T).view("<u8").ravel()
    joined = (signless >> np.uint64(1)).view("<i8") ^ -(signless & np.uint64(1)).view("<i8")
    parts = np.split(joined, np.cumsum([math.prod(shape) for shape in shapes])[:-1]) if shapes else []
    return [
        frozen_array(_sums(part.reshape(shape), order).view("<f8"))
        for part, shape, order in zip(parts, shapes, orders, strict=True)
    ]


def _signless(integers: Integers) -> Integers:
    return (integers << 1) ^ (integers >> 63)


def _differences(integers: Integers) -> tuple[Integers, list[int]]:
    """Differences of a column with the fewest bits, and their orders along stations and along places."""
    orders, bits = [0, 0], _bits(integers)
    while (found := min((_bits(np.diff(integers, axis=axis, prepend=0)), axis) for axis in (0, 1)))[0] < bits:
        bits, axis = found
        integers, orders[axis] = np.diff(integers, axis=axis, prepend=0), orders[axis] + 1
    return integers, orders


def _bits(integers: Integers) -> float:
    """Number of bits without leading zeros."""
    return float(np.log2(1.0 + _signless(integers).view(np.uint64)).sum())


def _sums(integers: Integers, orders: Sequence[int]) -> Integers:
    for axis, order in enumerate(orders):
        for _ in range(order):
            integers = np.cumsum(integers, axis=axis)
    return integers


_hints = cache(get_type_hints)


def _value(kind: Any, data: Any, arrays: list[Array]) -> Any:  # noqa: ANN401 - a type of an annotation, and JSON
    """The value of plain ``data`` for a field with the annotation ``kind``."""
    parts = get_args(kind)
    if NoneType in parts:
        return None if data is None else _value(parts[0], data, arrays)
    origin = get_origin(kind)
    if origin is np.ndarray:
        return arrays[data[0]][data[1]]
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
