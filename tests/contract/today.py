"""The promises of today's program, beside the recording."""

import json
from collections.abc import Iterable, Mapping

from .declared import Change, meant, trouble
from .packages import Packages
from .promises import Promises, Value
from .recorder import library, program, promised_names
from .runs import unmet

COMMANDS = ("command", "group")
WHOLES = (*COMMANDS, "class", "function")
"""Values of items with further items under the same name."""


def visible(promised: Mapping[str, Value]) -> Promises:
    """The promises of a recording without the impossible situations."""
    hidden = unmet(promised)
    return {item: value for item, value in promised.items() if item not in hidden}


def today(promised: Mapping[str, Value], changes: Iterable[Change]) -> Promises:
    """A recording of today's program, under the recorded names and the declared further names."""
    changes = list(changes)
    moved = {new: promised[item] for change in changes for item in promised if (new := change.becoming(item))}
    both = {**promised, **moved}
    commands = {item for item, value in both.items() if value in COMMANDS}
    packages = {words[1] for item in both if len(words := item.split()) == 4 and words[2] == "exports"}
    return program(Packages(), commands) | library(promised_names(both), packages)


def undeclared(promised: Mapping[str, Value], now: Mapping[str, Value], changes: Iterable[Change]) -> str:
    """Broken and undeclared promises, as entries for ``declared.toml`` with blank reasons.

    An entry is about a command or a public name: a pattern where all items changed, else item by item.
    """
    covered = {item for each in changes if not each.shown_by for p in each.promise for item in meant(p, promised)}
    items = [item for item in promised if item not in covered and trouble(promised, now, item)]
    wholes = sorted((item for item, value in promised.items() if value in WHOLES), key=len, reverse=True)
    entries: dict[str, list[str]] = {}
    for item in items:
        owner = next((whole for whole in wholes if f"{item} ".startswith(f"{whole} ")), item)
        entries.setdefault(owner, []).append(item)
    drafts = []
    for owner, broken in entries.items():
        pattern = f"{owner} *"
        further = meant(pattern, promised)
        if further and {owner, *further} <= set(items):
            broken = [owner, pattern]
        drafts.append(f'[[change]]\npromise = {_lines(broken)}\nreason = ""\ninstead = ""\n')
    return "\n".join(drafts)


def _lines(items: list[str]) -> str:
    """A list in TOML with an item a line."""
    return "[\n" + "".join(f"    {json.dumps(item, ensure_ascii=False)},\n" for item in items) + "]"
