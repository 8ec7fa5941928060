"""The energy along the path: between two stations of one branch it changes by the work of what is stepped.

==========  ======================================================================
Π           strain energy less the work of the loads
P, u        value of the stepped load, and how far its place has gone along it
d, F        value of the stepped drive, and its force along it
g, x, h     u or F; the value P or d; the way between two stations
==========  ======================================================================

    dΠ = −u dP,    dΠ = F dd

As long as g goes one way between two stations, the change lies between the products with its values at both ends, and
is their mean's but for half of the difference: nothing else is asked, since stations may be far apart.  Twice that is
allowed.  A reaction may rise and fall again in between, and have nearly one value at both ends.  Of that the station
before or behind tells: a parabola through g at all three holds |g[x₀, x₁, x₂]| h³/6 more or less than the mean, in
divided differences; twice the larger of these is allowed too.  Before a stage's first station that is the last one of
the stage before, or rest, where g is nought.  Where a state has jumped in between without a word, energy is lost that
no work accounts for.  Where there is no third station that alone is asked: g may have been larger in between, and
nothing says by how much.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np

from comparisons.audit.seen import Seen
from cprbm_scene import Answer
from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive

ROOM = 1.0  # times the difference of the products at both ends
CURVED = 2.0  # times what a parabola through a third station makes of it
FITTED = 2e-3  # of the energies: what meshes that are fitted from station to station leave between them


def balance(answer: Answer, stations: list[Seen]) -> Iterator[str]:
    """Where the energy changes by more than the work."""
    for i, (one, other) in enumerate(pairwise(stations)):
        if one.station.stage != other.station.stage or one.station.branch != other.station.branch:
            continue
        beside = [*_before(stations, i), *stations[i + 2 : i + 3]]
        lost, allowed = _lost(one, other, beside)
        if not -allowed <= lost <= (allowed if beside else np.inf):
            yield (
                f"from {one.station.stage} {one.station.value:g} to {other.station.value:g} the energy changes by "
                f"{lost:.3g} J more than the work, of which {allowed:.2g} J can be told"
            )
    for critical in answer.critical:
        if critical.after is not None and not critical.after <= critical.energy + 1e-9 * abs(critical.energy):
            where = f"{critical.stage} {critical.value:g}"
            yield f"beyond {where} the energy is {critical.after:.4g} J, no less than before"


def _before(stations: list[Seen], i: int) -> list[Seen | None]:
    """The station before number ``i``, None for the rest that all beams begin from; nothing where that is unknown."""
    if i > 0:
        return [stations[i - 1]]
    first = stations[0]
    at_rest = first.scene.assembly is None and first.station.stage == first.scene.stages[0].name
    return [None] if at_rest else []


def _lost(one: Seen, other: Seen, beside: Iterable[Seen | None]) -> tuple[float, float]:
    """Change of the energy less the work, and what it may be, with stations before or behind ``beside`` these."""
    name = next(stage.steps for stage in one.scene.stages if stage.name == one.station.stage)
    step = other.values[name] - one.values[name]
    begin, end = (_driving(seen, name) for seen in (one, other))
    energies = [strain - work for strain, work in (one.energy, other.energy)]
    size = sum(abs(part) for seen in (one, other) for part in seen.energy)
    lost = energies[1] - energies[0] - 0.5 * (begin + end) * step
    bent = 0.0
    for third in beside:
        if third is not None and third.station.branch != one.station.branch:
            continue
        value, driving = (0.0, 0.0) if third is None else (third.values[name], _driving(third, name))
        gaps = value - one.values[name], value - other.values[name]
        if step != 0.0 and all(gap * step != 0.0 for gap in gaps):
            slope, behind = (end - begin) / step, (driving - end) / gaps[1]
            bent = max(bent, abs((behind - slope) / gaps[0] * step**3) / 6.0)
    return lost, ROOM * abs((end - begin) * step) + CURVED * bent + FITTED * size


def _driving(seen: Seen, name: str) -> float:
    """dΠ by the value of what is stepped: −u or F."""
    if name in seen.scene.loads:
        return -seen.way_of(name)
    drive, statics = seen.scene.drives[name], seen.statics
    total = 0.0
    for by, force, moment in zip(statics.by, statics.forces, statics.moments, strict=True):
        if by == name:
            total += _along(force, drive.direction) if isinstance(drive, DisplacementDrive) else float(moment)
    return total


def _along(force: Array, direction: tuple[float, float]) -> float:
    x, y = direction
    return float((force[0] * x + force[1] * y) / (x * x + y * y) ** 0.5)
