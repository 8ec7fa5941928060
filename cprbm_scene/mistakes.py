"""A wrong question, said so that its author can mend it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import islice

_LISTED = 200
"""Names that a mistake lists, and among which one that may have been meant is sought."""


@dataclass(frozen=True, slots=True)
class Mistake:
    """One thing that is wrong with a problem statement.

    Attributes:
        key: the key path in the file, such as ``beams.beam1.thickness``; empty for the file as a whole.
        found: what stands there.
        allowed: what may stand there.
        file: the file it was read from; empty for a scene built in Python.
    """

    key: str
    found: str
    allowed: str
    file: str = ""

    def __str__(self) -> str:
        where = ": ".join(part for part in (self.file, self.key) if part) or "scene"
        return f"{where}: found {self.found}; allowed: {self.allowed}"


MOST = 100
"""Mistakes that are told at once: who made more has made one of them everywhere."""


class SceneError(ValueError):
    """The question was wrong: every mistake that was found, none twice, up to :data:`MOST`."""

    def __init__(self, mistakes: list[Mistake] | tuple[Mistake, ...]) -> None:
        self.mistakes = tuple(dict.fromkeys(mistakes))
        super().__init__("\n".join(str(mistake) for mistake in self.mistakes))


def first_of(found: Iterable[Mistake], file: str = "") -> list[Mistake]:
    """The first mistakes of those that are found, no more being looked for, and a word if there are more."""
    some = list(islice(found, MOST + 1))
    return some if len(some) <= MOST else [*some[:MOST], Mistake("", "more mistakes", "none; mend these first", file)]


def hint(word: str, known: Iterable[str]) -> str:
    """`` (is 'X' meant?)`` if one of the ``known`` words is near to a ``word``, in whatever case; else nothing."""
    by_case = {each.casefold(): each for each in known}
    near = get_close_matches(word.casefold(), by_case, n=1)
    # of words as short as a unit any two are near
    told = near and (len(word) > 2 or near[0] == word.casefold())
    return f" (is {by_case[near[0]]!r} meant?)" if told else ""


def unknown_name(key: str, name: str, what: str, known: Iterable[str]) -> Mistake:
    """The mistake of naming a ``what`` (such as ``beam``) that is not among the ``known``."""
    names = list(islice(known, _LISTED + 1))
    listed = ", ".join(repr(each) for each in names[:_LISTED]) or "there is none"
    listed += ", ..." if len(names) > _LISTED else ""
    return Mistake(key, f"{name!r}, which names no {what}{hint(name, names)}", f"the name of a {what}: {listed}")


def written_place(place: tuple[float, float]) -> str:
    """A place as a mistake says it."""
    return f"({place[0]:.9g}, {place[1]:.9g})"
