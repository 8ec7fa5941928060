"""Texts that are safe on a terminal."""

from __future__ import annotations


def printable(text: object) -> str:
    """Text with control characters, except line ends, as visible escapes: a path may hold commands of a terminal."""
    return "".join(repr(each)[1:-1] if _controls(each) else each for each in str(text))


def _controls(letter: str) -> bool:
    return letter != "\n" and (ord(letter) < 32 or 127 <= ord(letter) < 160)
