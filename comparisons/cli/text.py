"""Texts that are safe on a terminal."""

from __future__ import annotations

_CONTROLS = {*map(chr, (*range(32), *range(127, 160)))} - {"\n"}


def printable(text: object) -> str:
    """Text with control characters, except line ends, as visible escapes: a path may hold commands of a terminal."""
    return "".join(repr(each)[1:-1] if each in _CONTROLS else each for each in str(text))
