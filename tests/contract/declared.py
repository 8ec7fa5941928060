"""Declared changes: which promises end or alter, why, and what a user does instead."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path

from .promises import Value

DECLARED = Path(__file__).parent / "declared.toml"


@dataclass(frozen=True)
class Change:
    """One declared change.

    Attributes:
        promise: items that the change ends, moves or alters; in each ``*`` stands for any text.
        reason: why.
        instead: what a user does from now on.
        becomes: for each item of ``promise`` the item under which the promise goes on, with as many ``*``.
        value: what is promised from now on, where a value alters.
        shown_by: a command line that only a checkout takes; with it the promise goes on in a checkout, and ends in an
            installed package, which refuses the command line with exit code 2.
    """

    promise: tuple[str, ...]
    reason: str
    instead: str
    becomes: tuple[str, ...] = ()
    value: Value | None = None
    shown_by: tuple[str, ...] = ()

    def __post_init__(self):
        """See that the change says all of what it must.

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
        """The item under which a promise goes on; None for one that ends or is not meant."""
        for pattern, new in zip(self.promise, self.becomes, strict=False):
            found = _meant(pattern, item)
            if found:
                parts = zip(new.split("*"), (*found.groups(), ""), strict=True)
                return "".join(part + text for part, text in parts)
        return None


def _meant(pattern: str, item: str) -> re.Match[str] | None:
    return re.fullmatch("(.*)".join(map(re.escape, pattern.split("*"))), item)


def meant(pattern: str, items: Iterable[str]) -> list[str]:
    """The items that a pattern stands for."""
    return [item for item in items if _meant(pattern, item)]


def declared(file: Path = DECLARED) -> list[Change]:
    """The changes in a file.

    Raises:
        ValueError: a change has a key that means nothing, or says too little.
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
    """How the program breaks a promise, looked for under its own item or under another; empty where it is kept."""
    value = promised[item]
    if (under or item) not in now:
        return "is gone"
    found = now[under or item]
    if isinstance(value, list) and isinstance(found, list):
        further = [demand for demand in found if demand not in value]
        return f"demands {', '.join(further)}, which 3c78333 did not" if further else ""
    return "" if found == value else f"was {value!r} and is {found!r}"


def broken(promised: Mapping[str, Value], now: Mapping[str, Value], changes: Iterable[Change] = ()) -> list[str]:
    """What is wrong between a recording, the program and the declared changes; one sentence for each fault.

    Args:
        promised: the recording.
        now: what the program keeps, of at least the promised items and those that they become.
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
        for change in covering if wrong else ():
            sentences += _unkept(promised, now, change, item)
    return sentences


def _unkept(promised: Mapping[str, Value], now: Mapping[str, Value], change: Change, item: str) -> list[str]:
    """Where a promise that moves or alters is not kept as the change says."""
    under = change.becoming(item)
    if under is not None and (wrong := trouble(promised, now, item, under)):
        return [f"The promise '{item}' is declared to become '{under}', which {wrong}. Mend the program or the change."]
    if change.value is not None and now.get(item) != change.value:
        found = repr(now[item]) if item in now else "gone"
        said = f"The promise '{item}' is declared to be {change.value!r} and is {found}."
        return [f"{said} Mend the program or the change."]
    return []


def _stale(promised: Mapping[str, Value], now: Mapping[str, Value], change: Change) -> list[str]:
    """Where a change is declared of no promise, or of promises that are kept."""
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
