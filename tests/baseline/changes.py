"""The change of every run between two records.

========================  ====================================================================================
class                     meaning
========================  ====================================================================================
same                      all numbers within 1e-9 of their scales
moved within              numbers moved by at most the uncertainty stated in the old record
won                       a station or a whole answer is new
states less               a row's stated uncertainty fell below four fifths of the old one
moved beyond              a number moved by more than stated, or a critical point went or came
lost                      no longer there: a station, a row or a whole answer of the old record
word changed              the verdict is another one
crashed                   the run crashed, and did not in the old record
========================  ====================================================================================

A run with changes from *states less* on is in all classes of these changes; any other run is in its last class.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from enum import Enum

from tests.baseline.measuring import Entry
from tests.baseline.record import Record
from tests.baseline.scales import ROUND_OFF, norm, probe_scales, quantity_of
from tests.baseline.stated import StatedUncertainty, by_place

SAME = 1e-9
"""Largest distance of two equal values over the probe's scale."""

SMALLER = 0.8
"""A new stated uncertainty below this share of the old one is smaller; inverse of Roache's safety factor."""

ABSENT_WHILE_OPEN = frozenset({"centre", "ends", "closing_load"})
"""Quantities without a value while a contact is open; the contact's force then decides."""


class Change(Enum):
    """Class of a run's change, in ascending order of weight; the value is the name on the screen."""

    SAME = "same"
    WITHIN = "moved within the stated uncertainty"
    WON = "won"
    LESS = "states less uncertainty"
    BEYOND = "moved beyond the stated uncertainty"
    LOST = "lost"
    WORD = "word changed"
    CRASHED = "crashed"


WEIGHT = tuple(Change)
FAILING = frozenset({Change.LESS, Change.BEYOND, Change.LOST, Change.WORD, Change.CRASHED})
Detail = tuple[Change, str]


@dataclass(frozen=True, slots=True)
class Finding:
    """The change of one run.

    Attributes:
        change: its class.
        run: name of the run.
        scene: name of its scene.
        sentence: the first number that puts the run into its class.
        word: the new verdict of a comparison, else empty.
    """

    change: Change
    run: str
    scene: str
    sentence: str = ""
    word: str = ""


def compare_records(
    old: Record, new: Record, *, same: float = SAME, improved: Collection[str] = ()
) -> Iterator[Finding]:
    """The findings of every run of the old record, by name: a finding for every failing class, else a single finding.

    Args:
        old: the record that states the uncertainties.
        new: the record that is compared with it.
        same: share of a probe's scale up to which two values are the same.
        improved: parts of the stated uncertainty (``cprbm``, ``fea``, ...) that may become smaller.
    """
    of_scene: dict[str, list[Entry]] = defaultdict(list)
    for entry in old.entries.values():
        of_scene[entry["scene"]].append(entry)
    for name, before in sorted(old.entries.items()):
        after = new.entries.get(name)
        if after is None:
            yield Finding(Change.LOST, name, before["scene"], "the new record lacks this run")
            continue
        stated = StatedUncertainty(before, of_scene[before["scene"]])
        first: dict[Change, str] = {}
        for change, sentence in _details(before, after, stated, same, improved):
            first.setdefault(change, sentence)
        failing = [change for change in WEIGHT if change in first and change in FAILING]
        mild = max(first, key=WEIGHT.index, default=Change.SAME)
        for change in failing or [mild]:
            yield Finding(change, name, before["scene"], first.get(change, ""), after.get("verdict", ""))


def _details(
    before: Entry, after: Entry, stated: StatedUncertainty, same: float, improved: Collection[str]
) -> Iterator[Detail]:
    if before["outcome"] != "answered" or after["outcome"] != "answered":
        yield from _outcomes(before, after)
        return
    yield from _critical_points(before, after, same)
    if before["solver"] == "comparison":
        if before["verdict"] != after["verdict"]:
            yield Change.WORD, f"{before['verdict']} before, {after['verdict']} now: {after['sentence']}"
        yield from _rows(before, after, same, improved)
    else:
        yield from _stations(before, after, stated, same)


def _outcomes(before: Entry, after: Entry) -> Iterator[Detail]:
    was, now = before["outcome"], after["outcome"]
    if now == "crashed" and was != "crashed":
        yield Change.CRASHED, after["sentence"]
    elif was == "answered":
        yield Change.LOST, f"{now}: {after['sentence']}"
    elif now == "answered":
        yield Change.WON, f"{was} before: {before['sentence']}"


def _stations(before: Entry, after: Entry, stated: StatedUncertainty, same: float) -> Iterator[Detail]:
    old, new = by_place(before["stations"]), by_place(after["stations"])
    scales = probe_scales(before["stations"])
    for (stage, load, _), station in old.items():
        where = f"stage {stage} at {load:g}"
        if (stage, load, "") not in new:
            yield Change.LOST, f"{where} is not reached: {after['ending']}: {after['sentence']}"
            break  # all later stations are lost too
        values = new[stage, load, ""]["values"]
        for probe, was in station["values"].items():
            now = values.get(probe)
            if now is None:
                yield Change.LOST, f"{where}: no value of {probe}"
            elif len(was) == len(now):
                moved = norm(probe, [a - b for a, b in zip(was, now, strict=True)])
                floor = max(same * scales[stage, probe], ROUND_OFF * before["natural"][quantity_of(probe)])
                if not moved <= floor:
                    bound = stated.of((stage, load, probe), was)
                    scale = max(scales[stage, probe], floor)
                    yield _moved(moved, bound), f"{where}: {probe} moved by {_shares(moved, bound, scale)}"
            elif not _force_decides(probe, station):
                yield Change.BEYOND, f"{where}: {probe} has {len(now)} numbers, {len(was)} before"
    if set(new) - set(old):
        yield Change.WON, f"{len(set(new) - set(old))} stations more than before"


def _force_decides(probe: str, station: Entry) -> bool:
    """True if the station also holds the force of a contact whose place or closing load may be absent."""
    return quantity_of(probe) in ABSENT_WHILE_OPEN and f"{probe.rpartition('.')[0]}.force" in station["values"]


def _rows(before: Entry, after: Entry, same: float, improved: Collection[str]) -> Iterator[Detail]:
    new = by_place(after["rows"])
    for (stage, load, probe), was in by_place(before["rows"]).items():
        where = f"row of {probe}, stage {stage} at {load:g}"
        now = new.get((stage, load, probe))
        if now is None or (was["uncertainty"] and not now["uncertainty"]):
            yield Change.LOST, f"{where}: {'missing' if now is None else 'not compared any more'}"
            continue
        if not was["uncertainty"]:
            continue
        scale, total = was["scale"], sum(was["uncertainty"].values())
        moved = abs(was["difference"] - now["difference"])
        if not moved <= same * scale:
            yield _moved(moved, total), f"{where}: the difference moved by {_shares(moved, total, scale)}"
        for part, bound in was["uncertainty"].items():
            states = now["uncertainty"].get(part, 0.0)
            if not abs(states - bound) <= same * scale:
                smaller = states < SMALLER * bound and part not in improved
                change = Change.LESS if smaller else Change.WITHIN
                yield change, f"{where}: {part} states {states / scale:.2g} of the scale, {bound / scale:.2g} before"


def _critical_points(before: Entry, after: Entry, same: float) -> Iterator[Detail]:
    old, new = before["critical"], after["critical"]
    if [(each["stage"], each["kind"]) for each in old] != [(each["stage"], each["kind"]) for each in new]:
        yield Change.BEYOND, f"critical points: {_kinds(old)} before, {_kinds(new)} now"
        return
    for was, now in zip(old, new, strict=True):
        if "load" not in was:
            continue
        moved = abs(was["load"] - now["load"])
        if not moved <= same * abs(was["load"]):
            sentence = f"the critical load of stage {was['stage']} is {now['load']:.8g}, {was['load']:.8g} before"
            yield _moved(moved, was["uncertainty"]), sentence


def _moved(moved: float, bound: float) -> Change:
    return Change.WITHIN if moved <= bound else Change.BEYOND


def _shares(moved: float, bound: float, scale: float) -> str:
    return f"{moved / scale:.2g} of its scale, {bound / scale:.2g} is stated"


def _kinds(critical: list[Entry]) -> str:
    return ", ".join(f"{each['kind']} in {each['stage']}" for each in critical) or "none"
