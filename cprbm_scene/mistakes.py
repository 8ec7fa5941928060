"""Mistakes of a question, with the key, the value found and the values allowed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import islice

import numpy as np
from numpy.typing import NDArray

_LISTED = 200
"""Largest number of names in a message."""

_MEANT = {
    "gravity": ("distributed", "a load of kind 'distributed'"),
    "weight": ("distributed", "a load of kind 'distributed'"),
    "torque": ("moment", "a load of kind 'moment'"),
    "clamp": ("weld", "an end with joint = 'weld'"),
    "hinge": ("pin", "an end with joint = 'pin'"),
    "roller": ("slides", "a body with motion = 'slides'"),
    "pivot": ("turns", "a body with motion = 'turns'"),
    "circle": ("arc", "a curve of kind 'arc'"),
    "straight": ("line", "a curve of kind 'line'"),
}
"""Words of other programs; the words of a scene for the same, alone and with their place in a file."""
_NOT_MODELLED = re.compile("friction|temperature|thermal|plastic|yield|damping|density|mass|viscos", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Mistake:
    """A mistake of a problem statement.

    Attributes:
        key: the key path in the file, such as ``beams.beam1.thickness``; empty for the file as a whole.
        found: the value found.
        allowed: the values allowed.
        file: the name of the file; empty for a scene built in Python.
    """

    key: str
    found: str
    allowed: str
    file: str = ""

    def __str__(self) -> str:
        where = ": ".join(part for part in (self.file, self.key) if part) or "scene"
        return f"{where}: found {self.found}; allowed: {self.allowed}"


def broken(*rules: object) -> Iterator[Mistake]:
    """Mistakes of the broken rules, in order; a rule is ``condition and Mistake(...)``, true where it is broken."""
    return (rule for rule in rules if isinstance(rule, Mistake))


def first_broken(*rules: object) -> Iterator[Mistake]:
    """The mistake of the first broken rule, if any."""
    return islice(broken(*rules), 1)


MOST = 100
"""Largest number of mistakes in an error: a larger number repeats a single mistake."""


class SceneError(ValueError):
    """A wrong question: all different mistakes, up to :data:`MOST`."""

    def __init__(self, mistakes: list[Mistake] | tuple[Mistake, ...]) -> None:
        self.mistakes = tuple(dict.fromkeys(mistakes))
        super().__init__("\n".join(str(mistake) for mistake in self.mistakes))


def first_of(found: Iterable[Mistake], file: str = "") -> list[Mistake]:
    """The first :data:`MOST` mistakes, and a note if there are more."""
    some = list(islice(found, MOST + 1))
    return some if len(some) <= MOST else [*some[:MOST], Mistake("", "more mistakes", "none; mend these first", file)]


def hint(word: str, known: Iterable[str]) -> str:
    """`` (is 'X' meant?)`` for a ``word`` close to a ``known`` word, upper or lower case; otherwise an empty text."""
    by_case, same = {each.casefold(): each for each in known}, word.casefold()
    term, place = _MEANT.get(same, ("", ""))
    near = [term] if term in by_case and same not in by_case else get_close_matches(same, by_case, n=1)
    # any two words as short as a unit are close
    if near and (len(word) > 2 or near[0] == same):
        return f" (is {by_case[near[0]]!r} meant?)"
    if _NOT_MODELLED.search(word):
        return f" ({word} is not modelled)"
    return f" (is {place} meant?)" if place else ""


def unknown_name(key: str, name: str, what: str, known: Iterable[str]) -> Mistake:
    """The mistake of a name of a ``what`` (such as ``beam``) outside the ``known`` names."""
    names = list(islice(known, _LISTED + 1))
    listed = ", ".join(repr(each) for each in names[:_LISTED]) or "there is none"
    listed += ", ..." if len(names) > _LISTED else ""
    return Mistake(key, f"{name!r}, which names no {what}{hint(name, names)}", f"the name of a {what}: {listed}")


def written_place(place: Sequence[float] | NDArray[np.float64]) -> str:
    """A place as text."""
    return f"({place[0]:.9g}, {place[1]:.9g})"
