"""The energy along the path: between two stations of one branch it changes by the work of what is stepped.

==========  ======================================================================
Π           strain energy less the work of the loads
P, u        value of the stepped load, and how far its place has gone along it
d, F        value of the stepped drive, and its force along it
==========  ======================================================================

    dΠ = −u dP,    dΠ = F dd

As long as u or F goes one way between two stations, the change lies between the products with its values at both ends,
and is their mean's but for half of the difference: nothing else is asked, since stations may be far apart.  Twice that
is allowed.  Where a state has jumped in between without a word, energy is lost that no work accounts for.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from comparisons.audit.seen import Seen
from scene import Answer
from scene.answer import Array
from scene.statement import DisplacementDrive

ROOM = 1.0  # times the difference of the products at both ends
FITTED = 2e-3  # of the energies: what meshes that are fitted from station to station leave between them


def balance(answer: Answer, stations: list[Seen]) -> Iterator[str]:
    """Where the energy changes by more than the work."""
    for one, other in pairwise(stations):
        if one.station.stage != other.station.stage or one.station.branch != other.station.branch:
            continue
        lost, allowed = _lost(one, other)
        if not abs(lost) <= allowed:
            yield (
                f"from {one.station.stage} {one.station.value:g} to {other.station.value:g} the energy changes by "
                f"{lost:.3g} J more than the work, of which {allowed:.2g} J can be told"
            )
    for critical in answer.critical:
        if critical.after is not None and not critical.after <= critical.energy + 1e-9 * abs(critical.energy):
            where = f"{critical.stage} {critical.value:g}"
            yield f"beyond {where} the energy is {critical.after:.4g} J, no less than before"


def _lost(one: Seen, other: Seen) -> tuple[float, float]:
    """Change of the energy less the work, and what it may be."""
    name = next(stage.steps for stage in one.scene.stages if stage.name == one.station.stage)
    step = other.values[name] - one.values[name]
    begin, end = (_driving(seen, name) for seen in (one, other))
    energies = [strain - work for strain, work in (one.energy, other.energy)]
    size = sum(abs(part) for seen in (one, other) for part in seen.energy)
    lost = energies[1] - energies[0] - 0.5 * (begin + end) * step
    return lost, ROOM * abs((end - begin) * step) + FITTED * size


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
