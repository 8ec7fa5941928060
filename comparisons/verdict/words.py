"""Words and reasons of a verdict, and their order of severity."""

from collections.abc import Iterable
from enum import Enum
from typing import TypeVar

T = TypeVar("T")


class Word(Enum):
    """AGREE, DIFFER or UNDECIDED."""

    AGREE = "AGREE"
    DIFFER = "DIFFER"
    UNDECIDED = "UNDECIDED"


class Reason(Enum):
    """Why a row, an event or a case does not agree; the first three belong to DIFFER, all others to UNDECIDED."""

    VALUES = "VALUES"
    EXACT = "EXACT"
    EVENTS = "EVENTS"
    RUN_ENDED = "RUN_ENDED"
    AUDIT = "AUDIT"
    UNDECLARED_CONTACT = "UNDECLARED_CONTACT"
    BRANCH = "BRANCH"
    EVENT = "EVENT"
    THEORY = "THEORY"
    COARSE = "COARSE"
    NOT_UNIQUE = "NOT_UNIQUE"


SEVERITY = (Word.DIFFER, Word.UNDECIDED, Word.AGREE)
"""Words from the worst to the best."""


def worst_of(words: Iterable[Word | None]) -> Word | None:
    """DIFFER before UNDECIDED before AGREE; None without a word."""
    found = set(words)
    return next((word for word in SEVERITY if word in found), None)


def first_met(rules: Iterable[tuple[bool, T]], otherwise: T) -> T:
    """The result of the first rule that is met, of pairs of a condition and a result."""
    return next((result for met, result in rules if met), otherwise)
