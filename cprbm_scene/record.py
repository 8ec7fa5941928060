"""Base of all records of a scene, and common types: names, tables of names, references, rules.

A reference to another part of the scene states the kind of the part, ``Annotated[Name, Of("beam")]``; a walk over the
records finds all references (:mod:`cprbm_scene.names`).  The rules of a record yield the mistakes between
its fields, with keys below the record's key; a walk over the records finds all mistakes (:mod:`cprbm_scene.reading`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, StringConstraints

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake

T = TypeVar("T")

_LETTERS = "A-Za-z_À-ÖØ-öø-ɏΑ-Ωα-ω"
Name = Annotated[str, StringConstraints(pattern=f"^[{_LETTERS}][{_LETTERS}0-9-]*$", max_length=64)]
"""Latin and Greek letters, digits, '_' and '-': names are parts of file names, of HTML identifiers and of options."""
Text = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x08\x0b-\x1f\x7f-\x9f]*$")]
"""Text without control characters, but for tabs and line ends."""
Title = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
"""Text of one line without control characters."""


def _freeze(value: Mapping[str, T]) -> Mapping[str, T]:
    return frozendict(value)


Named = Annotated[Mapping[Name, T], AfterValidator(_freeze)]


@dataclass(frozen=True, slots=True)
class Of:
    """Kind of the named part of the scene, such as ``beam``; a tuple or table names several, at another ``key``."""

    kind: str
    key: str = ""


class Record(BaseModel):
    """Immutable record with strict types, without unknown keys, with finite numbers only."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    def rules(self) -> Iterator[Mistake]:
        """Mistakes between the record's own fields, with keys below the record's own; none by default."""
        return iter(())


def nonzero(key: str, direction: tuple[float, float] | None) -> Iterator[Mistake]:
    """The mistake of a direction [0, 0] at ``key``; no mistake without a direction."""
    if direction == (0.0, 0.0):
        yield Mistake(key, "[0, 0]", "a direction, at least one number not zero")
