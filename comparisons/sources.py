"""What a number hangs on besides its question: the program, the libraries that it computes with, and Python."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

_ROOMS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
_LIBRARIES = ("numpy", "scipy", "scikit-fem")


@cache
def program(*further: str) -> str:
    """A digest of all sources, those of ``further`` packages among them, and of what they compute with."""
    digest = sha256(sys.version.encode())
    for library in _LIBRARIES:
        digest.update(f"{library} {version(library)}\n".encode())
    sources = [source for room in (*_ROOMS, *further) for source in _sources(files(room))]
    for source in sorted(source.name.encode() + b"\0" + source.read_bytes() for source in sources):
        digest.update(source)
    return digest.hexdigest()


def _sources(folder: Traversable) -> Iterator[Traversable]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _sources(entry)
        elif entry.name.endswith(".py"):
            yield entry
