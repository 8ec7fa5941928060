"""What a verdict says."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum


class Word(Enum):
    """What a verdict says."""

    AGREE = "AGREE"
    DIFFER = "DIFFER"
    UNDECIDED = "UNDECIDED"


def worst_of(words: Iterable[Word | None]) -> Word | None:
    """DIFFER before UNDECIDED before AGREE; None where nobody says anything."""
    said = set(words)
    return next((word for word in (Word.DIFFER, Word.UNDECIDED, Word.AGREE) if word in said), None)
