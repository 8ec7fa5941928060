"""How a scene ends: exactly one of seven ways, with the numbers that say how nearly it was another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

from comparisons.present.columns import Plain, plain


class Way(Enum):
    """The seven ways; the value is the key in JSON."""

    AGREE = "agree"
    UNDECIDED = "undecided"
    ENDED = "ended"
    REFUSED = "refused"
    CRASHED = "crashed"
    TIMED_OUT = "timed_out"
    WRONG = "wrong"

    @property
    def words(self) -> str:
        """The same for people."""
        return self.value.replace("_", " ")


@dataclass(frozen=True, slots=True)
class Outcome:
    """How one scene ended.

    Attributes:
        name: of the scene.
        way: in which it ended.
        sentence: which row decided, or what went wrong.
        ending: name of the :class:`cprbm_scene.Ending` of the run that ended early; empty of the other ways.
        difference: largest difference over what the solvers state together, of all rows; None where no rows stand.
        uncertainty: largest sum of what is stated, a fraction of the probe's scale; None likewise.
        beyond: the largest distance from an exact answer over what is stated; None where none is known.
        links, elements: per beam, in the coarser of the runs that decided; 0 where none did.
        seconds: of the processor.
        iterations: of all runs.
        stated: features that the scene has.
        met: features that its answer has.
        warnings: what the numerical libraries complained of.
    """

    name: str
    way: Way
    sentence: str
    ending: str = ""
    difference: float | None = None
    uncertainty: float | None = None
    beyond: float | None = None
    links: int = 0
    elements: int = 0
    seconds: float = 0.0
    iterations: int = 0
    stated: tuple[str, ...] = ()
    met: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def kind(self) -> tuple[Way, str]:
        """What two outcomes have in common that ended alike."""
        return self.way, self.ending


def packed(outcome: Outcome) -> Plain:
    """An outcome as plain data for JSON."""
    found: Plain = plain({**asdict(outcome), "way": outcome.way.value})
    found["outcome"] = found.pop("way")
    return found


def unpacked(data: Plain) -> Outcome:
    """The outcome that :func:`packed` made plain.

    Raises:
        KeyError: something is missing in ``data``, or is not known here.
    """
    rest: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in data.items() if key != "outcome"
    }
    return Outcome(way=_WAYS[data["outcome"]], **rest)


_WAYS: Mapping[str, Way] = {way.value: way for way in Way}


def totals(outcomes: Iterable[Outcome]) -> dict[Way, int]:
    """How many ended in each way, in the order of the ways."""
    ended = [outcome.way for outcome in outcomes]
    return {way: ended.count(way) for way in Way}


def shares(outcomes: Iterable[Outcome]) -> dict[str, float]:
    """Of each feature the share of scenes that have it, by name.

    What a scene states counts in all scenes; what only its answer shows, in those that agree: of the others
    no answer is trusted.
    """
    every = list(outcomes)
    agreed = [outcome for outcome in every if outcome.way is Way.AGREE]
    found: dict[str, float] = {}
    for mine, among in (([outcome.stated for outcome in every], every), ([one.met for one in agreed], agreed)):
        for feature in sorted({feature for features in mine for feature in features}):
            found[feature] = sum(feature in features for features in mine) / len(among)
    return found
