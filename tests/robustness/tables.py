"""Tables, sentence and documented JSON of a run of random scenes."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from comparisons.formats import number, percent
from comparisons.present.columns import Plain, Table, plain
from tests.robustness.outcomes import Outcome, Way, packed, shares, totals
from tests.robustness.running import Stress

_WORST: dict[str, Callable[[Outcome], float | None]] = {
    "difference": lambda outcome: outcome.difference,
    "uncertainty": lambda outcome: outcome.uncertainty,
    "beyond": lambda outcome: outcome.beyond,
    "seconds": lambda outcome: outcome.seconds,
    "iterations": lambda outcome: float(outcome.iterations),
}
_WHAT = {
    "difference": "difference over what is stated",
    "uncertainty": "stated uncertainty, of the scale",
    "beyond": "distance from the exact answer over what is stated",
    "seconds": "seconds of the processor",
    "iterations": "iterations of all runs",
}
_OF_AGREEMENT = frozenset({"difference", "uncertainty", "beyond"})


def document(there: Stress) -> Plain:
    """The documented JSON; of scenes without an outcome yet nothing is told."""
    outcomes = list(there.outcomes.values())
    found: Plain = {"scenes": len(outcomes), **{way.value: count for way, count in totals(outcomes).items()}}
    return {
        **found,
        "strata": shares(outcomes),
        "worst": {
            name: None if worst is None else {"scene": worst.name, "value": plain(_WORST[name](worst))}
            for name, worst in _worst(outcomes).items()
        },
        "seed": there.plan.seed,
        "records": [
            {"index": index, **packed(outcome), "file": there.saved.get(index)}
            for index, outcome in there.outcomes.items()
        ],
    }


def sheets_of(there: Stress) -> tuple[Table, ...]:
    """How many ended in which way; what came nearest to another; what the scenes have; every one that failed."""
    outcomes = list(there.outcomes.values())
    every = max(len(outcomes), 1)
    counts = {way.words: count for way, count in totals(outcomes).items()}
    ways = tuple((said, str(count), percent(count / every)) for said, count in counts.items() if outcomes)
    worst = tuple(
        (_WHAT[name], number(value), outcome.name)
        for name, outcome in _worst(outcomes).items()
        if outcome is not None and (value := _WORST[name](outcome)) is not None
    )
    others = tuple(
        (outcome.name, _way(outcome), outcome.sentence, there.saved.get(index, ""))
        for index, outcome in there.outcomes.items()
        if outcome.way not in (Way.AGREE, Way.UNDECIDED)
    )
    strata = tuple((feature, percent(share)) for feature, share in shares(outcomes).items())
    sheets = [
        Table(f"{len(outcomes)} scenes of seed {there.plan.seed}", ("ended", "scenes", "share"), ways),
        Table("The largest of", ("what", "", "scene"), worst, note="The first three of the scenes that agree."),
        Table(
            "What the scenes have", ("feature", "share"), strata, note="What only answers show, of those that agree."
        ),
    ]
    if others:
        sheets.append(Table("Ended otherwise", ("scene", "ended", "why", "file"), others))
    return tuple(sheets)


def sentence(there: Stress) -> str:
    """The run in a line."""
    counts = totals(there.outcomes.values())
    said = ", ".join(f"{count} {way.words}" for way, count in counts.items() if count)
    before = f" ({there.before} of them in a run before)" if there.before else ""
    return f"{len(there.outcomes)} scenes{before}: {said or 'none'}."


def text_of(outcome: Outcome) -> str:
    """One scene in a line."""
    return f"{outcome.name}: {_way(outcome)}. {outcome.sentence}"


def _way(outcome: Outcome) -> str:
    return f"{outcome.way.words}, {outcome.ending}" if outcome.ending else outcome.way.words


def _worst(outcomes: Iterable[Outcome]) -> dict[str, Outcome | None]:
    """By what is measured the scene with the largest; of what answers show only those that agree have a part."""
    every = list(outcomes)
    found: dict[str, Outcome | None] = {}
    for name, measured in _WORST.items():
        mine = [one for one in every if one.way is Way.AGREE] if name in _OF_AGREEMENT else every
        with_value = [(value, one) for one in mine if (value := measured(one)) is not None]
        found[name] = max(with_value, key=lambda pair: pair[0])[1] if with_value else None
    return found
