"""What the answers at three sizes settle: the finest values, or what they extrapolate to, and what each states.

===========  =============================================================================================
symbol       meaning
===========  =============================================================================================
v_0 v_1 v_2  a probe's values at N/2, N and 2N
p            the order that :mod:`comparisons.order` assumes of them
q            the order of the largest changes in the stage, |v_1 − v_0| / |v_2 − v_1| = 2^q, between 1/2 and p
ρ            2^p/(2^p − 1)
w r          the value at N + N/7, and N over that number
V_i          the extrapolation of v_(i−1) and v_i, :func:`comparisons.convergence.limit`
===========  =============================================================================================

An estimate is always S·ρ·|value − beside it| (:mod:`comparisons.measures`), of two answers.  So each way of settling a
value comes with the answer to hold it against:

* *kept*: v_2 beside v_2 + (v_2 − v_1)/(ρ (2^q − 1)), so that S·|v_2 − v_1|/(2^q − 1) is stated, the error of v_2 if it
  falls as the changes have done. With q = p that is the value at 4N that the law through v_1 and v_2 foretells;
* *extrapolated*: V_2 beside V_2 + (V_1 − V_2)/ρ, so that S·|V_2 − V_1| is stated.  V_1's error is larger than V_2's:
  two successive extrapolations differ by more than the last one errs.

Where the error may be uneven in N, two changes may be small by accident: what the even law through v_1 and v_2 does not
foretell of w, the value at N + N/7 links (:mod:`comparisons.measures`), is d at N. Of v_2 it may be d/2^p, of what is
extrapolated twice d/(2^p − 1): d/2^p of v_2 times ρ, and d of v_1 times ρ − 1. A third answer is made from which that
follows as it does from w beside v_1 and v_2.

Shapes, places of contact, events and certificates are the finest answer's, critical values and branches of what it is
held against those at N.  Where a contact is open at one size and closed at another, or branches are different, values
are not of one law, and are kept; so are the ends of a zone that would change places, which
then is no longer than they are uncertain.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from comparisons.converging.limits import limit
from comparisons.order import foretold, order_of, richardson, unforeseen
from comparisons.scales import norm
from comparisons.stations import station_of
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict

Sizes = tuple[int, int, int]
Three = tuple[Answer, Answer, Answer]
Orders = dict[tuple[str, str], float]

SLOWEST = 0.5
"""The least order that is believed: what falls more slowly goes nowhere soon, and its own size is stated."""


def settled(scene: Scene, sizes: Sizes, answers: Three, probes: Collection[str]) -> tuple[Answer, Answer]:
    """The settled answer and the one to hold it against.

    Args:
        scene: the question.
        sizes: N/2, N, 2N.
        answers: at these, whole ones.
        probes: names of those whose values are extrapolated; all others are kept.
    """
    orders = _orders(scene, answers)
    both = [_station(scene, sizes, answers, station, probes, orders) for station in answers[-1].stations]
    seconds = sum(answer.seconds for answer in answers)
    value, beside = (replace(answers[-1], stations=stations, seconds=seconds) for stations in zip(*both, strict=True))
    beside = replace(beside, critical=answers[1].critical)
    if not probes:
        return value, beside
    settings = frozendict({**value.settings, "extrapolated_from": list(sizes[1:])})
    return replace(value, settings=settings, notes=(*value.notes, told(sizes[1:], probes))), beside


def uneven(
    scene: Scene, answers: Three, beside: Answer, ratio: float, pair: tuple[Answer, Answer], probes: Collection[str]
) -> Answer:
    """The answer to hold a settled ``pair`` against as one at N + N/7 is held against those at N and 2N.

    Args:
        scene: the question.
        answers: at N/2, N and 2N, whole ones.
        beside: at N + N/7, a whole one.
        ratio: r.
        pair: what :func:`settled` made of the answers.
        probes: names of those whose values are extrapolated.
    """
    stations = []
    for at in beside.stations:
        v_1, v_2, v, V = (station_of(each, at.stage, at.value) for each in (*answers[1:], *pair))
        values = dict(at.values)
        for probe in scene.probes:
            own = [each.values[probe.name] for each in (v_1, v_2, at, v, V)]
            if len({each.shape for each in own}) > 1:
                continue  # left as it is: where one has a value and another none, nothing is told
            p = order_of(scene, probe)
            share = 2.0 / (2.0**p - 1.0) if probe.name in probes else 2.0**-p
            d = unforeseen(own[0], own[1], own[2], ratio, p)
            values[probe.name] = frozen_array(foretold(own[3], own[4], ratio, p) + share * d * ratio**p)
        stations.append(replace(at, values=frozendict(values), beams={}, forces=PointForces(), statics=None))
    return replace(beside, stations=tuple(stations))


def told(sizes: tuple[int, ...], probes: Collection[str]) -> str:
    """Which values are extrapolated from two ``sizes``, and where the others are from."""
    coarse, fine = sizes
    which = ", ".join(sorted(probes))
    return (
        f"Extrapolated from N = {coarse}, {fine}: {which}; all other values, shapes and certificates are of N = {fine}."
    )


def _station(
    scene: Scene, sizes: Sizes, answers: Three, fine: StationAnswer, probes: Collection[str], orders: Orders
) -> tuple[StationAnswer, StationAnswer]:
    first, coarse = (station_of(answer, fine.stage, fine.value) for answer in answers[:2])
    one_law = first.touching.keys() == coarse.touching.keys() == fine.touching.keys()
    one_law = one_law and first.branch == coarse.branch == fine.branch
    values, beside = {}, {}
    for probe in scene.probes:
        three = [station.values[probe.name] for station in (first, coarse, fine)]
        found: tuple[Array, Array] | None = None
        if one_law and probe.name in probes and three[0].shape == three[1].shape == three[2].shape != (0,):
            found = _extrapolated(scene, probe, sizes, three)
        if found is None:
            found = _kept(scene, probe, three[1], three[2], orders[fine.stage, probe.name])
        values[probe.name], beside[probe.name] = map(frozen_array, found)
    # limits are no state's, so that nothing says what acts
    beside_it = replace(
        fine, values=frozendict(beside), branch=coarse.branch, beams={}, forces=PointForces(), statics=None
    )
    return replace(fine, values=frozendict(values), beams={}, forces=PointForces(), statics=None), beside_it


def _orders(scene: Scene, answers: Three) -> Orders:
    """q by stage and probe; p where nothing has changed."""
    found: Orders = {}
    for stage in scene.stages:
        levels = [[station_of(answer, stage.name, value) for value in stage.stations] for answer in answers]
        for probe in scene.probes:
            p = float(order_of(scene, probe))
            first, second = (
                max((_change(probe, a, b) for a, b in zip(levels[i], levels[i + 1], strict=True)), default=0.0)
                for i in (0, 1)
            )
            fallen = np.log2(first / second) if first > 0.0 and second > 0.0 else p
            found[stage.name, probe.name] = float(np.clip(fallen, SLOWEST, p))
    return found


def _change(probe: Probe, one: StationAnswer, other: StationAnswer) -> float:
    a, b = one.values[probe.name], other.values[probe.name]
    return norm(probe.quantity, b - a) if a.shape == b.shape and one.branch == other.branch else 0.0


def _kept(scene: Scene, probe: Probe, coarse: Array, fine: Array, q: float) -> tuple[Array, Array]:
    if coarse.shape != fine.shape:
        return fine, coarse
    return fine, fine + (fine - coarse) / (richardson(order_of(scene, probe)) * (2.0**q - 1.0))


def _extrapolated(scene: Scene, probe: Probe, sizes: Sizes, three: list[Array]) -> tuple[Array, Array] | None:
    order = order_of(scene, probe)
    earlier, last = (limit(sizes[i : i + 2], np.array(three[i : i + 2]), order).value for i in (0, 1))
    if probe.quantity == "ends" and np.any(np.diff(last) < 0.0):
        return None
    return last, last + (earlier - last) / richardson(order)
