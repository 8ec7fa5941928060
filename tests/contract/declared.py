"""Declared changes: promises that end or alter, the reasons, and the advice to users."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

from .promises import Value

DECLARED = Path(__file__).parent / "declared.toml"


@dataclass(frozen=True)
class Change:
    """One declared change.

    Attributes:
        promise: patterns of the items under change; ``*`` stands for any text.
        reason: why the promise changes.
        instead: the advice to users.
        becomes: further names of the items, in the order of ``promise``, with the same number of ``*``.
        value: the value of the promise from now on.
        shown_by: a command line for checkouts only. The promise holds in a checkout; an installed package refuses the
            command line with exit code 2.
    """

    promise: tuple[str, ...]
    reason: str
    instead: str
    becomes: tuple[str, ...] = ()
    value: Value | None = None
    shown_by: tuple[str, ...] = ()

    def __post_init__(self):
        """Check the parts of the change against one another.

        Raises:
            ValueError: a part is missing, or two parts contradict each other.
        """
        if not (self.promise and self.reason.strip() and self.instead.strip()):
            raise ValueError(f"{self.promise}: a change needs a promise, a reason, and what to use instead")
        if sum((bool(self.becomes), self.value is not None, bool(self.shown_by))) > 1:
            raise ValueError(f"{self.promise}: found several of becomes, value and shown_by; allowed: one of them")
        if self.becomes:
            stars = [(a.count("*"), b.count("*")) for a, b in zip(self.promise, self.becomes, strict=True)]
            if any(a != b for a, b in stars):
                raise ValueError(f"{self.promise}: an item and what it becomes have the same number of '*'")

    def becoming(self, item: str) -> str | None:
        """The further name of an item; None where the promise ends, or where no pattern matches."""
        for pattern, new in zip(self.promise, self.becomes, strict=False):
            found = _meant(pattern, item)
            if found:
                parts = zip(new.split("*"), (*found.groups(), ""), strict=True)
                return "".join(part + text for part, text in parts)
        return None


@cache
def _expression(pattern: str) -> re.Pattern[str]:
    return re.compile("(.*)".join(map(re.escape, pattern.split("*"))))


def _meant(pattern: str, item: str) -> re.Match[str] | None:
    return _expression(pattern).fullmatch(item)


def meant(pattern: str, items: Iterable[str]) -> list[str]:
    """The items under a pattern."""
    return [item for item in items if _meant(pattern, item)]


def declared(file: Path = DECLARED) -> list[Change]:
    """The changes in a file.

    Raises:
        ValueError: a change has an unknown key, or lacks a part.
    """
    changes = []
    known = {field.name for field in fields(Change)}
    for table in tomllib.loads(file.read_text("utf-8")).get("change", ()):
        if unknown := set(table) - known:
            raise ValueError(f"{file.name}: found {', '.join(sorted(unknown))}; allowed: {', '.join(sorted(known))}")
        lists = {
            key: (value,) if isinstance(value, str) else tuple(value)
            for key, value in table.items()
            if key in ("promise", "becomes", "shown_by")
        }
        changes.append(Change(**{"reason": "", "instead": "", **table, **lists}))
    return changes


def trouble(promised: Mapping[str, Value], now: Mapping[str, Value], item: str, under: str = "") -> str:
    """How the program breaks a promise, under its own or a further name; empty for a kept promise."""
    value = promised[item]
    if (under or item) not in now:
        return "is gone"
    found = now[under or item]
    if isinstance(value, list) and isinstance(found, list):
        further = [demand for demand in found if demand not in value]
        return f"demands {', '.join(further)}, which 3c78333 did not" if further else ""
    return "" if found == value else f"was {value!r} and is {found!r}"


def broken(promised: Mapping[str, Value], now: Mapping[str, Value], changes: Iterable[Change] = ()) -> list[str]:
    """Sentences about broken promises and stale changes; none where the program and the recording agree.

    Args:
        promised: the recording.
        now: a recording of today's program, with the further names of items.
        changes: the declared changes.
    """
    changes = list(changes)
    sentences = [sentence for change in changes for sentence in _stale(promised, now, change)]
    for item in promised:
        wrong = trouble(promised, now, item)
        covering = [each for each in changes if not each.shown_by and any(_meant(p, item) for p in each.promise)]
        if wrong and not covering:
            advice = "Keep the promise, or declare the change in tests/contract/declared.toml."
            sentences.append(f"The promise '{item}' {wrong}. {advice}")
        for change in covering[-1:] if wrong else ():  # a later change of the same item counts
            sentences += _unkept(promised, now, change, item)
    return sentences


def _unkept(promised: Mapping[str, Value], now: Mapping[str, Value], change: Change, item: str) -> list[str]:
    """Sentences about a declared change without effect in the program."""
    under = change.becoming(item)
    if under is not None and (wrong := trouble(promised, now, item, under)):
        return [f"The promise '{item}' is declared to become '{under}', which {wrong}. Mend the program or the change."]
    if change.value is not None and now.get(item) != change.value:
        found = repr(now[item]) if item in now else "gone"
        said = f"The promise '{item}' is declared to be {change.value!r} and is {found}."
        return [f"{said} Mend the program or the change."]
    return []


def _stale(promised: Mapping[str, Value], now: Mapping[str, Value], change: Change) -> list[str]:
    """Sentences about a change of no promise, or of kept promises."""
    sentences = []
    for pattern in change.promise:
        items = meant(pattern, promised)
        if not items:
            sentences.append(f"The declared change of '{pattern}' is of no promise. Correct the change or delete it.")
        kept = [] if change.shown_by else [item for item in items if not trouble(promised, now, item)]
        sentences += [
            f"The promise '{item}' is declared to change by '{pattern}', and is kept. Delete or narrow the change."
            for item in kept
        ]
    return sentences
