"""Slip of a beam's end off a rigid corner, extrapolated to infinite penalty.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
P       corner that presses on the beam's side, near an end
ℓ       arc length from P's closest point of the neutral line to that end, negative beyond
λ, s    value of the stepped parameter, and arc length of the branch
======  =====================================================================================

Beyond the beam's end the corner presses on the round end face, with a force that turns away, or on nothing. The
branch therefore ends with the beam's side, at ℓ = 0. A penalty acts along a zone. A zone that reaches the end is cut
short on a side. The branch then folds at an ℓ of the zone's width, which vanishes for an infinite penalty. A complete
zone is not affected by the end. The branch is extrapolated to ℓ = 0 from the last point with a complete zone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea_reference.advance import advance
from fea_reference.branch import Branch, Place, onwards
from fea_reference.face import corners_of
from fea_reference.model import Model
from fea_reference.slipping import along_line
from fea_reference.state import State
from fea_reference.system import System
from fea_reference.touch import Face, Touch

_NEAR = 1.0  # elements: largest distance of a zone from its end
_AT = 10.0  # times the penetration of a corner: distance beyond which the contact is on the corner's sides
_ROUNDED = 1e-9  # lengths: additional tolerance for the corner
_BESIDE = 0.1  # zone widths: distance from an end at which the zone counts as cut short
_HALVINGS = 14
_DIFFERENCE = 1e-7  # arc length increment of finite differences


@dataclass(frozen=True, slots=True)
class Stretch:
    """A segment of a branch: its first point and its arc ``length``."""

    branch: Branch
    begin: Place
    length: float


@dataclass(frozen=True, slots=True)
class Slip:
    """Slip of an end at ``value``, extrapolated from ``place``, where the contact ``one`` has a complete zone."""

    value: float
    one: Touch
    place: Place


def left_of_side(model: Model, one: Touch, z: State) -> float | None:
    """ℓ in state ``z``; None unless a single corner presses on the side within an element of an end."""
    seen = _corner(model, one, z)
    if seen is None or np.abs(one.zeta - seen[1]).max() > _NEAR:
        return None
    return _left(model, one, z, *seen)


def slipped_off(model: Model, one: Touch, before: State, after: State) -> bool:
    """True if a corner that presses on a side in state ``before`` lies beyond the end in ``after``."""
    seen = _corner(model, one, before)
    return seen is not None and _left(model, one, before, *seen) > 0.0 > _left(model, one, after, *seen)


def left_a_corner(model: Model, before: System, after: System) -> bool:
    """True if a pressing corner came past an end of the side, and the end is not in contact with it."""
    for one in before.touches:
        if slipped_off(model, one, before.z, after.z):
            now, seen = _named(after, one.pair.name), _corner(model, one, before.z)
            there = None if now is None else _corner(model, now, after.z)
            if seen is None or there is None or there[0] != seen[0]:
                return True
    return False


def cut_short(model: Model, system: System) -> bool:
    """True if a corner's zone beside an end is cut short, so that the penalty shifts the end of the branch."""
    pressing = (one for one in system.touches if left_of_side(model, one, system.z) is not None)
    return any(_cut_short(model, one, _BESIDE) for one in pressing)


def slips(model: Model, gone: Sequence[Stretch], end: System) -> Slip | None:
    """The slip beyond the segments ``gone`` of a branch that penalties end early, at ``end``; None without a slip."""
    for last in end.touches:
        if left_of_side(model, last, end.z) is None or not _cut_short(model, last, _BESIDE):
            continue
        name, place = last.pair.name, gone[-1].begin
        for stretch in reversed(gone):
            before = _named(stretch.begin.system, name)
            if before is None or _corner(model, before, stretch.begin.system.z) is None:
                break
            place = stretch.begin
            if not _cut_short(model, before):
                place = _whole(model, name, stretch)
                break
        return _foreseen(model, name, place)
    return None


def _foreseen(model: Model, name: str, place: Place) -> Slip | None:
    """The slip extrapolated from a ``place`` with a complete zone of the named contact; None if ℓ does not decrease."""
    one, z = _named(place.system, name), place.system.z
    seen = None if one is None else _corner(model, one, z)
    if one is None or seen is None:
        return None
    here = _left(model, one, z, *seen)
    nearer = here - _left(model, one, advance(model, z, _DIFFERENCE * place.way), *seen)
    if not nearer > 0.0:
        return None
    return Slip(float(place.value + place.rate * _DIFFERENCE * here / nearer), one, place)


def _whole(model: Model, name: str, stretch: Stretch) -> Place:
    """The last point of a segment with a complete zone; the zone is complete at its beginning."""
    found, low, high = stretch.begin, 0.0, stretch.length
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        there = onwards(stretch.branch, stretch.begin, middle)
        one = None if there is None else _named(there.system, name)
        if there is None or one is None or not there.curvature > 0.0 or _cut_short(model, one):
            high = middle
        else:
            low, found = middle, there
    return found


def _named(system: System, name: str) -> Touch | None:
    """The closed contact with this name; None if there is none."""
    return next((one for one in system.touches if one.pair.name == name and one.closed), None)


def _cut_short(model: Model, one: Touch, within: float = 0.0) -> bool:
    """True if a zone reaches an end of the beam, or comes as near as a share ``within`` of its length."""
    elements = model.beams[one.pair.first].elements
    first, last = float(one.zones.intervals.min()), float(one.zones.intervals.max())
    return bool(min(first, elements.stop - elements.start - last) <= within * (last - first))


def _corner(model: Model, one: Touch, z: State) -> tuple[int, int] | None:
    """Number of the only corner that presses on the beam, and the nearer end ζ; None without such a corner."""
    face = one.pair
    if not isinstance(face, Face) or not one.closed:
        return None
    corners = corners_of(model, face, z)
    n = model.line(model.beams[face.first], z).n
    end = 0 if 2.0 * float(np.median(one.zeta)) < n else n
    if corners.size == 0 or end in face.own:
        return None
    places = one.x_m[0] + 1j * one.x_m[1]
    number = int(np.argmin(np.abs(corners - places.mean())))
    if np.abs(places - corners[number]).max() > _AT * one.penetration + _ROUNDED:
        return None
    return number, end


def _left(model: Model, one: Touch, z: State, number: int, end: int) -> float:
    """ℓ of the given corner and end in state ``z``."""
    face = one.pair
    assert isinstance(face, Face)
    P, line = corners_of(model, face, z)[number], model.line(model.beams[face.first], z)
    s = along_line(line, np.array([[P.real], [P.imag]]), float(np.median(one.zeta)))
    return s if end == 0 else float(line.lengths.sum()) - s
